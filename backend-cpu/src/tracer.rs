//! What the kernels that follow rays need of an acceleration structure.

use crate::bvh8::{SlotHit, WideBvh};
use crate::simd::Width;
use glam::Vec3;

/// Finds hits as `core/src/kernels/trace.rs` defines them.
pub trait Tracer {
    /// The hit with the least (t, id) in `t_min < t ≤ t_max`.
    fn closest(&self, origin: Vec3, direction: Vec3, t_min: f32, t_max: f32) -> SlotHit;

    /// Whether there is any hit in `t_min < t ≤ t_max`.
    fn occluded(&self, origin: Vec3, direction: Vec3, t_min: f32, t_max: f32) -> bool;
}

/// The eight-wide hierarchy at one vector width.
pub struct WideTracer<'a, W>(pub &'a WideBvh, pub W);

impl<W: Width> Tracer for WideTracer<'_, W> {
    #[inline(always)]
    fn closest(&self, origin: Vec3, direction: Vec3, t_min: f32, t_max: f32) -> SlotHit {
        self.0.closest(self.1, origin, direction, t_min, t_max)
    }

    #[inline(always)]
    fn occluded(&self, origin: Vec3, direction: Vec3, t_min: f32, t_max: f32) -> bool {
        self.0.occluded(self.1, origin, direction, t_min, t_max)
    }
}
