// kernel family: light_voxels
// contract core/src/kernels/light_voxels.rs
// cpu backend-cpu/src/kernels/light_voxels.rs
// gpu backend-gpu/src/kernels/light_voxels.wgsl
// oracle conformance/src/oracle/light_voxels.rs
//! `light_voxels`: voxel by voxel in the order of their codes, so that neighbours' shadow rays go down the same branches of the hierarchy.

use crate::parallel::{RAYS, fill_chunks};
use crate::path::nothing_hides;
use crate::scene::SceneData;
use crate::simd::{Isa, Kernel, Width};
use bytemuck::Zeroable;
use glam::Vec3;
use twinlight_core::kernels::filter_indirect::RadianceTexel;
use twinlight_core::kernels::light_voxels::LightVoxelsBlock;
use twinlight_core::kernels::reduce_mips::VoxelLight;
use twinlight_core::kernels::sum_voxels::VoxelSums;
use twinlight_core::transport::SceneView;
use twinlight_core::transport::light::spheres_occlude;
use twinlight_core::transport::voxel_light::{VoxelSample, voxel_leaf, voxel_point, voxel_sample};

/// What is known of the active voxels.
#[derive(Clone, Copy)]
pub(crate) struct Lit<'a> {
    pub(crate) active: &'a [u32],
    pub(crate) sums: &'a [VoxelSums],
    /// Irradiance; empty without any.
    pub(crate) gathered: &'a [RadianceTexel],
}

/// Fills `leaves`, one per active voxel.
pub(crate) fn light_voxels(
    isa: Isa,
    scene: &SceneData,
    voxels: Lit<'_>,
    params: &LightVoxelsBlock,
    leaves: &mut [VoxelLight],
) {
    fill_chunks(isa, RAYS, leaves, |first, leaves| Leaves { scene, voxels, params, first, leaves });
}

struct Leaves<'a> {
    scene: &'a SceneData,
    voxels: Lit<'a>,
    params: &'a LightVoxelsBlock,
    first: usize,
    leaves: &'a mut [VoxelLight],
}

impl Kernel for Leaves<'_> {
    type Output = ();

    #[inline(always)]
    fn run<W: Width>(self, width: W) {
        let view = self.scene.view();
        for (i, leaf) in self.leaves.iter_mut().enumerate() {
            let voxel = self.first + i;
            let (code, sums) = (self.voxels.active[voxel], &self.voxels.sums[voxel]);
            if sums.count == 0 {
                *leaf = VoxelLight::zeroed();
                continue;
            }
            // [1] surface
            let point = voxel_point(self.params, code, sums);
            let mut irradiance = Vec3::ZERO;
            if view.environment.light_count > 0 {
                for sample in 0..self.params.samples {
                    // [2] sample
                    let light = voxel_sample(&view, self.params, &point, code, sample);
                    // [3] shadow
                    if light.irradiance != Vec3::ZERO && !is_shadowed(width, self.scene, &view, &light) {
                        irradiance += light.irradiance;
                    }
                }
                irradiance *= 1.0 / samples_of(self.params);
            }
            // [4] leaf
            if let Some(texel) = self.voxels.gathered.get(voxel) {
                irradiance += Vec3::from(texel.rgb);
            }
            *leaf = voxel_leaf(self.params, &point, irradiance);
        }
    }
}

/// At least 1: nothing is divided by none.
#[inline(always)]
fn samples_of(params: &LightVoxelsBlock) -> f32 {
    if params.samples > 0 { params.samples as f32 } else { 1.0 }
}

#[inline(always)]
fn is_shadowed<W: Width>(width: W, scene: &SceneData, view: &SceneView<'_>, sample: &VoxelSample) -> bool {
    (!nothing_hides(view) && scene.bvh.occluded(width, sample.origin, sample.direction, 0.0, sample.reach))
        || spheres_occlude(view, sample.origin, sample.direction, sample.reach, sample.light)
}
