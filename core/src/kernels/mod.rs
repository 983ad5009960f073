//! Contracts of the kernels, in pipeline order: purpose, formula, source, parameters, buffers, edge cases, accuracy.
//! No algorithm; the twins are in the backends under the same stem.

pub mod filter_indirect;
pub mod light_voxels;
pub mod merge_lhb;
pub mod pack_lhb;
pub mod query_lhb;
pub mod rasterize_lhb;
pub mod reduce_mips;
pub mod scan;
pub mod shade_primary;
pub mod sort;
pub mod sum_voxels;
pub mod trace;
pub mod trace_cones;
pub mod trace_paths;
pub mod voxelize;
pub mod walk_lhb;
