//! The environment map: lookup and sampling. Twin: `backend-gpu/src/shared/environment.wgsl`.
//!
//! Radiance is constant per texel and the pdf is stored per texel, so lookup and sampling agree exactly: which row a
//! direction falls into is decided by comparing with the very cosines the sampler interpolates between.

use super::SceneView;
use crate::math::hash::to_index;
use crate::math::trig::{atan2_turns, sin_cos_turns};
use glam::Vec3;

/// Radiance from a direction, and the sampler's density there (within the environment).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EnvironmentValue {
    /// Radiance.
    pub radiance: Vec3,
    /// Density over solid angle, sr⁻¹.
    pub pdf: f32,
}

#[inline(always)]
fn texel_value(scene: &SceneView<'_>, texel: u32) -> EnvironmentValue {
    let header = scene.environment;
    let base = (header.offset + header.height + 1 + texel * 6) as usize;
    let value = |i: usize| f32::from_bits(scene.words[base + i]);
    EnvironmentValue { radiance: Vec3::new(value(0), value(1), value(2)), pdf: value(3) }
}

#[inline(always)]
fn row_cosine(scene: &SceneView<'_>, row: u32) -> f32 {
    f32::from_bits(scene.words[(scene.environment.offset + row) as usize])
}

#[inline(always)]
fn map_row(scene: &SceneView<'_>, i: usize) -> Vec3 {
    let [x, y, z, _] = scene.environment.world_to_map[i];
    Vec3::new(x, y, z)
}

/// What comes from the unit `direction` (pointing away from the viewer). Only for scenes with an environment.
#[inline(always)]
pub fn environment_from(scene: &SceneView<'_>, direction: Vec3) -> EnvironmentValue {
    let header = scene.environment;
    let x = map_row(scene, 0).dot(direction);
    let y = map_row(scene, 1).dot(direction);
    let z = map_row(scene, 2).dot(direction);
    // Bisection for the row: cosine(low) ≥ y > cosine(high).
    let mut low = 0_u32;
    let mut high = header.height;
    while high - low > 1 {
        let middle = (low + high) >> 1;
        if row_cosine(scene, middle) >= y {
            low = middle;
        } else {
            high = middle;
        }
    }
    let column = (atan2_turns(x, -z) * header.width as f32) as u32;
    let last = header.width - 1;
    texel_value(scene, low * header.width + if column < last { column } else { last })
}

/// A direction towards the environment: `select` picks the texel with the alias table (index, threshold), (u, v) the
/// point in it.
#[inline(always)]
pub fn sample_environment(
    scene: &SceneView<'_>,
    select: [u32; 2],
    u: f32,
    v: f32,
) -> (Vec3, EnvironmentValue) {
    let header = scene.environment;
    let (row_index, _) = to_index(select[0], header.width * header.height);
    let base = (header.offset + header.height + 1 + row_index * 6) as usize;
    let texel = if select[1] < scene.words[base + 4] { row_index } else { scene.words[base + 5] };
    let row = texel / header.width;
    let column = texel - row * header.width;
    let top = row_cosine(scene, row);
    let cosine = top + (row_cosine(scene, row + 1) - top) * v;
    let squared = 1.0 - cosine * cosine;
    let sine = if squared > 0.0 { squared.sqrt() } else { 0.0 };
    let (s, c) = sin_cos_turns((column as f32 + u) / header.width as f32);
    let local = Vec3::new(sine * s, cosine, -(sine * c));
    // The transpose of the rotation turns the map's frame back to the world's.
    let direction = (map_row(scene, 0) * local.x + map_row(scene, 1) * local.y) + map_row(scene, 2) * local.z;
    (direction, texel_value(scene, texel))
}
