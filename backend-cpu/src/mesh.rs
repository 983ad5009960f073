//! A snapped mesh in host memory, laid out for the rasterizer.

use crate::buffer::try_copy;
use twinlight_core::Result;
use twinlight_core::lattice::LatticeMesh;

/// A resident mesh.
#[derive(Debug, Clone)]
pub struct CpuMesh {
    vertices: Vec<[i16; 3]>,
    triangles: Vec<[u32; 3]>,
}

impl CpuMesh {
    pub(crate) fn new(mesh: &LatticeMesh) -> Result<Self> {
        Ok(Self { vertices: try_copy(mesh.vertices())?, triangles: try_copy(mesh.triangles())? })
    }

    /// Positions, lattice steps.
    pub(crate) fn vertices(&self) -> &[[i16; 3]] {
        &self.vertices
    }

    /// Vertex numbers, all of them in range.
    pub(crate) fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }
}
