//! `reduce_mips` where one binding has no room, and where few workgroups fit into a row, against its CPU twin.

use crate::{Check, Target};
use libtest_mimic::Failed;
use twinlight_backend_cpu::CpuBackend;
use twinlight_backend_gpu::{DeviceOptions, GpuBackend, GpuDevice};
use twinlight_core::kernels::reduce_mips::{
    ANISOTROPIC, HARMONICS, HARMONICS_8, ISOTROPIC, OPAQUE, RANGES, ReduceMipsParams, SUMS, VoxelLight,
};
use twinlight_core::kernels::voxelize::VoxelBuffers;
use twinlight_core::lattice::VoxelGrid;
use twinlight_core::{Backend, Error, Result};

pub const CHECKS: &[(&str, Check)] = &[
    ("d3: voxels beyond a binding are refused", small_bindings),
    ("d4: voxels in more workgroups than a row has", short_rows),
];

/// The values of a cube whose voxels are all active.
fn values<B: Backend>(backend: &B, side: u32, storage: u32) -> Result<Vec<u32>> {
    let subvoxel_bits = 15 - side.trailing_zeros();
    let grid = VoxelGrid { dims: [side; 3], scale: 1 << 14, offset: [0; 3], subvoxel_bits };
    let words = grid.mask_words() as u32;
    let voxels = VoxelBuffers {
        grid,
        small: backend.zeroed(0)?,
        large: backend.zeroed(0)?,
        mask: backend.upload(&vec![u32::MAX; words as usize])?,
        ranks: backend.upload(&(0..=words).map(|word| 32 * word).collect::<Vec<u32>>())?,
        active: backend.upload(&(0..32 * words).collect::<Vec<u32>>())?,
        parents: backend.upload(&(0..4 * words).collect::<Vec<u32>>())?,
    };
    let levels = backend.voxel_levels(&voxels)?;
    let light = |code: u32| VoxelLight { rgb: [code, 3 * code, 7], opacity: OPAQUE - code % 999 };
    let leaves = backend.upload(&(0..32 * words).map(light).collect::<Vec<_>>())?;
    backend.download(&backend.reduce_mips(&levels, &leaves, &ReduceMipsParams { storage })?)
}

/// Bindings of 16 KiB: 4096 words. A cube of 8³ has 585 values.
fn small_bindings(target: &Target) -> std::result::Result<(), Failed> {
    let options = DeviceOptions { max_storage_binding_bytes: 16 << 10, ..target.options.clone() };
    let gpu = GpuBackend::new(GpuDevice::open(&options)?);
    for (storage, words) in [(ISOTROPIC, 4), (SUMS, 2), (RANGES, 2)] {
        let found = values(&gpu, 8, storage)?.len();
        if found != words * 585 {
            return Err(format!("{found} words of storage {storage}").into());
        }
    }
    // Bytes are made of words that have no room. The masks of 64³ have none, whatever is stored.
    for (side, storage) in [(8, ANISOTROPIC), (8, HARMONICS), (8, HARMONICS_8), (64, SUMS)] {
        let result = values(&gpu, side, storage);
        if !matches!(result, Err(Error::LimitExceeded { .. })) {
            return Err(format!("storage {storage} of {side}³: {result:?}").into());
        }
    }
    Ok(())
}

/// Five workgroups in a row, and 16³ leaves in 16 of them.
fn short_rows(target: &Target) -> std::result::Result<(), Failed> {
    let options = DeviceOptions { max_workgroups_per_dimension: 5, ..target.options.clone() };
    let gpu = GpuBackend::new(GpuDevice::open(&options)?);
    for storage in [ISOTROPIC, ANISOTROPIC, HARMONICS, HARMONICS_8, SUMS, RANGES] {
        let (got, want) = (values(&gpu, 16, storage)?, values(&CpuBackend::new(), 16, storage)?);
        if got != want {
            let place = got.iter().zip(&want).position(|(got, want)| got != want);
            return Err(format!("storage {storage} differs in word {place:?}").into());
        }
    }
    Ok(())
}
