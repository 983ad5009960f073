//! Ray origins off the surface they start on, by error bounds instead of a scene epsilon. Twin:
//! `backend-gpu/src/shared/offset.wgsl`. Source: Pharr, Jakob, Humphreys, PBRT 4th ed. §6.8.

use glam::{DVec3, Vec3};

/// γ(11) = 11u/(1 − 11u), u = 2⁻²⁴: barycentric interpolation makes 7 roundings (PBRT §6.8.5); the third weight,
/// 1 − u − v, is rounded twice more; moving the origin rounds each axis once more, by u of its coordinate, and the
/// product with the normal once more, by u of the distance. Counting them here is why [`offset_origin`] needs no step to
/// the next f32, unlike PBRT's.
pub const POSITION_ERROR: f32 = 6.556_516e-7;

/// 2⁻¹⁹ = 32u of the triangle's extent: how far from its plane, measured along the normal, the sheared test may place
/// the intersection of a ray that starts in it. Translation and shear displace a vertex by 3u·extent, an edge function
/// collects at most 16u·extent², the weighted sum of depths doubles that; divided by the determinant the error grows
/// like 1/cosine, measured along the normal it doesn't. Without it, walls in a coordinate plane (position and its error
/// exactly 0) meet themselves.
pub const PLANE_ERROR: f32 = 1.907_348_6e-6;

/// How far along its normal a ray has to start off a triangle so that the true surface isn't met again: the bounds of
/// the position's error and of a later intersection's, added over the axes. The weighted corners whose sum a position is
/// are each bounded by the largest corner, so one number serves the whole triangle; it is worked out once, on the host.
#[must_use]
pub fn leaving_distance(corners: [Vec3; 3], normal: Vec3) -> f32 {
    let [p0, p1, p2] = corners.map(|p| p.as_dvec3());
    let reach = p0.abs().max(p1.abs()).max(p2.abs());
    let extent = (p1 - p0).abs().max((p2 - p0).abs()).max_element();
    let error = reach * f64::from(POSITION_ERROR) + DVec3::splat(extent * f64::from(PLANE_ERROR));
    // Rounded up.
    (normal.abs().as_dvec3().dot(error) as f32).next_up()
}

/// A point at `distance` from `position`, on the side of the surface that `direction` leaves to.
#[inline(always)]
pub fn offset_origin(position: Vec3, distance: f32, normal: Vec3, direction: Vec3) -> Vec3 {
    let side = if direction.dot(normal) < 0.0 { -distance } else { distance };
    position + normal * side
}
