//! Light on voxels: once from the lights, then from each other.

use super::Lit;
use super::cones::voxel_cones;
use twinlight_core::kernels::filter_indirect::RadianceTexel;
use twinlight_core::kernels::light_voxels::LightVoxelsBlock;
use twinlight_core::kernels::reduce_mips::{MAX_RADIANCE, VoxelLight};
use twinlight_core::kernels::sum_voxels::VoxelSums;
use twinlight_core::kernels::trace_cones::{ConeLight, TraceConesBlock};
use twinlight_core::{Backend, Result};

/// What light falls on.
pub(super) struct Lighting<'a, B: Backend> {
    pub(super) backend: &'a B,
    pub(super) resident: &'a B::Scene,
    pub(super) active: &'a B::Buffer<u32>,
    pub(super) sums: &'a B::Buffer<VoxelSums>,
    pub(super) block: LightVoxelsBlock,
}

impl<B: Backend> Lighting<'_, B> {
    /// What voxels reflect of the scene's lights.
    pub(super) fn direct(&self) -> Result<Vec<VoxelLight>> {
        self.leaves(&[], self.block.samples)
    }

    /// `direct`, and what voxels reflect of the light that leaves those of `lit`. Reflection is linear: the lights needn't be sampled again.
    pub(super) fn scattered(&self, lit: &Lit<B>, direct: &[VoxelLight]) -> Result<Vec<VoxelLight>> {
        let backend = self.backend;
        let (sums, active) = (backend.download(self.sums)?, backend.download(self.active)?);
        let (bundle, flags) = voxel_cones(lit, &sums, &active);
        let mut light = backend.zeroed::<ConeLight>(bundle.cones.len())?;
        let call = TraceConesBlock { flags, ..lit.call };
        backend.trace_cones(&lit.levels, &lit.values, &backend.upload(&bundle.cones)?, &call, &mut light)?;
        let irradiance = bundle.sums(&backend.download(&light)?);
        let texel = |rgb| RadianceTexel { rgb, padding: 0 };
        let gathered: Vec<RadianceTexel> = irradiance.into_iter().map(texel).collect();
        let mut leaves = self.leaves(&gathered, 0)?;
        for (leaf, direct) in leaves.iter_mut().zip(direct) {
            for (word, direct) in leaf.rgb.iter_mut().zip(direct.rgb) {
                // Neither is more than the limit, whose double is a word.
                *word = (*word + direct).min(MAX_RADIANCE);
            }
        }
        Ok(leaves)
    }

    fn leaves(&self, gathered: &[RadianceTexel], samples: u32) -> Result<Vec<VoxelLight>> {
        let backend = self.backend;
        let gathered = backend.upload(gathered)?;
        let block = LightVoxelsBlock { samples, ..self.block };
        let mut leaves = backend.zeroed::<VoxelLight>(backend.len(self.active))?;
        backend.light_voxels(self.resident, self.active, self.sums, &gathered, &block, &mut leaves)?;
        backend.download(&leaves)
    }
}
