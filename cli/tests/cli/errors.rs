use crate::Folder;

#[test]
fn unknown_scenes_and_formats_are_3() {
    let folder = Folder::new();
    let run = folder.run(&["render", "builtin:cornel"]).fails(3, "did you mean 'cornell'");
    assert!(run.stderr.starts_with("error: builtin:cornel: no such builtin scene"), "{}", run.stderr);
    folder.run(&["render", "room.max"]).fails(3, "scene files end in .obj, .ply");
    folder.write("bad.toml", "[camera]\nposition = [0, 1]\n");
    folder.run(&["render", "bad.toml"]).fails(3, "bad.toml:2:");
    folder.write("method.toml", "[render]\nmethod = \"magic\"\n");
    folder.run(&["render", "method.toml"]).fails(3, "no method is called 'magic'");
    folder.write("far.obj", "v 2e12 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    for arguments in [&["render", "far.obj"][..], &["scene", "inspect", "far.obj"]] {
        let run = folder.run(arguments).fails(3, "is not a number within ±2^40");
        assert!(run.stderr.starts_with("error: far.obj: mesh "), "{}", run.stderr);
    }
    folder.run(&["render", "cornell"]).fails(3, "(did you mean 'builtin:cornell'?)");
    folder.run(&["render", "furnance"]).fails(3, "(did you mean 'builtin:furnace'?)");
    assert!(!folder.run(&["render", "quixotic"]).stderr.contains("did you mean"));
}

#[test]
fn wrong_flags_are_2_and_say_what_is_right() {
    let folder = Folder::new();
    for (flag, value, message) in [
        ("--size", "640", "WIDTHxHEIGHT"),
        ("--size", "0x4", "WIDTHxHEIGHT"),
        ("--spp", "0", "1..=16777216"),
        ("--time", "-1", "seconds above 0"),
        ("--bounces", "many", "`unlimited`"),
        ("--camera", "0,0,0 0,0,0 40", "same point"),
        ("--camera", "0,0 1,1,1 40", "vertical field of view"),
        ("--threads", "0", "1..=1024"),
        ("--backend", "cuda", "auto, cpu, gpu"),
        ("--max-memory", "1.5G", "such as 4GiB"),
        ("--tonemap", "filmic", "none, reinhard, aces"),
        ("--exposure", "99", "-64..=64"),
        ("-o", "picture.jpg", ".png or .exr"),
        (
            "--camera",
            "2e12,0,0 0,0,0 40",
            "2000000000000.0 of position or target is not a number within ±2^40",
        ),
        ("--camera", "0,0,0 0,0,-1e300 40", "-1e300 of position or target"),
    ] {
        let flag_and_value = format!("{flag}={value}");
        let arguments: Vec<&str> = if flag == "-o" { vec![flag, value] } else { vec![&flag_and_value] };
        folder.run(&[&["render", "builtin:furnace"], &arguments[..]].concat()).fails(2, message);
    }
    folder.run(&["render"]).fails(2, "SCENE");
    folder.run(&["rendr", "x"]).fails(2, "render");
}

#[test]
fn files_that_can_not_be_read_or_written_are_5() {
    let folder = Folder::new();
    folder.run(&["render", "missing.obj"]).fails(5, "missing.obj: ").fails(5, " hint: the path is relative");
    folder.write("file", "in the way");
    folder.run(&["render", "builtin:furnace", "-o", "file/a.png"]).fails(5, "file/a.png: ");
    std::fs::create_dir(folder.path("taken.png")).unwrap();
    folder.run(&["render", "builtin:furnace", "-o", "taken.png"]).fails(5, "taken.png: ");
    folder.run(&["compare", "missing.exr", "missing.exr"]).fails(5, "missing.exr: ");
}

#[test]
fn too_much_memory_is_6_before_it_is_taken() {
    let folder = Folder::new();
    folder.run(&["render", "builtin:cornell", "--max-memory", "1KiB"]).fails(6, "the limit is 1024");
    let large = ["render", "builtin:cornell", "--size", "16384x16384", "--max-memory", "1GiB"];
    folder.run(&large).fails(6, "bytes for a picture of 16384x16384 pixels").fails(6, " hint: fewer pixels");
}

#[test]
fn missing_adapters_are_7() {
    let folder = Folder::new();
    let message = if cfg!(feature = "gpu") {
        "no GPU adapter named like \"nothing like this\""
    } else {
        "built without GPU support"
    };
    let run =
        folder.run(&["render", "builtin:furnace", "--backend", "gpu:nothing like this"]).fails(7, message);
    assert!(run.stderr.contains(" hint: `twinlight devices`"), "{}", run.stderr);
}

#[test]
fn nothing_run_is_4() {
    let folder = Folder::new();
    folder.run(&["conform", "--adapter", "cpu", "--filter", "no such trial"]).fails(4, "nothing was run");
    folder.run(&["conform", "--adapter", "no such adapter"]).fails(4, "nothing was run");
}

#[test]
fn conform_writes_table_and_report() {
    let folder = Folder::new();
    let flags = ["conform", "--adapter", "cpu", "--filter", "scan.edge", "--quick", "--json", "report.json"];
    let run = folder.run(&flags).ok();
    assert!(run.stdout.contains("1 passed, 0 failed"), "{}", run.stdout);
    let report: serde_json::Value = serde_json::from_slice(&folder.read("report.json")).unwrap();
    assert_eq!(report[0]["kind"], "cpu");
    assert_eq!(report[0]["counts"]["passed"], 1);
}
