use crate::Folder;
use twinlight::io::image::read_layers;
use twinlight::scene::Limits;

const SMALL: [&str; 8] = ["--size", "16x16", "--spp", "2", "--backend", "cpu", "--grid", "32"];

#[test]
fn voxel_renders_and_says_what_it_built() {
    let folder = Folder::new();
    let arguments = ["render", "builtin:cornell", "--method", "voxel", "--storage", "sh8", "--bounces", "2"];
    folder.run(&[&arguments[..], &SMALL].concat()).ok();
    let sidecar: serde_json::Value = serde_json::from_slice(&folder.read("cornell.json")).unwrap();
    assert_eq!(sidecar["settings"]["method"], "voxel");
    let knobs = serde_json::json!({
        "grid": 32, "storage": "sh8", "cones": "6", "light_samples": 8, "bounces": 2
    });
    assert_eq!(sidecar["settings"]["voxel"], knobs);
    assert_eq!(sidecar["settings"]["bounces"], 2);
    assert!(sidecar["result"]["voxels"].as_u64().unwrap() > 1000);
    for step in ["voxelize", "light_voxels", "reduce_mips", "trace_cones", "trace_paths"] {
        assert!(sidecar["seconds"][step].as_f64().unwrap() > 0.0, "{step}");
    }
    assert!(sidecar["seconds"]["walk_lhb"].is_null() && sidecar["seconds"]["filter_indirect"].is_null());
}

/// The sum of the layers is the picture, and indirect light there is.
#[test]
fn indirect_light_is_a_layer() {
    let folder = Folder::new();
    let arguments = ["render", "builtin:cornell", "--method", "voxel", "-o", "a.exr", "--cones", "generic:8"];
    folder.run(&[&arguments[..], &SMALL].concat()).ok();
    let image = read_layers(&folder.read("a.exr"), "exr", &Limits::default()).unwrap();
    let [sum, direct, indirect] = ["", "direct", "indirect"].map(|name| image.rgb(name).unwrap());
    let added: Vec<_> = direct.iter().zip(&indirect).map(|(a, b)| [0, 1, 2].map(|c| a[c] + b[c])).collect();
    assert_eq!(sum, added);
    assert!(indirect.iter().flatten().filter(|&&radiance| radiance > 0.0).count() > 500);
}

#[test]
fn flags_of_other_methods_are_refused() {
    let folder = Folder::new();
    let refused = |arguments: &[&str], why: &str| {
        folder.run(&[&["render", "builtin:cornell"], arguments].concat()).fails(2, why);
    };
    refused(&["--grid", "64"], "--grid is for --method voxel, and this is reference");
    refused(&["--method", "voxel", "--filter", "4"], "--filter is for --method slhb, and this is voxel");
    refused(&["--method", "voxel", "--storage", "rgb"], "'rgb' is none of iso, aniso, sh, sh8");
    refused(&["--method", "voxel", "--grid", "513"], "513 is not in 1..=512");
}
