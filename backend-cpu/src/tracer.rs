//! What the kernels that follow rays need of an acceleration structure.

use glam::Vec3;
use twinlight_core::scene::NONE;

/// A closest hit, by slot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlotHit {
    /// Ray parameter.
    pub t: f32,
    /// Weight of the second vertex.
    pub u: f32,
    /// Weight of the third vertex.
    pub v: f32,
    /// Index into the scene's triangles (leaf order), or [`NONE`].
    pub slot: u32,
}

impl SlotHit {
    /// Nothing met up to `t_max`.
    pub fn miss(t_max: f32) -> Self {
        Self { t: t_max, u: 0.0, v: 0.0, slot: NONE }
    }
}

/// Finds hits as `core/src/kernels/trace.rs` defines them.
pub trait Tracer {
    /// The hit with the least (t, id) in `t_min < t ≤ t_max`.
    fn closest(&self, origin: Vec3, direction: Vec3, t_min: f32, t_max: f32) -> SlotHit;

    /// Whether there is any hit in `t_min < t ≤ t_max`.
    fn occluded(&self, origin: Vec3, direction: Vec3, t_min: f32, t_max: f32) -> bool;
}
