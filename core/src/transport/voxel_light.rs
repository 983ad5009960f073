//! Light on voxels. Twin: `backend-gpu/src/shared/voxel_light.wgsl`. Meaning: [`crate::kernels::light_voxels`].

use super::light::{FAR, SHADOW_REACH, sample_light, select_light};
use super::{INV_PI, SceneView};
use crate::kernels::light_voxels::{LIFT, LightVoxelsBlock};
use crate::kernels::reduce_mips::{MAX_RADIANCE, OPAQUE, VoxelLight};
use crate::kernels::sum_voxels::VoxelSums;
use crate::math::hash::{mix_pair, to_unit};
use crate::math::morton::morton_voxel;
use crate::math::sobol::sobol_pair;
use crate::math::vector::normalized;
use glam::Vec3;

/// A voxel's surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VoxelPoint {
    /// Centre of the voxel.
    pub centre: Vec3,
    /// Width of a voxel.
    pub width: f32,
    /// Unit normal, or 0 0 0.
    pub normal: Vec3,
    /// Albedo over π.
    pub reflectance: Vec3,
    /// Exitant radiance.
    pub emission: Vec3,
}

/// Light that may arrive at a voxel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VoxelSample {
    /// Start of the shadow ray.
    pub origin: Vec3,
    /// To its end; of unit length to infinity.
    pub direction: Vec3,
    /// End, in lengths of `direction`.
    pub reach: f32,
    /// Index of the light.
    pub light: u32,
    /// What arrives without a shadow; 0 0 0 where nothing does.
    pub irradiance: Vec3,
}

/// The surface of the voxel of `code`, whose sums have a count.
#[inline(always)]
pub fn voxel_point(params: &LightVoxelsBlock, code: u32, sums: &VoxelSums) -> VoxelPoint {
    let [i, j, k] = morton_voxel(code);
    let width = 1.0 / params.frame.voxels_per_unit;
    let place = Vec3::new(i as f32 + 0.5, j as f32 + 0.5, k as f32 + 0.5);
    let count = sums.count as f32;
    let share = 1.0 / (count * 4095.0);
    let [r, g, b] = sums.albedo;
    let [x, y, z] = sums.normal;
    let [red, green, blue] = sums.emission;
    let whole = Vec3::new(x as f32, y as f32, z as f32);
    let has_normal = x != 0 || y != 0 || z != 0;
    VoxelPoint {
        centre: Vec3::from(params.frame.corner) + place * width,
        width,
        normal: if has_normal { normalized(whole) } else { Vec3::ZERO },
        reflectance: Vec3::new(r as f32, g as f32, b as f32) * (share * INV_PI),
        emission: Vec3::new(red as f32, green as f32, blue as f32) * (params.emission_unit / count),
    }
}

/// Light of one sample.
#[inline(always)]
pub fn voxel_sample(
    scene: &SceneView<'_>,
    params: &LightVoxelsBlock,
    point: &VoxelPoint,
    code: u32,
    sample: u32,
) -> VoxelSample {
    let stream = mix_pair(params.seed, code);
    let [u, v] = sobol_pair(stream, sample, 0);
    let [choice, _] = sobol_pair(stream, sample, 1);
    let texel = sobol_pair(stream, sample, 2);
    let light = select_light(scene, choice);
    let found = sample_light(scene, light, point.centre, to_unit(u), to_unit(v), texel);
    let facing = point.normal.dot(found.direction);
    let has_normal = point.normal != Vec3::ZERO;
    let cosine = if !has_normal {
        0.5
    } else if facing < 0.0 {
        -facing
    } else {
        facing
    };
    let lift = if facing < 0.0 { -LIFT } else { LIFT };
    let origin = point.centre + point.normal * (lift * point.width);
    VoxelSample {
        origin,
        direction: if found.infinite { found.direction } else { found.target - origin },
        reach: if found.infinite { FAR } else { SHADOW_REACH },
        light,
        irradiance: if found.pdf > 0.0 { found.emission * (cosine / found.pdf) } else { Vec3::ZERO },
    }
}

/// An integer of radiance.
#[inline(always)]
fn quantized(radiance: f32, scale: f32) -> u32 {
    let units = radiance * scale + 0.5;
    if !(units >= 1.0) {
        return 0;
    }
    if units < MAX_RADIANCE as f32 { units as u32 } else { MAX_RADIANCE }
}

/// The leaf of a voxel on which `irradiance` falls.
#[inline(always)]
pub fn voxel_leaf(params: &LightVoxelsBlock, point: &VoxelPoint, irradiance: Vec3) -> VoxelLight {
    let radiance = point.reflectance * irradiance + point.emission;
    let [r, g, b] = radiance.to_array();
    let rgb = [quantized(r, params.scale), quantized(g, params.scale), quantized(b, params.scale)];
    VoxelLight { rgb, opacity: OPAQUE }
}
