//! The kernels: one `.wgsl` with the algorithm and one `.rs` that sizes its buffers and records its dispatches.
//!
//! To add one: write the two files, add the module here and its [`KernelSource`] to [`ALL`], and the method to
//! `backend.rs`. The tests `sources` and `layout` find it through [`ALL`].

pub mod filter_indirect;
pub mod light_voxels;
pub mod merge_lhb;
pub mod pack_lhb;
pub mod path;
pub mod query_lhb;
pub mod rasterize_lhb;
pub mod reduce_mips;
pub mod scan;
pub mod shade_primary;
pub mod sort;
mod status;
pub mod sum_voxels;
pub mod trace;
pub mod trace_cones;
pub mod trace_paths;
pub mod voxelize;
pub mod walk_lhb;

use crate::source::KernelSource;

/// Every kernel's source, in pipeline order.
pub const ALL: &[&KernelSource] = &[
    &scan::SOURCE,
    &sort::SOURCE,
    &rasterize_lhb::SOURCE,
    &merge_lhb::SOURCE,
    &pack_lhb::SOURCE,
    &query_lhb::SOURCE,
    &trace::SOURCE,
    &shade_primary::SOURCE,
    &trace_paths::SOURCE,
    &walk_lhb::SOURCE,
    &filter_indirect::SOURCE,
    &reduce_mips::SOURCE,
    &voxelize::SOURCE,
    &sum_voxels::SOURCE,
    &trace_cones::SOURCE,
    &light_voxels::SOURCE,
];
