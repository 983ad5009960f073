//! What is refused, and grids at the ends of their budget.

use super::inputs::{some_mesh, unit_grid};
use super::{Case, SEPARATIONS};
use crate::trial::{Check, Context, Failure, Listing, ensure, list_trials};
use twinlight_core::kernels::voxelize::{MAX_TRIANGLES, VoxelizeParams};
use twinlight_core::lattice::VoxelGrid;
use twinlight_core::{Backend, Error};
use twinlight_fixtures::random::Random;

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "voxelize": bad_calls_are_refused, ends_of_the_budget);
}

/// An error of invalid input.
pub(in crate::kernels) fn refused<T>(result: Result<T, Error>) -> Check {
    match result {
        Err(Error::InvalidInput { .. }) => Ok(()),
        Err(other) => Err(other.into()),
        Ok(_) => Err(Failure::Mismatch("not refused".into())),
    }
}

/// Grids that are out of their budget by one.
pub(in crate::kernels) fn impossible_grids() -> Vec<VoxelGrid> {
    let sound = unit_grid([8, 8, 8], 6);
    let with = |change: &dyn Fn(&mut VoxelGrid)| {
        let mut grid = sound;
        change(&mut grid);
        grid
    };
    vec![
        with(&|g| g.dims[0] = 0),
        with(&|g| g.dims[2] = 0),
        with(&|g| g.dims[1] = 513),
        with(&|g| g.dims[1] = u32::MAX),
        with(&|g| g.subvoxel_bits = 5),
        with(&|g| g.subvoxel_bits = 0),
        with(&|g| g.subvoxel_bits = 13),
        with(&|g| (g.dims, g.subvoxel_bits) = ([1; 3], 16)),
        with(&|g| (g.dims, g.subvoxel_bits) = ([1; 3], 31)),
        with(&|g| (g.dims, g.subvoxel_bits) = ([1, 257, 1], 7)),
        with(&|g| g.scale = -1),
        with(&|g| g.scale = (1 << 14) + 1),
        with(&|g| g.offset[0] = (1 << 30) + 1),
        with(&|g| g.offset[2] = -(1 << 30) - 1),
        with(&|g| g.offset[1] = i32::MIN),
    ]
}

fn bad_calls_are_refused<B: Backend>(cx: &Context<'_, B>) -> Check {
    let sound = unit_grid([8, 8, 8], 6);
    let mesh = some_mesh(&mut Random::new(cx.options.seed ^ 31), &sound, 50);
    let resident = cx.backend.upload_mesh(&mesh)?;
    let thin = VoxelizeParams::thin();
    for separation in [2, 3, u32::MAX] {
        let params = VoxelizeParams { separation, ..thin };
        let result = cx.backend.voxelize(&resident, &sound, &params);
        refused(result).map_err(|f| f.within(&format!("{params:?}")))?;
    }
    for grid in impossible_grids() {
        let result = cx.backend.voxelize(&resident, &grid, &thin);
        refused(result).map_err(|f| f.within(&format!("{grid:?}")))?;
    }
    // No mesh of so many is made for this.
    let limit = thin.check(&sound, MAX_TRIANGLES + 1);
    let is_limit =
        matches!(limit, Err(Error::LimitExceeded { .. })) && thin.check(&sound, MAX_TRIANGLES).is_ok();
    ensure(is_limit, || format!("{limit:?} for too many triangles"))?;
    // A refused call leaves its mesh and the backend as they were.
    let again = cx.backend.voxelize(&resident, &sound, &thin)?;
    let want = Case { mesh, grid: sound, params: thin };
    super::same(cx, &super::downloaded(cx, &again)?, &want.agreed(cx)?)
}

/// Scales and offsets that leave all in one place, or move all to the box's surface.
fn ends_of_the_budget<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 32);
    let sound = unit_grid([5, 9, 4], 11);
    let mesh = some_mesh(&mut random, &sound, 80);
    let (far, half) = (1 << 30, 1 << 13);
    for (scale, offset) in [
        (0, [0; 3]),
        (0, [3 << 25, half, 1 << 25]),
        (1, sound.offset),
        (1 << 14, [far; 3]),
        (1 << 14, [-far; 3]),
        (1 << 14, [far, -far, sound.offset[2]]),
        ((1 << 14) - 1, sound.offset.map(|o| o - half)),
    ] {
        let grid = VoxelGrid { scale, offset, ..sound };
        for separation in SEPARATIONS {
            Case::new(mesh.clone(), grid, separation).agrees(cx)?;
        }
    }
    Ok(())
}
