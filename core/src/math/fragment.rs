//! What a surface adds to a voxel's sums. Twin: `backend-gpu/src/shared/fragment.wgsl`. Meaning:
//! [`crate::kernels::sum_voxels`].

use crate::kernels::sum_voxels::{CLAMP, NONE, VoxelSurface};

/// Albedo (3), count, normal (3, two's complement), unused, emission (3), unused: the words of
/// [`VoxelSums`](crate::kernels::sum_voxels::VoxelSums).
#[inline(always)]
pub fn fragment_at(surface: &VoxelSurface, texels: &[u32], weights: [u32; 3]) -> [u32; 12] {
    let normal = [0, 8, 16].map(|shift| {
        let byte = |i: usize| i32::from((surface.normals[i] >> shift) as i8);
        (blend(weights, [byte(0), byte(1), byte(2)]) + (1 << 13)) >> 14
    });
    let texel = texel_at(surface, texels, weights);
    let tint = unpacked_halves(surface.tint);
    let albedo = [0, 1, 2].map(|i| (tint[i] * (texel >> (10 * i) & 1023) + 511) / 1023);
    let emission = unpacked_halves(surface.emission);
    let [r, g, b] = albedo;
    let [x, y, z] = normal.map(|c| c as u32);
    let [red, green, blue] = emission;
    [r, g, b, 1, x, y, z, 0, red, green, blue, 0]
}

/// The texel at the weighted texture coordinates; white where there is none.
#[inline(always)]
fn texel_at(surface: &VoxelSurface, texels: &[u32], weights: [u32; 3]) -> u32 {
    const WHITE: u32 = (1 << 30) - 1;
    if surface.texture == NONE {
        return WHITE;
    }
    let [a, b, c] = surface.texcoords;
    let size = [surface.texture_size & 0xffff, surface.texture_size >> 16];
    let place = [0, 1].map(|i| {
        let whole = blend(weights, [a[i], b[i], c[i]]) >> 20;
        let size = size[i] as i32;
        let inside = if surface.flags & CLAMP != 0 {
            whole.min(size - 1).max(0)
        } else {
            whole.rem_euclid(size.max(1))
        };
        inside as u32
    });
    let index = surface.texture.wrapping_add(place[1] * size[0]).wrapping_add(place[0]);
    // Surfaces of other origin.
    texels.get(index as usize).copied().unwrap_or(WHITE)
}

#[inline(always)]
fn blend(weights: [u32; 3], values: [i32; 3]) -> i32 {
    let product = |i: usize| (weights[i] as i32).wrapping_mul(values[i]);
    product(0).wrapping_add(product(1)).wrapping_add(product(2))
}

/// Red and green share a word.
#[inline(always)]
fn unpacked_halves([two, blue]: [u32; 2]) -> [u32; 3] {
    [two & 0xffff, two >> 16, blue & 0xffff]
}
