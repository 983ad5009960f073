//! Bilinear lookup of 8-bit sRGB textures. Twin: `backend-gpu/src/shared/texture.wgsl`.

use crate::scene::MaterialRecord;
use glam::Vec3;

/// One texel, linear light.
#[inline(always)]
fn texel(words: &[u32], material: &MaterialRecord, x: u32, y: u32) -> Vec3 {
    let word = words[(material.texture_offset + y * material.texture_width + x) as usize];
    let decode = |byte: u32| f32::from_bits(words[byte as usize]);
    Vec3::new(decode(word & 0xff), decode((word >> 8) & 0xff), decode((word >> 16) & 0xff))
}

/// The coordinate brought into [0, 1].
#[inline(always)]
fn wrapped(coordinate: f32, wrap: u32) -> f32 {
    if wrap == 1 {
        let low = if coordinate < 0.0 { 0.0 } else { coordinate };
        return if low > 1.0 { 1.0 } else { low };
    }
    coordinate - coordinate.floor()
}

/// Left texel, right texel and the right one's weight along one axis.
#[inline(always)]
fn taps(coordinate: f32, size: u32, wrap: u32) -> (u32, u32, f32) {
    let x = wrapped(coordinate, wrap) * size as f32 - 0.5;
    let floor = x.floor();
    let first = floor as i32;
    let last = size as i32 - 1;
    let (before, after) = if wrap == 1 { (0, last) } else { (last, 0) };
    let i0 = if first < 0 { before } else { first };
    let i1 = if first + 1 > last { after } else { first + 1 };
    (if i0 > last { last } else { i0 } as u32, i1 as u32, x - floor)
}

/// The texture of `material` at (u, v), v downwards from the top row. Only for materials with a texture.
#[inline(always)]
pub fn sample_texture(words: &[u32], material: &MaterialRecord, u: f32, v: f32) -> Vec3 {
    let (x0, x1, fx) = taps(u, material.texture_width, material.texture_wrap);
    let (y0, y1, fy) = taps(v, material.texture_height, material.texture_wrap);
    let a = texel(words, material, x0, y0);
    let b = texel(words, material, x1, y0);
    let c = texel(words, material, x0, y1);
    let d = texel(words, material, x1, y1);
    let top = a + (b - a) * fx;
    let bottom = c + (d - c) * fx;
    top + (bottom - top) * fy
}
