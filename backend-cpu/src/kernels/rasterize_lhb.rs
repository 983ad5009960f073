// kernel family: rasterize_lhb
// contract core/src/kernels/rasterize_lhb.rs
// cpu backend-cpu/src/kernels/rasterize_lhb.rs
// gpu backend-gpu/src/kernels/rasterize_lhb.wgsl
// oracle conformance/src/oracle/rasterize_lhb.rs
//! `rasterize_lhb`.

use crate::mesh::CpuMesh;
use crate::simd::Isa;
use twinlight_core::kernels::rasterize_lhb::{Lhb, RasterizeLhbParams};
use twinlight_core::lattice::View;
use twinlight_core::{Error, Result};

pub(crate) fn rasterize_lhb(
    _isa: Isa,
    mesh: &CpuMesh,
    _views: &[View],
    _params: &RasterizeLhbParams,
) -> Result<Lhb<crate::CpuBackend>> {
    let _ = (mesh.vertices(), mesh.triangles());
    Err(Error::Unsupported("rasterize_lhb".into()))
}
