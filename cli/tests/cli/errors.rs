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
        ("--spp", "-1", "1..=16777216"),
        ("--time", "-1", "seconds above 0"),
        ("--bounces", "many", "`unlimited`"),
        ("--camera", "0,0,0 0,0,0 40", "same point"),
        ("--camera", "0,0 1,1,1 40", "vertical field of view"),
        (
            "--camera",
            "2e12,0,0 0,0,0 40",
            "2000000000000.0 of position or target is not a number within ±2^40",
        ),
        ("--camera", "0,0,0 0,0,-1e300 40", "-1e300 of position or target"),
        ("--threads", "0", "1..=1024"),
        ("--backend", "cuda", "auto, cpu, gpu"),
        ("--max-memory", "1.5G", "such as 4GiB"),
        ("--tonemap", "filmic", "none, reinhard, aces"),
        ("--exposure", "99", "-64..=64"),
        ("-o", "picture.jpg", ".png or .exr"),
    ] {
        let flag_and_value = format!("{flag}={value}");
        let arguments: Vec<&str> = if flag == "-o" { vec![flag, value] } else { vec![&flag_and_value] };
        folder.run(&[&["render", "builtin:furnace"], &arguments[..]].concat()).fails(2, message);
    }
    // A separate word that begins with a dash is the value all the same.
    for flag in ["--spp", "--time", "--bounces", "--seed", "--threads"] {
        let run = folder.run(&["render", "builtin:furnace", flag, "-1"]).fails(2, "invalid value '-1'");
        assert!(!run.stderr.contains("-- -1"), "{}", run.stderr);
    }
    folder
        .run(&["compare", "a.exr", "b.exr", "--error-image", "e.jpg"])
        .fails(2, "'e.jpg': the error image is a PNG");
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
    folder.run(&["render", "builtin:furnace", "-o", "taken.png"]).fails(2, "such as 'taken.png/furnace.png'");
    let run = folder.run(&["compare", "missing.exr", "missing.exr"]).fails(5, "missing.exr: ");
    assert!(run.stderr.ends_with(" hint: the path is relative to the current folder\n"), "{}", run.stderr);
}

/// A device may never end and a pipe never begin.
#[cfg(unix)]
#[test]
fn only_regular_files_are_read() {
    let folder = Folder::new();
    let made = std::process::Command::new("mkfifo").arg(folder.path("pipe.exr")).status().unwrap();
    assert!(made.success());
    for path in ["/dev/zero", "pipe.exr", "."] {
        folder.run(&["compare", path, "a.exr"]).fails(3, &format!("{path}: is not a regular file"));
    }
    folder.write("a.toml", "[environment]\nfile = \"pipe.exr\"\n");
    folder.run(&["render", "a.toml"]).fails(3, "pipe.exr: is not a regular file");
}

#[test]
fn a_file_outside_the_folder_is_refused_with_the_way_to_allow_it() {
    let folder = Folder::new();
    folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    std::fs::create_dir(folder.path("in")).unwrap();
    folder.write("in/a.toml", "[[mesh]]\npath = \"../a.obj\"\n");
    folder.run(&["scene", "inspect", "in/a.toml"]).fails(3, "--allow-path");
    folder.run(&["scene", "inspect", "in/a.toml", "--allow-path", "."]).ok();
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
