//! The CPU twins. Contracts: [`twinlight_core::kernels`].

pub(crate) mod filter_indirect;
pub(crate) mod light_voxels;
pub(crate) mod merge_lhb;
pub(crate) mod pack_lhb;
pub(crate) mod query_lhb;
pub(crate) mod rasterize_lhb;
pub(crate) mod reduce_mips;
pub(crate) mod scan;
pub(crate) mod shade_primary;
pub(crate) mod sort;
pub(crate) mod sum_voxels;
pub(crate) mod trace;
pub(crate) mod trace_cones;
pub(crate) mod trace_paths;
pub(crate) mod voxelize;
pub(crate) mod walk_lhb;
