//! A snapped mesh in host memory, laid out for the rasterizer.

use crate::buffer::{try_collect, try_copy};
use twinlight_core::Result;
use twinlight_core::lattice::{LatticeMesh, LatticePlane};

/// A resident mesh.
#[derive(Debug, Clone)]
pub struct CpuMesh {
    /// Positions, an array per axis, so that eight are rotated at once.
    pub(crate) axes: [Vec<i16>; 3],
    /// Vertex numbers; every one is below the length of the axes.
    pub(crate) triangles: Vec<[u32; 3]>,
    /// The triangles' planes.
    pub(crate) planes: Vec<LatticePlane>,
}

impl CpuMesh {
    pub(crate) fn new(mesh: &LatticeMesh) -> Result<Self> {
        let [x, y, z] = [0, 1, 2].map(|axis| try_collect(mesh.vertices().iter().map(|p| p[axis])));
        Ok(Self {
            axes: [x?, y?, z?],
            triangles: try_copy(mesh.triangles())?,
            planes: try_collect(mesh.planes())?,
        })
    }
}
