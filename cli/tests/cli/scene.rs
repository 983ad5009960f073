use crate::Folder;

fn inspect(folder: &Folder, scene: &str) -> serde_json::Value {
    serde_json::from_str(&folder.run(&["scene", "inspect", scene, "--json"]).ok().stdout).unwrap()
}

#[test]
fn toml_keeps_every_scene_and_loads_back() {
    for name in ["cornell", "lights", "materials", "textured", "environment", "veach"] {
        let folder = Folder::new();
        let source = format!("builtin:{name}");
        folder.run(&["scene", "convert", &source, "out/s.toml"]).ok();
        let (before, after) = (inspect(&folder, &source), inspect(&folder, "out/s.toml"));
        for key in ["triangles", "lights", "camera", "notices"] {
            assert_eq!(before[key], after[key], "{name}: {key}");
        }
    }
}

/// A mesh has one material in a scene file, so triangles are reordered, but not moved or shaded otherwise.
#[test]
fn converted_scene_is_the_same_picture() {
    let folder = Folder::new();
    folder.run(&["scene", "convert", "builtin:cornell", "box.toml"]).ok();
    for (scene, out) in [("builtin:cornell", "a.exr"), ("box.toml", "b.exr")] {
        let flags = ["--size", "24x24", "--spp", "256", "--bounces", "3", "--backend", "cpu", "-o", out];
        folder.run(&[&["render", scene, "--sampler", "independent"], &flags[..]].concat()).ok();
    }
    folder.run(&["compare", "b.exr", "a.exr", "--ztest", "--threshold", "ratio=0.02"]).ok();
}

#[test]
fn ply_keeps_triangles_and_bounds_and_says_what_it_drops() {
    let folder = Folder::new();
    let run = folder.run(&["scene", "convert", "builtin:materials", "m.ply"]).ok();
    assert!(run.stderr.contains("geometry only"), "{}", run.stderr);
    let (before, after) = (inspect(&folder, "builtin:materials"), inspect(&folder, "m.ply"));
    assert_eq!((&before["triangles"], &before["bounds"]), (&after["triangles"], &after["bounds"]));
    folder.run(&["scene", "convert", "builtin:axis", "a.obj"]).fails(2, ".toml or .ply");
}

#[test]
fn inspection_list_and_schema() {
    let folder = Folder::new();
    let run = folder.run(&["scene", "inspect", "builtin:cornell"]).ok();
    assert!(run.stdout.contains("triangles   32 in "), "{}", run.stdout);
    assert!(run.stdout.contains("--camera \"278,273,-800 278,273,0 0,1,0 39.31\""), "{}", run.stdout);
    assert!(folder.run(&["scene", "list"]).ok().stdout.contains("builtin:room-70k"));
    let list: serde_json::Value =
        serde_json::from_str(&folder.run(&["scene", "list", "--json"]).ok().stdout).unwrap();
    assert_eq!(list[0]["name"], "builtin:cornell");
    let schema: serde_json::Value =
        serde_json::from_str(&folder.run(&["scene", "schema"]).ok().stdout).unwrap();
    assert!(schema["properties"]["camera"].is_object());
}

#[test]
fn a_scene_is_not_converted_onto_itself() {
    let folder = Folder::new();
    folder.run(&["scene", "convert", "builtin:furnace", "a.toml"]).ok();
    let before = folder.read("a.toml");
    folder.run(&["scene", "convert", "a.toml", "./a.toml"]).fails(2, "is the scene that is read");
    assert_eq!(folder.read("a.toml"), before);
}
