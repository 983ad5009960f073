//! Where light comes from: directions and what would arrive along them, over the whole of a light.

use glam::{DMat3, DVec3};
use std::f64::consts::{PI, TAU};
use twinlight_core::scene::{
    CompiledScene, EMITS_BOTH_SIDES, LIGHT_DIRECTIONAL, LIGHT_ENVIRONMENT, LIGHT_POINT, LIGHT_SPHERE,
    LIGHT_SPOT, LIGHT_TRIANGLE, LightRecord,
};
use twinlight_fixtures::random::Random;

/// Light that arrives unless something is in between.
pub(super) struct Arrival {
    /// Unit direction to it.
    pub direction: DVec3,
    /// Where it comes from; `None` for infinitely far away.
    pub from: Option<DVec3>,
    /// On a plane that faces it, if all of the light were there.
    pub irradiance: DVec3,
}

/// Whether samples of the light differ.
pub(super) fn has_extent(light: &LightRecord) -> bool {
    matches!(light.kind, LIGHT_SPHERE | LIGHT_TRIANGLE | LIGHT_ENVIRONMENT)
}

/// Evenly weighed points of a light: their mean is the light's irradiance.
pub(super) fn arrivals(
    scene: &CompiledScene,
    light: &LightRecord,
    at: DVec3,
    strata: u32,
    numbers: &mut Random,
) -> Vec<Arrival> {
    match light.kind {
        LIGHT_POINT | LIGHT_SPOT => vec![of_point(light, at)],
        LIGHT_DIRECTIONAL => {
            vec![Arrival { direction: -vector(light.direction), from: None, irradiance: emission(light) }]
        }
        LIGHT_TRIANGLE => squares(strata, numbers, |u, v| of_triangle(scene, light, at, u, v)),
        LIGHT_SPHERE => squares(strata, numbers, |u, v| of_sphere(light, at, u, v)),
        // Skies are wide: shadows of small things take more directions.
        LIGHT_ENVIRONMENT => squares(4 * strata, numbers, |u, v| of_sky(scene, u, v)),
        _ => Vec::new(),
    }
}

fn vector(v: [f32; 3]) -> DVec3 {
    DVec3::from(v.map(f64::from))
}

fn emission(light: &LightRecord) -> DVec3 {
    vector(light.emission)
}

/// A random point in each of `strata`² squares of the unit square.
fn squares(strata: u32, numbers: &mut Random, arrival: impl Fn(f64, f64) -> Arrival) -> Vec<Arrival> {
    let mut within = |stratum: u32| (f64::from(stratum) + numbers.unit()) / f64::from(strata);
    (0..strata * strata).map(|i| arrival(within(i % strata), within(i / strata))).collect()
}

fn of_point(light: &LightRecord, at: DVec3) -> Arrival {
    let position = vector(light.position);
    let way = position - at;
    let direction = way.normalize_or_zero();
    let mut irradiance = emission(light) / way.length_squared();
    if light.kind == LIGHT_SPOT {
        let cosine = -direction.dot(vector(light.direction));
        let ramp = cosine * f64::from(light.spot_scale) + f64::from(light.spot_offset);
        irradiance *= ramp.clamp(0.0, 1.0).powi(2);
    }
    Arrival { direction, from: Some(position), irradiance }
}

/// By area: radiance · cosine at the light / distance², times its area.
fn of_triangle(scene: &CompiledScene, light: &LightRecord, at: DVec3, u: f64, v: f64) -> Arrival {
    let triangle = &scene.triangles[light.triangle as usize];
    let [a, b, c] = [triangle.p0, triangle.p1, triangle.p2].map(vector);
    let root = u.sqrt();
    let point = a * (1.0 - root) + b * (root * (1.0 - v)) + c * (root * v);
    let way = point - at;
    let direction = way.normalize_or_zero();
    let twice_area = (b - a).cross(c - a);
    let facing = -direction.dot(twice_area.normalize_or_zero());
    let cosine = if light.flags & EMITS_BOTH_SIDES == 0 { facing.max(0.0) } else { facing.abs() };
    let irradiance = emission(light) * (cosine / way.length_squared() * twice_area.length() / 2.0);
    Arrival { direction, from: Some(point), irradiance }
}

/// By solid angle: radiance times the cap's. From inside a sphere is dark.
fn of_sphere(light: &LightRecord, at: DVec3, u: f64, v: f64) -> Arrival {
    let (way, radius) = (vector(light.position) - at, f64::from(light.radius));
    let distance = way.length();
    let sine = radius / distance;
    if sine >= 1.0 {
        return Arrival { direction: DVec3::Z, from: None, irradiance: DVec3::ZERO };
    }
    let least = (1.0 - sine * sine).sqrt();
    let cosine = 1.0 - u * (1.0 - least);
    let (axis, turn) = (way / distance, v * TAU);
    let (s, t) = axis.any_orthonormal_pair();
    let across = (1.0 - cosine * cosine).max(0.0).sqrt();
    let direction = axis * cosine + (s * turn.cos() + t * turn.sin()) * across;
    let reach = distance * cosine - (radius * radius - (distance * across).powi(2)).max(0.0).sqrt();
    let irradiance = emission(light) * (TAU * (1.0 - least));
    Arrival { direction, from: Some(at + direction * reach), irradiance }
}

/// By solid angle: 4π times the texel's radiance.
fn of_sky(scene: &CompiledScene, u: f64, v: f64) -> Arrival {
    let header = &scene.environment;
    let (cosine, turn) = (1.0 - 2.0 * u, v * TAU);
    let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
    let in_map = DVec3::new(sine * turn.sin(), cosine, -sine * turn.cos());
    // A rotation's rows are its inverse's columns.
    let to_world =
        DMat3::from_cols_array_2d(&header.world_to_map.map(|[x, y, z, _]| [x, y, z].map(f64::from)));
    let row =
        ((cosine.clamp(-1.0, 1.0).acos() / PI * f64::from(header.height)) as u32).min(header.height - 1);
    let column = ((v * f64::from(header.width)) as u32).min(header.width - 1);
    let texel = header.offset + header.height + 1 + 6 * (row * header.width + column);
    let radiance = [0, 1, 2].map(|channel| f32::from_bits(scene.words[(texel + channel) as usize]));
    Arrival { direction: to_world * in_map, from: None, irradiance: vector(radiance) * (2.0 * TAU) }
}
