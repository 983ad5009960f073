// kernel family: trace
// contract core/src/kernels/trace.rs
// cpu backend-cpu/src/kernels/trace.rs
// gpu backend-gpu/src/kernels/trace.wgsl
// oracle conformance/src/oracle/trace.rs
//! Oracle of `trace`: every ray against every triangle, twice.
//!
//! [`closest_as_written`] and [`occluded_as_written`] evaluate the contract's formula in f32, without a hierarchy: what
//! strict mode must give bit for bit. They share the scalar test with the CPU twin, so they only judge traversal.
//!
//! [`closest`] and [`occluded`] are the third road: Möller–Trumbore in f64, and around its result the interval that the
//! contract's f32 formula may reach under WGSL's accuracy rules. A triangle is a *certain* hit, a *possible* one, or
//! none; an answer is right when no certain hit lies in front of it.

mod bounds;

use bounds::possible_hit;
use glam::Vec3;
use twinlight_core::kernels::trace::{Hit, NO_HIT, Ray};
use twinlight_core::scene::Triangle;
use twinlight_core::transport::intersect::{RayFrame, TriangleHit, ray_frame, triangle};

pub use bounds::{Aim, Interval, Possible, wide};

fn test(frame: &RayFrame, ray: &Ray, t: &Triangle) -> Option<TriangleHit> {
    triangle(frame, t, ray.t_min, ray.t_max)
}

fn frame_of(ray: &Ray) -> RayFrame {
    ray_frame(Vec3::from(ray.origin), Vec3::from(ray.direction))
}

/// The least (t, id) over all triangles by the contract's own arithmetic.
pub fn closest_as_written(triangles: &[Triangle], ray: &Ray) -> Hit {
    let frame = frame_of(ray);
    let mut best = Hit { t: ray.t_max, triangle: NO_HIT, u: 0.0, v: 0.0 };
    for candidate in triangles {
        let Some(hit) = test(&frame, ray, candidate) else { continue };
        if best.triangle == NO_HIT || hit.t < best.t || (hit.t == best.t && candidate.id < best.triangle) {
            best = Hit { t: hit.t, triangle: candidate.id, u: hit.u, v: hit.v };
        }
    }
    best
}

/// Whether any triangle is met, by the contract's own arithmetic: 1 or 0.
pub fn occluded_as_written(triangles: &[Triangle], ray: &Ray) -> u32 {
    let frame = frame_of(ray);
    u32::from(triangles.iter().any(|t| test(&frame, ray, t).is_some()))
}

/// What a closest hit may be.
#[derive(Debug, Clone, PartialEq)]
pub struct Allowed {
    /// Ids and where t, u and v must lie for each.
    pub hits: Vec<(u32, Possible)>,
    /// Whether meeting nothing is right too.
    pub miss: bool,
}

impl Allowed {
    /// Whether only one answer is right.
    pub fn is_decided(&self) -> bool {
        self.hits.len() + usize::from(self.miss) == 1
    }
}

/// The answers that f64 and the derived intervals leave open. The ray's direction is not zero.
pub fn closest(triangles: &[Triangle], ray: &Ray) -> Allowed {
    closest_along(triangles, &Aim::from(ray))
}

/// As [`closest`], for a direction that is itself the result of float arithmetic.
pub fn closest_along(triangles: &[Triangle], ray: &Aim) -> Allowed {
    let mut hits: Vec<(u32, Possible)> =
        triangles.iter().filter_map(|t| Some((t.id, possible_hit(ray, &[t.p0, t.p1, t.p2])?))).collect();
    let bound =
        hits.iter().filter(|(_, hit)| hit.certain).map(|(_, hit)| hit.t.high).fold(f64::INFINITY, f64::min);
    hits.retain(|(_, hit)| hit.t.low <= bound);
    Allowed { miss: !hits.iter().any(|(_, hit)| hit.certain), hits }
}

/// `Some(true)` or `Some(false)` where f64 is sure, else `None`.
pub fn occluded(triangles: &[Triangle], ray: &Ray) -> Option<bool> {
    let allowed = closest(triangles, ray);
    match (allowed.miss, allowed.hits.is_empty()) {
        (false, _) => Some(true),
        (true, true) => Some(false),
        (true, false) => None,
    }
}

#[cfg(test)]
mod tests;
