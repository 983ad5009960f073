//! Closed meshes are closed sets of voxels: what is not met is inside or outside, and no path leads from one to the other.

use super::inputs::{in_units, unit_grid};
use super::{Case, Checked, SEPARATIONS};
use crate::kernels::rasterize_lhb::inputs::{snapped, turned};
use crate::oracle::voxelize::{Placed, Triple, code};
use crate::trial::{Check, Context, Failure, Listing, ensure, list_trials};
use glam::DVec3;
use std::collections::BTreeSet;
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

/// Voxels that share a face with this one, or at least a corner.
fn neighbours(grid: &VoxelGrid, voxel: Triple, share_faces: bool) -> impl Iterator<Item = Triple> + use<> {
    let dims = grid.dims.map(i128::from);
    let steps = (0..27).map(|i| [i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1]);
    let wanted = move |step: &Triple| {
        let axes = step.iter().filter(|s| **s != 0).count();
        axes == 1 || (!share_faces && axes > 1)
    };
    steps
        .filter(wanted)
        .map(move |step| [0, 1, 2].map(|axis| voxel[axis] + step[axis]))
        .filter(move |voxel| (0..3).all(|axis| (0..dims[axis]).contains(&voxel[axis])))
}

/// No step from voxel to voxel that are both not met changes the winding: across faces for thin voxels, across corners for
/// conservative ones. Returns how many are within.
fn closes<B: Backend>(
    cx: &Context<'_, B>,
    mesh: &LatticeMesh,
    grid: &VoxelGrid,
    separation: u32,
) -> Checked<usize> {
    let met: BTreeSet<u32> =
        Case::new(mesh.clone(), *grid, separation).found(cx)?.active.into_iter().collect();
    let windings = windings(mesh, grid);
    let is_free = |voxel: &Triple| !met.contains(&code(*voxel));
    let winding = |voxel: Triple| windings[index(grid, voxel)];
    let mut within = 0;
    for voxel in all_voxels(grid).filter(is_free) {
        within += usize::from(winding(voxel) != 0);
        let mut around = neighbours(grid, voxel, separation == THIN).filter(is_free);
        let entered = around.find(|&other| winding(other) != winding(voxel));
        ensure(entered.is_none(), || {
            let place = format!("from {voxel:?} to {entered:?}, separation {separation}");
            format!("{place}: winding {}, {:?}; {grid:?}", winding(voxel), entered.map(winding))
        })?;
    }
    Ok(within)
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
        for resolution in if cx.full() { vec![9, 16, 21, 40] } else { vec![9, 21] } {
            let (mesh, grid) = with_room(&mesh, resolution)?;
            for separation in SEPARATIONS {
                let within = closes(cx, &mesh, &grid, separation).map_err(|f: Failure| f.within(name))?;
                ensure(within > 0 || resolution < 20, || format!("{name}: nothing within {grid:?}"))?;
            }
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
            for separation in SEPARATIONS {
                closes(cx, &mesh, &grid, separation).map_err(|f| f.within(&format!("{begin} to {end}")))?;
            }
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
            let found = Case::new(mesh.clone(), grid, separation).found(cx)?;
            let surface: BTreeSet<u32> = found.active.into_iter().collect();
            let outside = flooded(&grid, &surface, separation == THIN);
            let is_inside = |v: &Triple| !surface.contains(&code(*v)) && !outside.contains(&code(*v));
            let inside: BTreeSet<u32> = all_voxels(&grid).filter(is_inside).map(code).collect();
            let counts = [surface.len(), outside.len(), inside.len()];
            let all = grid.dims.iter().product::<u32>() as usize;
            let parted = counts.iter().sum::<usize>() == all && counts.iter().all(|&n| n > 100);
            ensure(parted, || format!("{name}: {counts:?} of {all}, separation {separation}"))?;
            let stray = all_voxels(&grid)
                .filter(|v| !surface.contains(&code(*v)))
                .find(|&v| inside.contains(&code(v)) != (windings[index(&grid, v)] == 1));
            ensure(stray.is_none(), || format!("{name}: {stray:?}, separation {separation}"))?;
        }
    }
    Ok(())
}

/// What a flood from the first voxel reaches.
fn flooded(grid: &VoxelGrid, walls: &BTreeSet<u32>, across_faces: bool) -> BTreeSet<u32> {
    let mut reached = BTreeSet::from([0]);
    let mut next = vec![[0; 3]];
    while let Some(voxel) = next.pop() {
        for other in neighbours(grid, voxel, across_faces) {
            if !walls.contains(&code(other)) && reached.insert(code(other)) {
                next.push(other);
            }
        }
    }
    reached
}
