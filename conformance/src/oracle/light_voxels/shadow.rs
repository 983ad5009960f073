//! What is between a voxel and a light: every triangle and every sphere is asked.

use super::lights::Arrival;
use glam::DVec3;
use twinlight_core::scene::{CompiledScene, Triangle};

/// What of the way to a light is looked at: the last millionth is the light itself.
const REACH: f64 = 1.0 - 1e-6;

/// Whether nothing is between `begin` and the light, whose index is `light`.
pub(super) fn is_free(scene: &CompiledScene, begin: DVec3, arrival: &Arrival, light: u32) -> bool {
    let (way, reach) = match arrival.from {
        Some(point) => (point - begin, REACH),
        None => (arrival.direction, f64::INFINITY),
    };
    let spheres = &scene.lights[..scene.environment.sphere_count as usize];
    !scene.triangles.iter().any(|triangle| meets_triangle(triangle, begin, way, reach))
        && !spheres.iter().enumerate().any(|(index, sphere)| {
            let centre = DVec3::from(sphere.position.map(f64::from));
            index as u32 != light && meets_sphere(centre, f64::from(sphere.radius), begin, way, reach)
        })
}

/// Möller and Trumbore 1997.
fn meets_triangle(triangle: &Triangle, begin: DVec3, way: DVec3, reach: f64) -> bool {
    let [a, b, c] = [triangle.p0, triangle.p1, triangle.p2].map(|p| DVec3::from(p.map(f64::from)));
    let (ab, ac) = (b - a, c - a);
    let p = way.cross(ac);
    let determinant = ab.dot(p);
    if determinant == 0.0 {
        return false;
    }
    let from_a = begin - a;
    let u = from_a.dot(p) / determinant;
    let q = from_a.cross(ab);
    let v = way.dot(q) / determinant;
    let t = ac.dot(q) / determinant;
    u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0 && t < reach
}

/// From inside, the sphere's far side is in the way.
fn meets_sphere(centre: DVec3, radius: f64, begin: DVec3, way: DVec3, reach: f64) -> bool {
    let to_centre = centre - begin;
    let along = way.dot(to_centre) / way.length_squared();
    let beside = (to_centre - way * along).length_squared();
    let half = (radius * radius - beside) / way.length_squared();
    if half <= 0.0 {
        return false;
    }
    let (near, far) = (along - half.sqrt(), along + half.sqrt());
    let t = if near > 0.0 { near } else { far };
    t > 0.0 && t < reach
}
