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
    let corners = distinct_corners(&triangles);
    if triangles.len() as u64 * corners.len() as u64 > MOST_PAIRS
        && rises_above_one_of(&triangles, &corners, (MOST_PAIRS / corners.len() as u64) as usize)
    {
        return Sight::Some("a surface rises above the plane of another");
    }
    if triangles.len() as u64 * corners.len() as u64 > MOST_PAIRS {
        return Sight::Unknown("there are too many surfaces to compare");
    }
    if triangles.iter().all(|triangle| heights(triangle, &corners).all(|h| h.abs() <= reach(triangle))) {
        return Sight::None("all surfaces lie in one plane");
    }
    if rises_above_one_of(&triangles, &corners, triangles.len()) {
        return Sight::Some("a surface rises above the plane of another");
    }
    if !is_closed(&triangles) {
        return Sight::Some("the surface is open, and its inside may be seen");
    }
    let eye = DVec3::from(camera.position) - DVec3::from(scene.origin);
    let is_outside = |triangle: &&&Triangle| height(triangle, eye) > reach(triangle);
    match triangles.iter().find(is_outside) {
        Some(_) => Sight::None("the surface is convex, and seen from outside"),
        None => Sight::Some("the camera is inside the surface"),
    }
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

/// Of a point above a triangle's plane, on its front.
fn height(triangle: &Triangle, point: DVec3) -> f64 {
    let [a, b, c] = [triangle.p0, triangle.p1, triangle.p2].map(|p| Vec3::from(p).as_dvec3());
    // Not by the record's normal, which is rounded: over a large body that would be more than the reach.
    (b - a).cross(c - a).normalize_or_zero().dot(point - a)
}

fn heights<'a>(triangle: &'a Triangle, points: &'a [DVec3]) -> impl Iterator<Item = f64> + 'a {
    let [a, b, c] = [triangle.p0, triangle.p1, triangle.p2].map(|p| Vec3::from(p).as_dvec3());
    let normal = (b - a).cross(c - a).normalize_or_zero();
    points.iter().map(move |&point| normal.dot(point - a))
}

fn rises_above_one_of(triangles: &[&Triangle], corners: &[DVec3], count: usize) -> bool {
    let rises = |triangle: &&Triangle| heights(triangle, corners).any(|h| h > reach(triangle));
    triangles.iter().take(count).any(rises)
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
