//! Meshes and grids made to hurt: vertices on voxels' faces, edges and corners and a unit beside them, triangles of every size and shape,
//! grids whose units are lattice steps and grids whose aren't.

use crate::kernels::rasterize_lhb::inputs::SIDE;
use twinlight_core::lattice::{LatticeMesh, VoxelGrid};
use twinlight_fixtures::random::Random;

/// The lattice point that is the lower corner of a [`unit_grid`], on every axis.
const LOW: i32 = -16_384;

/// A point in units of a grid, which may be beyond it.
pub(in crate::kernels) type Point = [i32; 3];

/// A grid whose unit is a lattice step: points are where a case puts them.
pub(in crate::kernels) fn unit_grid(dims: [u32; 3], subvoxel_bits: u32) -> VoxelGrid {
    VoxelGrid { dims, scale: 1 << 14, offset: [-LOW << 14; 3], subvoxel_bits }
}

/// Triangles of given points of a [`unit_grid`], with corners of their own.
///
/// # Panics
/// When a corner is out of reach: a defect of the case.
pub(in crate::kernels) fn in_units(triangles: &[[Point; 3]]) -> LatticeMesh {
    let grid = unit_grid([1; 3], 15);
    let vertices = triangles.iter().flatten().map(|&point| lattice_point(&grid, point)).collect();
    let numbers = (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    LatticeMesh::new(vertices, numbers).expect("the suite's own corners are within reach")
}

/// A lattice point that is at or near a point of a grid, and within reach.
fn lattice_point(grid: &VoxelGrid, point: Point) -> [i16; 3] {
    let scale = i64::from(grid.scale.max(1));
    [0, 1, 2].map(|axis| {
        let steps = ((i64::from(point[axis]) << 14) - i64::from(grid.offset[axis])).div_euclid(scale);
        steps.clamp(-i64::from(SIDE), i64::from(SIDE)) as i16
    })
}

/// A grid: of one voxel to 2¹⁶, of lattice steps or not, over all there is or over a part of it.
pub(in crate::kernels) fn some_grid(random: &mut Random) -> VoxelGrid {
    match random.index(4) {
        0 => some_unit_grid(random),
        1 => some_scaled_grid(random),
        _ => grid_over_some_box(random),
    }
}

/// Numbers of voxels per axis, the product at most 2¹⁶.
fn some_dims(random: &mut Random, most: u32) -> [u32; 3] {
    let mut dims = [(); 3].map(|()| match random.index(4) {
        0 => 1 + random.index(4) as u32,
        1 => 1 + random.index(most as usize) as u32,
        2 => 1 << random.index(most.trailing_zeros() as usize + 1),
        _ => 1 + random.index(20) as u32,
    });
    while dims.iter().product::<u32>() > 1 << 16 {
        let longest = usize::from(dims[1] > dims[0]);
        let longest = if dims[2] > dims[longest] { 2 } else { longest };
        dims[longest] /= 2;
    }
    dims.map(|n| n.min(most))
}

fn some_unit_grid(random: &mut Random) -> VoxelGrid {
    let subvoxel_bits = 7 + random.index(9) as u32;
    unit_grid(some_dims(random, 1 << (15 - subvoxel_bits)), subvoxel_bits)
}

/// Scales and offsets as they come.
fn some_scaled_grid(random: &mut Random) -> VoxelGrid {
    let unit = some_unit_grid(random);
    let scale = random.index((1 << 14) + 1) as i32;
    let offset = [(); 3].map(|()| random.index(1 << 29) as i32);
    VoxelGrid { scale, offset, ..unit }
}

fn grid_over_some_box(random: &mut Random) -> VoxelGrid {
    let resolution = [1 + random.index(40), 1 << random.index(6), 1 + random.index(9)][random.index(3)];
    let low = [(); 3].map(|()| -(random.index(SIDE as usize) as i16));
    let reach = 1 + (SIDE as usize >> random.index(12));
    let high = low.map(|c| (c + random.index(reach) as i16).min(SIDE));
    // Boxes are drawn within the lattice, resolutions within the limit.
    VoxelGrid::over(low, high, resolution as u32).expect("a box of the lattice")
}

/// As many triangles of every kind as asked for. Wide ones are fewer the more voxels there are.
pub(in crate::kernels) fn some_mesh(random: &mut Random, grid: &VoxelGrid, count: usize) -> LatticeMesh {
    let voxels: u32 = grid.dims.iter().product();
    // The oracle tries every voxel of a wide triangle's bounds: a few million of them are what a trial has time for.
    let wide = ((1 << 19) / voxels as usize).max(4);
    let mut mesh = Parts::default();
    while mesh.triangles.len() < count {
        let is_wide = mesh.triangles.len() < wide;
        some_part(random, grid, is_wide, &mut mesh);
    }
    let vertices = mesh.points.iter().map(|&point| lattice_point(grid, point)).collect();
    LatticeMesh::new(vertices, mesh.triangles).expect("points are moved into reach")
}

/// A mesh in the making.
#[derive(Default)]
struct Parts {
    points: Vec<Point>,
    triangles: Vec<[u32; 3]>,
}

impl Parts {
    fn push(&mut self, corners: [Point; 3]) {
        let first = self.points.len() as u32;
        self.points.extend(corners);
        self.triangles.push([first, first + 1, first + 2]);
    }

    /// A triangle over two corners of the last one: fans and strips.
    fn push_neighbour(&mut self, point: Point, keeps: usize) {
        let Some(&last) = self.triangles.last() else { return };
        let number = self.points.len() as u32;
        self.points.push(point);
        self.triangles.push([last[keeps], last[2], number]);
    }
}

fn some_part(random: &mut Random, grid: &VoxelGrid, wide: bool, mesh: &mut Parts) {
    let width = 1 << grid.subvoxel_bits;
    let p = some_point(random, grid);
    let reach = if wide { 1 << random.index(16) } else { 2 * width };
    let [q, r] = [(); 2].map(|()| near(random, p, reach));
    let along = [0, 1, 2].map(|axis| (p[axis] + q[axis]) / 2);
    match random.index(11) {
        0..=1 => mesh.push([p, q, r]),
        // Corners on faces, edges and corners of voxels, or in their middle, exactly or beside them.
        2..=3 => {
            let step = (width / 2).max(1);
            let corners = [p, q, r].map(|point| aligned(random, point, step));
            mesh.push(corners);
        }
        // Along an axis.
        4 => {
            let axis = random.index(3);
            let corners = [p, q, r].map(|mut point| {
                point[axis] = p[axis] / width * width;
                point
            });
            mesh.push(corners);
        }
        5 => {
            let sliver = [p, q, near(random, along, 2)];
            mesh.push(sliver);
        }
        6 => mesh.push([[p, q, along], [p, p, q], [p, q, q], [p, q, p], [p; 3]][random.index(5)]),
        7 => {
            let point = near(random, p, 3);
            mesh.push([p, point, near(random, p, 3)]);
        }
        // Equal components of the normal.
        8 => {
            let by = 1 + random.index(reach as usize) as i32;
            let [x, y, z] = p;
            mesh.push([[x + by, y, z], [x, y + by, z], [x, y, z + by]]);
        }
        9 if !mesh.triangles.is_empty() => {
            let copy = mesh.triangles[random.index(mesh.triangles.len())];
            mesh.triangles.push(copy);
        }
        _ => {
            mesh.push([p, q, r]);
            for _ in 0..random.index(6) {
                let point = near(random, p, reach.min(width));
                mesh.push_neighbour(point, random.index(2));
            }
        }
    }
}

/// Mostly within the grid.
fn some_point(random: &mut Random, grid: &VoxelGrid) -> Point {
    let beyond = if random.index(8) == 0 { 1 << grid.subvoxel_bits } else { 0 };
    grid.dims.map(|n| {
        let extent = (n << grid.subvoxel_bits) as i32;
        random.index((extent + 2 * beyond) as usize) as i32 - beyond
    })
}

fn near(random: &mut Random, point: Point, reach: i32) -> Point {
    point.map(|c| (c - reach / 2 + random.index(reach as usize + 1) as i32).clamp(-40_000, 40_000))
}

fn aligned(random: &mut Random, point: Point, step: i32) -> Point {
    let beside = if random.index(3) == 0 { 1 } else { 0 };
    point.map(|c| c / step * step + beside * (random.index(5) as i32 - 2))
}
