//! A scene on a device.

use crate::buffer::{BufferRef, GpuBuffer};
use crate::device::GpuDevice;
use bytemuck::{Pod, Zeroable};
use twinlight_core::bvh::{BvhNode, MAX_DEPTH};
use twinlight_core::scene::{
    CompiledScene, EnvironmentHeader, LightRecord, MaterialRecord, Triangle, TriangleAttributes,
};
use twinlight_core::{Error, Result};

/// A resident scene: the buffers that `shared/scene.wgsl` binds, under the same names.
#[derive(Debug)]
pub struct GpuScene {
    nodes: GpuBuffer<BvhNode>,
    triangles: GpuBuffer<Triangle>,
    attributes: GpuBuffer<TriangleAttributes>,
    materials: GpuBuffer<MaterialRecord>,
    lights: GpuBuffer<LightRecord>,
    words: GpuBuffer<u32>,
    /// Number of triangles.
    pub(crate) triangle_count: u32,
    /// For the parameters of kernels that sample lights.
    pub environment: EnvironmentHeader,
}

impl GpuScene {
    /// Uploads what kernels need.
    ///
    /// # Errors
    /// [`Error::LimitExceeded`] for a hierarchy deeper than the traversal stacks or records beyond a binding's size,
    /// [`Error::OutOfMemory`].
    pub fn new(device: &GpuDevice, scene: &CompiledScene) -> Result<Self> {
        if scene.bvh.depth > MAX_DEPTH {
            return Err(Error::limit("depth of the hierarchy", scene.bvh.depth.into(), MAX_DEPTH.into()));
        }
        // No ray enters a box turned inside out: the root of a scene without triangles.
        let nowhere = BvhNode { min: [1e30; 3], first: 0, max: [-1e30; 3], count: 1 };
        let nodes = if scene.bvh.nodes.is_empty() { &[nowhere][..] } else { &scene.bvh.nodes };
        Ok(Self {
            nodes: upload(device, "hierarchy", nodes)?,
            triangles: upload(device, "triangles", &scene.triangles)?,
            attributes: upload(device, "triangle attributes", &scene.attributes)?,
            materials: upload(device, "materials", &scene.materials)?,
            lights: upload(device, "lights", &scene.lights)?,
            words: upload(device, "textures", &scene.words)?,
            triangle_count: scene.triangles.len() as u32,
            environment: scene.environment,
        })
    }

    /// The scene's buffers by their WGSL names, and `own` behind them.
    pub fn buffers_and<'a>(
        &'a self,
        own: &[(&'static str, BufferRef<'a>)],
    ) -> Vec<(&'static str, BufferRef<'a>)> {
        let mut buffers = vec![
            ("nodes", self.nodes.binding()),
            ("triangles", self.triangles.binding()),
            ("attributes", self.attributes.binding()),
            ("materials", self.materials.binding()),
            ("lights", self.lights.binding()),
            ("words", self.words.binding()),
        ];
        buffers.extend_from_slice(own);
        buffers
    }
}

/// Uploads records; a buffer of none holds a zeroed one, because a binding holds at least one element.
pub(crate) fn upload<T: Pod + Zeroable>(
    device: &GpuDevice,
    what: &str,
    records: &[T],
) -> Result<GpuBuffer<T>> {
    let limit = device.report().limits.storage_binding_bytes;
    let bytes = size_of_val(records) as u64;
    if bytes > limit {
        return Err(Error::limit(format!("bytes of {what} on {}", device.report().name), bytes, limit));
    }
    if records.is_empty() { device.zeroed(1) } else { device.upload(records) }
}
