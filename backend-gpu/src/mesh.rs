//! A snapped mesh on a device.

use crate::buffer::{BufferRef, GpuBuffer};
use crate::device::GpuDevice;
use crate::scene::upload;
use twinlight_core::Result;
use twinlight_core::lattice::{LatticeMesh, LatticePlane};

/// A resident mesh.
#[derive(Debug)]
pub struct GpuMesh {
    vertices: GpuBuffer<[u32; 2]>,
    triangles: GpuBuffer<[u32; 3]>,
    planes: GpuBuffer<LatticePlane>,
    vertex_count: u32,
    triangle_count: u32,
}

impl GpuMesh {
    /// Uploads vertices, triangles and their planes.
    ///
    /// # Errors
    /// [`twinlight_core::Error::LimitExceeded`] for more of either than a binding holds,
    /// [`twinlight_core::Error::OutOfMemory`].
    pub fn new(device: &GpuDevice, mesh: &LatticeMesh) -> Result<Self> {
        let vertices: Vec<[u32; 2]> = mesh.vertices().iter().map(|&v| packed(v)).collect();
        let planes: Vec<_> = mesh.planes().collect();
        Ok(Self {
            vertices: upload(device, "vertices", &vertices)?,
            triangles: upload(device, "triangles", mesh.triangles())?,
            planes: upload(device, "planes", &planes)?,
            vertex_count: vertices.len() as u32,
            triangle_count: mesh.triangles().len() as u32,
        })
    }

    /// Number of vertices.
    pub fn vertex_count(&self) -> u32 {
        self.vertex_count
    }

    /// Number of triangles.
    pub fn triangle_count(&self) -> u32 {
        self.triangle_count
    }

    pub(crate) fn vertices(&self) -> BufferRef<'_> {
        self.vertices.binding()
    }

    pub(crate) fn triangles(&self) -> BufferRef<'_> {
        self.triangles.binding()
    }

    pub(crate) fn planes(&self) -> BufferRef<'_> {
        self.planes.binding()
    }
}

/// x and y in the halves of the first word, x in the low one; z in the second.
fn packed([x, y, z]: [i16; 3]) -> [u32; 2] {
    [u32::from(x as u16) | u32::from(y as u16) << 16, i32::from(z) as u32]
}
