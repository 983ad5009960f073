//! Light transport, scalar: what both twins of a kernel do to one ray, one surface, one light. Each file is the twin of
//! `backend-gpu/src/shared/<stem>.wgsl`, function by function, operation by operation.

pub mod bsdf;
pub mod cone;
pub mod environment;
pub mod intersect;
pub mod lhb;
pub mod light;
pub mod offset;
pub mod surface;
pub mod texture;
pub mod voxel_light;

use crate::scene::{
    CompiledScene, EnvironmentHeader, LightRecord, MaterialRecord, Triangle, TriangleAttributes,
};

/// The records of a scene, as the functions here read them; in WGSL, the bindings.
#[derive(Debug, Clone, Copy)]
pub struct SceneView<'a> {
    /// Positions, leaf order.
    pub triangles: &'a [Triangle],
    /// Attributes, leaf order.
    pub attributes: &'a [TriangleAttributes],
    /// Materials.
    pub materials: &'a [MaterialRecord],
    /// Lights, spheres first.
    pub lights: &'a [LightRecord],
    /// sRGB table, texels, environment.
    pub words: &'a [u32],
    /// Environment and light counts.
    pub environment: &'a EnvironmentHeader,
}

impl<'a> From<&'a CompiledScene> for SceneView<'a> {
    fn from(scene: &'a CompiledScene) -> Self {
        Self {
            triangles: &scene.triangles,
            attributes: &scene.attributes,
            materials: &scene.materials,
            lights: &scene.lights,
            words: &scene.words,
            environment: &scene.environment,
        }
    }
}

/// 1/π.
pub const INV_PI: f32 = 0.318_309_87;

/// π.
pub const PI: f32 = std::f32::consts::PI;
