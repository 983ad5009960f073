//! Choosing a light, a point on it, and the density with which that happens. Twin:
//! `backend-gpu/src/shared/light.wgsl`.

use super::environment::sample_environment;
use super::intersect::{smaller, sphere};
use super::offset::offset_origin;
use super::{PI, SceneView};
use crate::math::hash::to_index;
use crate::math::trig::sin_cos_turns;
use crate::math::vector::{basis, normalized, to_world};
use crate::scene::{
    EMITS_BOTH_SIDES, LIGHT_DIRECTIONAL, LIGHT_ENVIRONMENT, LIGHT_POINT, LIGHT_SPHERE, LIGHT_SPOT,
    LIGHT_TRIANGLE, LightRecord, NONE,
};
use glam::Vec3;

/// `t_max` of rays to infinity.
pub const FAR: f32 = 3.0e38;

/// Shadow rays to a point are traced up to this share of their length, 1 − 2⁻²⁰: both ends are off their surfaces by
/// error bounds, this covers the rounding of t itself (16 ulp; the sheared test makes about 10 roundings, and so does a ray's meeting with a
/// triangle's plane).
pub const SHADOW_REACH: f32 = 0.999_999_05;

/// Light that may arrive from one direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LightSample {
    /// Unit direction to the light.
    pub direction: Vec3,
    /// The point on the light, already off its surface; unused when `infinite`.
    pub target: Vec3,
    /// Radiance, or for delta lights intensity/distance² or irradiance.
    pub emission: Vec3,
    /// Density over solid angle, selection included; for delta lights the selection probability. 0: no light.
    pub pdf: f32,
    /// Whether the light is infinitely far away.
    pub infinite: bool,
    /// Whether no other sampling technique can find it.
    pub delta: bool,
    /// Index of the light.
    pub light: u32,
}

/// Picks a light with the alias table from one 32-bit draw.
#[inline(always)]
pub fn select_light(scene: &SceneView<'_>, bits: u32) -> u32 {
    let (row, rest) = to_index(bits, scene.environment.light_count);
    let record = &scene.lights[row as usize];
    if rest < record.alias_threshold { row } else { record.alias }
}

/// Density of the sphere-light sampler at a point, without selection; 0 inside.
#[inline(always)]
fn sphere_pdf(center: Vec3, radius: f32, from: Vec3) -> f32 {
    let to_center = center - from;
    let distance_squared = to_center.dot(to_center);
    let radius_squared = radius * radius;
    if !(distance_squared > radius_squared) {
        return 0.0;
    }
    let sine_squared = radius_squared / distance_squared;
    // 1 − cos without cancellation.
    let one_minus_cosine = sine_squared / (1.0 + (1.0 - sine_squared).sqrt());
    1.0 / (2.0 * PI * one_minus_cosine)
}

/// Density, selection included, with which [`sample_light`] would have found the sphere light from `from`.
#[inline(always)]
pub fn sphere_light_pdf(light: &LightRecord, from: Vec3) -> f32 {
    light.select_pdf * sphere_pdf(Vec3::from(light.position), light.radius, from)
}

/// Density, selection included, with which [`sample_light`] would have found the point of a triangle light that a ray
/// met after `distance` under the cosine `cosine` > 0.
#[inline(always)]
pub fn triangle_light_pdf(light: &LightRecord, distance: f32, cosine: f32) -> f32 {
    light.select_pdf * ((distance * distance) / (light.area * cosine))
}

/// The nearest sphere light on a ray.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SphereHit {
    /// Index of the light, or [`NONE`].
    pub light: u32,
    /// Ray parameter; the ray's `t_max` when nothing is met.
    pub t: f32,
    /// Whether the inside is met, which is black.
    pub inside: bool,
}

/// The nearest sphere light in 0 < t < `t_max`. Linear in their number: they are few, and exact.
#[inline(always)]
pub fn nearest_sphere(scene: &SceneView<'_>, origin: Vec3, direction: Vec3, t_max: f32) -> SphereHit {
    let mut nearest = SphereHit { light: NONE, t: t_max, inside: false };
    for index in 0..scene.environment.sphere_count {
        let light = &scene.lights[index as usize];
        if let Some((near, far)) = sphere(origin, direction, Vec3::from(light.position), light.radius) {
            let inside = !(near > 0.0);
            let t = if inside { far } else { near };
            if t > 0.0 && t < nearest.t {
                nearest = SphereHit { light: index, t, inside };
            }
        }
    }
    nearest
}

/// Whether a sphere light other than `skip` lies in 0 < t < `t_max`.
#[inline(always)]
pub fn spheres_occlude(scene: &SceneView<'_>, origin: Vec3, direction: Vec3, t_max: f32, skip: u32) -> bool {
    let mut occluded = false;
    for index in 0..scene.environment.sphere_count {
        let light = &scene.lights[index as usize];
        if index != skip
            && let Some((near, far)) = sphere(origin, direction, Vec3::from(light.position), light.radius)
        {
            let t = if near > 0.0 { near } else { far };
            occluded = occluded || (t > 0.0 && t < t_max);
        }
    }
    occluded
}

#[inline(always)]
fn nothing(light: u32) -> LightSample {
    LightSample {
        direction: Vec3::ZERO,
        target: Vec3::ZERO,
        emission: Vec3::ZERO,
        pdf: 0.0,
        infinite: false,
        delta: false,
        light,
    }
}

#[inline(always)]
fn sample_triangle(scene: &SceneView<'_>, index: u32, from: Vec3, u: f32, v: f32) -> LightSample {
    let light = &scene.lights[index as usize];
    let triangle = &scene.triangles[light.triangle as usize];
    // Heitz 2019: a low-distortion map from the square to the triangle.
    let half = smaller(u, v) * 0.5;
    let b0 = u - half;
    let b1 = v - half;
    let a = Vec3::from(triangle.p0) * ((1.0 - b0) - b1);
    let b = Vec3::from(triangle.p1) * b0;
    let c = Vec3::from(triangle.p2) * b1;
    let point = (a + b) + c;
    let to_light = point - from;
    let squared = to_light.dot(to_light);
    let direction = normalized(to_light);
    let normal = Vec3::from(light.direction);
    let facing = -(normal.dot(direction));
    let both = light.flags & EMITS_BOTH_SIDES != 0;
    let cosine = if both && facing < 0.0 { -facing } else { facing };
    if !(cosine > 0.0 && squared > 0.0) {
        return nothing(index);
    }
    LightSample {
        direction,
        target: offset_origin(point, triangle.offset, normal, -direction),
        emission: Vec3::from(light.emission),
        pdf: light.select_pdf * (squared / (light.area * cosine)),
        infinite: false,
        delta: false,
        light: index,
    }
}

#[inline(always)]
fn sample_sphere(light: &LightRecord, index: u32, from: Vec3, u: f32, v: f32) -> LightSample {
    let center = Vec3::from(light.position);
    let to_center = center - from;
    let distance_squared = to_center.dot(to_center);
    let pdf = sphere_light_pdf(light, from);
    if !(pdf > 0.0) {
        return nothing(index);
    }
    let sine_squared = (light.radius * light.radius) / distance_squared;
    let one_minus_cosine = sine_squared / (1.0 + (1.0 - sine_squared).sqrt());
    let down = v * one_minus_cosine;
    // sin² = 1 − (1 − down)² without cancellation.
    let sine = (down * (2.0 - down)).sqrt();
    let (s, c) = sin_cos_turns(u);
    let axis = normalized(to_center);
    let (t, b) = basis(axis);
    let direction = normalized(to_world(t, b, axis, Vec3::new(sine * c, sine * s, 1.0 - down)));
    // A direction on the silhouette may miss by rounding: then the tangent point's distance serves.
    let distance = match sphere(from, direction, center, light.radius) {
        Some((near, _)) => near,
        None => (distance_squared - light.radius * light.radius).sqrt(),
    };
    LightSample {
        direction,
        target: from + direction * distance,
        emission: Vec3::from(light.emission),
        pdf,
        infinite: false,
        delta: false,
        light: index,
    }
}

#[inline(always)]
fn sample_point(light: &LightRecord, index: u32, from: Vec3) -> LightSample {
    let position = Vec3::from(light.position);
    let to_light = position - from;
    let squared = to_light.dot(to_light);
    let direction = normalized(to_light);
    if !(squared > 0.0) {
        return nothing(index);
    }
    let mut emission = Vec3::from(light.emission) * (1.0 / squared);
    if light.kind == LIGHT_SPOT {
        // KHR_lights_punctual: squared linear ramp of the cosine.
        let cosine = -(direction.dot(Vec3::from(light.direction)));
        let ramp = cosine * light.spot_scale + light.spot_offset;
        let low = if ramp > 0.0 { ramp } else { 0.0 };
        let clamped = if low < 1.0 { low } else { 1.0 };
        emission *= clamped * clamped;
    }
    LightSample {
        direction,
        target: position,
        emission,
        pdf: light.select_pdf,
        infinite: false,
        delta: true,
        light: index,
    }
}

/// A point of light `index` for a receiver at `from`; (u, v) place it, `texel` picks an environment texel.
#[inline(always)]
pub fn sample_light(
    scene: &SceneView<'_>,
    index: u32,
    from: Vec3,
    u: f32,
    v: f32,
    texel: [u32; 2],
) -> LightSample {
    let light = &scene.lights[index as usize];
    if light.kind == LIGHT_TRIANGLE {
        return sample_triangle(scene, index, from, u, v);
    }
    if light.kind == LIGHT_SPHERE {
        return sample_sphere(light, index, from, u, v);
    }
    if light.kind == LIGHT_POINT || light.kind == LIGHT_SPOT {
        return sample_point(light, index, from);
    }
    if light.kind == LIGHT_DIRECTIONAL {
        return LightSample {
            direction: -Vec3::from(light.direction),
            emission: Vec3::from(light.emission),
            pdf: light.select_pdf,
            infinite: true,
            delta: true,
            ..nothing(index)
        };
    }
    if light.kind != LIGHT_ENVIRONMENT {
        return nothing(index);
    }
    let (direction, value) = sample_environment(scene, texel, u, v);
    LightSample {
        direction,
        emission: value.radiance,
        pdf: light.select_pdf * value.pdf,
        infinite: true,
        ..nothing(index)
    }
}
