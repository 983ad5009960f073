//! Well-known public scenes load with the triangle counts their authors state.
//!
//! The files are too large to live here: the test runs where `TWINLIGHT_SCENES` names the folder that holds them, and
//! says so where it doesn't.
#![cfg(feature = "io")]

use std::path::Path;
use std::time::Instant;
use twinlight::io::resolve::Resolver;
use twinlight::io::{LoadOptions, load, toml_scene};
use twinlight_core::scene::Scene;

/// File and triangles.
const SCENES: [(&str, usize); 16] = [
    ("cornell-box-measured/cornell-measured.obj", 32),
    ("cornell-box-original/CornellBox-Original.obj", 36),
    ("cornell-box-variants/CornellBox-Glossy.obj", 1112),
    ("cornell-box-variants/CornellBox-Glossy-Floor.obj", 1112),
    ("cornell-box-variants/CornellBox-Sphere.obj", 2188),
    ("cornell-box-variants/CornellBox-Empty-CO.obj", 12),
    ("cornell-box-variants/CornellBox-Empty-RG.obj", 12),
    ("cornell-box-variants/CornellBox-Empty-White.obj", 12),
    ("cornell-box-variants/CornellBox-Empty-Squashed.obj", 12),
    ("sponza-dabrovic/sponza.obj", 66454),
    ("conference/conference.obj", 331_179),
    ("staircase2/staircase2.obj", 31087),
    ("kitchen-lux/kitchen.obj", 86032),
    ("veach-mis/veach-mis.obj", 11956),
    ("bunny/stanford-bunny.obj", 69451),
    ("dragon-100k/dragon.obj", 100_000),
];
const MORE: [(&str, usize); 2] =
    [("buddha-100k/buddha.obj", 100_000), ("dragon-871k/dragon_vrip.ply", 871_414)];

#[test]
fn public_scenes_have_their_triangle_counts() {
    let Some(folder) = std::env::var_os("TWINLIGHT_SCENES") else {
        println!("SKIPPED: TWINLIGHT_SCENES does not name the folder of the public scenes");
        return;
    };
    for (file, triangles) in SCENES.iter().chain(&MORE) {
        let path = Path::new(&folder).join(file);
        let start = Instant::now();
        let options = LoadOptions::default();
        let scene = load(path.to_str().unwrap(), &options).unwrap_or_else(|e| panic!("{file}: {e}"));
        let milliseconds = start.elapsed().as_secs_f64() * 1e3;
        let Scene { materials, textures, notices, .. } = &scene;
        println!(
            "{file}: {} triangles, {} materials, {} textures, {milliseconds:.1} ms",
            scene.triangle_count(),
            materials.len(),
            textures.len()
        );
        notices.iter().for_each(|n| println!("    {n}"));
        assert_eq!(scene.triangle_count(), *triangles, "{file}");
        scene.validate(&options.limits).unwrap_or_else(|e| panic!("{file}: {e}"));
    }
}

#[test]
fn scene_files_for_public_models_have_cameras_and_light() {
    let Some(folder) = std::env::var_os("TWINLIGHT_SCENES") else {
        println!("SKIPPED: TWINLIGHT_SCENES does not name the folder of the public scenes");
        return;
    };
    let options = LoadOptions::default();
    let files = Path::new(env!("CARGO_MANIFEST_DIR")).join("benchmarks/scenes");
    let mut count = 0;
    for entry in std::fs::read_dir(files).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|e| e != "toml") {
            continue;
        }
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        // The files name their models as if they stood in the models' folder.
        let beside = Resolver::new(&Path::new(&folder).join(&name), &options).unwrap();
        let (scene, settings) =
            toml_scene::parse_with_settings(&std::fs::read(&path).unwrap(), &name, &beside, &options)
                .unwrap_or_else(|e| panic!("{e}"));
        assert!(scene.camera.is_some() && scene.has_light() && settings.size.is_some(), "{name}");
        scene.validate(&options.limits).unwrap_or_else(|e| panic!("{name}: {e}"));
        println!("{name}: {} triangles", scene.triangle_count());
        count += 1;
    }
    assert!(count >= 10, "{count} scene files");
}
