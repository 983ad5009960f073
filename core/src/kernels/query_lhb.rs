// kernel family: query_lhb
// contract core/src/kernels/query_lhb.rs
// cpu backend-cpu/src/kernels/query_lhb.rs
// gpu backend-gpu/src/kernels/query_lhb.wgsl
// oracle conformance/src/oracle/query_lhb.rs
//! `query_lhb`: what a point sees along a direction, looked up in layered hit buffers instead of traced.
//!
//! *Shapes.* [`LhbBuffers`](crate::kernels::rasterize_lhb::LhbBuffers) of V views, the V [`View`](crate::lattice::View)s and the [`LatticeMesh`](crate::lattice::LatticeMesh) it was made of, and
//! `queries[n]` in; `hits[n]` out. *Units.* Lattice steps, screen units and depths of [`crate::kernels::rasterize_lhb`].
//!
//! *Meaning.* The query looks along view v = `ray >> 1`, away from the viewer, or towards him where `ray & 1` is 1 (reversed).
//! 1. (x, y) is the query's `position` on the screen of v, plus `offset`, brought into [0, N·2ˢ − 1]. The list is that of
//!    pixel (x >> s, y >> s). z is the position's depth.
//! 2. The list is read from its nearest element on, or from its farthest when reversed. An element of depth d is at a = d − z, or
//!    z − d when reversed. The first of these is the hit: an element with a > `window`, or one with −`window` ≤ a ≤ `window` that is
//!    *entered*.
//! 3. An element is entered when it is not of the triangle that the query leaves, when it shows the query the side (front or
//!    back) on which the query lies of the triangle that it leaves, and when the position is more than [`CLEARANCE`] before the
//!    plane of the element's triangle, on that side: s > [`CLEARANCE`] for a front, s < −[`CLEARANCE`] for a back, where
//!    s = normal·position − offset of its [`LatticePlane`](crate::lattice::LatticePlane).
//!
//! `hits[i]` is that element, its facing as the query sees it (inverted when reversed); [`NO_ELEMENT`] when there is none.
//!
//! *Why.* A list belongs to its pixel's centre, and the query's point is up to half a pixel and `offset` beside it. The surface
//! that the query leaves is met there at another depth, by its slope; so is a wall that the point stands before, whose element
//! may even lie behind the point. Within the window, which the caller derives from that distance and the slope, planes decide
//! instead of depths. That a surface is entered on the side that was left keeps the far facets of a curved surface from
//! hiding it from itself.
//! *Edge cases.* A view beyond V hits nothing. Positions beyond the lattice's reach and windows beyond 2³⁰ are the caller's error: any
//! hit of some list, or none, and nothing outside the buffers is read.
//! *Source.* Yu, layered hit buffers, "the element with the smallest depth difference", made exact; see its erratum: the nearest
//! one ahead, beyond what the slope across a pixel explains.

use crate::accuracy::Accuracy;
use bytemuck::{Pod, Zeroable};

/// Every decision is integer arithmetic.
pub const ACCURACY: Accuracy =
    Accuracy::Exact { because: "projection, order and the side of a plane are integer arithmetic" };

/// How far a position must be before a plane to be known to be before it: the units of [`crate::lattice::LatticePlane::offset`]. 8 steps, times
/// 2¹³: quantised normals are off by up to 7 steps across the lattice, positions by 0.9.
pub const CLEARANCE: i32 = 8 << 13;

/// [`crate::kernels::rasterize_lhb::LhbElement::surface`] of a query that meets nothing.
pub const NO_ELEMENT: u32 = u32::MAX;

/// A lookup.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
pub struct LhbQuery {
    /// Lattice steps, within [`crate::lattice::REACH`].
    pub position: [i32; 3],
    /// Twice the view's number, plus 1 to look towards the viewer.
    pub ray: u32,
    /// Added to the position on the screen, screen units.
    pub offset: [i32; 2],
    /// Twice the number of the triangle that the query leaves, plus 1 where the position is on its front.
    pub leaves: u32,
    /// Elements this near in depth are judged by their planes; at most 2³⁰.
    pub window: u32,
}
