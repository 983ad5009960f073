// kernel family: rasterize_lhb
// contract core/src/kernels/rasterize_lhb.rs
// cpu backend-cpu/src/kernels/rasterize_lhb.rs
// gpu backend-gpu/src/kernels/rasterize_lhb.wgsl
// oracle conformance/src/oracle/rasterize_lhb.rs
//! Host side of `rasterize_lhb`.

use crate::backend::GpuBackend;
use crate::device::GpuDevice;
use crate::mesh::GpuMesh;
use twinlight_core::kernels::rasterize_lhb::{Lhb, RasterizeLhbParams};
use twinlight_core::lattice::View;
use twinlight_core::{Error, Result};

/// Runs the kernel; see the contract.
///
/// # Errors
/// [`Error::InvalidInput`], [`Error::LimitExceeded`], [`Error::OutOfMemory`].
pub fn run(
    _device: &GpuDevice,
    _mesh: &GpuMesh,
    views: &[View],
    params: &RasterizeLhbParams,
) -> Result<Lhb<GpuBackend>> {
    params.check(views)?;
    Err(Error::Unsupported("rasterize_lhb".into()))
}
