// kernel family: voxelize
// contract core/src/kernels/voxelize.rs
// cpu backend-cpu/src/kernels/voxelize.rs
// gpu backend-gpu/src/kernels/voxelize.wgsl
// oracle conformance/src/oracle/voxelize.rs
//! `voxelize`: one pass over the triangles that classes them and marks what small ones meet, eight at once where they are within two voxels;
//! large ones are marked row by row of their cells. Bits are set by atomic operations, which no order shows in.

use crate::buffer::try_zeroed;
use crate::mesh::{CpuMesh, RUN, Run};
use crate::simd::{Isa, Kernel, Width, dispatch};
use crate::{CpuBackend, CpuBuffer};
use rayon::prelude::*;
use std::ops::Range;
use twinlight_core::Result;
use twinlight_core::kernels::voxelize::{THIN, VoxelBuffers, VoxelizeParams, Voxels};
use twinlight_core::lattice::{VoxelGrid, VoxelTriangle, others};

mod columns;
pub(crate) mod lists;
mod marks;
mod runs;

#[cfg(test)]
mod tests;

use marks::Marks;
use runs::{MAX_CELLS, MAX_SUBVOXEL_BITS, Runs};

/// Runs of triangles per task.
const CHUNK: usize = 256;

/// Cells of a large triangle per task: some ten microseconds.
const TASK_CELLS: i32 = 4096;

/// Marks what a mesh meets, and lists it.
pub(crate) fn voxelize(
    isa: Isa,
    mesh: &CpuMesh,
    grid: &VoxelGrid,
    params: &VoxelizeParams,
) -> Result<Voxels<CpuBackend>> {
    let mut mask = try_zeroed::<u32>(grid.mask_words())?;
    let marks = Marks::new(&mut mask);
    let call = Call { mesh, grid, params, marks: &marks };
    let chunks = (0..mesh.len().div_ceil(RUN * CHUNK)).into_par_iter();
    let classes = chunks.map(|chunk| {
        let Classes { small, large } = dispatch(isa, Chunk { call, chunk });
        (small, large)
    });
    let (small, large): (Vec<Vec<u32>>, Vec<Vec<u32>>) = classes.unzip();
    let (small, large) = (small.concat(), large.concat());
    large.par_iter().for_each(|&triangle| call.mark_large(isa, triangle));
    // [4] rank
    let ranks = lists::ranks(isa, &mask)?;
    // [5] list
    let active = lists::codes(&mask, &ranks)?;
    let parents = lists::parents(&active);
    let [small, large, mask, ranks, active, parents] =
        [small, large, mask, ranks, active, parents].map(CpuBuffer::from);
    Ok(VoxelBuffers { grid: *grid, small, large, mask, ranks, active, parents })
}

#[derive(Clone, Copy)]
struct Call<'a> {
    mesh: &'a CpuMesh,
    grid: &'a VoxelGrid,
    params: &'a VoxelizeParams,
    marks: &'a Marks<'a>,
}

impl Call<'_> {
    #[inline(always)]
    fn triangle(&self, corners: [[i32; 3]; 3]) -> VoxelTriangle {
        let mut placed = corners;
        for corner in &mut placed {
            *corner = self.grid.place(corner.map(|c| c as i16));
        }
        VoxelTriangle::new(self.grid, placed, self.params.separation)
    }

    fn mark_large(&self, isa: Isa, triangle: u32) {
        let run = &self.mesh.clusters.as_flattened()[triangle as usize / RUN];
        let triangle = self.triangle(run.corners(triangle as usize % RUN));
        let (b, c) = others(triangle.axis);
        let (columns, rows) =
            (triangle.high[b] - triangle.low[b] + 1, triangle.high[c] - triangle.low[c] + 1);
        let step = (TASK_CELLS / columns).max(1);
        let tasks = (0..(rows + step - 1) / step).into_par_iter();
        tasks.for_each(|task| {
            let rows = task * step..rows.min((task + 1) * step);
            dispatch(isa, Rows { triangle: &triangle, rows, marks: self.marks });
        });
    }
}

/// Some rows of a large triangle.
struct Rows<'a> {
    triangle: &'a VoxelTriangle,
    rows: Range<i32>,
    marks: &'a Marks<'a>,
}

impl Kernel for Rows<'_> {
    type Output = ();

    #[inline(always)]
    fn run<W: Width>(self, _: W) {
        // [3] mark large
        columns::mark(self.triangle, self.rows, self.marks);
    }
}

/// Numbers of triangles, ascending.
#[derive(Default)]
struct Classes {
    small: Vec<u32>,
    large: Vec<u32>,
}

/// Some runs of triangles.
struct Chunk<'a> {
    call: Call<'a>,
    chunk: usize,
}

impl Kernel for Chunk<'_> {
    type Output = Classes;

    #[inline(always)]
    fn run<W: Width>(self, width: W) -> Classes {
        let Call { mesh, grid, params, marks } = self.call;
        let runs = Runs::<W::U8>::new(width, grid, marks);
        let by_runs = params.separation == THIN
            && params.cutoff >= MAX_CELLS
            && grid.subvoxel_bits <= MAX_SUBVOXEL_BITS;
        let mut classes = Classes::default();
        let all = mesh.clusters.as_flattened();
        let end = mesh.len().div_ceil(RUN).min((self.chunk + 1) * CHUNK);
        classes.small.reserve((end - self.chunk * CHUNK) * RUN);
        for (i, run) in all.iter().enumerate().take(end).skip(self.chunk * CHUNK) {
            let first = i * RUN;
            let lanes = (1_u32 << RUN.min(mesh.len() - first)) - 1;
            let (mut small, mut left) = (0, lanes);
            if by_runs {
                let done = runs.mark(width, run);
                small = lanes & !(done.left | done.empty);
                left = lanes & done.left;
            }
            let large = self.mark_left(run, left, &mut small);
            push(&mut classes.small, first, small);
            push(&mut classes.large, first, large);
        }
        classes
    }
}

impl Chunk<'_> {
    /// Classes the triangles of the lanes `left` and marks what small ones meet; returns the lanes of large ones.
    #[inline(always)]
    fn mark_left(&self, run: &Run, mut left: u32, small: &mut u32) -> u32 {
        let mut large = 0;
        while left != 0 {
            let lane = left.trailing_zeros();
            left &= left - 1;
            // [1] classify
            let triangle = self.call.triangle(run.corners(lane as usize));
            if triangle.is_empty() {
                continue;
            }
            if triangle.cells() > self.call.params.cutoff {
                large |= 1 << lane;
                continue;
            }
            // [2] mark small
            *small |= 1 << lane;
            let (_, c) = others(triangle.axis);
            columns::mark(&triangle, 0..triangle.high[c] - triangle.low[c] + 1, self.call.marks);
        }
        large
    }
}

/// Appends the numbers of some lanes.
#[inline(always)]
fn push(list: &mut Vec<u32>, first: usize, mut lanes: u32) {
    while lanes != 0 {
        list.push(first as u32 + lanes.trailing_zeros());
        lanes &= lanes - 1;
    }
}
