// kernel family: query_lhb
// contract core/src/kernels/query_lhb.rs
// cpu backend-cpu/src/kernels/query_lhb.rs
// gpu backend-gpu/src/kernels/query_lhb.wgsl
// oracle conformance/src/oracle/query_lhb.rs
//! Host side of `query_lhb`.

use crate::backend::GpuBackend;
use crate::buffer::{BufferRef, GpuBuffer, chunks};
use crate::device::GpuDevice;
use crate::kernels::status;
use crate::mesh::GpuMesh;
use crate::scene::upload;
use crate::shared;
use crate::source::{KernelSource, WgslFile};
use bytemuck::{Pod, Zeroable};
use twinlight_core::kernels::query_lhb::LhbQuery;
use twinlight_core::kernels::rasterize_lhb::{Lhb, LhbElement};
use twinlight_core::lattice::View;
use twinlight_core::{Error, Result};

/// The WGSL.
pub const SOURCE: KernelSource = KernelSource {
    stem: "query_lhb",
    files: &[
        shared::DISPATCH,
        shared::LATTICE,
        shared::LOOK_UP,
        WgslFile { path: "backend-gpu/src/kernels/query_lhb.wgsl", text: include_str!("query_lhb.wgsl") },
    ],
};

/// Queries per workgroup; twin of the WGSL constant.
pub const WORKGROUP_SIZE: u32 = 64;

/// How much there is to look up; twin of the WGSL struct.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct LhbHeader {
    /// Pixels per row and column of a view.
    pub size: u32,
    /// Number of views.
    pub view_count: u32,
    /// Elements of all lists.
    pub element_count: u32,
    /// Triangles of the mesh.
    pub plane_count: u32,
}

/// Twin of the WGSL struct.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct QueryLhbBlock {
    /// What is looked up.
    pub lhb: LhbHeader,
    /// Number of queries.
    pub query_count: u32,
    /// For `loops_run`.
    pub loop_rounds: u32,
    /// Unused, 0.
    pub padding: [u32; 2],
}

/// Layered hit buffers and what lookups need beside them: the bindings of `shared/look_up.wgsl`.
pub(crate) struct Lookups<'a> {
    pub(crate) header: LhbHeader,
    views: GpuBuffer<View>,
    lhb: &'a Lhb<GpuBackend>,
    mesh: &'a GpuMesh,
}

impl<'a> Lookups<'a> {
    /// Uploads the views.
    ///
    /// # Errors
    /// [`Error::InvalidInput`] for what doesn't belong together, [`Error::OutOfMemory`].
    pub(crate) fn new(
        device: &GpuDevice,
        mesh: &'a GpuMesh,
        lhb: &'a Lhb<GpuBackend>,
        views: &[View],
    ) -> Result<Self> {
        check_equal("query_lhb views", views.len(), lhb.view_count as usize)?;
        check_equal("query_lhb offsets", lhb.offsets.len(), lhb.lists()? + 1)?;
        let header = LhbHeader {
            size: lhb.size,
            view_count: lhb.view_count,
            element_count: lhb.elements.len() as u32,
            plane_count: mesh.triangle_count(),
        };
        Ok(Self { header, views: upload(device, "views", views)?, lhb, mesh })
    }

    /// The buffers by their WGSL names, and `own` behind them.
    pub(crate) fn buffers_and<'b>(
        &'b self,
        own: &[(&'static str, BufferRef<'b>)],
    ) -> Vec<(&'static str, BufferRef<'b>)> {
        let mut buffers = vec![
            ("views", self.views.binding()),
            ("offsets", self.lhb.offsets.binding()),
            ("elements", self.lhb.elements.binding()),
            ("planes", self.mesh.planes()),
        ];
        buffers.extend_from_slice(own);
        buffers
    }
}

/// Runs the kernel; see the contract.
///
/// # Errors
/// [`Error::InvalidInput`] when lengths differ, [`Error::LimitExceeded`] beyond 2³² queries, [`Error::Unsupported`] when
/// the driver ends loops early.
pub fn run(
    device: &GpuDevice,
    mesh: &GpuMesh,
    lhb: &Lhb<GpuBackend>,
    views: &[View],
    queries: &GpuBuffer<LhbQuery>,
    hits: &mut GpuBuffer<LhbElement>,
) -> Result<()> {
    check_equal("query_lhb hits", hits.len(), queries.len())?;
    u32::try_from(queries.len())
        .map_err(|_| Error::limit("queries of one call", queries.len() as u64, u32::MAX.into()))?;
    let lookups = Lookups::new(device, mesh, lhb, views)?;
    let pipeline = device.pipeline(&SOURCE, "answer_queries")?;
    let status = status::new(device)?;
    let mut recorder = device.record("look up");
    for chunk in chunks(queries.len(), device.elements_per_binding(size_of::<LhbQuery>())) {
        let params = QueryLhbBlock {
            lhb: lookups.header,
            query_count: chunk.len() as u32,
            loop_rounds: status::LOOP_ROUNDS,
            padding: [0; 2],
        };
        let buffers = lookups.buffers_and(&[
            ("queries", queries.binding_of(chunk.clone())),
            ("hits", hits.binding_of(chunk)),
            ("status", status.binding()),
        ]);
        let workgroups = params.query_count.div_ceil(WORKGROUP_SIZE);
        recorder.dispatch("answer queries", &pipeline, &params, &buffers, workgroups)?;
    }
    recorder.run()?;
    status::read(device, &status, "query_lhb")?;
    Ok(())
}

pub(crate) fn check_equal(place: &str, found: usize, expected: usize) -> Result<()> {
    if found == expected {
        return Ok(());
    }
    Err(Error::invalid(place, format!("has {found} elements where {expected} are needed")))
}
