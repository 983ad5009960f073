// kernel family: light_voxels
// contract core/src/kernels/light_voxels.rs
// cpu backend-cpu/src/kernels/light_voxels.rs
// gpu backend-gpu/src/kernels/light_voxels.wgsl
// oracle conformance/src/oracle/light_voxels.rs
//! Oracle of `light_voxels`: the leaf that samples are expected to give, in f64. Nothing is chosen at random between lights: each is
//! integrated over its whole extent, and every triangle and sphere is asked whether it is in between.
//!
//! Lights without extent give one number, which every sample of a scene of one light must give too. Others are integrated a few
//! times by stratified points, so that the spread of the results says how far their mean may be off.

mod lights;
mod shadow;

use glam::DVec3;
use lights::Arrival;
use shadow::is_free;
use std::f64::consts::PI;
use twinlight_core::kernels::light_voxels::{LIFT, LightVoxelsBlock};
use twinlight_core::kernels::reduce_mips::{MAX_RADIANCE, OPAQUE, VoxelLight};
use twinlight_core::kernels::sum_voxels::VoxelSums;
use twinlight_core::scene::{CompiledScene, LightRecord};
use twinlight_fixtures::random::Random;

/// Integrals of a light with an extent.
const REPETITIONS: u64 = 8;
/// Strata per dimension of each.
const STRATA: u32 = 12;

/// What is known of a voxel.
#[derive(Debug, Clone, Copy)]
pub struct Voxel {
    /// Its Morton code.
    pub code: u32,
    /// Its surfaces.
    pub sums: VoxelSums,
    /// Irradiance that was gathered for it.
    pub gathered: [f32; 3],
}

/// A number and how far it may be off.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Expected {
    /// Per channel.
    pub value: DVec3,
    /// Standard error of `value`, for lights with an extent.
    pub error: DVec3,
    /// What `value` would be if all light came straight and unhindered: rounding errors are shares of it.
    pub most: DVec3,
}

/// A voxel's surface.
struct Surface {
    centre: DVec3,
    albedo: DVec3,
    normal: Option<DVec3>,
}

/// Every third bit of `code`, from bit `axis` on.
fn coordinate(code: u32, axis: u32) -> f64 {
    (0..10).map(|bit| f64::from(code >> (3 * bit + axis) & 1) * f64::from(1 << bit)).sum()
}

fn surface(block: &LightVoxelsBlock, voxel: &Voxel) -> Surface {
    let count = f64::from(voxel.sums.count);
    let width = 1.0 / f64::from(block.frame.voxels_per_unit);
    let middle = DVec3::from([0, 1, 2].map(|axis| coordinate(voxel.code, axis) + 0.5));
    let normal = DVec3::from(voxel.sums.normal.map(f64::from));
    Surface {
        centre: DVec3::from(block.frame.corner.map(f64::from)) + middle * width,
        albedo: DVec3::from(voxel.sums.albedo.map(f64::from)) / (count * 4095.0),
        normal: (normal != DVec3::ZERO).then(|| normal.normalize()),
    }
}

impl Surface {
    /// What `arrival` adds to the irradiance, and what it would add from straight above.
    fn receive(
        &self,
        scene: &CompiledScene,
        block: &LightVoxelsBlock,
        light: u32,
        arrival: &Arrival,
    ) -> (DVec3, DVec3) {
        let lift = f64::from(LIFT) / f64::from(block.frame.voxels_per_unit);
        let (cosine, begin) = match self.normal {
            None => (0.5, self.centre),
            Some(normal) => {
                let facing = normal.dot(arrival.direction);
                (facing.abs(), self.centre + normal * (lift * facing.signum()))
            }
        };
        let straight = arrival.irradiance;
        if cosine == 0.0 || straight == DVec3::ZERO || !is_free(scene, begin, arrival, light) {
            return (DVec3::ZERO, straight);
        }
        (straight * cosine, straight)
    }
}

/// Irradiance of a voxel by all lights.
fn irradiance(scene: &CompiledScene, block: &LightVoxelsBlock, voxel: &Voxel) -> Expected {
    let surface = surface(block, voxel);
    let mut repeated = Vec::new();
    let mut most = DVec3::ZERO;
    let is_random = scene.lights.iter().any(lights::has_extent);
    for repetition in 0..if is_random { REPETITIONS } else { 1 } {
        let mut numbers = Random::new(u64::from(voxel.code) << 8 | repetition);
        let mut sum = DVec3::ZERO;
        for (index, light) in scene.lights.iter().enumerate() {
            let arrivals = lights::arrivals(scene, light, surface.centre, STRATA, &mut numbers);
            let share = 1.0 / arrivals.len().max(1) as f64;
            for arrival in &arrivals {
                let (received, straight) = surface.receive(scene, block, index as u32, arrival);
                sum += received * share;
                most += straight * share * steepness(light);
            }
        }
        repeated.push(sum);
    }
    let n = repeated.len() as f64;
    let mean = repeated.iter().sum::<DVec3>() / n;
    let squares: DVec3 = repeated.iter().map(|sum| (*sum - mean) * (*sum - mean)).sum();
    // The variance of the mean.
    let variance = squares / (n * (n - 1.0).max(1.0));
    Expected { value: mean, error: DVec3::from(variance.to_array().map(f64::sqrt)), most: most / n }
}

/// How much more than others the light answers to an error of its direction: spots have a ramp.
fn steepness(light: &LightRecord) -> f64 {
    1.0 + 2.0 * f64::from(light.spot_scale)
}

/// The leaf before it is rounded and limited, in the leaf's unit. The voxel has a fragment.
pub fn expected(scene: &CompiledScene, block: &LightVoxelsBlock, voxel: &Voxel) -> Expected {
    let surface = surface(block, voxel);
    let nothing = Expected { value: DVec3::ZERO, error: DVec3::ZERO, most: DVec3::ZERO };
    let lit = if block.samples == 0 { nothing } else { irradiance(scene, block, voxel) };
    let gathered = DVec3::from(voxel.gathered.map(f64::from));
    let emission = DVec3::from(voxel.sums.emission.map(f64::from)) / f64::from(voxel.sums.count);
    let emitted = emission * f64::from(block.emission_unit);
    let scale = f64::from(block.scale);
    let reflected = surface.albedo / PI;
    Expected {
        value: (reflected * (lit.value + gathered) + emitted) * scale,
        error: reflected * lit.error * scale,
        most: (reflected * (lit.most + gathered.abs()) + emitted.abs()) * scale.abs(),
    }
}

/// The leaf of a voxel whose light has no extent, or that has none.
pub fn leaf(scene: &CompiledScene, block: &LightVoxelsBlock, voxel: &Voxel) -> VoxelLight {
    if voxel.sums.count == 0 {
        return VoxelLight::default();
    }
    let value = expected(scene, block, voxel).value;
    VoxelLight { rgb: value.to_array().map(units), opacity: OPAQUE }
}

/// To the nearest integer, halves up, in 0 to [`MAX_RADIANCE`]; 0 for what is no number.
pub fn units(value: f64) -> u32 {
    if value > 0.0 { (value + 0.5).floor().min(f64::from(MAX_RADIANCE)) as u32 } else { 0 }
}

#[cfg(test)]
mod tests;
