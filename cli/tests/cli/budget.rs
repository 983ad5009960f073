use crate::Folder;
use serde_json::{Value, json};

const SMALL: [&str; 6] = ["--size", "16x16", "--backend", "cpu", "--bounces", "2"];

/// A table in which one voxel setting is quick and good, and nothing else is.
fn table(scene: &str) -> Value {
    let point = |method: &str, settings: Value, sampling: &str, seconds: f64, relmse: f64, flip: f64| {
        json!({
            "method": method, "settings": settings, "seconds": { "median": seconds },
            "steps": [{ "name": sampling, "seconds": seconds }], "errors": { "relmse": relmse, "flip": flip },
        })
    };
    json!({
        "scene": { "source": scene, "triangles": 32 }, "size": [16, 16],
        "points": [
            point("reference", json!([["--spp", "16"]]), "trace_paths", 0.05, 4.0, 0.8),
            point("reference", json!([["--spp", "64"]]), "trace_paths", 0.2, 1.0, 0.4),
            point("voxel", json!([["--spp", "4"], ["--grid", "24"], ["--storage", "iso"]]), "trace_paths", 0.01, 0.02, 0.06),
            point("voxel", json!([["--spp", "4"], ["--grid", "48"], ["--storage", "iso"]]), "trace_paths", 0.01, 0.09, 0.09),
        ],
    })
}

fn sidecar(folder: &Folder) -> Value {
    serde_json::from_slice(&folder.read("cornell.json")).unwrap()
}

#[test]
fn budgets_choose_what_was_best() {
    let folder = Folder::new();
    folder.write("costs.json", &table("builtin:cornell").to_string());
    let flags = ["render", "builtin:cornell", "--budget", "0.5", "--costs", "costs.json"];
    let said = folder.run(&[&flags[..], &SMALL].concat()).ok().stderr;
    assert!(said.contains("chosen: --method voxel --grid 24 --storage iso with about"), "{said}");
    let found = sidecar(&folder);
    assert_eq!(found["settings"]["method"], "voxel");
    assert_eq!(found["settings"]["voxel"]["grid"], 24);
    assert_eq!(found["result"]["stop"], "time", "it samples as long as there is time");
    assert_eq!(found["budget"]["seconds"], 0.5);
    assert!(found["budget"]["expected"]["relmse"].as_f64().unwrap() < 0.021);
    // Of one method, that one's best.
    let said = folder.run(&[&flags[..], &SMALL, &["--method", "reference"]].concat()).ok().stderr;
    assert!(said.contains("chosen: --method reference with about"), "{said}");
}

#[test]
fn targets_choose_what_is_quickest() {
    let folder = Folder::new();
    std::fs::create_dir(folder.path("cornell-cost")).unwrap();
    folder.write("cornell-cost/cost.json", &table("builtin:cornell").to_string());
    let target = |flip: &str| {
        folder.run(&[&["render", "builtin:cornell", "--target-flip", flip][..], &SMALL].concat()).ok().stderr
    };
    let said = target("0.07");
    assert!(said.contains("--grid 24") && said.contains("measured in cornell-cost"), "{said}");
    assert_eq!(sidecar(&folder)["result"]["stop"], "samples");
    let said = target("0.0001");
    assert!(said.contains("notice: no setting that was measured comes down to a ꟻLIP of 0.0001"), "{said}");
}

/// Where nothing is known of a scene, builtin scenes stand for it.
#[test]
fn other_scenes_are_judged_by_builtin_ones() {
    let folder = Folder::new();
    folder.write("cornell-cost.json", "{}");
    let said =
        folder.run(&[&["render", "builtin:cornell", "--budget", "0.4"][..], &SMALL].concat()).ok().stderr;
    assert!(said.contains("expected by what was measured in builtin scenes"), "{said}");
}

#[test]
fn wrong_budgets_are_named() {
    let folder = Folder::new();
    folder.write("other.json", &table("builtin:axis").to_string());
    folder.write("none.json", "{}");
    let refused = |flags: &[&str], code: i32, why: &str| {
        folder.run(&[&["render", "builtin:cornell", "--backend", "cpu"], flags].concat()).fails(code, why);
    };
    refused(&["--budget", "0"], 2, "write seconds above 0");
    refused(&["--target-flip", "1.5"], 2, "write a number between 0 and 1");
    refused(&["--budget", "1", "--spp", "4"], 2, "cannot be used with");
    refused(&["--budget", "1", "--grid", "64"], 2, "--grid would be chosen by --budget or --target-flip");
    refused(&["--budget", "1", "--costs", "other.json"], 2, "other.json is about 'builtin:axis'");
    refused(&["--budget", "1", "--costs", "none.json"], 3, "no table of costs: `twinlight cost` writes one");
    refused(&["--budget", "1", "--costs", "missing.json"], 5, "missing.json");
}
