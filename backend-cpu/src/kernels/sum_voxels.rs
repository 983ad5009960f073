// kernel family: sum_voxels
// contract core/src/kernels/sum_voxels.rs
// cpu backend-cpu/src/kernels/sum_voxels.rs
// gpu backend-gpu/src/kernels/sum_voxels.wgsl
// oracle conformance/src/oracle/sum_voxels.rs
//! `sum_voxels`: every triangle adds what it is to the voxels it meets, by atomic operations: no order shows in integer sums.

use crate::buffer::try_zeroed;
use crate::mesh::CpuMesh;
use crate::{CpuBackend, CpuBuffer};
use rayon::prelude::*;
use std::sync::atomic::{AtomicU32, Ordering};
use twinlight_core::Result;
use twinlight_core::kernels::sum_voxels::{VoxelSums, VoxelSurface, check_fragments};
use twinlight_core::kernels::voxelize::{VoxelizeParams, Voxels};
use twinlight_core::lattice::VoxelTriangle;
use twinlight_core::math::fragment::fragment_at;
use twinlight_core::math::morton::morton_code;

/// Words of a voxel's sums.
const WORDS: usize = size_of::<VoxelSums>() / size_of::<u32>();

/// Triangles per task.
const CHUNK: usize = 1 << 10;

/// Sums over the fragments of each active voxel.
pub(crate) fn sum_voxels(
    mesh: &CpuMesh,
    voxels: &Voxels<CpuBackend>,
    surfaces: &[VoxelSurface],
    texels: &[u32],
    params: &VoxelizeParams,
    active: usize,
) -> Result<CpuBuffer<VoxelSums>> {
    let zeroes = try_zeroed::<u32>(active * WORDS)?;
    let sums: Vec<AtomicU32> = zeroes.into_iter().map(AtomicU32::new).collect();
    let (mask, ranks, grid) = (voxels.mask.as_slice(), voxels.ranks.as_slice(), &voxels.grid);
    // [1] add
    (0..mesh.len()).into_par_iter().with_min_len(CHUNK).for_each(|t| {
        let corners = mesh.corners(t).map(|p| grid.place(p));
        let triangle = VoxelTriangle::new(grid, corners, params.separation);
        if triangle.is_empty() {
            return;
        }
        triangle.for_each(|voxel| {
            let code = morton_code(voxel.map(|i| i as u32));
            let (word, bit) = ((code >> 5) as usize, code & 31);
            let below = mask[word] & ((1 << bit) - 1);
            let rank = ranks[word].wrapping_add(below.count_ones()) as usize;
            // Voxels of other origin.
            if mask[word] >> bit & 1 == 0 || rank >= active {
                return;
            }
            let fragment = fragment_at(&surfaces[t], texels, triangle.weights(voxel));
            for (sum, word) in sums[rank * WORDS..].iter().zip(fragment) {
                sum.fetch_add(word, Ordering::Relaxed);
            }
        });
    });
    // [2] check
    let sums: Vec<u32> = sums.into_iter().map(AtomicU32::into_inner).collect();
    let sums: Vec<VoxelSums> = bytemuck::pod_collect_to_vec(&sums);
    check_fragments(sums.iter().map(|s| s.count).max().unwrap_or(0))?;
    Ok(CpuBuffer::from(sums))
}
