//! Hard cases: faces, edges and corners of voxels, ends of the grid, the least and the greatest that there is.

use super::inputs::{Point, in_units, some_mesh, unit_grid};
use super::{CUTOFFS, Case, SEPARATIONS, over, same_voxels};
use crate::oracle::voxelize::{Triple, code};
use crate::trial::{Check, Context, Listing, ensure, list_trials};
use std::collections::BTreeSet;
use twinlight_core::Backend;
use twinlight_core::kernels::voxelize::{CONSERVATIVE, NO_CUTOFF, THIN};
use twinlight_core::lattice::{LatticeMesh, VoxelGrid};
use twinlight_fixtures::random::Random;

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "voxelize":
        v1_walls_in_face_planes, v2_corners_on_corners_and_edges_on_edges, v3_upper_bounds_are_in_the_last_voxel,
        v6_every_size_any_cutoff, v7_any_shape_of_grid, products_at_their_limits,
    );
}

/// Exactly these voxels.
fn meets<B: Backend>(cx: &Context<'_, B>, case: &Case, want: impl IntoIterator<Item = Triple>) -> Check {
    let want: BTreeSet<u32> = want.into_iter().map(code).collect();
    let found = case.agreed(cx)?;
    ensure(found.active.iter().eq(&want), || {
        format!("{:?}, want {want:?}; separation {}", found.active, case.params.separation)
    })
}

/// Points of which the axis given comes first.
fn turned(axis: usize, mut point: Point) -> Point {
    point.rotate_right(axis);
    point
}

/// All six faces of a voxel, and planes a unit and two beside them, from either side. Thin walls are in the upper voxel; conservative ones
/// in both that are not farther than the margin.
fn v1_walls_in_face_planes<B: Backend>(cx: &Context<'_, B>) -> Check {
    let (grid, width) = (unit_grid([8; 3], 7), 128);
    for axis in 0..3 {
        for (face, beside) in [4, 5].into_iter().flat_map(|face| [-2, -1, 0, 1, 2].map(|by| (face, by))) {
            let height = face * width + beside;
            let corner = |u: i32, v: i32| turned(axis, [height, 4 * width + u, 4 * width + v]);
            let wall = [
                [corner(9, 9), corner(119, 9), corner(119, 119)],
                [corner(9, 9), corner(9, 119), corner(119, 119)],
            ];
            let layer = |k: i32| turned(axis, [k, 4, 4]).map(i128::from);
            let upper = face - i32::from(beside < 0);
            for turned_over in [wall, wall.map(|[p, q, r]| [p, r, q])] {
                let mesh = in_units(&turned_over);
                meets(cx, &Case::new(mesh.clone(), grid, THIN), [layer(upper)])?;
                // Cubes are closed: a unit below a face is within the margin, two are not.
                let touched = match beside {
                    -2 => vec![layer(face - 1)],
                    2 => vec![layer(face)],
                    _ => vec![layer(face - 1), layer(face)],
                };
                meets(cx, &Case::new(mesh, grid, CONSERVATIVE), touched)?;
            }
        }
    }
    Ok(())
}

/// A point and a triangle that ends on a corner touch its eight voxels, a segment along an edge its four to a voxel's width. And
/// triangles whose corners are all on corners and half-way between.
fn v2_corners_on_corners_and_edges_on_edges<B: Backend>(cx: &Context<'_, B>) -> Check {
    let (grid, width) = (unit_grid([6; 3], 8), 256);
    let around =
        |x: i128, y: i128, z: i128| (0..8).map(move |i| [x - 1 + i % 2, y - 1 + i / 2 % 2, z - 1 + i / 4]);
    let corner = [3 * width; 3];
    let pointed = [
        corner,
        [3 * width + 9, 3 * width + 20, 3 * width + 30],
        [3 * width + 30, 3 * width + 9, 3 * width + 9],
    ];
    for triangle in [[corner; 3], pointed] {
        meets(cx, &Case::new(in_units(&[triangle]), grid, CONSERVATIVE), around(3, 3, 3))?;
    }
    for axis in 0..3 {
        let at = |along: i32| turned(axis, [3 * width + along, 2 * width, 4 * width]);
        let segment = in_units(&[[at(2), at(width - 2), at(90)]]);
        let touched = [(1, 3), (1, 4), (2, 3), (2, 4)].map(|(y, z)| turned(axis, [3, y, z]).map(i128::from));
        meets(cx, &Case::new(segment.clone(), grid, CONSERVATIVE), touched)?;
        meets(cx, &Case::new(segment, grid, THIN), [])?;
    }
    let mut random = Random::new(cx.options.seed ^ 11);
    for step in [width, width / 2] {
        let mut point = || [(); 3].map(|()| step * random.index(1 + (6 * width / step) as usize) as i32);
        let triangles: Vec<[Point; 3]> = (0..300).map(|_| [point(), point(), point()]).collect();
        for separation in SEPARATIONS {
            Case::new(in_units(&triangles), grid, separation).agrees(cx)?;
        }
    }
    Ok(())
}

/// The upper end of each axis, a unit before it, and what is moved there from beyond it, are in the last voxel.
fn v3_upper_bounds_are_in_the_last_voxel<B: Backend>(cx: &Context<'_, B>) -> Check {
    let dims = [5, 3, 4];
    let grid = unit_grid(dims, 6);
    for (axis, n) in dims.map(|n: u32| n as i32).into_iter().enumerate() {
        let end = n * 64;
        for coordinate in [end - 1, end, end + 1, end + 70, 20_000] {
            let corner = |u: i32, v: i32| turned(axis, [coordinate, 70 + u, 70 + v]);
            let mesh = in_units(&[[corner(0, 0), corner(50, 0), corner(0, 50)]]);
            let last = turned(axis, [n - 1, 1, 1]).map(i128::from);
            for separation in SEPARATIONS {
                meets(cx, &Case::new(mesh.clone(), grid, separation), [last])?;
            }
        }
    }
    // Both corners of a box are in a grid over it.
    let mut random = Random::new(cx.options.seed ^ 12);
    for resolution in [1, 2, 3, 7, 31, 32, 33, 100] {
        let low = [(); 3].map(|()| -(random.index(18_000) as i16));
        let high = low.map(|c| c + 9 + random.index(18_000) as i16);
        let at = |corner: [i16; 3], by: i16| {
            [corner, [corner[0] + by, corner[1], corner[2]], [corner[0], corner[1] + by, corner[2]]]
        };
        let mesh = LatticeMesh::new([at(low, 9), at(high, -9)].concat(), vec![[0, 1, 2], [3, 4, 5]])?;
        let grid = VoxelGrid::over(low, high, resolution)?;
        let last = grid.dims.map(|n| i128::from(n) - 1);
        let found = Case::new(mesh, grid, CONSERVATIVE).agreed(cx)?;
        let ends = [found.active.first(), found.active.last()];
        let want = [code([0; 3]), code(last)];
        ensure(ends == [Some(&want[0]), Some(&want[1])], || format!("{ends:?}, want {want:?} of {grid:?}"))?;
    }
    Ok(())
}

/// Triangles of a unit and of the whole grid: classes differ, voxels don't.
fn v6_every_size_any_cutoff<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 13);
    for (dims, subvoxel_bits) in [([16, 16, 16], 11), ([40, 9, 64], 9)] {
        let grid = unit_grid(dims, subvoxel_bits);
        let mesh = some_mesh(&mut random, &grid, 400);
        for separation in SEPARATIONS {
            let case = Case::new(mesh.clone(), grid, separation);
            let want = case.agreed(cx)?;
            for cutoff in CUTOFFS.into_iter().chain([7, 15, 16, 17, 255, 4_096]) {
                let found = case.clone().cut(cutoff).found(cx)?;
                same_voxels(cx, &found, &want).map_err(|f| f.within(&format!("cutoff {cutoff}")))?;
                let mut all = [found.small.as_slice(), &found.large].concat();
                all.sort_unstable();
                ensure(all == want.small, || format!("cutoff {cutoff}: {} classed", all.len()))?;
                let rise = found.small.is_sorted() && found.large.is_sorted();
                ensure(rise, || format!("cutoff {cutoff}: unsorted classes"))?;
            }
        }
    }
    Ok(())
}

/// No cubes, no powers of two, one voxel thick.
fn v7_any_shape_of_grid<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 14);
    for (i, dims) in [
        [1, 1, 1],
        [2, 1, 1],
        [1, 1, 3],
        [1, 17, 1],
        [31, 1, 30],
        [33, 32, 1],
        [1, 63, 65],
        [7, 13, 11],
        [3, 100, 5],
        [129, 2, 3],
    ]
    .into_iter()
    .enumerate()
    {
        let longest: u32 = dims.into_iter().fold(1, u32::max);
        let grid = unit_grid(dims, 15 - longest.next_power_of_two().trailing_zeros());
        let mesh = some_mesh(&mut random, &grid, 150);
        for separation in SEPARATIONS {
            Case::new(mesh.clone(), grid, separation).cut(CUTOFFS[i % 4]).agrees(cx)?;
        }
        // The same mesh, as its own bounds have it.
        let grid = over(&mesh, longest)?;
        Case::new(mesh, grid, SEPARATIONS[i % 2]).cut(CUTOFFS[i % 4]).agrees(cx)?;
    }
    Ok(())
}

/// Triangles over corners of the widest grid, and over points a unit from them: the greatest areas, edge functions and heights that there are,
/// in voxels of any width.
fn products_at_their_limits<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 15);
    let ends = |i: i32| [0, 1, 2].map(|axis| if i >> axis & 1 == 1 { (1 << 15) - 1 } else { 0 });
    let mut triangles: Vec<[Point; 3]> = Vec::new();
    for (a, b) in (0..8).flat_map(|a| (0..8).map(move |b| (a, b))) {
        let corners = [ends(a), ends(b), ends(random.index(8) as i32)];
        triangles.push(corners);
        triangles.push(
            corners.map(|corner| corner.map(|c| (c + random.index(5) as i32 - 2).clamp(0, (1 << 15) - 1))),
        );
    }
    let mesh = in_units(&triangles);
    for (n, subvoxel_bits) in [(1, 15), (2, 14), (5, 12), (16, 11)] {
        for (separation, cutoff) in
            [(THIN, NO_CUTOFF), (THIN, 1), (CONSERVATIVE, NO_CUTOFF), (CONSERVATIVE, 1)]
        {
            Case::new(mesh.clone(), unit_grid([n; 3], subvoxel_bits), separation).cut(cutoff).agrees(cx)?;
        }
    }
    Ok(())
}
