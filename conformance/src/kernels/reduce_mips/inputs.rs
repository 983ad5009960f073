//! Grids of voxels that are made up, and what leaves them.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use twinlight_core::kernels::reduce_mips::{OPAQUE, VoxelLight};
use twinlight_core::lattice::{COORDINATE_BITS, SCALE_BITS, VoxelGrid};
use twinlight_core::math::morton::{morton_code, morton_voxel};
use twinlight_fixtures::random::Random;

/// Most of a channel per unit of opacity: 2²² / 2¹⁶.
const MOST: u32 = 64;

/// Active voxels of a grid with their light, by code.
#[derive(Clone)]
pub(crate) struct Field {
    pub(crate) grid: VoxelGrid,
    pub(crate) leaves: BTreeMap<u32, VoxelLight>,
}

impl fmt::Debug for Field {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y, z] = self.grid.dims;
        write!(f, "{} voxels of {x}x{y}x{z}", self.leaves.len())
    }
}

impl Field {
    /// The light of each of `codes` is some.
    pub(crate) fn of(grid: VoxelGrid, codes: impl IntoIterator<Item = u32>, random: &mut Random) -> Self {
        Self { grid, leaves: codes.into_iter().map(|code| (code, some_light(random))).collect() }
    }

    pub(super) fn codes(&self) -> BTreeSet<u32> {
        self.leaves.keys().copied().collect()
    }

    pub(super) fn lights(&self) -> Vec<VoxelLight> {
        self.leaves.values().copied().collect()
    }

    /// The same, seen in a mirror across `axis` of the padded grid.
    pub(super) fn mirrored(&self, axis: usize) -> Self {
        let leaves = self.leaves.iter().map(|(&code, &light)| (self.mirror(0, code, axis), light)).collect();
        Self { leaves, ..*self }
    }

    /// The mirror image of a voxel of a level.
    pub(super) fn mirror(&self, level: u32, code: u32, axis: usize) -> u32 {
        let mut voxel = morton_voxel(code);
        voxel[axis] = (self.grid.padded() >> level) - 1 - voxel[axis];
        morton_code(voxel)
    }
}

/// A grid of so many voxels per axis.
pub(crate) fn grid(dims: [u32; 3]) -> VoxelGrid {
    let longest = dims[0].max(dims[1]).max(dims[2]);
    let subvoxel_bits = COORDINATE_BITS - longest.next_power_of_two().trailing_zeros();
    VoxelGrid { dims, scale: 1 << SCALE_BITS, offset: [0; 3], subvoxel_bits }
}

/// Every code of a cube.
pub(super) fn full(side: u32) -> std::ops::Range<u32> {
    0..side * side * side
}

/// Opacities and channels within their limits, at either end and between.
pub(super) fn some_light(random: &mut Random) -> VoxelLight {
    let most = OPAQUE as usize;
    let opacity = [0, 1, most, random.index(most + 1), random.index(most + 1)][random.index(5)] as u32;
    let limit = (opacity * MOST) as usize;
    let rgb = [(); 3]
        .map(|()| [0, limit, random.index(limit + 1), random.index(limit + 1)][random.index(4)] as u32);
    VoxelLight { rgb, opacity }
}

/// The most that a voxel may have.
pub(super) fn brightest() -> VoxelLight {
    VoxelLight { rgb: [MOST * OPAQUE; 3], opacity: OPAQUE }
}

/// How voxels are spread over a grid.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Spread {
    /// Anywhere.
    Random,
    /// Around a few centres.
    Clustered,
    /// The shell of a ball.
    Shell,
    /// All along one axis.
    Row,
}

pub(super) const SPREADS: [Spread; 4] = [Spread::Random, Spread::Clustered, Spread::Shell, Spread::Row];

/// About `count` voxels of a grid.
pub(super) fn spread(random: &mut Random, dims: [u32; 3], kind: Spread, count: usize) -> Field {
    let centres: Vec<[u32; 3]> = (0..4).map(|_| anywhere(random, dims)).collect();
    let axis = random.index(3);
    let voxel = |random: &mut Random| match kind {
        Spread::Random => anywhere(random, dims),
        Spread::Clustered => {
            let centre = centres[random.index(4)];
            [0, 1, 2].map(|a| (centre[a] + random.index(5) as u32).min(dims[a] - 1))
        }
        Spread::Shell => {
            let towards = random.direction().to_array();
            [0, 1, 2].map(|a| (((towards[a] * 0.49 + 0.5) * f64::from(dims[a])) as u32).min(dims[a] - 1))
        }
        Spread::Row => {
            let mut voxel = centres[0];
            voxel[axis] = random.index(dims[axis] as usize) as u32;
            voxel
        }
    };
    let codes: Vec<u32> = (0..count).map(|_| morton_code(voxel(random))).collect();
    Field::of(grid(dims), codes, random)
}

fn anywhere(random: &mut Random, dims: [u32; 3]) -> [u32; 3] {
    dims.map(|n| random.index(n as usize) as u32)
}

/// Shells of balls, as surfaces are: many voxels with neighbours, and much that is empty.
pub(crate) fn surfaces(random: &mut Random, side: u32, count: usize) -> Field {
    let mut field = spread(random, [side; 3], Spread::Shell, count);
    field.leaves.extend(spread(random, [side, side / 2, side / 3], Spread::Shell, count).leaves);
    field
}
