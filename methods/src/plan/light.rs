//! Bounds of the light that surfaces get from lights.

use glam::{DVec3, Vec3};
use std::f64::consts::PI;
use twinlight_core::scene::{
    CompiledScene, LIGHT_DIRECTIONAL, LIGHT_ENVIRONMENT, LIGHT_POINT, LIGHT_SPOT, NONE, Triangle,
};

/// How much looking is worth it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lighting {
    /// Pairs of point lights and triangles whose distance is measured at most.
    pub(super) pairs: u64,
}

impl Default for Lighting {
    fn default() -> Self {
        // A nanosecond or two each.
        Self { pairs: 1 << 24 }
    }
}

/// Most radiance that a white diffuse surface scatters of the lights, whatever its place and direction, over channels; infinite where nothing is known.
///
/// A surface's irradiance over π is a mean of the radiance that it sees: of all lamps with an extent together at most that of the brightest. Of an
/// environment it is also at most its integral over the sphere, over π, which is less for a small sun. Points and directions add up.
pub(super) fn most_scattered(scene: &CompiledScene, lighting: &Lighting) -> f64 {
    let points = scene.lights.iter().filter(|light| matches!(light.kind, LIGHT_POINT | LIGHT_SPOT));
    let near_is_known = points.clone().count() as u64 * scene.triangles.len() as u64 <= lighting.pairs;
    let (mut brightest, mut others) = (0.0_f64, 0.0_f64);
    for light in &scene.lights {
        let most = f64::from(light.emission.into_iter().fold(0.0, f32::max));
        match light.kind {
            LIGHT_ENVIRONMENT => others += environment(scene),
            LIGHT_DIRECTIONAL => others += most / PI,
            LIGHT_POINT | LIGHT_SPOT if most > 0.0 => {
                let near = if near_is_known { nearest(scene, light.position) } else { 0.0 };
                others += most / (near * near) / PI;
            }
            LIGHT_POINT | LIGHT_SPOT => {}
            _ => brightest = brightest.max(most),
        }
    }
    brightest + others
}

/// Distance of a point from the nearest triangle.
fn nearest(scene: &CompiledScene, point: [f32; 3]) -> f64 {
    let point = Vec3::from(point).as_dvec3();
    let squared = scene.triangles.iter().map(|triangle| squared_distance(triangle, point));
    squared.fold(f64::INFINITY, f64::min).sqrt()
}

/// Squared distance of a point from a triangle. *Source.* Ericson 2005 §5.1.5.
fn squared_distance(triangle: &Triangle, p: DVec3) -> f64 {
    let [a, b, c] = [triangle.p0, triangle.p1, triangle.p2].map(|p| Vec3::from(p).as_dvec3());
    let (ab, ac, normal) = (b - a, c - a, (b - a).cross(c - a));
    let inside = |from: DVec3, side: DVec3| side.cross(p - from).dot(normal) >= 0.0;
    if normal.length_squared() > 0.0 && inside(a, ab) && inside(b, c - b) && inside(c, -ac) {
        let height = normal.dot(p - a);
        return height * height / normal.length_squared();
    }
    let edge = |from: DVec3, side: DVec3| {
        let length = side.length_squared();
        let t = if length > 0.0 { ((p - from).dot(side) / length).clamp(0.0, 1.0) } else { 0.0 };
        (p - (from + side * t)).length_squared()
    };
    edge(a, ab).min(edge(b, c - b)).min(edge(c, -ac))
}

/// The largest radiance of an environment, or its integral over the sphere over π where that is less.
fn environment(scene: &CompiledScene) -> f64 {
    let header = &scene.environment;
    if header.offset == NONE {
        return 0.0;
    }
    let (width, height) = (header.width as usize, header.height as usize);
    let words = &scene.words[header.offset as usize..];
    let value = |i: usize| f64::from(f32::from_bits(words[i]));
    let (mut most, mut sum) = ([0.0_f64; 3], [0.0_f64; 3]);
    for row in 0..height {
        // A row's share of the sphere is the difference of its cosines.
        let solid_angle = (value(row) - value(row + 1)) * 2.0 * PI / width as f64;
        for column in 0..width {
            let texel = height + 1 + 6 * (row * width + column);
            for c in 0..3 {
                most[c] = most[c].max(value(texel + c));
                sum[c] += value(texel + c) * solid_angle;
            }
        }
    }
    (0..3).map(|c| most[c].min(sum[c] / PI)).fold(0.0, f64::max)
}
