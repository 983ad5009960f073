//! Ray origins off the surface they start on. How far is a bound of errors, not a scene epsilon:
//! [`crate::scene::Triangle::offset`]. Twin: `backend-gpu/src/shared/offset.wgsl`.

use glam::Vec3;

/// A point at `distance` from `position`, on the side of the surface that `direction` leaves to.
#[inline(always)]
pub fn offset_origin(position: Vec3, distance: f32, normal: Vec3, direction: Vec3) -> Vec3 {
    let side = if direction.dot(normal) < 0.0 { -distance } else { distance };
    position + normal * side
}
