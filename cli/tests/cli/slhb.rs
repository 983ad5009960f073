use crate::Folder;
use twinlight::io::image::{LayeredImage, read_layers, read_rgb};
use twinlight::scene::Limits;

const SMALL: [&str; 8] = ["--size", "16x16", "--spp", "2", "--backend", "cpu", "--directions", "20"];

#[test]
fn slhb_renders_and_says_what_it_built() {
    let folder = Folder::new();
    let arguments = ["render", "builtin:cornell", "--method", "slhb", "--lhb-size", "16", "--cone", "off"];
    folder.run(&[&arguments[..], &SMALL].concat()).ok();
    let sidecar: serde_json::Value = serde_json::from_slice(&folder.read("cornell.json")).unwrap();
    assert_eq!(sidecar["settings"]["method"], "slhb");
    let knobs = serde_json::json!({
        "directions": "icosahedron:20", "size": 16, "layers": null, "elements": "full", "cone": false, "trace_misses": true,
        "shadows": "rays", "gather": false, "interleave": 1, "filter": 1
    });
    assert_eq!(sidecar["settings"]["slhb"], knobs);
    assert_eq!(sidecar["result"]["lhb_views"], 10);
    assert!(sidecar["result"]["lhb_elements"].as_u64().unwrap() > 100);
    assert!(sidecar["seconds"]["rasterize_lhb"].as_f64().unwrap() > 0.0);
    assert!(sidecar["seconds"]["walk_lhb"].as_f64().unwrap() > 0.0);
    assert!(sidecar["seconds"]["trace_paths"].is_null());
    assert!(sidecar["seconds"]["filter_indirect"].is_null());
    assert!(sidecar["seconds"]["pack_lhb"].is_null() && sidecar["bytes"]["lhb_read_back"].is_null());
}

/// Every output shows filtered light, and none of them other direct light.
#[test]
fn filtered_light_is_in_every_picture() {
    let folder = Folder::new();
    let render = |name: &str, knobs: &[&str]| {
        let (png, exr) = (format!("{name}.png"), format!("{name}.exr"));
        let arguments = ["render", "builtin:cornell", "--method", "slhb", "--lhb-size", "16"];
        folder.run(&[&arguments[..], &SMALL, &["-o", &png, "-o", &exr], knobs].concat()).ok();
        let sidecar: serde_json::Value =
            serde_json::from_slice(&folder.read(&format!("{name}.json"))).unwrap();
        (folder.read(&png), read_layers(&folder.read(&exr), "exr", &Limits::default()).unwrap(), sidecar)
    };
    let noisy = render("noisy", &["--interleave", "4"]);
    let filtered = render("filtered", &["--interleave", "4", "--filter", "4"]);
    assert_eq!(filtered.2["settings"]["slhb"]["interleave"], 4);
    assert_eq!(filtered.2["settings"]["slhb"]["filter"], 4);
    assert!(filtered.2["seconds"]["filter_indirect"].as_f64().unwrap() > 0.0);
    assert_ne!(filtered.0, noisy.0);
    let layer = |image: &LayeredImage, name: &str| image.rgb(name).unwrap();
    assert_eq!(layer(&filtered.1, "direct"), layer(&noisy.1, "direct"));
    assert_ne!(layer(&filtered.1, "indirect"), layer(&noisy.1, "indirect"));
    let parts = layer(&filtered.1, "direct").into_iter().zip(layer(&filtered.1, "indirect"));
    let sum: Vec<_> = parts.map(|(direct, indirect)| [0, 1, 2].map(|c| direct[c] + indirect[c])).collect();
    assert_eq!(layer(&filtered.1, ""), sum);
}

/// Formats take the bytes that they are for, and render other pictures.
#[test]
fn elements_are_stored_as_asked_for() {
    let folder = Folder::new();
    let render = |format: &str, more: &[&str]| {
        let arguments = ["render", "builtin:cornell", "--method", "slhb", "--lhb-size", "16", "-o", "a.exr"];
        folder.run(&[&arguments[..], &SMALL, &["--elements", format], more].concat()).ok();
        let sidecar: serde_json::Value = serde_json::from_slice(&folder.read("a.json")).unwrap();
        assert_eq!(sidecar["settings"]["slhb"]["elements"], format);
        (folder.read("a.exr"), sidecar)
    };
    let number = |sidecar: &serde_json::Value, of: &str, key: &str| sidecar[of][key].as_u64().unwrap();
    let [full, packed, layers] = ["full", "packed", "layers:2"].map(|format| render(format, &[]));
    let [all, still_all, fewer] = [&full, &packed, &layers].map(|r| number(&r.1, "result", "lhb_elements"));
    assert!(all == still_all && fewer < all, "{all}, {still_all}, {fewer}");
    let [of_full, of_packed, of_layers] = [&full, &packed, &layers].map(|r| number(&r.1, "bytes", "lhb"));
    assert_eq!(of_full - of_packed, 4 * all);
    // 10 views of 16² pixels: two words and a number left out, instead of an offset and the elements.
    let lists = 10 * 16 * 16;
    assert_eq!(of_full - 8 * all - 4 * (lists + 1), of_layers - 12 * lists);
    assert_eq!(number(&packed.1, "bytes", "lhb_read_back"), 8 * all + 4 * (lists + 1));
    assert!(packed.1["seconds"]["pack_lhb"].as_f64().unwrap() > 0.0);
    assert!(full.0 != packed.0 && packed.0 != layers.0);
    // A cap before the layers leaves room in them.
    let capped = render("layers:3", &["--layers", "2"]);
    assert!(capped.0 == layers.0);
}

#[test]
fn elements_that_cannot_be_are_refused() {
    let folder = Folder::new();
    for wrong in ["layers:0", "layers", "half", "layers:-1"] {
        let failed = folder.run(&["render", "builtin:cornell", "--method", "slhb", "--elements", wrong]);
        assert_eq!(failed.code, Some(2));
        assert!(failed.stderr.contains("neither full, packed nor layers:K"), "{}", failed.stderr);
    }
    let failed = folder.run(&["render", "builtin:cornell", "--elements", "packed"]);
    assert!(failed.stderr.contains("--elements is for --method slhb"), "{}", failed.stderr);
}

#[test]
fn filters_are_of_the_method() {
    let folder = Folder::new();
    for flag in ["--interleave", "--filter"] {
        let failed = folder.run(&["render", "builtin:cornell", flag, "4"]);
        assert_eq!(failed.code, Some(2));
        let text = format!("{flag} is for --method slhb, and this is reference");
        assert!(failed.stderr.contains(&text), "{}", failed.stderr);
        for wrong in ["0", "33"] {
            let failed = folder.run(&["render", "builtin:cornell", "--method", "slhb", flag, wrong]);
            assert!(failed.stderr.contains("not in 1..=32"), "{}", failed.stderr);
        }
    }
}

/// Direct light keeps its traced shadows unless all are looked up, and indirect light has others in either case.
#[test]
fn shadows_are_looked_up_where_asked_for() {
    let folder = Folder::new();
    let render = |which: &str| {
        let exr = format!("{which}.exr");
        let arguments = ["render", "builtin:cornell", "--method", "slhb", "--lhb-size", "16"];
        folder.run(&[&arguments[..], &SMALL, &["-o", &exr, "--shadows", which]].concat()).ok();
        let sidecar: serde_json::Value =
            serde_json::from_slice(&folder.read(&format!("{which}.json"))).unwrap();
        assert_eq!(sidecar["settings"]["slhb"]["shadows"], which);
        read_layers(&folder.read(&exr), "exr", &Limits::default()).unwrap()
    };
    let [rays, indirect, all] = ["rays", "indirect", "all"].map(render);
    let layer = |image: &LayeredImage, name: &str| image.rgb(name).unwrap();
    assert_eq!(layer(&indirect, "direct"), layer(&rays, "direct"));
    assert_ne!(layer(&indirect, "indirect"), layer(&rays, "indirect"));
    assert_ne!(layer(&all, "direct"), layer(&rays, "direct"));
    let failed = folder.run(&["render", "builtin:cornell", "--shadows", "all"]);
    assert_eq!(failed.code, Some(2));
    let text = "--shadows is for --method slhb, and this is reference";
    assert!(failed.stderr.contains(text), "{}", failed.stderr);
}

/// A scene file names the method too. A scene without triangles needs no buffers; where they are asked for all the same, they have no elements.
#[test]
fn scene_files_choose_the_method() {
    let folder = Folder::new();
    let room = "[render]\nmethod = \"slhb\"\n[camera]\nposition = [0, 0, 1]\ntarget = [0, 0, 0]\n";
    folder.write("room.toml", room);
    let elements = |effects: &str| {
        folder.run(&[&["render", "room.toml", "--effects", effects], &SMALL[..]].concat()).ok();
        let sidecar: serde_json::Value = serde_json::from_slice(&folder.read("room.json")).unwrap();
        assert_eq!(sidecar["settings"]["method"], "slhb");
        sidecar["result"]["lhb_elements"].clone()
    };
    assert!(elements("auto").is_null());
    assert_eq!(elements("all"), 0);
    folder.write("room.toml", &room.replace("slhb", "radiosity"));
    let failed = folder.run(&[&["render", "room.toml"], &SMALL[..]].concat());
    assert!(failed.stderr.contains("no method is called 'radiosity'"), "{}", failed.stderr);
}

#[test]
fn show_draws_a_hit_buffer() {
    let folder = Folder::new();
    let arguments =
        ["render", "builtin:cornell", "--directions", "20", "--lhb-size", "24", "--show", "lhb:4"];
    let run = folder.run(&arguments).ok();
    assert_eq!(run.stdout, "cornell-lhb.png\n");
    assert!(run.stderr.starts_with("view 4 of 10 along "), "{}", run.stderr);
    let png = read_rgb(&folder.read("cornell-lhb.png"), "png", &Limits::default()).unwrap();
    assert_eq!((png.width, png.height), (8 * 24, 24));
    for (wrong, text) in [("lhb:10", "there are 10 views"), ("voxels", "not of the form lhb:VIEW")] {
        let arguments = ["render", "builtin:cornell", "--directions", "20", "--show", wrong];
        let failed = folder.run(&arguments);
        assert!(failed.stderr.contains(text), "{}", failed.stderr);
    }
    let two = ["render", "builtin:cornell", "--show", "lhb:0", "-o", "a.png", "-o", "b.png"];
    assert!(folder.run(&two).stderr.contains("--show draws one picture"));
}

/// A room that stays, in which a file's skin bends.
fn moving_room() -> Folder {
    let folder = Folder::new();
    let all = twinlight::fixtures::files::all();
    let bytes = &all.iter().find(|(path, _)| *path == "bending/bending.glb").expect("the fixture").1;
    std::fs::write(folder.path("b.glb"), bytes).expect("a file of the test");
    folder.write(
        "room.toml",
        "[[mesh]]\nname = 'b'\npath = 'b.glb'\n[[mesh]]\nname = 'room'\npath = 'builtin:cornell'\n[[instance]]\nmesh = 'b'\n\
         translate = [180, 340, 280]\nscale = 60\n[[instance]]\nmesh = 'room'\n",
    );
    folder
}

/// What is kept from frame to frame doesn't show: any frame is the picture of its moment.
fn frames_are_pictures_of_their_moments(backend: &str, small: &[&str]) {
    let folder = moving_room();
    let render = [
        "render",
        "room.toml",
        "--method",
        "slhb",
        "--lhb-size",
        "48",
        "--bounces",
        "3",
        "--backend",
        backend,
    ];
    let run = |more: &[&str]| folder.run(&[&render[..], small, more].concat()).ok();
    run(&["--frames", "0..3", "--fps", "2", "-o", "a.exr"]);
    run(&["--frames", "2..3", "--fps", "2", "-o", "b.exr"]);
    run(&["--at", "0.5", "-o", "c.exr"]);
    assert!(folder.read("a-0002.exr") == folder.read("b-0002.exr"));
    assert!(folder.read("a-0001.exr") == folder.read("c.exr"));
    assert!(folder.read("a-0001.exr") != folder.read("a-0002.exr"));
    let result = |name: &str| {
        let sidecar: serde_json::Value = serde_json::from_slice(&folder.read(name)).unwrap();
        let count = |key: &str| sidecar["result"][key].as_u64().unwrap();
        (count("lhb_elements_kept"), count("lhb_elements"))
    };
    let (kept, whole) = result("a-0002.json");
    assert!(kept > 1000 && kept < whole, "{kept} of {whole}");
    for first in ["a-0000.json", "b-0002.json", "c.json"] {
        assert_eq!(result(first).0, 0, "{first}");
    }
}

#[test]
fn frames_on_the_cpu_are_pictures_of_their_moments() {
    frames_are_pictures_of_their_moments("cpu", &["--size", "16x16", "--spp", "2", "--directions", "80"]);
}

/// On whichever adapter comes first, where adapters are demanded.
#[cfg(feature = "gpu")]
#[test]
fn frames_on_a_gpu_are_pictures_of_their_moments() {
    if std::env::var("TWINLIGHT_REQUIRE_GPU").is_ok_and(|value| value == "1") {
        frames_are_pictures_of_their_moments("gpu", &["--size", "8x8", "--spp", "1", "--directions", "20"]);
    }
}

/// With all directions in turn, samples come in multiples of their number.
#[test]
fn gathering_shares_samples_among_directions() {
    let folder = Folder::new();
    let room = ["render", "builtin:cornell", "--method", "slhb", "--size", "8x8", "--backend", "cpu"];
    let knobs = ["--directions", "20", "--lhb-size", "16", "--gather", "all"];
    let room = [&room[..], &knobs].concat();
    folder.run(&room).ok();
    let sidecar: serde_json::Value = serde_json::from_slice(&folder.read("cornell.json")).unwrap();
    assert_eq!(sidecar["settings"]["spp"], 80);
    let failed = folder.run(&[&room[..], &["--spp", "50"]].concat());
    assert!(failed.stderr.contains("--spp 50") && failed.stderr.contains("ask for 60"), "{}", failed.stderr);
}
