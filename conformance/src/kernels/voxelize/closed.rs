//! Closed meshes are closed sets of voxels: what is not met is inside or outside, and no path leads from one to the other.

use super::inputs::{in_units, unit_grid};
use super::{Case, Checked, SEPARATIONS};
use crate::kernels::rasterize_lhb::inputs::{snapped, turned};
use crate::oracle::voxelize::{Placed, Triple, voxel};
use crate::trial::{Check, Context, Failure, Listing, ensure, list_trials};
use glam::DVec3;
use twinlight_core::Backend;
use twinlight_core::kernels::voxelize::{CONSERVATIVE, THIN};
use twinlight_core::lattice::{LatticeMesh, VoxelGrid};
use twinlight_core::scene::Mesh;
use twinlight_fixtures::meshes;

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "voxelize":
        v5_closed_meshes_are_not_entered, v5_boxes_in_face_planes, v10_surface_inside_outside,
    );
}

/// A mesh with room around it, in a grid of so many voxels to the longest axis.
fn with_room(mesh: &Mesh, resolution: u32) -> Checked<(LatticeMesh, VoxelGrid)> {
    let mesh = snapped(mesh);
    let vertices = mesh.vertices().iter().map(|v| v.map(|c| c / 2)).collect();
    let mesh = LatticeMesh::new(vertices, mesh.triangles().to_vec())?;
    // Meshes reach half as far as the lattice: four voxels remain on either side where there are sixteen.
    Ok((mesh, VoxelGrid::over([-32_760; 3], [32_760; 3], resolution)?))
}

/// How often a mesh winds around the voxels' centres: surfaces above them, as they show their front to below or not. Lines pass
/// centres by an infinitesimal step in x and one still smaller in y, and so pass edges by.
fn windings(mesh: &LatticeMesh, grid: &VoxelGrid) -> Vec<i32> {
    let triangles: Vec<Placed> = (0..mesh.triangles().len()).map(|i| Placed::of(mesh, grid, i)).collect();
    let mut windings = vec![0; grid.dims.iter().product::<u32>() as usize];
    for (x, y) in cells(grid) {
        for placed in triangles.iter().filter(|t| t.normal[2] != 0) {
            let at = placed.centre([x, y, 0]);
            let inside = |&[dx, dy, e]: &Triple| {
                // Edges run anticlockwise where the normal points up.
                let [dx, dy] = [dx, dy].map(|d| d * placed.normal[2].signum());
                e > 0 || e == 0 && (dy < 0 || dy == 0 && dx > 0)
            };
            if !placed.edges(2, at).iter().all(inside) {
                continue;
            }
            let [p, n] = [placed.corners[0], placed.normal];
            let rest = (at[0] - p[0]) * n[0] + (at[1] - p[1]) * n[1];
            for z in 0..i128::from(grid.dims[2]) {
                let height = placed.centre([x, y, z])[2] - p[2];
                // The plane is above where n·(centre − p) and the normal's z differ in sign.
                if (rest + height * n[2]) * n[2] < 0 {
                    windings[index(grid, [x, y, z])] += n[2].signum() as i32;
                }
            }
        }
    }
    windings
}

fn cells(grid: &VoxelGrid) -> impl Iterator<Item = (i128, i128)> + use<> {
    let [nx, ny, _] = grid.dims.map(i128::from);
    (0..ny).flat_map(move |y| (0..nx).map(move |x| (x, y)))
}

fn index(grid: &VoxelGrid, [x, y, z]: Triple) -> usize {
    let [nx, ny, _] = grid.dims.map(i128::from);
    ((z * ny + y) * nx + x) as usize
}

fn all_voxels(grid: &VoxelGrid) -> impl Iterator<Item = Triple> + use<> {
    let nz = i128::from(grid.dims[2]);
    cells(grid).flat_map(move |(x, y)| (0..nz).map(move |z| [x, y, z]))
}

/// Steps to voxels that share a face, or at least a corner.
fn steps(share_faces: bool) -> Vec<Triple> {
    let steps = (0..27).map(|i| [i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1]);
    let axes = |step: &Triple| step.iter().filter(|s| **s != 0).count();
    steps.filter(|step| axes(step) == 1 || (!share_faces && axes(step) > 1)).collect()
}

/// Where a step leads to, if there is a voxel.
fn stepped(grid: &VoxelGrid, voxel: Triple, step: Triple) -> Option<Triple> {
    let to = [0, 1, 2].map(|axis| voxel[axis] + step[axis]);
    (0..3).all(|axis| (0..i128::from(grid.dims[axis])).contains(&to[axis])).then_some(to)
}

/// Which voxels of a grid are not met.
fn free(grid: &VoxelGrid, met: &[u32]) -> Vec<bool> {
    let mut free = vec![true; grid.dims.iter().product::<u32>() as usize];
    met.iter().for_each(|&code| free[index(grid, voxel(code))] = false);
    free
}

/// No step from voxel to voxel that are both not met changes the winding: across faces for thin voxels, across corners for
/// conservative ones. Returns how many are within.
fn closes(grid: &VoxelGrid, windings: &[i32], met: &[u32], separation: u32) -> Checked<usize> {
    let free = free(grid, met);
    // Of each step and the one back, one will do.
    let steps: Vec<Triple> =
        steps(separation == THIN).into_iter().filter(|[x, y, z]| 9 * z + 3 * y + x > 0).collect();
    let mut within = 0;
    for from in all_voxels(grid).filter(|&v| free[index(grid, v)]) {
        let winding = windings[index(grid, from)];
        within += usize::from(winding != 0);
        for to in steps.iter().filter_map(|&step| stepped(grid, from, step)) {
            let other = windings[index(grid, to)];
            ensure(!free[index(grid, to)] || other == winding, || {
                format!("{from:?} to {to:?}: winding {winding}, {other}; separation {separation}, {grid:?}")
            })?;
        }
    }
    Ok(within)
}

/// Neither separation lets anything in. Returns the least that is within.
fn is_closed<B: Backend>(cx: &Context<'_, B>, mesh: &LatticeMesh, grid: &VoxelGrid) -> Checked<usize> {
    let windings = windings(mesh, grid);
    let mut least = usize::MAX;
    for separation in SEPARATIONS {
        let met = Case::new(mesh.clone(), *grid, separation).found(cx)?.active;
        least = least.min(closes(grid, &windings, &met, separation)?);
    }
    Ok(least)
}

/// Closed meshes, convex and not, through themselves and in each other.
fn v5_closed_meshes_are_not_entered<B: Backend>(cx: &Context<'_, B>) -> Check {
    let displaced = meshes::displaced_sphere(5, DVec3::new(0.1, 0.2, -0.3), 0.8, 0.3, cx.options.seed);
    for (name, mesh) in [
        ("icosphere", meshes::icosphere(3)),
        ("cube", meshes::cube()),
        ("turned cube", turned(meshes::cube(), 3)),
        ("torus", turned(meshes::torus(12, 7, 0.4), 5)),
        ("displaced sphere", displaced),
        ("shells", meshes::shells(3, 2)),
    ] {
        for resolution in if cx.full() { vec![9, 16, 31] } else { vec![9, 21] } {
            let (mesh, grid) = with_room(&mesh, resolution)?;
            let within = is_closed(cx, &mesh, &grid).map_err(|f: Failure| f.within(name))?;
            ensure(within > 0 || resolution < 20, || format!("{name}: nothing within {grid:?}"))?;
        }
    }
    Ok(())
}

/// Boxes whose sides are in the planes of voxels' faces and centres, and a unit beside them.
fn v5_boxes_in_face_planes<B: Backend>(cx: &Context<'_, B>) -> Check {
    let (grid, half) = (unit_grid([12; 3], 7), 64);
    for (begin, end) in [(8, 14), (8, 15), (9, 14), (9, 15)] {
        for beside in [-1, 0, 1] {
            let at =
                |i: usize, axis: usize| if i >> axis & 1 == 1 { end * half + beside } else { begin * half };
            let corner = |i: usize| [at(i, 0), at(i, 1), at(i, 2)];
            // Two triangles a side, each outwards.
            let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
            let triangles = sides.map(|[a, b, c, d]| [[a, b, c], [a, c, d]].map(|t| t.map(corner)));
            let mesh = in_units(&triangles.concat());
            is_closed(cx, &mesh, &grid).map_err(|f| f.within(&format!("{begin} to {end}")))?;
        }
    }
    Ok(())
}

/// Voxels that are met, that a flood from outside reaches, and the rest: around a convex body these are its surface, what is outside and
/// what is inside, and there are no others.
fn v10_surface_inside_outside<B: Backend>(cx: &Context<'_, B>) -> Check {
    for (name, mesh) in [
        ("cube", meshes::cube()),
        ("turned cube", turned(meshes::cube(), 9)),
        ("icosphere", turned(meshes::icosphere(4), 4)),
        ("uv sphere", meshes::uv_sphere(9, 14)),
    ] {
        let (mesh, grid) = with_room(&mesh, 24)?;
        let windings = windings(&mesh, &grid);
        for separation in [THIN, CONSERVATIVE] {
            let surface = Case::new(mesh.clone(), grid, separation).found(cx)?.active;
            let free = free(&grid, &surface);
            let outside = flooded(&grid, &free, &steps(separation == THIN));
            let inside: Vec<bool> =
                free.iter().zip(&outside).map(|(free, outside)| *free && !outside).collect();
            let count = |of: &[bool]| of.iter().filter(|is| **is).count();
            let (counts, all) = ([surface.len(), count(&outside), count(&inside)], free.len());
            let parted = counts.iter().sum::<usize>() == all && counts.iter().all(|&n| n > 100);
            ensure(parted, || format!("{name}: {counts:?} of {all}, separation {separation}"))?;
            let stray = all_voxels(&grid).find(|&v| {
                let i = index(&grid, v);
                free[i] && inside[i] != (windings[i] == 1)
            });
            ensure(stray.is_none(), || format!("{name}: {stray:?}, separation {separation}"))?;
        }
    }
    Ok(())
}

/// What a flood from the first voxel reaches.
fn flooded(grid: &VoxelGrid, free: &[bool], steps: &[Triple]) -> Vec<bool> {
    let mut reached = vec![false; free.len()];
    let mut next = vec![[0; 3]];
    reached[0] = true;
    while let Some(from) = next.pop() {
        for to in steps.iter().filter_map(|&step| stepped(grid, from, step)) {
            let i = index(grid, to);
            if free[i] && !reached[i] {
                reached[i] = true;
                next.push(to);
            }
        }
    }
    reached
}
