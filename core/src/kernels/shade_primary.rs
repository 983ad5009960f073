// kernel family: shade_primary
// contract core/src/kernels/shade_primary.rs
// cpu backend-cpu/src/kernels/shade_primary.rs
// gpu backend-gpu/src/kernels/shade_primary.wgsl
// oracle conformance/src/oracle/shade_primary.rs
//! `shade_primary`: the G-buffer, what a pinhole camera sees through the centre of every pixel.
//!
//! *Shapes.* `gbuffer[width * height]`, row-major from the top-left pixel. *Units.* Position and depth in world units
//! (depth is the distance along the view axis), normals unit length, albedo linear RGB in [0, 1].
//! *Edge cases.* A ray that meets nothing, or meets an analytic sphere light, leaves `triangle = NO_HIT`, depth 0 and
//! zeros (a sphere light is no surface). Shading normals face the side the camera is on, as geometric normals do; a
//! missing, zero or contrary vertex normal gives the geometric normal.
//! *Source.* Saito & Takahashi, "Comprehensible rendering of 3-D shapes", 1990.

use crate::accuracy::Accuracy;
use crate::kernels::trace_paths::CameraRecord;
use bytemuck::{Pod, Zeroable};

/// Interpolation and the camera ray are float arithmetic.
pub const ACCURACY: Accuracy = Accuracy::Interval {
    because: "exact in strict mode; elsewhere a few ulp of interpolation, and another id where two surfaces meet",
};

/// Parameters of one call.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct ShadePrimaryParams {
    /// The camera, for `width` by `height` pixels.
    pub camera: CameraRecord,
    /// Pixels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Unused, 0.
    pub padding: [u32; 2],
}

/// One pixel's surface.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct GBufferTexel {
    /// Position relative to [`crate::scene::CompiledScene::origin`].
    pub position: [f32; 3],
    /// Distance along the view axis, world units; 0 where nothing is seen.
    pub depth: f32,
    /// Unit normal of the triangle, facing the camera.
    pub geometric_normal: [f32; 3],
    /// Triangle id, or [`crate::kernels::trace::NO_HIT`].
    pub triangle: u32,
    /// Unit interpolated normal, on the side of the geometric normal.
    pub shading_normal: [f32; 3],
    /// Material index, 0 where nothing is seen.
    pub material: u32,
    /// Diffuse albedo, texture included.
    pub albedo: [f32; 3],
    /// Unused, 0.
    pub padding: u32,
}
