//! Whether any surface sees another.

use glam::{DVec3, Vec3};
use std::collections::HashMap;
use twinlight_core::scene::{Camera, CompiledScene, Triangle};

/// What surfaces see of each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sight {
    /// Nothing: why.
    None(&'static str),
    /// Something, perhaps: why.
    Some(&'static str),
    /// It wasn't worth finding out: why.
    Unknown(&'static str),
}

/// Pairs of planes and corners that are compared at most: about a tenth of a second. Scenes in which surfaces see each other are told by the first few planes.
const MOST_PAIRS: u64 = 1 << 27;

/// Looks whether surfaces of a scene see each other, from the sides that a camera can see.
///
/// They don't where everything is behind every triangle, up to the distance at which rays start: a ray that leaves a triangle only rises above its plane. That is so
/// of the outside of a convex body, and of both sides of a plane.
pub(super) fn of(scene: &CompiledScene, camera: &Camera, has_glass: bool) -> Sight {
    let triangles: Vec<&Triangle> = scene.triangles.iter().filter(|t| t.normal != [0.0; 3]).collect();
    if triangles.is_empty() {
        return Sight::None("there are no surfaces");
    }
    if has_glass {
        return Sight::Some("light goes through glass");
    }
    // Most scenes are told by the first triangle, before corners are sorted.
    let all = || all_corners(&triangles);
    if triangles.iter().take(FIRST).any(|triangle| heights(triangle, all()).any(|h| h > reach(triangle))) {
        return Sight::Some("a surface rises above the plane of another");
    }
    let corners = distinct_corners(&triangles);
    if triangles.len() as u64 * corners.len() as u64 > MOST_PAIRS {
        return Sight::Unknown("there are too many surfaces to compare");
    }
    let points = || corners.iter().copied();
    if triangles.iter().all(|triangle| heights(triangle, points()).all(|h| h.abs() <= reach(triangle))) {
        return Sight::None("all surfaces lie in one plane");
    }
    if triangles.iter().any(|triangle| heights(triangle, points()).any(|h| h > reach(triangle))) {
        return Sight::Some("a surface rises above the plane of another");
    }
    if !is_closed(&triangles) {
        return Sight::Some("the surface is open, and its inside may be seen");
    }
    let eye = DVec3::from(camera.position) - DVec3::from(scene.origin);
    let is_outside =
        |triangle: &&&Triangle| heights(triangle, std::iter::once(eye)).any(|h| h > reach(triangle));
    match triangles.iter().find(is_outside) {
        Some(_) => Sight::None("the surface is convex, and seen from outside"),
        None => Sight::Some("the camera is inside the surface"),
    }
}

/// Triangles that are looked at first.
const FIRST: usize = 8;

fn all_corners(triangles: &[&Triangle]) -> impl Iterator<Item = DVec3> {
    triangles.iter().flat_map(|t| [t.p0, t.p1, t.p2]).map(|p| Vec3::from(p).as_dvec3())
}

fn distinct_corners(triangles: &[&Triangle]) -> Vec<DVec3> {
    let mut corners: Vec<[u32; 3]> =
        triangles.iter().flat_map(|t| [t.p0, t.p1, t.p2]).map(|p| p.map(f32::to_bits)).collect();
    corners.sort_unstable();
    corners.dedup();
    corners.into_iter().map(|bits| Vec3::from(bits.map(f32::from_bits)).as_dvec3()).collect()
}

/// How far something may rise above a triangle's plane and yet be met by no ray that leaves it.
fn reach(triangle: &Triangle) -> f64 {
    f64::from(triangle.offset)
}

/// Of points above a triangle's plane, on its front.
fn heights(triangle: &Triangle, points: impl Iterator<Item = DVec3>) -> impl Iterator<Item = f64> {
    let [a, b, c] = [triangle.p0, triangle.p1, triangle.p2].map(|p| Vec3::from(p).as_dvec3());
    // Not the record's normal, which is rounded: over a large body that would be more than the reach.
    let normal = (b - a).cross(c - a).normalize_or_zero();
    points.map(move |point| normal.dot(point - a))
}

/// Whether every side of a triangle is one of another, the other way round.
fn is_closed(triangles: &[&Triangle]) -> bool {
    let mut sides: HashMap<([u32; 3], [u32; 3]), i32> = HashMap::new();
    for triangle in triangles {
        let [a, b, c] = [triangle.p0, triangle.p1, triangle.p2].map(|p| p.map(|x| (x + 0.0).to_bits()));
        for (from, to) in [(a, b), (b, c), (c, a)] {
            let (key, way) = if from < to { ((from, to), 1) } else { ((to, from), -1) };
            *sides.entry(key).or_default() += way;
        }
    }
    sides.values().all(|&balance| balance == 0)
}
