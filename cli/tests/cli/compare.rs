use crate::Folder;

fn render(folder: &Folder, name: &str, more: &[&str]) {
    let fixed = ["render", "builtin:cornell", "--size", "16x16", "--backend", "cpu", "-o", name];
    folder.run(&[&fixed[..], more].concat()).ok();
}

#[test]
fn identity_thresholds_and_error_image() {
    let folder = Folder::new();
    render(&folder, "a.exr", &["--spp", "16"]);
    render(&folder, "b.exr", &["--spp", "1"]);
    let run =
        folder.run(&["compare", "a.exr", "a.exr", "--threshold", "mse=0", "--threshold", "mssim=1"]).ok();
    assert!(run.stdout.contains("the same picture bit for bit (256 pixels)"), "{}", run.stdout);
    assert!(run.stdout.contains("mean (x - r)^2 / (r^2 + 0.01)"), "formulas are printed: {}", run.stdout);

    let run = folder.run(&["compare", "b.exr", "a.exr", "--threshold", "mse=0", "--error-image", "e.png"]);
    assert!(run.fails(10, "mse is ").stderr.contains("the limit is 0"));
    assert_eq!(folder.read("e.png")[1..4], *b"PNG");
    let json = folder.run(&["compare", "b.exr", "a.exr", "--json", "--threshold", "psnr=200"]);
    let value: serde_json::Value = serde_json::from_str(&json.stdout).unwrap();
    assert_eq!(json.code, Some(10), "--json does not change the code");
    assert!(value["metrics"]["mse"]["value"].as_f64().unwrap() > 0.0);
    assert_eq!(value["missed"].as_array().unwrap().len(), 1);
    folder.run(&["compare", "b.exr", "a.exr"]).ok();
}

#[test]
fn pictures_that_do_not_fit_are_3() {
    let folder = Folder::new();
    render(&folder, "a.exr", &["--spp", "1"]);
    render(&folder, "b.png", &["--spp", "1"]);
    folder.run(&["compare", "a.exr", "b.png", "--ztest"]).fails(3, "no variance.Y layer");
    folder.write("no.exr", "not a picture");
    folder.run(&["compare", "a.exr", "no.exr"]).fails(3, "no.exr");
    folder.run(&["compare", "a.exr", "a.exr", "--threshold", "rmse=1"]).fails(2, "mae, mse, nrmse");
}

#[test]
fn z_test_tells_noise_from_bias() {
    let folder = Folder::new();
    let independent = |seed| ["--spp", "256", "--sampler", "independent", "--bounces", "2", "--seed", seed];
    render(&folder, "a.exr", &independent("1"));
    render(&folder, "b.exr", &independent("2"));
    render(&folder, "direct.exr", &["--spp", "256", "--sampler", "independent", "--bounces", "1"]);
    let run = folder.run(&["compare", "a.exr", "b.exr", "--ztest"]).ok();
    assert!(run.stdout.contains("z-test of luminance passes"), "{}", run.stdout);
    folder.run(&["compare", "direct.exr", "a.exr", "--ztest"]).fails(10, "the expectations differ");
}
