// kernel family: reduce_mips
// contract core/src/kernels/reduce_mips.rs
// cpu backend-cpu/src/kernels/reduce_mips.rs
// gpu backend-gpu/src/kernels/reduce_mips.wgsl
// oracle conformance/src/oracle/reduce_mips.rs
//! `reduce_mips`: not there yet.

use crate::{CpuBackend, CpuBuffer};
use twinlight_core::kernels::reduce_mips::{VoxelLevels, VoxelLight};
use twinlight_core::kernels::voxelize::Voxels;
use twinlight_core::{Error, Result};

pub(crate) fn voxel_levels(_: &Voxels<CpuBackend>) -> Result<VoxelLevels<CpuBackend>> {
    Err(Error::Internal("voxel_levels: not there yet".into()))
}

pub(crate) fn reduce_mips(
    _: &VoxelLevels<CpuBackend>,
    _: &[VoxelLight],
    _: u32,
    _: usize,
) -> Result<CpuBuffer<u32>> {
    Err(Error::Internal("reduce_mips: not there yet".into()))
}
