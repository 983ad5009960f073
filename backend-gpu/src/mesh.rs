//! A snapped mesh on a device.

use crate::device::GpuDevice;
use twinlight_core::Result;
use twinlight_core::lattice::LatticeMesh;

/// A resident mesh.
#[derive(Debug)]
pub struct GpuMesh {}

impl GpuMesh {
    /// Uploads vertices and triangles.
    ///
    /// # Errors
    /// [`twinlight_core::Error::LimitExceeded`], [`twinlight_core::Error::OutOfMemory`].
    pub fn new(_device: &GpuDevice, _mesh: &LatticeMesh) -> Result<Self> {
        Ok(Self {})
    }
}
