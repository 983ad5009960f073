//! Third opinions, one per kernel: serial, naive on purpose, exact or in f64. They share no algorithm with either twin,
//! so that a misreading both twins share still shows.

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
