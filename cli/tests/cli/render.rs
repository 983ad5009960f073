use crate::Folder;
use twinlight::io::image::{Samples, exr, read_layers, read_rgb};
use twinlight::scene::Limits;

const SMALL: [&str; 8] = ["--size", "16x16", "--spp", "4", "--backend", "cpu", "--threads", "2"];

fn small<'a>(scene: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    [&["render", scene], &SMALL[..], more].concat()
}

#[test]
fn furnace_gives_png_exr_and_sidecar() {
    let folder = Folder::new();
    let run = folder.run(&small("builtin:furnace", &[])).ok();
    assert_eq!(run.stdout, "furnace.png\nfurnace.exr\nfurnace.json\n");
    let summary = run.stderr.strip_prefix("4 samples per pixel in ").expect("no bar and no notice before it");
    assert!(summary.contains(" paths/s, CPU, 2 threads)\n") && summary.lines().count() == 1, "{summary}");
    assert_eq!(folder.run(&small("builtin:furnace", &["--progress", "never"])).ok().stderr, "");

    let limits = Limits::default();
    let png = read_rgb(&folder.read("furnace.png"), "png", &limits).unwrap();
    assert_eq!((png.width, png.height), (16, 16));
    let bytes = folder.read("furnace.exr");
    let layers = read_layers(&bytes, "exr", &limits).unwrap();
    let names: Vec<&str> = layers.channels.iter().map(|c| c.name.as_str()).collect();
    let expected = "B G N.X N.Y N.Z R Z albedo.B albedo.G albedo.R direct.B direct.G direct.R id indirect.B indirect.G \
                    indirect.R variance.Y";
    assert_eq!(names.join(" "), expected);
    let mean = layers.f32_channel("G").unwrap().iter().sum::<f32>() / 256.0;
    // Radiance is 1 everywhere; roulette with four samples leaves some noise.
    assert!((mean - 1.0).abs() < 0.1, "{mean}");
    assert!(matches!(layers.channel("id"), Some(Samples::U32(ids)) if ids.iter().all(|&id| id != u32::MAX)));
    let attributes = exr::read_attributes(&bytes, "exr", &limits).unwrap();
    assert!(attributes.contains(&("samples".into(), "4".into())), "{attributes:?}");

    let sidecar: serde_json::Value = serde_json::from_slice(&folder.read("furnace.json")).unwrap();
    assert_eq!(sidecar["result"]["stop"], "samples");
    assert_eq!(sidecar["result"]["samples"]["least"], 4);
    assert_eq!(sidecar["settings"]["size"], serde_json::json!([16, 16]));
    assert_eq!(sidecar["backend"]["kind"], "cpu");
    assert!(sidecar["seconds"]["trace_paths"].as_f64().unwrap() > 0.0);
}

#[test]
fn same_bytes_for_any_number_of_threads_and_twice() {
    let folder = Folder::new();
    let mut files = Vec::new();
    for threads in ["1", "2", "3", "8", "8"] {
        let arguments = ["render", "builtin:cornell", "--size", "24x24", "--spp", "9", "--backend", "cpu"];
        folder.run(&[&arguments[..], &["--threads", threads]].concat()).ok();
        files.push((folder.read("cornell.exr"), folder.read("cornell.png")));
    }
    assert!(files.iter().all(|f| *f == files[0]));
    let other_seed = ["--spp", "9", "--backend", "cpu", "--seed", "1"];
    folder.run(&[&["render", "builtin:cornell", "--size", "24x24"], &other_seed[..]].concat()).ok();
    assert_ne!(folder.read("cornell.exr"), files[0].0);
}

/// G9: a scene without triangles is black, with a notice.
#[test]
fn g9_empty_scene_is_black_with_a_notice() {
    let folder = Folder::new();
    let run = folder.run(&small("builtin:empty", &["-o", "new/folder/e.exr"])).ok();
    assert_eq!(run.stdout, "new/folder/e.exr\nnew/folder/e.json\n");
    assert!(run.stderr.contains("notice: no triangles in the scene"), "{}", run.stderr);
    let image = read_rgb(&folder.read("new/folder/e.exr"), "e", &Limits::default()).unwrap();
    assert!(image.pixels.iter().all(|p| *p == [0.0; 3]));
}

#[test]
fn scene_settings_count_until_a_flag_says_otherwise() {
    let folder = Folder::new();
    folder.write(
        "room.toml",
        "[render]\nsize = [12, 8]\nspp = 2\nbounces = 1\nseed = 7\n[[mesh]]\npath = \"builtin:furnace\"\n",
    );
    let sidecar =
        |folder: &Folder| -> serde_json::Value { serde_json::from_slice(&folder.read("room.json")).unwrap() };
    folder.run(&["render", "room.toml", "--backend", "cpu"]).ok();
    let settings = sidecar(&folder)["settings"].clone();
    assert_eq!((&settings["size"], &settings["spp"]), (&serde_json::json!([12, 8]), &2.into()));
    assert_eq!((&settings["bounces"], &settings["seed"]), (&1.into(), &7.into()));
    let flags = ["--spp", "3", "--bounces", "unlimited", "--seed", "8", "--size", "4x4"];
    folder.run(&[&["render", "room.toml", "--backend", "cpu"], &flags[..]].concat()).ok();
    let settings = sidecar(&folder)["settings"].clone();
    assert_eq!((&settings["size"], &settings["spp"]), (&serde_json::json!([4, 4]), &3.into()));
    assert_eq!((&settings["bounces"], &settings["seed"]), (&serde_json::Value::Null, &8.into()));
}

#[test]
fn time_ends_a_render_but_not_before_every_pixel_has_a_sample() {
    let folder = Folder::new();
    let run = ["render", "builtin:cornell", "--size", "32x32", "--time", "0.3", "--backend", "cpu"];
    folder.run(&run).ok();
    let sidecar: serde_json::Value = serde_json::from_slice(&folder.read("cornell.json")).unwrap();
    assert_eq!(sidecar["result"]["stop"], "time");
    assert!(sidecar["result"]["samples"]["least"].as_u64().unwrap() >= 1);
}

#[test]
fn progress_lines_reach_one_and_never_fall() {
    let folder = Folder::new();
    let run = folder.run(&small("builtin:cornell", &["--progress", "json"])).ok();
    let fractions: Vec<f64> = run
        .stderr
        .lines()
        .map(|line| serde_json::from_str::<serde_json::Value>(line).unwrap()["fraction"].as_f64().unwrap())
        .collect();
    assert_eq!(fractions.last(), Some(&1.0));
    assert!(fractions.is_sorted(), "{fractions:?}");
    let run = folder.run(&small("builtin:cornell", &["--progress", "plain"])).ok();
    assert!(run.stderr.contains("100.0 %  4 spp"), "{}", run.stderr);
}

#[test]
fn a_mode_of_gpus_is_not_ignored_in_silence() {
    let folder = Folder::new();
    let run = folder.run(&small("builtin:furnace", &["--mode", "portable"])).ok();
    assert!(run.stderr.contains("notice: --mode portable is for GPUs"), "{}", run.stderr);
    let run = folder.run(&small("builtin:furnace", &["--mode", "strict"])).ok();
    assert!(!run.stderr.contains("notice"), "{}", run.stderr);
}

#[test]
fn somebodys_json_is_not_replaced() {
    let folder = Folder::new();
    folder.write("picture.json", "{\"mine\": 1}");
    let run = folder.run(&small("builtin:furnace", &["-o", "picture.png"]));
    run.fails(2, "'picture.json' exists and is not a report of twinlight");
    assert_eq!(folder.read("picture.json"), b"{\"mine\": 1}");
    // An earlier report is replaced.
    for _ in 0..2 {
        folder.run(&small("builtin:furnace", &["-o", "other.png"])).ok();
    }
}

/// A scene without camera and light: the light that is added stands beside the camera asked for.
#[test]
fn an_added_light_is_where_the_camera_is() {
    let folder = Folder::new();
    folder.write("floor.obj", "v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nf 4 3 2 1\n");
    let camera = ["--camera", "0.5,2,0.001 0.5,0,0 20", "-o", "floor.exr"];
    let run = folder.run(&small("floor.obj", &camera)).ok();
    assert!(run.stderr.contains("no light in the scene"), "{}", run.stderr);
    assert!(!run.stderr.contains("no camera"), "{}", run.stderr);
    let image = read_rgb(&folder.read("floor.exr"), "floor.exr", &Limits::default()).unwrap();
    let mean = image.pixels.iter().map(|p| p[1]).sum::<f32>() / image.pixels.len() as f32;
    assert!(mean > 0.1, "{mean}");
}
