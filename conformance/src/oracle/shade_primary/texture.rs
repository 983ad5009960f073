//! Bilinear lookup in f64: sRGB bytes by the formula of IEC 61966-2-1, not by the table.

use glam::DVec3;
use twinlight_core::scene::MaterialRecord;

fn linear(byte: u32) -> f64 {
    let c = f64::from(byte & 0xff) / 255.0;
    if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
}

/// The texture at (u, v), v downwards, and how far it may be off when (u, v) are off by `error`: bilinear
/// interpolation changes by at most the largest difference of neighbours per texel, which is below 1.
pub(super) fn bilinear(
    words: &[u32],
    material: &MaterialRecord,
    uv: [f64; 2],
    error: [f64; 2],
) -> (DVec3, f64) {
    let size = [material.texture_width, material.texture_height].map(f64::from);
    let clamp = material.texture_wrap == 1;
    let brought = |c: f64| if clamp { c.clamp(0.0, 1.0) } else { c - c.floor() };
    let position = [0, 1].map(|i| brought(uv[i]) * size[i] - 0.5);
    let index = |cell: f64, size: f64| {
        let cell = if clamp { cell.clamp(0.0, size - 1.0) } else { cell.rem_euclid(size) };
        cell as u32
    };
    let mut sum = DVec3::ZERO;
    for (dx, dy) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)] {
        let cell = [position[0].floor() + dx, position[1].floor() + dy];
        let weight = |i: usize| 1.0 - (position[i] - cell[i]).abs();
        let texel = index(cell[1], size[1]) * material.texture_width + index(cell[0], size[0]);
        let word = words[(material.texture_offset + texel) as usize];
        sum += DVec3::new(linear(word), linear(word >> 8), linear(word >> 16)) * (weight(0) * weight(1));
    }
    // Positions in texels are rounded at the magnitude of the picture's size.
    let shift = |i: usize| (error[i] + 2.0 / 8_388_608.0) * size[i];
    (sum, shift(0) + shift(1))
}
