use crate::Folder;
use serde_json::Value;

fn plan(arguments: &[&str]) -> Value {
    let folder = Folder::new();
    let text = folder.run(&[&["plan"], arguments, &["--json"]].concat()).ok().stdout;
    serde_json::from_str(&text).unwrap()
}

fn decision(plan: &Value, effect: &str) -> String {
    let effects = plan["plan"]["effects"].as_array().unwrap();
    let found = effects.iter().find(|decided| decided["effect"] == effect).unwrap();
    found["decision"].as_str().unwrap().to_owned()
}

#[test]
fn plans_are_tables_for_people() {
    let folder = Folder::new();
    let text = folder.run(&["plan", "builtin:materials", "--method", "voxel", "--explain"]).ok().stdout;
    for line in [
        "refraction       lacking    unknown  cones don't go through glass",
        "textures         skipped          0  no surface has a texture",
        "surfaces see surfaces  yes: light goes through glass",
        "voxelize                 1",
    ] {
        assert!(text.contains(line), "{line} in {text}");
    }
    let short = folder.run(&["plan", "builtin:materials", "--method", "voxel"]).ok().stdout;
    assert!(text.starts_with(&short), "what is explained comes after the decisions");
}

#[test]
fn plans_are_json_for_machines() {
    let cornell = plan(&["builtin:cornell", "--tolerance", "1/255", "--size", "32x16"]);
    assert_eq!(decision(&cornell, "interreflection"), "bounded");
    assert!(cornell["plan"]["bound"].as_f64().unwrap() <= 1.0 / 255.0);
    assert_eq!(cornell["facts"]["triangles"], 32);
    assert_eq!(cornell["steps"][1]["work"], 512.0);
    assert_eq!(plan(&["builtin:cornell"]), plan(&["builtin:cornell"]), "the same twice");
    // A brighter exposure makes less radiance white, and less of it may be missing.
    let bright = plan(&["builtin:cornell", "--tolerance", "1/255", "--exposure", "4"]);
    assert!(bright["plan"]["bounces"].as_u64() > cornell["plan"]["bounces"].as_u64());
}

/// A render does what the plan of the same flags says, and its sidecar names it.
#[test]
fn renders_do_what_plans_say() {
    let folder = Folder::new();
    let flags =
        ["builtin:cornell", "--method", "slhb", "--size", "16x16", "--spp", "2", "--directions", "20"];
    folder.run(&[&["render", "--backend", "cpu"], &flags[..]].concat()).ok();
    let sidecar: Value = serde_json::from_slice(&folder.read("cornell.json")).unwrap();
    assert_eq!(sidecar["plan"], plan(&flags)["plan"]);
    assert_eq!(sidecar["settings"]["bounces"], sidecar["plan"]["bounces"]);
    assert!(sidecar["settings"]["bounces"].is_u64(), "a tolerance bounds them");
}

/// Without interreflection nothing is looked up, and nothing is built for it.
#[test]
fn what_is_left_out_is_not_built() {
    let folder = Folder::new();
    let flags = ["render", "builtin:cornell", "--method", "slhb", "--backend", "cpu", "--size", "16x16"];
    folder.run(&[&flags[..], &["--spp", "2", "--effects", "shadows"]].concat()).ok();
    let sidecar: Value = serde_json::from_slice(&folder.read("cornell.json")).unwrap();
    assert_eq!(sidecar["settings"]["effects"], "shadows");
    assert_eq!(sidecar["settings"]["bounces"], 1);
    assert!(sidecar["seconds"]["rasterize_lhb"].is_null() && sidecar["seconds"]["walk_lhb"].is_null());
    assert!(sidecar["seconds"]["trace_paths"].as_f64().unwrap() > 0.0);
}

#[test]
fn wrong_effects_and_tolerances_are_named() {
    let folder = Folder::new();
    let refused = |flags: &[&str], why: &str| {
        folder.run(&[&["plan", "builtin:cornell"], flags].concat()).fails(2, why);
    };
    refused(&["--effects", "fog"], "'fog' is none of auto, all, none, shadows");
    refused(&["--tolerance", "-1"], "write a share from 0 on");
    refused(&["--tolerance", "1/0"], "write a share from 0 on");
}
