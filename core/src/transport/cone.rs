//! Cones through the levels of a grid of voxels. Twin: `backend-gpu/src/shared/cone.wgsl`. Meaning: [`crate::kernels::trace_cones`].

use crate::kernels::reduce_mips::{ANISOTROPIC, HARMONICS, HARMONICS_8, ISOTROPIC, OPAQUE};
use crate::kernels::trace_cones::{
    Cone, ConeLight, LEAST_TRANSMITTANCE, MAX_SINE, MAX_STEPS, PLANE_MARGIN, SIXTY_DEGREES, TraceConesBlock,
};
use crate::math::morton::morton_code;
use glam::{Vec3, Vec4};

/// Most levels: those of 512³ voxels.
pub const MAX_LEVELS: usize = 10;

/// Levels and values of a grid, as the functions here read them; in WGSL, the bindings.
#[derive(Debug, Clone, Copy)]
pub struct VoxelView<'a> {
    /// Occupancy of all levels.
    pub mask: &'a [u32],
    /// Bits set before each word.
    pub ranks: &'a [u32],
    /// Values of all levels.
    pub values: &'a [u32],
    /// Voxels per axis of level 0.
    pub dims: [u32; 3],
    /// Number of levels.
    pub level_count: u32,
    /// First word of each level's mask.
    pub word_starts: [u32; MAX_LEVELS],
    /// Of the call.
    pub params: &'a TraceConesBlock,
}

/// No value.
const NONE: u32 = u32::MAX;

/// Number of the value of a voxel, or [`NONE`].
#[inline(always)]
fn value_of(view: &VoxelView<'_>, level: u32, voxel: [u32; 3]) -> u32 {
    let code = morton_code(voxel);
    let word = (view.word_starts[level as usize] + (code >> 5)) as usize;
    let bits = view.mask[word] >> (code & 31);
    if bits & 1 == 0 {
        return NONE;
    }
    let below = view.mask[word] & ((1 << (code & 31)) - 1);
    view.ranks[word].wrapping_add(below.count_ones())
}

/// Word `i` of a value; 0 beyond the buffer.
#[inline(always)]
fn word(view: &VoxelView<'_>, first: u32, i: u32) -> u32 {
    view.values.get(first.wrapping_add(i) as usize).copied().unwrap_or(0)
}

/// Four words as floats.
#[inline(always)]
fn four(view: &VoxelView<'_>, first: u32) -> Vec4 {
    let [r, g, b, opacity] = [0, 1, 2, 3].map(|i| word(view, first, i) as f32);
    Vec4::new(r, g, b, opacity)
}

/// Radiance of four coefficients against `direction`.
#[inline(always)]
fn radiance(a: [f32; 4], direction: Vec3) -> f32 {
    let sum = a[0] - ((a[1] * direction.x + a[2] * direction.y) + a[3] * direction.z);
    if sum > 0.0 { sum } else { 0.0 }
}

#[inline(always)]
fn face(view: &VoxelView<'_>, first: u32, axis: u32, component: f32) -> Vec4 {
    let side = if component < 0.0 { 0 } else { 1 };
    four(view, first.wrapping_add(8 * axis + 4 * side)) * (component * component)
}

#[inline(always)]
fn byte(word: u32, i: u32) -> f32 {
    ((word << (24 - 8 * i)) as i32 >> 24) as f32
}

/// What leaves a voxel against `direction`: (rgb, opacity), in units of the values.
#[inline(always)]
fn value(view: &VoxelView<'_>, number: u32, direction: Vec3) -> Vec4 {
    let storage = view.params.storage;
    if storage == ISOTROPIC {
        return four(view, number.wrapping_mul(4));
    }
    if storage == ANISOTROPIC {
        let first = number.wrapping_mul(24);
        let x = face(view, first, 0, direction.x);
        let y = face(view, first, 1, direction.y);
        let z = face(view, first, 2, direction.z);
        return (x + y) + z;
    }
    if storage == HARMONICS {
        let first = number.wrapping_mul(13);
        let channel = |c: u32| {
            let a = [0, 1, 2, 3].map(|i| word(view, first, 1 + 4 * c + i) as i32 as f32);
            radiance(a, direction)
        };
        return Vec4::new(channel(0), channel(1), channel(2), word(view, first, 0) as f32);
    }
    if storage != HARMONICS_8 {
        return Vec4::ZERO;
    }
    let first = number.wrapping_mul(4);
    let head = word(view, first, 0);
    // 2^e by its bits.
    let scale = f32::from_bits((127 + (head >> 24 & 31)) << 23);
    let channel = |c: u32| {
        let q = word(view, first, 1 + c);
        radiance([(q & 255) as f32, byte(q, 1), byte(q, 2), byte(q, 3)], direction) * scale
    };
    Vec4::new(channel(0), channel(1), channel(2), (head & 0xff_ffff) as f32)
}

/// A value whose opacity is a mean over space, as that of a voxel of level `level`: 2ˡ such layers, one behind the other.
#[inline(always)]
fn deepened(value: Vec4, level: u32) -> Vec4 {
    let mean = value.w * (1.0 / OPAQUE as f32);
    if !(mean > 0.0) {
        return value;
    }
    let mut open = if mean < 1.0 { 1.0 - mean } else { 0.0 };
    for _ in 0..level {
        open *= open;
    }
    value * ((1.0 - open) / mean)
}

/// A voxel's value, or zeroes.
#[inline(always)]
fn value_at(view: &VoxelView<'_>, level: u32, voxel: [u32; 3], direction: Vec3) -> Vec4 {
    let number = value_of(view, level, voxel);
    if number == NONE {
        return Vec4::ZERO;
    }
    let found = value(view, number, direction);
    if view.params.storage == ANISOTROPIC { found } else { deepened(found, level) }
}

/// 2⁻ˡ.
#[inline(always)]
fn scale_of(level: u32) -> f32 {
    f32::from_bits((127 - level) << 23)
}

/// `i` brought into 0 to `count` − 1.
#[inline(always)]
fn inside(i: i32, count: u32) -> u32 {
    let low = if i < 0 { 0 } else { i as u32 };
    if low < count { low } else { count - 1 }
}

/// What is in front of a cone's surface.
#[derive(Debug, Clone, Copy)]
struct HalfSpace {
    /// 0 0 0 for all of space.
    normal: Vec3,
    /// normal·p of the points p of the surface, in voxels.
    offset: f32,
    /// Half of what a voxel of width 1 spans along the normal.
    span: f32,
}

/// Whether a voxel of a level is in front of the surface's plane as a whole.
#[inline(always)]
fn is_in_front(space: &HalfSpace, voxel: [u32; 3], width: f32) -> bool {
    let [x, y, z] = voxel.map(|i| (i as f32 + 0.5) * width);
    let n = space.normal;
    let height = ((n.x * x + n.y * y) + n.z * z) - space.offset;
    height > space.span * width + PLANE_MARGIN || n == Vec3::ZERO
}

/// The filtered value of a level at `p`, in voxels of level 0.
#[inline(always)]
fn filtered(view: &VoxelView<'_>, space: &HalfSpace, level: u32, p: Vec3, direction: Vec3) -> Vec4 {
    let q = p * scale_of(level) - Vec3::splat(0.5);
    let floor = Vec3::new(q.x.floor(), q.y.floor(), q.z.floor());
    let g = q - floor;
    let first = [floor.x as i32, floor.y as i32, floor.z as i32];
    let dims = view.dims.map(|n| (n + (1 << level) - 1) >> level);
    let width = f32::from_bits((127 + level) << 23);
    let (mut sum, mut weight) = (Vec4::ZERO, 0.0);
    for corner in 0..8_u32 {
        let bit = [corner & 1, corner >> 1 & 1, corner >> 2];
        let voxel = [0, 1, 2].map(|axis| inside(first[axis] + bit[axis] as i32, dims[axis]));
        let x = if bit[0] == 1 { g.x } else { 1.0 - g.x };
        let y = if bit[1] == 1 { g.y } else { 1.0 - g.y };
        let z = if bit[2] == 1 { g.z } else { 1.0 - g.z };
        if is_in_front(space, voxel, width) {
            let share = (x * y) * z;
            sum += value_at(view, level, voxel, direction) * share;
            weight += share;
        }
    }
    if weight > 0.0 { sum * (1.0 / weight) } else { Vec4::ZERO }
}

/// The value of a sphere of diameter `width` ≥ 1 at `p`.
#[inline(always)]
fn sample(view: &VoxelView<'_>, space: &HalfSpace, p: Vec3, width: f32, direction: Vec3) -> Vec4 {
    let bits = width.to_bits();
    let level = (bits >> 23).wrapping_sub(127);
    let last = view.level_count - 1;
    if level >= last {
        return filtered(view, space, last, p, direction);
    }
    // m: the significand alone.
    let f = f32::from_bits((bits & 0x7f_ffff) | 0x3f80_0000) - 1.0;
    let fine = filtered(view, space, level, p, direction);
    if !(f > 0.0) {
        return fine;
    }
    fine * (1.0 - f) + filtered(view, space, level + 1, p, direction) * f
}

/// Whether `p` is in the grid.
#[inline(always)]
fn is_in_grid(view: &VoxelView<'_>, p: Vec3) -> bool {
    let [x, y, z] = view.dims.map(|n| n as f32);
    p.x >= 0.0 && p.x <= x && p.y >= 0.0 && p.y <= y && p.z >= 0.0 && p.z <= z
}

/// Whether a sphere of radius `r` at `p` has a part in the grid.
#[inline(always)]
fn meets_grid(view: &VoxelView<'_>, p: Vec3, r: f32) -> bool {
    let [x, y, z] = view.dims.map(|n| n as f32);
    p.x > -r && p.x < x + r && p.y > -r && p.y < y + r && p.z > -r && p.z < z + r
}

/// The place in the grid next to `p`.
#[inline(always)]
fn brought_in(view: &VoxelView<'_>, p: Vec3) -> Vec3 {
    let [x, y, z] = view.dims.map(|n| n as f32);
    let within = |c: f32, end: f32| if c > 0.0 { if c < end { c } else { end } } else { 0.0 };
    Vec3::new(within(p.x, x), within(p.y, y), within(p.z, z))
}

/// The least power of two that is at least `x` ≥ 1.
#[inline(always)]
fn power_of_two(x: f32) -> f32 {
    let bits = x.to_bits();
    f32::from_bits((bits + 0x7f_ffff) & 0x7f80_0000)
}

/// What comes through a cone.
#[inline(always)]
pub fn trace_cone(view: &VoxelView<'_>, cone: &Cone) -> ConeLight {
    let params = view.params;
    let frame = &params.frame;
    let sixty = params.flags & SIXTY_DEGREES != 0;
    let apex = (Vec3::from(cone.origin) - Vec3::from(frame.corner)) * frame.voxels_per_unit;
    let direction = Vec3::from(cone.direction);
    let normal = Vec3::from(cone.normal);
    let space = HalfSpace {
        normal,
        offset: (normal.x * apex.x + normal.y * apex.y) + normal.z * apex.z,
        span: 0.5 * ((normal.x.abs() + normal.y.abs()) + normal.z.abs()),
    };
    let reach = params.reach * frame.voxels_per_unit;
    let s = if cone.sine > 0.0 { if cone.sine < MAX_SINE { cone.sine } else { MAX_SINE } } else { 0.0 };
    let mut d = cone.start * frame.voxels_per_unit;
    if sixty {
        d = power_of_two(if d > 1.0 { d } else { 1.0 });
    }
    let mut rgb = Vec3::ZERO;
    let mut t = 1.0;
    let mut is_inside = is_in_grid(view, apex);
    for _ in 0..MAX_STEPS {
        let p = apex + direction * d;
        let wide = d * s;
        let r = if sixty {
            d * 0.5
        } else if wide > 0.5 {
            wide
        } else {
            0.5
        };
        if !is_inside || !meets_grid(view, p, r) || !(d <= reach) || !(t > LEAST_TRANSMITTANCE) {
            break;
        }
        is_inside = is_in_grid(view, p);
        let found = sample(view, &space, brought_in(view, p), r + r, direction);
        let opacity = found.w * (1.0 / OPAQUE as f32);
        rgb += Vec3::new(found.x, found.y, found.z) * t;
        t *= 1.0 - if opacity < 1.0 { opacity } else { 1.0 };
        if sixty {
            d += d;
        } else {
            let touching = (d + r) / (1.0 - s);
            let beyond = d + (r + r);
            d = if touching > beyond { touching } else { beyond };
        }
    }
    ConeLight { rgb: (rgb * params.unit).to_array(), transmittance: t }
}
