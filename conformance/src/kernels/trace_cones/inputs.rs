//! Grids with light in them, and cones.

use crate::oracle::reduce_mips::{Levels, levels, reduce};
use crate::oracle::trace_cones::Pyramid;
use std::collections::BTreeMap;
use std::fmt;
use twinlight_core::kernels::reduce_mips::{OPAQUE, VoxelLight};
use twinlight_core::kernels::trace_cones::{Cone, SIXTY_DEGREES, TraceConesBlock, VoxelFrame};
use twinlight_core::lattice::{COORDINATE_BITS, SCALE_BITS, VoxelGrid};
use twinlight_core::math::morton::morton_code;
use twinlight_fixtures::random::Random;

/// Most of a channel per unit of opacity: 2²² / 2¹⁶.
const MOST: usize = 64;

/// The leaves of a grid by code.
pub(super) type Leaves = BTreeMap<u32, VoxelLight>;

/// A grid whose levels store light.
#[derive(Clone)]
pub(crate) struct Lit {
    pub(super) grid: VoxelGrid,
    pub(super) storage: u32,
    pub(super) levels: Levels,
    pub(super) values: Vec<u32>,
    pub(crate) pyramid: Pyramid,
}

impl fmt::Debug for Lit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y, z] = self.grid.dims;
        write!(f, "storage {} of {:?} voxels of {x}x{y}x{z}", self.storage, self.levels.starts)
    }
}

impl Lit {
    pub(super) fn new(dims: [u32; 3], leaves: &Leaves, storage: u32) -> Self {
        let grid = grid(dims);
        let levels = levels(grid.padded(), &leaves.keys().copied().collect());
        Self::made_up(grid, levels, reduce(grid.padded(), leaves, storage), storage)
    }

    /// With values that are none of leaves.
    pub(super) fn made_up(grid: VoxelGrid, levels: Levels, values: Vec<u32>, storage: u32) -> Self {
        let pyramid = Pyramid::new(grid.dims, storage, &levels.starts, &levels.active, &values);
        Self { grid, storage, levels, values, pyramid }
    }
}

/// A grid of so many voxels per axis.
pub(super) fn grid(dims: [u32; 3]) -> VoxelGrid {
    let longest = dims[0].max(dims[1]).max(dims[2]);
    let subvoxel_bits = COORDINATE_BITS - longest.next_power_of_two().trailing_zeros();
    VoxelGrid { dims, scale: 1 << SCALE_BITS, offset: [0; 3], subvoxel_bits }
}

/// Voxels as units, at 0.
pub(super) fn plain(storage: u32) -> TraceConesBlock {
    let frame = VoxelFrame { corner: [0.0; 3], voxels_per_unit: 1.0 };
    TraceConesBlock { frame, unit: 1.0, reach: 2048.0, storage, flags: 0 }
}

/// Some frame, unit and reach for a grid of `side` voxels.
pub(super) fn some_block(random: &mut Random, storage: u32, side: f64) -> TraceConesBlock {
    let width = random.between(0.01, 3.0);
    TraceConesBlock {
        frame: VoxelFrame {
            corner: [(); 3].map(|()| (random.between(-4.0, 4.0) * width) as f32),
            voxels_per_unit: (1.0 / width) as f32,
        },
        unit: random.between(1e-6, 1e-2) as f32,
        reach: (random.between(0.3, 3.0) * side * width) as f32,
        storage,
        flags: if random.index(2) == 0 { 0 } else { SIXTY_DEGREES },
    }
}

/// The voxels of a box with the same light.
pub(super) fn filled(low: [u32; 3], high: [u32; 3], light: VoxelLight) -> Leaves {
    let mut leaves = Leaves::new();
    for z in low[2]..high[2] {
        for y in low[1]..high[1] {
            leaves.extend((low[0]..high[0]).map(|x| (morton_code([x, y, z]), light)));
        }
    }
    leaves
}

/// `count` voxels or fewer anywhere, of every opacity.
pub(super) fn scattered(random: &mut Random, dims: [u32; 3], count: usize) -> Leaves {
    let leaf = |random: &mut Random| {
        let opacity =
            [0, 1, OPAQUE as usize, random.index(OPAQUE as usize), random.index(4096)][random.index(5)];
        let rgb = [(); 3].map(|()| random.index(opacity * MOST + 1) as u32);
        (
            morton_code(dims.map(|n| random.index(n as usize) as u32)),
            VoxelLight { rgb, opacity: opacity as u32 },
        )
    };
    (0..count).map(|_| leaf(random)).collect()
}

/// A cone without a surface.
pub(super) fn cone(origin: [f32; 3], direction: [f32; 3], sine: f32) -> Cone {
    Cone { origin, sine, direction, start: 0.0, normal: [0.0; 3], padding: 0 }
}

/// A cone that begins in the grid or a voxel beside it, of any aperture; every other one leaves a surface.
pub(super) fn some_cone(random: &mut Random, block: &TraceConesBlock, dims: [u32; 3]) -> Cone {
    let width = 1.0 / f64::from(block.frame.voxels_per_unit);
    let direction = random.direction();
    let normal = random.direction();
    let normal = if normal.dot(direction) < 0.0 { -normal } else { normal };
    let place = |axis: usize, random: &mut Random| {
        f64::from(block.frame.corner[axis]) + random.between(-0.2, f64::from(dims[axis]) + 0.2) * width
    };
    Cone {
        origin: [0, 1, 2].map(|axis| place(axis, random) as f32),
        sine: [0.0, 0.01, random.unit(), random.unit(), 0.2588][random.index(5)] as f32,
        direction: direction.as_vec3().to_array(),
        start: (random.between(0.0, 2.0) * width) as f32,
        normal: if random.index(2) == 0 { [0.0; 3] } else { normal.as_vec3().to_array() },
        padding: 0,
    }
}

/// A grid, parameters and cones of a storage.
pub(crate) fn some_call(random: &mut Random, storage: u32) -> (Lit, TraceConesBlock, Vec<Cone>) {
    let dims = [13, 16, 9];
    let lit = Lit::new(dims, &scattered(random, dims, 250), storage);
    let block = some_block(random, storage, 16.0);
    let cones = (0..200).map(|_| some_cone(random, &block, dims)).collect();
    (lit, block, cones)
}
