//! A scene in host memory.

use crate::buffer::try_copy;
use std::sync::Arc;
use twinlight_core::bvh::{Bvh, MAX_DEPTH};
use twinlight_core::scene::{
    CompiledScene, EnvironmentHeader, LightRecord, MaterialRecord, Triangle, TriangleAttributes,
};
use twinlight_core::transport::SceneView;
use twinlight_core::{Error, Result};

/// A resident scene. Clones share the data.
#[derive(Debug, Clone)]
pub struct CpuScene(Arc<SceneData>);

/// What kernels read: the fields of [`CompiledScene`] of the same names.
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
    pub bvh: Bvh,
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
    /// [`Error::LimitExceeded`] for a hierarchy deeper than the traversal stacks; [`Error::OutOfMemory`].
    pub(crate) fn new(scene: &CompiledScene) -> Result<Self> {
        if scene.bvh.depth > MAX_DEPTH {
            return Err(Error::limit("depth of the hierarchy", scene.bvh.depth.into(), MAX_DEPTH.into()));
        }
        Ok(Self(Arc::new(SceneData {
            triangles: try_copy(&scene.triangles)?,
            attributes: try_copy(&scene.attributes)?,
            materials: try_copy(&scene.materials)?,
            lights: try_copy(&scene.lights)?,
            words: try_copy(&scene.words)?,
            environment: scene.environment,
            bvh: Bvh { nodes: try_copy(&scene.bvh.nodes)?, depth: scene.bvh.depth },
        })))
    }

    /// What kernels read.
    pub fn data(&self) -> &SceneData {
        &self.0
    }
}
