// kernel family: query_lhb
// contract core/src/kernels/query_lhb.rs
// cpu backend-cpu/src/kernels/query_lhb.rs
// gpu backend-gpu/src/kernels/query_lhb.wgsl
// oracle conformance/src/oracle/query_lhb.rs
//! Host side of `query_lhb`.

use crate::backend::GpuBackend;
use crate::buffer::GpuBuffer;
use crate::device::GpuDevice;
use crate::mesh::GpuMesh;
use twinlight_core::kernels::query_lhb::LhbQuery;
use twinlight_core::kernels::rasterize_lhb::{Lhb, LhbElement};
use twinlight_core::lattice::View;
use twinlight_core::{Error, Result};

/// Runs the kernel; see the contract.
///
/// # Errors
/// [`Error::InvalidInput`] when lengths differ.
pub fn run(
    _device: &GpuDevice,
    _mesh: &GpuMesh,
    _lhb: &Lhb<GpuBackend>,
    _views: &[View],
    _queries: &GpuBuffer<LhbQuery>,
    _hits: &mut GpuBuffer<LhbElement>,
) -> Result<()> {
    Err(Error::Unsupported("query_lhb".into()))
}
