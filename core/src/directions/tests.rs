mod nearest;
mod sets;
mod table;

use super::*;
use crate::math::hash::{mix_pair, to_unit};

/// One of every kind, and the small ones.
const NAMES: [&str; 19] = [
    "icosahedron:20",
    "icosahedron:80",
    "icosahedron:320",
    "octahedron:8",
    "octahedron:32",
    "octahedron:128",
    "octahedron:512",
    "halton:1",
    "halton:2",
    "halton:3",
    "halton:7",
    "halton:50",
    "halton:320",
    "uv:1x2",
    "uv:1x4",
    "uv:2x2",
    "uv:3x6",
    "uv:8x16",
    "uv:16x20",
];

fn every_set() -> impl Iterator<Item = DirectionSet> {
    NAMES.iter().map(|name| name.parse().unwrap())
}

/// Random unit vectors, uniform on the sphere.
fn random_directions(count: u32) -> impl Iterator<Item = DVec3> {
    let component = |word: u32| 2.0 * f64::from(to_unit(word)) - 1.0;
    let point = move |i: u32| DVec3::from([1, 2, 3].map(|k| component(mix_pair(i, k))));
    (0..).map(point).filter(|p| (0.01..=1.0).contains(&p.length())).map(DVec3::normalize).take(count as usize)
}

fn nearest_by_search(set: &DirectionSet, q: DVec3) -> usize {
    let d = set.directions();
    (1..d.len()).fold(0, |best, i| if q.dot(d[i]) > q.dot(d[best]) { i } else { best })
}
