//! Ray against triangle, box and sphere. Twin: `backend-gpu/src/shared/intersect.wgsl`.
//!
//! The meaning of a hit is in [`crate::kernels::trace`].

use crate::scene::Triangle;
use glam::Vec3;

/// Smallest magnitude of a direction component that is divided by: 2⁻⁶⁰. Below it the component counts as ±2⁻⁶⁰, so
/// that slabs never see 0·∞ and, with coordinates up to 2⁴⁰, never overflow.
pub const MIN_DIRECTION: f32 = 8.673_617_4e-19;

/// Far sides of slabs are moved out by this factor, 1 + 2⁻²¹: more than the three roundings of (bound − origin)·inverse
/// (Ize 2013).
pub const SLAB_FAR_FACTOR: f32 = 1.000_000_476_837_158_2;

/// Bounds of triangles are padded by this share of the triangle's largest extent, 2⁻²⁰.
pub const PAD_EXTENT: f32 = 9.536_743_164_062_5e-7;

/// … and by this share of its largest coordinate, 2⁻²².
pub const PAD_COORDINATE: f32 = 2.384_185_791_015_625e-7;

/// How far a ray's origin has to be off a triangle's plane, as a share of the farthest corner's distance along an axis,
/// before it counts as being on that side: 2⁻²⁰ = 16u. Rounding moves the height by less than 9u of that distance (one
/// rounding of each difference, of the normal and of the product, two of the sum; √3 for three axes), and the
/// direction's slope by 7u: a ray that counts as leaving would meet the plane beyond all three corners if it did.
pub const SIDE_ERROR: f32 = 9.536_743_164_062_5e-7;

/// What is computed once per ray.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RayFrame {
    /// Origin.
    pub origin: Vec3,
    /// Direction.
    pub direction: Vec3,
    /// Reciprocal of the direction, components at least [`MIN_DIRECTION`] in magnitude beforehand.
    pub inverse: Vec3,
    /// Axes: the last is the direction's dominant one, the order keeps the winding.
    pub axes: [u32; 3],
    /// Shear (x, y) and scale (z) that map the direction to the unit of the dominant axis.
    pub shear: Vec3,
}

/// Reciprocal of one direction component, finite for any finite input.
#[inline(always)]
pub fn safe_reciprocal(d: f32) -> f32 {
    let magnitude = if d.abs() < MIN_DIRECTION { MIN_DIRECTION } else { d.abs() };
    let reciprocal = 1.0 / magnitude;
    if d < 0.0 { -reciprocal } else { reciprocal }
}

/// The frame of a ray. A zero direction gives a frame with which every triangle test fails.
#[inline(always)]
pub fn ray_frame(origin: Vec3, direction: Vec3) -> RayFrame {
    let magnitude = direction.abs();
    let mut kz = 0_u32;
    if magnitude.y > magnitude.x {
        kz = 1;
    }
    if magnitude.z > (if kz == 1 { magnitude.y } else { magnitude.x }) {
        kz = 2;
    }
    let mut kx = if kz == 2 { 0 } else { kz + 1 };
    let mut ky = if kx == 2 { 0 } else { kx + 1 };
    // A masked index of four numbers: glam's own indexing branches, and which axis dominates can't be predicted.
    let components = [direction.x, direction.y, direction.z, 0.0];
    let dominant = components[kz as usize & 3];
    if dominant < 0.0 {
        (kx, ky) = (ky, kx);
    }
    let scale = 1.0 / dominant;
    let shear =
        Vec3::new(components[kx as usize & 3] / dominant, components[ky as usize & 3] / dominant, scale);
    let inverse =
        Vec3::new(safe_reciprocal(direction.x), safe_reciprocal(direction.y), safe_reciprocal(direction.z));
    RayFrame { origin, direction, inverse, axes: [kx, ky, kz], shear }
}

/// Entry and exit parameters of a ray and a box, the exit moved out by [`SLAB_FAR_FACTOR`]. The ray meets the box in
/// `t ≥ 0` when `max(near, 0) ≤ far`. Monotone: a box inside another has no smaller entry and no greater exit.
#[inline(always)]
pub fn slab(frame: &RayFrame, min: Vec3, max: Vec3) -> (f32, f32) {
    let a = (min - frame.origin) * frame.inverse;
    let b = (max - frame.origin) * frame.inverse;
    let near = larger(larger(smaller(a.x, b.x), smaller(a.y, b.y)), smaller(a.z, b.z));
    let far = smaller(smaller(larger(a.x, b.x), larger(a.y, b.y)), larger(a.z, b.z));
    (near, if far < 0.0 { far } else { far * SLAB_FAR_FACTOR })
}

/// `a < b ? a : b`, the form WGSL's `select` has; differs from `f32::min` on signed zeros.
#[inline(always)]
pub fn smaller(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// `a > b ? a : b`.
#[inline(always)]
pub fn larger(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// Padded bounds of a triangle. The pad covers the distance by which rounding in the sheared test may accept a ray
/// that passes outside: relative to the edge lengths, and to the coordinates the edges are differences of.
#[inline(always)]
pub fn padded_bounds(p0: Vec3, p1: Vec3, p2: Vec3) -> (Vec3, Vec3) {
    let min = Vec3::new(
        smaller(smaller(p0.x, p1.x), p2.x),
        smaller(smaller(p0.y, p1.y), p2.y),
        smaller(smaller(p0.z, p1.z), p2.z),
    );
    let max = Vec3::new(
        larger(larger(p0.x, p1.x), p2.x),
        larger(larger(p0.y, p1.y), p2.y),
        larger(larger(p0.z, p1.z), p2.z),
    );
    let size = max - min;
    let extent = larger(larger(size.x, size.y), size.z);
    let reach = Vec3::new(
        larger(min.x.abs(), max.x.abs()),
        larger(min.y.abs(), max.y.abs()),
        larger(min.z.abs(), max.z.abs()),
    );
    let coordinate = larger(larger(reach.x, reach.y), reach.z);
    let pad = Vec3::splat(extent * PAD_EXTENT + coordinate * PAD_COORDINATE);
    (min - pad, max + pad)
}

/// A met triangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TriangleHit {
    /// Ray parameter, not less than the entry into the triangle's padded bounds.
    pub t: f32,
    /// Weight of the second vertex.
    pub u: f32,
    /// Weight of the third vertex.
    pub v: f32,
}

/// Where a ray meets the plane of a triangle, or `t_edge` where rounding leaves open on which side of it the ray starts.
/// `None` when it starts on one side and goes away from it. The edge functions alone can't tell: `t_edge` is off by
/// rounding times the triangle's aspect, so that a needle would meet its own rays and miss those of its neighbour.
#[inline(always)]
fn plane_t(frame: &RayFrame, normal: Vec3, [a, b, c]: [Vec3; 3], t_edge: f32) -> Option<f32> {
    let height = -(normal.dot(a));
    let slope = normal.dot(frame.direction);
    let (a, b, c) = (a.abs(), b.abs(), c.abs());
    let x = larger(larger(a.x, b.x), c.x);
    let y = larger(larger(a.y, b.y), c.y);
    let z = larger(larger(a.z, b.z), c.z);
    let doubt = larger(larger(x, y), z) * SIDE_ERROR;
    if height > doubt {
        return (slope < 0.0).then_some(height / -slope);
    }
    if height < -doubt {
        return (slope > 0.0).then_some(-height / slope);
    }
    Some(t_edge)
}

/// Conditions 2 to 4 of [`crate::kernels::trace`] for a triangle whose `edges` U, V, W let the ray through: t.
#[inline(always)]
fn triangle_t(
    frame: &RayFrame,
    normal: Vec3,
    [p0, p1, p2]: [Vec3; 3],
    [u, v, w]: [f32; 3],
    t_min: f32,
    t_max: f32,
) -> Option<f32> {
    let determinant = (u + v) + w;
    // Written so that NaN fails too.
    if !(determinant < 0.0 || determinant > 0.0) {
        return None;
    }
    let relative = [p0 - frame.origin, p1 - frame.origin, p2 - frame.origin];
    let [a, b, c] = relative.map(|p| frame.shear.z * [p.x, p.y, p.z, 0.0][frame.axes[2] as usize & 3]);
    let low = smaller(smaller(a, b), c);
    let high = larger(larger(a, b), c);
    if !(high > t_min && low <= t_max) {
        return None;
    }
    let (min, max) = padded_bounds(p0, p1, p2);
    let (near, far) = slab(frame, min, max);
    if !(larger(near, 0.0) <= far) {
        return None;
    }
    let t_edge = ((u * a + v * b) + w * c) / determinant;
    let t = smaller(larger(plane_t(frame, normal, relative, t_edge)?, low), high);
    let t_i = larger(t, near);
    (t > t_min && t_i <= t_max).then_some(t_i)
}

/// Conditions 1 to 4 of [`crate::kernels::trace`].
#[inline(always)]
pub fn triangle(frame: &RayFrame, record: &Triangle, t_min: f32, t_max: f32) -> Option<TriangleHit> {
    let [p0, p1, p2] = [record.p0, record.p1, record.p2].map(Vec3::from);
    let [kx, ky, kz] = frame.axes.map(|k| k as usize);
    let a = p0 - frame.origin;
    let b = p1 - frame.origin;
    let c = p2 - frame.origin;
    let ax = a[kx] - frame.shear.x * a[kz];
    let ay = a[ky] - frame.shear.y * a[kz];
    let bx = b[kx] - frame.shear.x * b[kz];
    let by = b[ky] - frame.shear.y * b[kz];
    let cx = c[kx] - frame.shear.x * c[kz];
    let cy = c[ky] - frame.shear.y * c[kz];
    let u = cx * by - cy * bx;
    let v = ax * cy - ay * cx;
    let w = bx * ay - by * ax;
    if (u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0) {
        return None;
    }
    let t = triangle_t(frame, record.normal.into(), [p0, p1, p2], [u, v, w], t_min, t_max)?;
    let determinant = (u + v) + w;
    Some(TriangleHit { t, u: v / determinant, v: w / determinant })
}

/// Entry and exit of a ray (direction of any length) and a sphere, or `None`. The discriminant is formed from the
/// perpendicular distance, which keeps its digits when the sphere is small and far (Haines et al., Ray Tracing Gems
/// ch. 7).
#[inline(always)]
pub fn sphere(origin: Vec3, direction: Vec3, center: Vec3, radius: f32) -> Option<(f32, f32)> {
    let f = origin - center;
    let a = direction.dot(direction);
    let b = -(f.dot(direction));
    let s = b / a;
    let perpendicular = f + direction * s;
    let discriminant = radius * radius - perpendicular.dot(perpendicular);
    if !(discriminant >= 0.0) {
        return None;
    }
    let c = f.dot(f) - radius * radius;
    let root = (a * discriminant).sqrt();
    let q = if b < 0.0 { b - root } else { b + root };
    let t0 = c / q;
    let t1 = q / a;
    // q is 0 only when the ray starts on the sphere and leaves tangentially: no hit ahead.
    if !(q < 0.0 || q > 0.0) {
        return None;
    }
    Some(if t0 < t1 { (t0, t1) } else { (t1, t0) })
}
