// kernel family: trace_cones
// contract core/src/kernels/trace_cones.rs
// cpu backend-cpu/src/kernels/trace_cones.rs
// gpu backend-gpu/src/kernels/trace_cones.wgsl
// oracle conformance/src/oracle/trace_cones.rs
//! `trace_cones`: cone by cone, in the order in which they come: neighbours in a list are neighbours in the grid, whose voxels are cached.

use crate::CpuBackend;
use rayon::prelude::*;
use twinlight_core::kernels::reduce_mips::{VoxelLevels, word_starts};
use twinlight_core::kernels::trace_cones::{Cone, ConeLight, TraceConesBlock};
use twinlight_core::transport::cone::{MAX_LEVELS, VoxelView, trace_cone};

/// Cones per task.
const CHUNK: usize = 256;

/// Fills `light`, one per cone.
pub(crate) fn trace_cones(
    levels: &VoxelLevels<CpuBackend>,
    values: &[u32],
    cones: &[Cone],
    params: &TraceConesBlock,
    light: &mut [ConeLight],
) {
    let mut starts = [0; MAX_LEVELS];
    for (start, word) in starts.iter_mut().zip(word_starts(levels.grid.padded())) {
        *start = word as u32;
    }
    let view = VoxelView {
        mask: levels.mask.as_slice(),
        ranks: levels.ranks.as_slice(),
        values,
        dims: levels.grid.dims,
        level_count: levels.grid.level_count(),
        word_starts: starts,
        params,
    };
    light.par_chunks_mut(CHUNK).zip(cones.par_chunks(CHUNK)).for_each(|(light, cones)| {
        for (light, cone) in light.iter_mut().zip(cones) {
            // [1] trace
            *light = trace_cone(&view, cone);
        }
    });
}
