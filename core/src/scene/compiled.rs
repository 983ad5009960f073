//! The flat, world-space form of a scene that backends upload. Every record is `repr(C)` and has a WGSL twin.

use super::triangle::Triangle;
use crate::bvh::Bvh;
use bytemuck::{Pod, Zeroable};

/// No texture, no light, no alias.
pub const NONE: u32 = u32::MAX;

/// [`MaterialRecord::kind`]: diffuse base and GGX lobe.
pub const MATERIAL_OPAQUE: u32 = 0;
/// [`MaterialRecord::kind`]: perfect mirror.
pub const MATERIAL_MIRROR: u32 = 1;
/// [`MaterialRecord::kind`]: smooth dielectric.
pub const MATERIAL_DIELECTRIC: u32 = 2;

/// [`LightRecord::kind`]: analytic sphere. Spheres come first in the list.
pub const LIGHT_SPHERE: u32 = 0;
/// [`LightRecord::kind`]: an emissive triangle.
pub const LIGHT_TRIANGLE: u32 = 1;
/// [`LightRecord::kind`]: point.
pub const LIGHT_POINT: u32 = 2;
/// [`LightRecord::kind`]: spot.
pub const LIGHT_SPOT: u32 = 3;
/// [`LightRecord::kind`]: directional.
pub const LIGHT_DIRECTIONAL: u32 = 4;
/// [`LightRecord::kind`]: environment map.
pub const LIGHT_ENVIRONMENT: u32 = 5;

/// [`TriangleAttributes::flags`]: vertex normals are present and usable.
pub const HAS_NORMALS: u32 = 1;
/// [`TriangleAttributes::flags`]: texture coordinates are present.
pub const HAS_TEXCOORDS: u32 = 2;
/// [`MaterialRecord::flags`]: the back face emits too.
pub const EMITS_BOTH_SIDES: u32 = 1;

/// [`EnvironmentHeader::flags`]: no triangle hides a light from another, or it is to be as if: kernels send no shadow rays.
pub const NOTHING_HIDES: u32 = 1;

/// The first words of [`CompiledScene::words`] decode an sRGB byte to linear light.
pub const SRGB_TABLE_LEN: u32 = 256;

/// Shading attributes of one triangle, in leaf order.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct TriangleAttributes {
    /// Unit normal at the first vertex; 0 0 0 when absent.
    pub n0: [f32; 3],
    /// [`HAS_NORMALS`] | [`HAS_TEXCOORDS`].
    pub flags: u32,
    /// Unit normal at the second vertex.
    pub n1: [f32; 3],
    /// Texture coordinate v of the third vertex.
    pub uv2_v: f32,
    /// Unit normal at the third vertex.
    pub n2: [f32; 3],
    /// Texture coordinate u of the third vertex.
    pub uv2_u: f32,
    /// Texture coordinates of the first vertex; v grows downwards, from the picture's top row.
    pub uv0: [f32; 2],
    /// Texture coordinates of the second vertex.
    pub uv1: [f32; 2],
}

/// A material.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct MaterialRecord {
    /// Diffuse albedo.
    pub albedo: [f32; 3],
    /// [`MATERIAL_OPAQUE`], [`MATERIAL_MIRROR`] or [`MATERIAL_DIELECTRIC`].
    pub kind: u32,
    /// Reflectance at normal incidence.
    pub specular_f0: [f32; 3],
    /// GGX α = roughness², at least 2⁻¹⁰.
    pub alpha: f32,
    /// Exitant radiance.
    pub emission: [f32; 3],
    /// [`EMITS_BOTH_SIDES`].
    pub flags: u32,
    /// Reflectance at grazing incidence: min(1, 50·max f0), so that the lobe fades with f0.
    pub specular_f90: f32,
    /// Index of refraction, inside over outside.
    pub ior: f32,
    /// Smith-Schlick k = (roughness + 1)² / 8.
    pub smith_k: f32,
    /// First word of the texture in [`CompiledScene::words`], or [`NONE`].
    pub texture_offset: u32,
    /// Texels per row.
    pub texture_width: u32,
    /// Rows.
    pub texture_height: u32,
    /// 0 repeat, 1 clamp.
    pub texture_wrap: u32,
    /// Unused, 0.
    pub padding: u32,
}

/// A light and its row of the alias table.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct LightRecord {
    /// World position; for directional lights 0 0 0.
    pub position: [f32; 3],
    /// One of the `LIGHT_…` kinds.
    pub kind: u32,
    /// Unit direction light travels (spot axis, directional), or unit normal of the triangle's front.
    pub direction: [f32; 3],
    /// Sphere radius.
    pub radius: f32,
    /// Radiance (sphere, triangle), intensity (point, spot) or irradiance (directional).
    pub emission: [f32; 3],
    /// Probability that the selection picks this light.
    pub select_pdf: f32,
    /// Keep this row's light when the 32-bit draw is below this, else take `alias`.
    pub alias_threshold: u32,
    /// The other light of the row.
    pub alias: u32,
    /// Slot of the emissive triangle in [`CompiledScene::triangles`].
    pub triangle: u32,
    /// [`EMITS_BOTH_SIDES`].
    pub flags: u32,
    /// Spot: 1 / max(0.001, cos inner − cos outer).
    pub spot_scale: f32,
    /// Spot: −cos outer · scale.
    pub spot_offset: f32,
    /// Triangle: area, world units².
    pub area: f32,
    /// Unused, 0.
    pub padding: u32,
}

/// Where the environment lies in [`CompiledScene::words`] (f32 values by their bits).
///
/// From `offset`: `height + 1` row cosines (1 down to −1), then per texel 6 words: radiance R, G, B; pdf over solid
/// angle; alias threshold; alias index.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct EnvironmentHeader {
    /// Rows of the world-to-map rotation, each padded to 4.
    pub world_to_map: [[f32; 4]; 3],
    /// First word, or [`NONE`] without an environment.
    pub offset: u32,
    /// Texels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Index of the environment in the light list.
    pub light: u32,
    /// Number of lights.
    pub light_count: u32,
    /// Number of sphere lights, the first of the list.
    pub sphere_count: u32,
    /// [`NOTHING_HIDES`].
    pub flags: u32,
    /// Unused, 0.
    pub padding: u32,
}

/// A validated scene in world space, ready for any backend.
#[derive(Debug, Clone)]
pub struct CompiledScene {
    /// In leaf order of `bvh`; first those that stay from frame to frame.
    pub triangles: Vec<Triangle>,
    /// Slot of the first triangle that may move ([`super::Instance::moves`]): the number of triangles where nothing does.
    pub moving_from: u32,
    /// In leaf order of `bvh`.
    pub attributes: Vec<TriangleAttributes>,
    /// Material records; at least one.
    pub materials: Vec<MaterialRecord>,
    /// Light records, spheres first.
    pub lights: Vec<LightRecord>,
    /// sRGB table, texels, environment.
    pub words: Vec<u32>,
    /// Where the environment is, and light counts.
    pub environment: EnvironmentHeader,
    /// The hierarchy over `triangles`.
    pub bvh: Bvh,
    /// World position of the records' origin: every position in this struct is relative to it.
    pub origin: [f64; 3],
    /// Bounds of the geometry (min, max), relative to `origin`.
    pub bounds: ([f32; 3], [f32; 3]),
    /// [`crate::kernels::trace_paths::TracePathsParams::film_exponent`] for this scene.
    pub film_exponent: i32,
    /// [`crate::kernels::trace_paths::TracePathsParams::moment_exponent`] for this scene.
    pub moment_exponent: i32,
    /// What was dropped or mended while compiling.
    pub notices: Vec<String>,
}

impl CompiledScene {
    /// The triangles that stay from frame to frame, and those that may move.
    pub fn parts(&self) -> (&[Triangle], &[Triangle]) {
        self.triangles.split_at(self.moving_from as usize)
    }
}
