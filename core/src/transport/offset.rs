//! Ray origins off the surface they start on, by error bounds instead of a scene epsilon. Twin:
//! `backend-gpu/src/shared/offset.wgsl`. Source: Pharr, Jakob, Humphreys, PBRT 4th ed. §6.8.

use glam::Vec3;

/// γ(9) = 9u/(1 − 9u), u = 2⁻²⁴: barycentric interpolation makes 7 roundings (PBRT §6.8.5); the third weight,
/// 1 − u − v, is rounded twice more.
pub const POSITION_ERROR: f32 = 5.364_421e-7;

/// 2⁻¹⁹ = 32u of the triangle's extent: how far from its plane, measured along the normal, the sheared test may place
/// the intersection of a ray that starts in it. Translation and shear displace a vertex by 3u·extent, an edge function
/// collects at most 16u·extent², the weighted sum of depths doubles that; divided by the determinant the error grows
/// like 1/cosine, measured along the normal it doesn't. Without it, walls in a coordinate plane (position and its error
/// exactly 0) meet themselves.
pub const PLANE_ERROR: f32 = 1.907_348_6e-6;

/// Bound of the absolute error of the point `a + b + c`, where a, b, c are the weighted corners of a triangle, and of a
/// later intersection with that triangle.
#[inline(always)]
pub fn triangle_error(p0: Vec3, p1: Vec3, p2: Vec3, a: Vec3, b: Vec3, c: Vec3) -> Vec3 {
    let e1 = (p1 - p0).abs();
    let e2 = (p2 - p0).abs();
    let x = if e1.x > e2.x { e1.x } else { e2.x };
    let y = if e1.y > e2.y { e1.y } else { e2.y };
    let z = if e1.z > e2.z { e1.z } else { e2.z };
    let xy = if x > y { x } else { y };
    let extent = if xy > z { xy } else { z };
    ((a.abs() + b.abs()) + c.abs()) * POSITION_ERROR + Vec3::splat(extent * PLANE_ERROR)
}

/// The next f32 away from 0 on the side of `toward`; 0 goes to ±2⁻¹⁰⁰, past the subnormals that adapters flush.
#[inline(always)]
fn nudged(x: f32, toward: f32) -> f32 {
    if toward == 0.0 {
        return x;
    }
    if x == 0.0 {
        return if toward > 0.0 { 7.888_609e-31 } else { -7.888_609e-31 };
    }
    let bits = x.to_bits();
    let outwards = (x > 0.0) == (toward > 0.0);
    f32::from_bits(if outwards { bits + 1 } else { bits - 1 })
}

/// A point on the side of the surface that `direction` leaves to, so far from `position` that the true surface, within
/// `error` (absolute, per axis), isn't met again.
#[inline(always)]
pub fn offset_origin(position: Vec3, error: Vec3, normal: Vec3, direction: Vec3) -> Vec3 {
    let a = normal.abs();
    let distance = a.dot(error);
    let side = if direction.dot(normal) < 0.0 { -distance } else { distance };
    let offset = normal * side;
    let moved = position + offset;
    Vec3::new(nudged(moved.x, offset.x), nudged(moved.y, offset.y), nudged(moved.z, offset.z))
}
