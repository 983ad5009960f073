//! A snapped mesh in host memory, laid out for the rasterizer.

use crate::buffer::try_copy;
use twinlight_core::Result;
use twinlight_core::lattice::LatticeMesh;

/// A resident mesh.
#[derive(Debug, Clone)]
pub struct CpuMesh {
    /// Positions, an array per axis, so that eight are rotated at once.
    pub(crate) axes: [Vec<i16>; 3],
    /// Vertex numbers; every one is below the length of the axes.
    pub(crate) triangles: Vec<[u32; 3]>,
}

impl CpuMesh {
    pub(crate) fn new(mesh: &LatticeMesh) -> Result<Self> {
        let mut axes = [const { Vec::new() }; 3];
        for (axis, values) in axes.iter_mut().enumerate() {
            values
                .try_reserve_exact(mesh.vertices().len())
                .map_err(|_| crate::buffer::out_of_memory::<i16>(mesh.vertices().len()))?;
            values.extend(mesh.vertices().iter().map(|p| p[axis]));
        }
        Ok(Self { axes, triangles: try_copy(mesh.triangles())? })
    }
}
