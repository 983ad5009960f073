//! The hierarchy at one vector width: what kernels that follow rays hand around.

use crate::bvh8::{SlotHit, WideBvh};
use crate::simd::Width;
use glam::Vec3;

/// Finds hits as `core/src/kernels/trace.rs` defines them.
pub struct WideTracer<'a, W>(pub &'a WideBvh, pub W);

impl<W: Width> WideTracer<'_, W> {
    /// The hit with the least (t, id).
    #[inline(always)]
    pub fn closest(&self, origin: Vec3, direction: Vec3, t_min: f32, t_max: f32) -> SlotHit {
        self.0.closest(self.1, origin, direction, t_min, t_max)
    }

    /// Whether there is any hit.
    #[inline(always)]
    pub fn occluded(&self, origin: Vec3, direction: Vec3, t_min: f32, t_max: f32) -> bool {
        self.0.occluded(self.1, origin, direction, t_min, t_max)
    }
}
