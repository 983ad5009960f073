//! The public test scenes, where `TWINLIGHT_SCENES` names their folder.
#![cfg(feature = "io")]

use std::path::PathBuf;
use twinlight::io::{LoadOptions, load};
use twinlight_core::scene::compile;

fn scenes(test: &str) -> Option<PathBuf> {
    let folder = std::env::var_os("TWINLIGHT_SCENES").map(PathBuf::from);
    if folder.is_none() {
        println!("SKIPPED {test}: TWINLIGHT_SCENES is not set");
    }
    folder
}

#[test]
fn triangle_counts_bounds_and_textures_of_the_public_scenes() {
    let Some(folder) = scenes("triangle_counts_bounds_and_textures_of_the_public_scenes") else { return };
    let cases = [
        ("sponza-crytek-partial/sponza.gltf", 172_473, 20, [-10.52, -0.224, -5.21, 11.46, 10.65, 4.84]),
        ("animated-fox/Fox.glb", 576, 1, [-12.6, -0.12, -88.1, 12.6, 78.9, 66.6]),
        ("animated-cesium-man/CesiumMan.glb", 4672, 1, [-0.57, 0.0, -0.13, 0.57, 1.51, 0.18]),
    ];
    for (file, triangles, textures, bounds) in cases {
        let options = LoadOptions::default();
        let scene = load(folder.join(file).to_str().unwrap(), &options).unwrap();
        assert_eq!(scene.triangle_count(), triangles, "{file}");
        assert_eq!(scene.textures.len(), textures, "{file}");
        let (lo, hi) = scene.bounds().unwrap();
        let found = [lo.x, lo.y, lo.z, hi.x, hi.y, hi.z];
        // The table gives three digits.
        for (found, expected) in found.into_iter().zip(bounds) {
            assert!(
                (found - expected).abs() <= 0.006 * f64::abs(expected).max(1.0),
                "{file}: {found} {expected}"
            );
        }
        compile(&scene, &options.limits).unwrap();
        println!("{file}: {:#?}", scene.notices);
    }
}
