//! The tables of a TOML scene file, as written.

use super::value::OneOrThree;
use schemars::JsonSchema;
use serde::Deserialize;
use toml::Spanned;

/// A twinlight scene: a camera, meshes from files and their placements, materials, lights, an environment and how to
/// render. Angles are degrees, colours linear RGB, lengths world units.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub(super) struct Document {
    /// Where the JSON Schema of this file is, for editors.
    #[serde(rename = "$schema")]
    pub schema: Option<String>,
    /// How to render, unless the caller says otherwise.
    pub render: RenderTable,
    /// Where the picture is taken from. Without it, the camera of the first mesh file that has one.
    #[schemars(with = "Option<CameraTable>")]
    pub camera: Option<Spanned<CameraTable>>,
    /// Light from infinitely far away.
    #[schemars(with = "Option<EnvironmentTable>")]
    pub environment: Option<Spanned<EnvironmentTable>>,
    /// Materials that meshes and instances may use instead of their own.
    #[schemars(with = "Vec<MaterialTable>")]
    pub material: Vec<Spanned<MaterialTable>>,
    /// Meshes from files. A mesh that no instance names is placed once, as it is.
    pub mesh: Vec<MeshTable>,
    /// Placements of meshes.
    pub instance: Vec<InstanceTable>,
    /// Lights beside those of materials and mesh files.
    #[schemars(with = "Vec<LightTable>")]
    pub light: Vec<Spanned<LightTable>>,
}

/// How to render, unless the caller says otherwise.
#[derive(Debug, Clone, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub(super) struct RenderTable {
    /// Width and height of the picture, pixels.
    pub size: Option<[u32; 2]>,
    /// Samples per pixel.
    pub spp: Option<u32>,
    /// Most scattering events of a path; 1 is direct light only. Without it, paths end by roulette.
    pub bounces: Option<u32>,
    /// Seed of the sampling pattern.
    pub seed: Option<u32>,
    /// Rendering method.
    pub method: Option<String>,
}

/// A pinhole camera.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct CameraTable {
    /// Eye.
    pub position: [f64; 3],
    /// A point on the view axis.
    pub target: [f64; 3],
    /// Roughly upwards; +Y by default.
    #[serde(default = "up")]
    pub up: [f64; 3],
    /// Full vertical field of view, degrees; 40 by default.
    #[serde(default = "vfov")]
    pub vfov: f64,
}

fn up() -> [f64; 3] {
    [0.0, 1.0, 0.0]
}

fn vfov() -> f64 {
    40.0
}

/// Light from infinitely far away: a picture or a constant.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct EnvironmentTable {
    /// A latitude-longitude EXR.
    #[schemars(with = "Option<String>")]
    pub file: Option<Spanned<String>>,
    /// The same radiance from everywhere.
    pub radiance: Option<OneOrThree>,
    /// Multiplies the radiance; 1 by default.
    pub scale: Option<f32>,
    /// Turns the map about +Y, degrees.
    pub rotation: Option<f64>,
}

/// How a material scatters.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub(super) enum KindName {
    /// Diffuse under an optional rough reflection.
    #[default]
    Opaque,
    /// Perfect mirror of reflectance `specular`.
    Mirror,
    /// Clear glass of index `ior`.
    Dielectric,
}

/// A material.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct MaterialTable {
    /// What meshes and instances call it.
    #[schemars(with = "String")]
    pub name: Spanned<String>,
    /// How it scatters; `opaque` by default.
    #[serde(default)]
    pub kind: KindName,
    /// Diffuse albedo, 0 to 1; 0.5 by default.
    pub albedo: Option<OneOrThree>,
    /// A PNG or JPEG that multiplies the albedo.
    #[schemars(with = "Option<String>")]
    pub albedo_texture: Option<Spanned<String>>,
    /// Reflectance at normal incidence, 0 to 1; 0 by default, 1 for a mirror.
    pub specular: Option<OneOrThree>,
    /// Perceptual roughness, 0 to 1; 1 by default. The square of it is the α of GGX.
    pub roughness: Option<f32>,
    /// Index of refraction of a dielectric; 1.5 by default.
    pub ior: Option<f32>,
    /// Exitant radiance; 0 by default.
    pub emission: Option<OneOrThree>,
    /// Whether the back faces emit too.
    #[serde(default)]
    pub emits_both_sides: bool,
}

/// A mesh from a file.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct MeshTable {
    /// What instances call it; the path by default.
    #[schemars(with = "Option<String>")]
    pub name: Option<Spanned<String>>,
    /// An OBJ, PLY, glTF or TOML scene file in this file's folder or below, or `builtin:NAME`.
    #[schemars(with = "String")]
    pub path: Spanned<String>,
    /// Replaces the materials of the file.
    #[schemars(with = "Option<String>")]
    pub material: Option<Spanned<String>>,
    /// Which animation of a glTF file is played, by name or number from 0; the caller's choice by default, else the first.
    #[schemars(with = "Option<String>")]
    pub animation: Option<Spanned<String>>,
}

/// A rotation about an axis.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct AxisAngle {
    /// Axis, any length but 0.
    pub axis: [f64; 3],
    /// Angle, degrees, right-handed.
    pub angle: f64,
}

/// A keyframe of a placement. Between keyframes, translation and scale run on straight lines, and rotations about the same
/// axis through the angles between theirs; others take the shortest turn.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct KeyframeTable {
    /// Seconds, at least 0; later than the keyframe before.
    pub time: f64,
    /// Translation.
    pub translate: Option<[f64; 3]>,
    /// Rotation about an axis.
    pub rotate: Option<AxisAngle>,
    /// Scale, one factor or one per axis.
    pub scale: Option<OneOrThree>,
}

/// A placement of a mesh: scaled, then rotated, then moved; or by a matrix.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct InstanceTable {
    /// The mesh's name.
    #[schemars(with = "String")]
    pub mesh: Spanned<String>,
    /// Translation.
    pub translate: Option<[f64; 3]>,
    /// Rotation about an axis.
    #[schemars(with = "Option<AxisAngle>")]
    pub rotate: Option<Spanned<AxisAngle>>,
    /// Rotations about X, then Y, then Z, degrees.
    pub euler: Option<[f64; 3]>,
    /// Scale, one factor or one per axis.
    pub scale: Option<OneOrThree>,
    /// Three rows of an affine 3×4 matrix, instead of the four above.
    #[schemars(with = "Option<[[f64; 4]; 3]>")]
    pub matrix: Option<Spanned<[[f64; 4]; 3]>>,
    /// Replaces the materials of the mesh.
    #[schemars(with = "Option<String>")]
    pub material: Option<Spanned<String>>,
    /// Keyframes that move it; what none of them gives stays as above.
    #[schemars(with = "Vec<KeyframeTable>")]
    #[serde(default)]
    pub motion: Vec<Spanned<KeyframeTable>>,
}

/// The kinds of light.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub(super) enum LightType {
    /// `position`, `intensity`.
    Point,
    /// `position`, `direction`, `intensity`, `inner_angle`, `outer_angle`.
    Spot,
    /// `direction`, `irradiance`.
    Directional,
    /// `corner`, `edge_u`, `edge_v`, `radiance`; the side along edge_u × edge_v emits.
    Rectangle,
    /// `center`, `radius`, `radiance`.
    Sphere,
}

/// A light. Which keys it has depends on its type.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct LightTable {
    /// Kind of light.
    #[serde(rename = "type")]
    pub kind: LightType,
    /// Point, spot: where it stands.
    pub position: Option<[f32; 3]>,
    /// Spot, directional: where the light goes.
    pub direction: Option<[f32; 3]>,
    /// Point, spot: radiant intensity, W/sr.
    pub intensity: Option<OneOrThree>,
    /// Directional: irradiance on a facing plane, W/m².
    pub irradiance: Option<OneOrThree>,
    /// Rectangle, sphere: exitant radiance, W/(sr·m²).
    pub radiance: Option<OneOrThree>,
    /// Spot: half-angle of full intensity, degrees; 0 by default.
    pub inner_angle: Option<f32>,
    /// Spot: half-angle of the edge, degrees, at most 90; 45 by default.
    pub outer_angle: Option<f32>,
    /// Rectangle: a corner.
    pub corner: Option<[f32; 3]>,
    /// Rectangle: from the corner along one side.
    pub edge_u: Option<[f32; 3]>,
    /// Rectangle: from the corner along the other side.
    pub edge_v: Option<[f32; 3]>,
    /// Sphere: centre.
    pub center: Option<[f32; 3]>,
    /// Sphere: radius.
    pub radius: Option<f32>,
}
