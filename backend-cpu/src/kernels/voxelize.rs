// kernel family: voxelize
// contract core/src/kernels/voxelize.rs
// cpu backend-cpu/src/kernels/voxelize.rs
// gpu backend-gpu/src/kernels/voxelize.wgsl
// oracle conformance/src/oracle/voxelize.rs
//! `voxelize`: one pass over the triangles that classes them and marks what small ones meet; large ones are marked row by row of their cells.
//! Bits are set by atomic operations, which no order shows in.

use crate::buffer::try_zeroed;
use crate::mesh::CpuMesh;
use crate::{CpuBackend, CpuBuffer};
use rayon::prelude::*;
use std::sync::atomic::{AtomicU32, Ordering};
use twinlight_core::Result;
use twinlight_core::kernels::voxelize::{VoxelBuffers, VoxelizeParams, Voxels};
use twinlight_core::lattice::{VoxelGrid, VoxelTriangle, others};
use twinlight_core::math::morton::morton_code;

pub(crate) mod lists;

/// Triangles per task.
const CHUNK: usize = 1 << 10;

/// Marks what a mesh meets, and lists it.
pub(crate) fn voxelize(
    mesh: &CpuMesh,
    grid: &VoxelGrid,
    params: &VoxelizeParams,
) -> Result<Voxels<CpuBackend>> {
    let mask = try_zeroed::<u32>(grid.mask_words())?;
    let mut marks = Marks { mask: atomic(mask), grid, params, mesh };
    let chunks: Vec<[Vec<u32>; 2]> =
        (0..mesh.len().div_ceil(CHUNK)).into_par_iter().map(|chunk| marks.small(chunk)).collect();
    let [small, large] =
        [0, 1].map(|class| chunks.iter().flat_map(|c| &c[class]).copied().collect::<Vec<u32>>());
    large.par_iter().for_each(|&triangle| marks.large(triangle));
    let mask: Vec<u32> = marks.mask.iter_mut().map(|word| *word.get_mut()).collect();
    let ranks = lists::ranks(&mask)?;
    let active = lists::codes(&mask, &ranks)?;
    let parents = lists::parents(&active);
    let [small, large, mask, ranks, active, parents] =
        [small, large, mask, ranks, active, parents].map(CpuBuffer::from);
    Ok(VoxelBuffers { grid: *grid, small, large, mask, ranks, active, parents })
}

fn atomic(words: Vec<u32>) -> Vec<AtomicU32> {
    words.into_iter().map(AtomicU32::new).collect()
}

/// What is met so far.
struct Marks<'a> {
    mask: Vec<AtomicU32>,
    grid: &'a VoxelGrid,
    params: &'a VoxelizeParams,
    mesh: &'a CpuMesh,
}

impl Marks<'_> {
    /// Classes a chunk's triangles, and marks the small ones' voxels.
    fn small(&self, chunk: usize) -> [Vec<u32>; 2] {
        let mut classes = [Vec::new(), Vec::new()];
        for t in chunk * CHUNK..self.mesh.len().min((chunk + 1) * CHUNK) {
            // [1] classify
            let triangle = self.triangle(t);
            if triangle.is_empty() {
                continue;
            }
            let is_large = triangle.cells() > self.params.cutoff;
            classes[usize::from(is_large)].push(t as u32);
            // [2] mark small
            if !is_large {
                triangle.for_each(|voxel| self.mark(voxel));
            }
        }
        classes
    }

    fn large(&self, t: u32) {
        // [3] mark large
        let triangle = self.triangle(t as usize);
        let (b, c) = others(triangle.axis);
        (triangle.low[c]..triangle.high[c] + 1).into_par_iter().with_min_len(8).for_each(|y| {
            for x in triangle.low[b]..=triangle.high[b] {
                let (first, last) = triangle.column(x, y);
                for k in first..=last {
                    let voxel = triangle.voxel(x, y, k);
                    if triangle.meets(voxel) {
                        self.mark(voxel);
                    }
                }
            }
        });
    }

    fn triangle(&self, t: usize) -> VoxelTriangle {
        let corners = self.mesh.corners(t).map(|p| self.grid.place(p));
        VoxelTriangle::new(self.grid, corners, self.params.separation)
    }

    fn mark(&self, voxel: [i32; 3]) {
        let code = morton_code(voxel.map(|i| i as u32));
        let (word, bit) = (&self.mask[(code >> 5) as usize], 1 << (code & 31));
        if word.load(Ordering::Relaxed) & bit == 0 {
            word.fetch_or(bit, Ordering::Relaxed);
        }
    }
}
