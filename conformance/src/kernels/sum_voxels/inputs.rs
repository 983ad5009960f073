//! Surfaces made to hurt: channels, normals and texture coordinates at the ends of their ranges, textures of one texel and of many.

use super::Painted;
use crate::kernels::voxelize::inputs::{some_grid, some_mesh};
use crate::kernels::voxelize::{Case, SEPARATIONS};
use twinlight_core::kernels::sum_voxels::{ALBEDO_ONE, CLAMP, NONE, VoxelSurface, texel_word};
use twinlight_core::lattice::{LatticeMesh, VoxelGrid};
use twinlight_fixtures::random::Random;

/// Texels that surfaces are drawn over.
const TEXELS: usize = 3_000;

/// White all over, and facing +z.
pub(super) fn plain() -> VoxelSurface {
    VoxelSurface {
        normals: [normal([0, 0, 127]); 3],
        texture: NONE,
        texcoords: [[0; 2]; 3],
        texture_size: 1 | 1 << 16,
        flags: 0,
        tint: channels([ALBEDO_ONE; 3]),
        emission: [0; 2],
    }
}

/// A normal's word.
pub(super) fn normal([x, y, z]: [i8; 3]) -> u32 {
    u32::from_le_bytes([x as u8, y as u8, z as u8, 0])
}

/// Three channels in two words.
pub(super) fn channels([r, g, b]: [u32; 3]) -> [u32; 2] {
    [r | g << 16, b]
}

pub(super) fn some_texels(random: &mut Random) -> Vec<u32> {
    let mut channel = || [0, 1_023, random.index(1_024) as u32, random.index(1_024) as u32][random.index(4)];
    (0..TEXELS).map(|_| texel_word([channel(), channel(), channel()])).collect()
}

fn some_channels(random: &mut Random) -> [u32; 2] {
    let mut channel =
        || [0, ALBEDO_ONE, random.index(4_096) as u32, random.index(4_096) as u32][random.index(4)];
    channels([channel(), channel(), channel()])
}

pub(super) fn some_normal(random: &mut Random) -> u32 {
    let mut byte = || [127, -127, 0, random.index(255) as i32 - 127][random.index(4)] as i8;
    normal([byte(), byte(), byte()])
}

pub(super) fn some_surface(random: &mut Random) -> VoxelSurface {
    let [width, height] =
        [[1, 1], [1, 50], [32, 16], [7, 1], [1 + random.index(40), 1 + random.index(50)]][random.index(5)];
    let texture = random.index(TEXELS - width * height + 1) as u32;
    // In the texture, at and beside whole texels, far outside, and at the ends.
    let (kind, reach) = (random.index(4), 1 << 16);
    let mut coordinate = |size: usize| match kind {
        0 => random.index(64 * size) as i32,
        1 => 64 * (random.index(4 * size) as i32 - 2 * size as i32) + random.index(3) as i32 - 1,
        2 => random.index(2 * reach + 1) as i32 - reach as i32,
        _ => [-(reach as i32), reach as i32][random.index(2)],
    };
    let texcoords = [(); 3].map(|()| [coordinate(width), coordinate(height)]);
    VoxelSurface {
        normals: [(); 3].map(|()| some_normal(random)),
        texture: if random.index(4) == 0 { NONE } else { texture },
        texcoords,
        texture_size: (width | height << 16) as u32,
        flags: [0, CLAMP][random.index(2)],
        tint: some_channels(random),
        emission: some_channels(random),
    }
}

/// A mesh with a surface to each of its triangles.
pub(super) fn painted(random: &mut Random, mesh: LatticeMesh, grid: VoxelGrid, separation: u32) -> Painted {
    let surfaces = mesh.triangles().iter().map(|_| some_surface(random)).collect();
    Painted { case: Case::new(mesh, grid, separation), surfaces, texels: some_texels(random) }
}

/// Any of either separation.
pub(super) fn some_painted(seed: u64, count: usize, kind: usize) -> Painted {
    let mut random = Random::new(seed);
    let grid = some_grid(&mut random);
    let mesh = some_mesh(&mut random, &grid, count);
    painted(&mut random, mesh, grid, SEPARATIONS[kind % 2])
}
