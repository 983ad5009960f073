//! A scene in host memory.

use crate::buffer::try_copy;
use crate::bvh8::WideBvh;
use std::sync::Arc;
use twinlight_core::Result;
use twinlight_core::scene::{
    CompiledScene, EnvironmentHeader, LightRecord, MaterialRecord, Triangle, TriangleAttributes,
};
use twinlight_core::transport::SceneView;

/// A resident scene. Clones share the data.
#[derive(Debug, Clone)]
pub struct CpuScene(Arc<SceneData>);

/// What kernels read: the fields of [`CompiledScene`] of the same names, and an eight-wide hierarchy.
#[derive(Debug)]
pub struct SceneData {
    /// In leaf order of `bvh`.
    pub triangles: Vec<Triangle>,
    /// In leaf order of `bvh`.
    pub attributes: Vec<TriangleAttributes>,
    /// At least one.
    pub materials: Vec<MaterialRecord>,
    /// Spheres first.
    pub lights: Vec<LightRecord>,
    /// sRGB table, texels, environment.
    pub words: Vec<u32>,
    /// Where the environment is, and light counts.
    pub environment: EnvironmentHeader,
    /// The hierarchy over `triangles`.
    pub bvh: WideBvh,
}

impl SceneData {
    /// The records as the shared transport functions take them.
    pub(crate) fn view(&self) -> SceneView<'_> {
        SceneView {
            triangles: &self.triangles,
            attributes: &self.attributes,
            materials: &self.materials,
            lights: &self.lights,
            words: &self.words,
            environment: &self.environment,
        }
    }
}

impl CpuScene {
    /// Copies what kernels need.
    ///
    /// # Errors
    /// [`twinlight_core::Error::OutOfMemory`].
    pub(crate) fn new(scene: &CompiledScene) -> Result<Self> {
        Ok(Self(Arc::new(SceneData {
            triangles: try_copy(&scene.triangles)?,
            attributes: try_copy(&scene.attributes)?,
            materials: try_copy(&scene.materials)?,
            lights: try_copy(&scene.lights)?,
            words: try_copy(&scene.words)?,
            environment: scene.environment,
            bvh: WideBvh::new(scene),
        })))
    }

    /// What kernels read.
    pub fn data(&self) -> &SceneData {
        &self.0
    }
}
