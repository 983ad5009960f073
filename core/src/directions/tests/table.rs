//! The table of the module's documentation is what the code gives.

use super::*;

const NAMES: [&str; 16] = [
    "icosahedron:20",
    "icosahedron:80",
    "icosahedron:320",
    "icosahedron:1280",
    "octahedron:8",
    "octahedron:32",
    "octahedron:128",
    "octahedron:512",
    "octahedron:2048",
    "halton:20",
    "halton:50",
    "halton:320",
    "halton:1280",
    "uv:4x8",
    "uv:8x16",
    "uv:16x20",
];

fn row(name: &str) -> String {
    let set: DirectionSet = name.parse().unwrap();
    let map = NearestMap::new(&set);
    let largest = set.solid_angles().iter().copied().fold(0.0, f64::max);
    let smallest = set.solid_angles().iter().copied().fold(f64::INFINITY, f64::min);
    format!(
        "//! | `{name}` | {:.2} | {:.2} | {:.2} | {}², {} KiB, {} |",
        set.covering_radius().to_degrees(),
        largest / smallest,
        100.0 * set.nearest_error() / set.covering_radius(),
        map.resolution(),
        (map.words().len() * 4).div_ceil(1024),
        map.most_candidates(),
    )
}

#[test]
fn documented_figures_are_measured() {
    let documented: Vec<&str> =
        include_str!("../../directions.rs").lines().filter(|line| line.starts_with("//! | `")).collect();
    let measured: Vec<String> = NAMES.map(row).into();
    assert!(documented == measured, "the table should be\n{}", measured.join("\n"));
}
