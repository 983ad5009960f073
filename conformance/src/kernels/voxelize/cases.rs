//! Edge ladders, meshes and grids of every kind, and meshes of more triangles than a task has.

use super::inputs::{in_units, some_grid, some_mesh, unit_grid};
use super::{CUTOFFS, Case, SEPARATIONS, over};
use crate::kernels::property::hold;
use crate::kernels::rasterize_lhb::inputs::{
    duplicates, fans_and_strips, mixed_sizes, snapped, thin, turned,
};
use crate::trial::{Check, Context, Listing, ensure, list_trials};
use proptest::prelude::*;
use twinlight_core::Backend;
use twinlight_core::kernels::voxelize::{CONSERVATIVE, NO_CUTOFF, THIN};
use twinlight_core::lattice::LatticeMesh;
use twinlight_fixtures::meshes;
use twinlight_fixtures::random::Random;

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "voxelize":
        g9_nothing_to_voxelize, one_triangle, random_meshes, fixture_meshes, classes_go_by_cells, triangle_ladder,
        whole_meshes, most_voxels_to_an_axis,
    );
}

/// No triangles, with vertices and without; and triangles that thin voxels don't see.
fn g9_nothing_to_voxelize<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 1);
    let unused = LatticeMesh::new(vec![[1, 2, 3]], Vec::new())?;
    let points = in_units(&[[[300; 3]; 3], [[0; 3], [100; 3], [50; 3]]]);
    for grid in [unit_grid([1; 3], 15), unit_grid([3, 1, 2], 7), some_grid(&mut random)] {
        for separation in SEPARATIONS {
            for mesh in [LatticeMesh::default(), unused.clone(), points.clone()] {
                let found = Case::new(mesh.clone(), grid, separation).agreed(cx)?;
                let nothing = mesh.triangles().is_empty() || separation == THIN;
                let lists = [found.small.len() + found.large.len(), found.active.len(), found.parents.len()];
                ensure(nothing == (lists == [0; 3]), || format!("lists of {lists:?}"))?;
            }
        }
    }
    Ok(())
}

/// A triangle whose voxels can be counted, in grids of one voxel, of few, and beyond them. Far from the centre's lines a thin voxel
/// does without it.
fn one_triangle<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mesh = in_units(&[[[10, 10, 70], [120, 20, 80], [20, 100, 90]]]);
    for (grid, [thin, touched]) in [
        (unit_grid([1; 3], 15), [0, 1]),
        (unit_grid([1; 3], 6), [1, 1]),
        (unit_grid([2; 3], 6), [3, 4]),
        (unit_grid([2, 2, 1], 7), [1, 1]),
    ] {
        for (separation, want) in [(THIN, thin), (CONSERVATIVE, touched)] {
            for cutoff in CUTOFFS {
                let found = Case::new(mesh.clone(), grid, separation).cut(cutoff).agreed(cx)?;
                ensure(found.active.len() == want, || {
                    format!("{:?}, want {want} in {grid:?}, separation {separation}", found.active)
                })?;
            }
        }
    }
    Ok(())
}

fn random_meshes<B: Backend>(cx: &Context<'_, B>) -> Check {
    hold(cx, (any::<u64>(), 1..600_usize, 0..8_usize), |(seed, count, kind)| {
        let mut random = Random::new(seed);
        let grid = some_grid(&mut random);
        let mesh = some_mesh(&mut random, &grid, count);
        Case::new(mesh, grid, SEPARATIONS[kind / 4]).cut(CUTOFFS[kind % 4]).agrees(cx)
    })
}

/// Fans, strips, needles, slivers and copies in grids over what is there.
fn fixture_meshes<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mesh = prop_oneof![mixed_sizes(), fans_and_strips(), thin(), duplicates()];
    hold(cx, (mesh, 1..24_u32, 0..8_usize), |(mesh, resolution, kind)| {
        let grid = over(&mesh, resolution)?;
        Case::new(mesh, grid, SEPARATIONS[kind / 4]).cut(CUTOFFS[kind % 4]).agrees(cx)
    })
}

/// Bounds of so many cells that the cutoff is one less, as many, and one more.
fn classes_go_by_cells<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut triangles = Vec::new();
    // Across so many voxels of 64 units, to the last unit or the next one.
    for (columns, rows) in [(1, 1), (1, 2), (3, 1), (8, 8), (5, 13), (64, 1), (8, 9)] {
        for more in [-1, 0] {
            let [x, y] = [columns, rows].map(|n: i32| 64 * n + more);
            triangles.extend([
                [[0, 0, 5], [x, 0, 6], [0, y, 7]],
                [[5, 0, 0], [6, x, 0], [7, 0, y]],
                [[0, 5, 0], [0, 6, x], [y, 7, 0]],
                // A sliver has no area to speak of, and all the cells.
                [[0, 0, 5], [x, y, 6], [x - 1, y, 6]],
                [[0, 0, 5], [x, y, 6], [0, 0, 5]],
            ]);
        }
    }
    let (mesh, grid) = (in_units(&triangles), unit_grid([66; 3], 6));
    for separation in SEPARATIONS {
        for cutoff in [0, 1, 2, 3, 63, 64, 65, 71, 72, 73, NO_CUTOFF] {
            Case::new(mesh.clone(), grid, separation).cut(cutoff).agrees(cx)?;
        }
    }
    Ok(())
}

/// Numbers of triangles around every chunk or workgroup size a backend is likely to use.
fn triangle_ladder<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 2);
    let grid = unit_grid([17, 9, 12], 9);
    for (i, count) in [1, 2, 63, 64, 65, 255, 256, 257, 1_023, 1_024, 1_025, 2_049].into_iter().enumerate() {
        let mesh = some_mesh(&mut random, &grid, count);
        let mut triangles = mesh.triangles().to_vec();
        triangles.truncate(count - 1);
        // The last one is alone where it is.
        let mut vertices: Vec<_> =
            mesh.vertices().iter().map(|v| v.map(|c| c.min(16_384 - (1 << 9)))).collect();
        let first = vertices.len() as u32;
        let last = in_units(&[[[8_200, 4_100, 5_700], [8_600, 4_200, 5_700], [8_200, 4_600, 5_700]]]);
        vertices.extend(last.vertices());
        triangles.push([first, first + 1, first + 2]);
        let mesh = LatticeMesh::new(vertices, triangles)?;
        Case::new(mesh, grid, SEPARATIONS[i % 2]).cut(CUTOFFS[i / 2 % 4]).agrees(cx)?;
    }
    Ok(())
}

/// Closed meshes of thousands of triangles, most of them smaller than a voxel, and many thousands of single ones.
fn whole_meshes<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 3);
    let sphere = snapped(&turned(meshes::icosphere(16), 5));
    let torus = snapped(&turned(meshes::torus(60, 30, 0.4), 6));
    for (mesh, resolution, cutoff) in [(sphere, 40, 64), (torus, 64, 4)] {
        let grid = over(&mesh, resolution)?;
        for separation in SEPARATIONS {
            Case::new(mesh.clone(), grid, separation).cut(cutoff).agrees(cx)?;
        }
    }
    let grid = unit_grid([64, 33, 50], 9);
    let mesh = some_mesh(&mut random, &grid, if cx.full() { 40_000 } else { 10_000 });
    Case::new(mesh, grid, THIN).cut(8).agrees(cx)
}

/// 512 voxels along one axis, and along all: the first and the last of each, and a diagonal.
fn most_voxels_to_an_axis<B: Backend>(cx: &Context<'_, B>) -> Check {
    let most = (1 << 15) - 1;
    let corner = |c: i32| [[c, c, c], [c ^ 9, c, c ^ 2], [c, c ^ 8, c ^ 1]];
    let sliver = [[0, 0, 0], [most, most, most], [most - 1, most, most]];
    let mesh = in_units(&[corner(0), corner(most), sliver]);
    for (dims, subvoxel_bits) in [([512, 1, 2], 6), ([3, 256, 2], 7), ([1, 2, 256], 7)] {
        for separation in SEPARATIONS {
            Case::new(mesh.clone(), unit_grid(dims, subvoxel_bits), separation).cut(3).agrees(cx)?;
        }
    }
    // The oracle would try every voxel of the diagonal's bounds.
    let corners = in_units(&[corner(0), corner(most), corner(1 << 14)]);
    Case::new(corners, unit_grid([512; 3], 6), CONSERVATIVE).agrees(cx)
}
