//! Conservative voxels hold the mesh as it was before it was snapped to the lattice and to the grid.

use super::{Case, over};
use crate::oracle::voxelize::{Placed, code};
use crate::trial::{Check, Context, Failure, Listing, ensure, list_trials};
use glam::DVec3;
use twinlight_core::Backend;
use twinlight_core::kernels::voxelize::CONSERVATIVE;
use twinlight_core::lattice::{Lattice, LatticeMesh, VoxelGrid};
use twinlight_fixtures::random::Random;

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "voxelize": v4_touched_before_snapping);
}

/// Parts of a lattice step that corners are multiples of: few enough for exact arithmetic.
const PARTS: i128 = 256;

/// A corner in those parts.
type Corner = [i128; 3];

/// What a triangle that was never snapped touches, found with fractions, is met: where a unit is a lattice step, and where it is less.
fn v4_touched_before_snapping<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 41);
    for (reach, resolution) in [(500, 4), (900, 64), (3_000, 33), (18_000, 5), (18_000, 31), (9_000, 48)] {
        for _ in 0..if cx.full() { 3 } else { 1 } {
            let triangles: Vec<[Corner; 3]> =
                (0..120).map(|i| some_triangle(&mut random, reach, i < 20)).collect();
            holds_all(cx, &triangles, resolution)?;
        }
    }
    Ok(())
}

fn holds_all<B: Backend>(cx: &Context<'_, B>, triangles: &[[Corner; 3]], resolution: u32) -> Check {
    // Of one step: corners are where they are said to be.
    let lattice = Lattice::new(DVec3::ZERO, 32_759.0)?;
    let world = |corner: Corner| DVec3::from(corner.map(|c| c as f64 / PARTS as f64));
    let mesh = LatticeMesh::snap(&lattice, triangles.iter().map(|t| t.map(world)))?;
    let grid = over(&mesh, resolution)?;
    let found = Case::new(mesh, grid, CONSERVATIVE).agreed(cx)?;
    let mut touched = 0;
    for triangle in triangles {
        let exact = unsnapped(&grid, triangle);
        for voxel in exact.around(grid.dims).filter(|&voxel| exact.touches(voxel, 0)) {
            touched += 1;
            ensure(found.active.binary_search(&code(voxel)).is_ok(), || {
                format!("{voxel:?} is touched by {triangle:?}, in 256ths of steps, but not met; {grid:?}")
            })?;
        }
    }
    ensure(touched >= triangles.len(), || format!("{touched} voxels"))
        .map_err(|f: Failure| f.within("touched"))
}

/// The triangle in 2⁻¹⁴/256 of the grid's units, without the half unit that rounds.
fn unsnapped(grid: &VoxelGrid, triangle: &[Corner; 3]) -> Placed {
    let place = |corner: Corner| {
        [0, 1, 2].map(|axis| {
            let offset = i128::from(grid.offset[axis]) - (1 << 13);
            i128::from(grid.scale) * corner[axis] + offset * PARTS
        })
    };
    Placed::new(triangle.map(place), (PARTS << 14) << grid.subvoxel_bits)
}

/// Wide, or small; a third in parts that rounding is most unsure of.
fn some_triangle(random: &mut Random, reach: i128, wide: bool) -> [Corner; 3] {
    let mut between = |reach: i128| random.index(2 * (reach * PARTS) as usize + 1) as i128 - reach * PARTS;
    let middle = [(); 3].map(|()| between(reach * 9 / 10));
    let corners = [(); 3].map(|()| middle.map(|c| c + between(reach / 20)));
    let corners = if wide { [(); 3].map(|()| [(); 3].map(|()| between(reach))) } else { corners };
    let halves = random.index(3) == 0;
    corners.map(|corner| corner.map(|c| if halves { c / PARTS * PARTS + PARTS / 2 } else { c }))
}
