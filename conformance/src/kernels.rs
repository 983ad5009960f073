//! Cases and laws of every kernel, in pipeline order.

pub mod filter_indirect;
pub mod light_voxels;
pub mod merge_lhb;
pub mod pack_lhb;
mod property;
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

use crate::trial::{Check, Context, Failure, Listing};
use twinlight_core::Backend;

/// Stems of the kernels the suite knows, in pipeline order.
pub const STEMS: [&str; 16] = [
    "scan",
    "sort",
    "rasterize_lhb",
    "merge_lhb",
    "pack_lhb",
    "query_lhb",
    "trace",
    "shade_primary",
    "trace_paths",
    "walk_lhb",
    "filter_indirect",
    "reduce_mips",
    "voxelize",
    "sum_voxels",
    "trace_cones",
    "light_voxels",
];

/// Lists every kernel's trials.
pub fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    scan::list(list);
    sort::list(list);
    rasterize_lhb::list(list);
    merge_lhb::list(list);
    pack_lhb::list(list);
    query_lhb::list(list);
    trace::list(list);
    shade_primary::list(list);
    trace_paths::list(list);
    walk_lhb::list(list);
    filter_indirect::list(list);
    reduce_mips::list(list);
    voxelize::list(list);
    sum_voxels::list(list);
    trace_cones::list(list);
    light_voxels::list(list);
}

/// Bit equality is promised where float results are those of IEEE 754 evaluated as written.
fn strict_only<B: Backend>(cx: &Context<'_, B>) -> Check {
    if cx.backend.info().strict {
        return Ok(());
    }
    Err(Failure::Skip("bit equality is promised in strict mode only".into()))
}

/// Pictures of many samples. On a GPU they wait for full effort: at quick effort it is compared with the CPU, bit for bit in strict
/// mode, and software adapters take minutes for what that comparison shows in seconds.
fn pictures_wanted<B: Backend>(cx: &Context<'_, B>) -> Check {
    if cx.full() || cx.backend.info().kind != "gpu" {
        return Ok(());
    }
    Err(Failure::Skip("at quick effort GPUs are compared with the CPU instead".into()))
}
