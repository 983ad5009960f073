// kernel family: sum_voxels
// contract core/src/kernels/sum_voxels.rs
// cpu backend-cpu/src/kernels/sum_voxels.rs
// gpu backend-gpu/src/kernels/sum_voxels.wgsl
// oracle conformance/src/oracle/sum_voxels.rs
//! Oracle of `sum_voxels`: the voxels of every triangle, found anew, one after the other, with quotients and remainders of 128 bits
//! where both twins shift.

use super::voxelize::{Placed, Triple, code, each_fragment};
use std::collections::BTreeMap;
use twinlight_core::kernels::sum_voxels::{CLAMP, NONE, VoxelSums, VoxelSurface};
use twinlight_core::lattice::{LatticeMesh, VoxelGrid};

/// Weights add up to this.
pub const WHOLE: i128 = 1 << 14;
/// A channel of a texel at its brightest.
pub const WHITE: i128 = 1023;

/// What one fragment adds, or several.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Sums {
    /// RGB.
    pub albedo: Triple,
    /// x, y, z.
    pub normal: Triple,
    /// RGB.
    pub emission: Triple,
    /// Fragments.
    pub count: i128,
}

impl Sums {
    /// Adds what another one holds.
    pub fn add(&mut self, other: &Self) {
        for i in 0..3 {
            self.albedo[i] += other.albedo[i];
            self.normal[i] += other.normal[i];
            self.emission[i] += other.emission[i];
        }
        self.count += other.count;
    }

    /// As a backend holds them.
    pub fn record(&self) -> VoxelSums {
        VoxelSums {
            albedo: self.albedo.map(|a| a as u32),
            count: self.count as u32,
            normal: self.normal.map(|n| n as i32),
            emission: self.emission.map(|e| e as u32),
            ..VoxelSums::default()
        }
    }
}

/// What the contract promises for the voxels of these arguments, none of which has too many fragments.
pub fn sum_voxels(
    mesh: &LatticeMesh,
    grid: &VoxelGrid,
    separation: u32,
    surfaces: &[VoxelSurface],
    texels: &[u32],
) -> Vec<VoxelSums> {
    let mut sums: BTreeMap<u32, Sums> = BTreeMap::new();
    each_fragment(mesh, grid, separation, |number, placed, voxel| {
        let weights = weights(placed, placed.centre(voxel));
        sums.entry(code(voxel)).or_default().add(&fragment(&surfaces[number], weights, texels));
    });
    sums.values().map(Sums::record).collect()
}

/// w of the contract, at a voxel's centre.
pub fn weights(placed: &Placed, centre: Triple) -> Triple {
    let [of_2, of_0, of_1] = placed.edges(placed.dominant, centre).map(|[_, _, e]| e.max(0));
    let areas = [of_0, of_1, of_2];
    let mut unit = 1;
    while areas.iter().sum::<i128>() / unit >= 1 << 17 {
        unit *= 2;
    }
    let areas = areas.map(|a| a / unit);
    let whole = areas.iter().sum::<i128>().max(1);
    let [w1, w2] = [areas[1], areas[2]].map(|a| WHOLE * a / whole);
    [WHOLE - w1 - w2, w1, w2]
}

/// What a fragment adds where the corners weigh as much.
pub fn fragment(surface: &VoxelSurface, weights: Triple, texels: &[u32]) -> Sums {
    let texel = match texel_number(surface, weights) {
        Some(number) => rgb(texels[number]),
        None => [WHITE; 3],
    };
    let tint = colour(surface.tint);
    Sums {
        albedo: [0, 1, 2].map(|c| (tint[c] * texel[c] + 511) / WHITE),
        normal: [0, 1, 2].map(|axis| {
            let sum: i128 = (0..3).map(|i| weights[i] * component(surface.normals[i], axis)).sum();
            (sum + WHOLE / 2).div_euclid(WHOLE)
        }),
        emission: colour(surface.emission),
        count: 1,
    }
}

/// The number of the texel in the buffer of all, if there is a texture.
pub fn texel_number(surface: &VoxelSurface, weights: Triple) -> Option<usize> {
    if surface.texture == NONE {
        return None;
    }
    let [column, row] = [0, 1].map(|axis| {
        let size = texture_size(surface)[axis];
        let sum: i128 = (0..3).map(|i| weights[i] * i128::from(surface.texcoords[i][axis])).sum();
        let whole = sum.div_euclid(1 << 20);
        if surface.flags & CLAMP != 0 { whole.clamp(0, size - 1) } else { whole.rem_euclid(size) }
    });
    Some((i128::from(surface.texture) + row * texture_size(surface)[0] + column) as usize)
}

/// Texels per row, and rows.
pub fn texture_size(surface: &VoxelSurface) -> [i128; 2] {
    [i128::from(surface.texture_size % 65_536), i128::from(surface.texture_size / 65_536)]
}

/// A corner's normal along an axis.
pub fn component(normal: u32, axis: usize) -> i128 {
    i128::from(normal.to_le_bytes()[axis] as i8)
}

/// A texel's channels.
pub fn rgb(texel: u32) -> Triple {
    [1, 1 << 10, 1 << 20].map(|unit| i128::from(texel / unit % 1024))
}

/// Three channels in two words.
pub fn colour(words: [u32; 2]) -> Triple {
    [words[0] % 65_536, words[0] / 65_536, words[1]].map(i128::from)
}

#[cfg(test)]
mod tests;
