// kernel family: trace
// contract core/src/kernels/trace.rs
// cpu backend-cpu/src/kernels/trace.rs
// gpu backend-gpu/src/kernels/trace.wgsl
// oracle conformance/src/oracle/trace.rs
//! `trace`: closest hit and any hit of rays with the scene's triangles.
//!
//! *Shapes.* `rays[n]` in, `hits[n]` (closest) or `occluded[n]` (any: 1 or 0) out. *Units.* World units; `t` counts
//! lengths of `direction`, which need not be unit.
//!
//! *Meaning.* A ray meets triangle i when
//! 1. the sheared edge functions U, V, W ([`crate::transport::intersect::triangle`]) don't have mixed signs (zero
//!    counts for both sides, so a ray through a shared edge or vertex meets at least one of the triangles there), and
//! 2. the ray meets the triangle's padded bounds ([`crate::transport::intersect::slab`]), `t_near ≤ t_far`, and
//! 3. the ray doesn't start off the triangle's plane and go away from it, and
//! 4. t lies in `t_min < t` and `t_i = max(t, t_near) ≤ t_max`. Here t is where the ray meets the plane if rounding leaves
//!    no doubt on which side of the plane it starts, else t_edge, the mean of the corners' depths along the ray with
//!    weights U, V, W; either is clamped to the range of these depths.
//!
//! The closest hit is the least (t_i, id). Condition 2 makes the answer independent of the acceleration structure:
//! slab arithmetic is monotone in the bounds, so a box that holds a triangle's padded bounds is never missed by a ray
//! that meets them, and never lies behind `t_i`. Any BVH, any order of traversal, any vector width: the same bits.
//!
//! *Edge cases.* Zero-area triangles and NaN are never hit. Infinite `t_max` is allowed. A zero direction misses.
//! Both faces are hit. Coplanar duplicates: the lower id wins.
//! *Sources.* Woop, Benthin, Wald, "Watertight ray/triangle intersection", JCGT 2(1) 2013, without the f64 fallback:
//! with zero counted inside, rounding of a product difference can only add hits on the edge, never lose one. Ize,
//! "Robust BVH ray traversal", JCGT 2(2) 2013, for the slab's far side.

use crate::accuracy::Accuracy;
use bytemuck::{Pod, Zeroable};

/// Ids and distances are decided by float comparisons that strict mode evaluates as written.
pub const ACCURACY: Accuracy = Accuracy::Interval {
    because: "ids and t are exact in strict mode; elsewhere a driver may fuse or reassociate the edge functions",
};

/// [`Hit::triangle`] of a ray that meets nothing.
pub const NO_HIT: u32 = u32::MAX;

/// A ray. `t_min` is exclusive, `t_max` inclusive.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct Ray {
    /// Start, world units.
    pub origin: [f32; 3],
    /// Hits at or before this parameter are ignored. At least 0.
    pub t_min: f32,
    /// Direction, any length but 0.
    pub direction: [f32; 3],
    /// Hits beyond this parameter are ignored.
    pub t_max: f32,
}

/// A closest hit.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct Hit {
    /// Ray parameter; `t_max` of the ray when nothing is met.
    pub t: f32,
    /// The triangle's id in the scene's order, or [`NO_HIT`].
    pub triangle: u32,
    /// Barycentric weight of the second vertex.
    pub u: f32,
    /// Barycentric weight of the third vertex.
    pub v: f32,
}
