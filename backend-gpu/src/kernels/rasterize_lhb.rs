// kernel family: rasterize_lhb
// contract core/src/kernels/rasterize_lhb.rs
// cpu backend-cpu/src/kernels/rasterize_lhb.rs
// gpu backend-gpu/src/kernels/rasterize_lhb.wgsl
// oracle conformance/src/oracle/rasterize_lhb.rs
//! Host side of `rasterize_lhb`: every triangle is counted and filled in by `cover`, lists are sized, sorted and capped
//! by `lists`.

mod cover;
mod lists;

use crate::backend::GpuBackend;
use crate::device::GpuDevice;
use crate::kernels::scan;
use crate::mesh::GpuMesh;
use crate::shared;
use crate::source::{KernelSource, WgslFile};
use bytemuck::{Pod, Zeroable};
use cover::Cover;
use lists::Lists;
use twinlight_core::kernels::rasterize_lhb::{Lhb, LhbBuffers, LhbElement, RasterizeLhbParams};
use twinlight_core::lattice::View;
use twinlight_core::{Error, Result};

/// The WGSL.
pub const SOURCE: KernelSource = KernelSource {
    stem: "rasterize_lhb",
    files: &[
        shared::DISPATCH,
        shared::WIDE,
        shared::LATTICE,
        WgslFile {
            path: "backend-gpu/src/kernels/rasterize_lhb/outline.wgsl",
            text: include_str!("rasterize_lhb/outline.wgsl"),
        },
        WgslFile {
            path: "backend-gpu/src/kernels/rasterize_lhb/lists.wgsl",
            text: include_str!("rasterize_lhb/lists.wgsl"),
        },
        WgslFile {
            path: "backend-gpu/src/kernels/rasterize_lhb.wgsl",
            text: include_str!("rasterize_lhb.wgsl"),
        },
    ],
};

/// Invocations per workgroup; twin of the WGSL constant.
pub const WORKGROUP_SIZE: u32 = 256;
/// Elements of a list that a workgroup sorts; twin of the WGSL constant.
pub const TILE_SIZE: u32 = 1024;
/// Lists whose counts one invocation sums; twin of the WGSL constant.
pub const LISTS_PER_LANE: u32 = 16;

/// Twin of the WGSL struct.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct RasterizeLhbBlock {
    /// The contract's parameters.
    pub call: RasterizeLhbParams,
    /// First view of the dispatch's pairs.
    pub view_begin: u32,
    /// First triangle.
    pub triangle_begin: u32,
    /// Triangles per view.
    pub triangle_count: u32,
    /// Pairs of a triangle and a view.
    pub pair_count: u32,
    /// Views of the dispatch.
    pub view_count: u32,
    /// Vertices of the mesh.
    pub vertex_count: u32,
    /// First item of the dispatch, of all those of the pairs.
    pub item_begin: u32,
    /// The item after the last.
    pub item_end: u32,
    /// 0 counts elements, 1 writes them.
    pub fill: u32,
    /// Pixels of all views.
    pub list_count: u32,
    /// Elements that the cap keeps.
    pub element_count: u32,
    /// Length of the sorted runs that are merged.
    pub run: u32,
    /// Tiles of long lists.
    pub tile_count: u32,
    /// For `loops_run`.
    pub loop_rounds: u32,
    /// Unused, 0.
    pub padding: [u32; 2],
}

/// A tile of a list that isn't short; twin of the WGSL struct.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct ListTile {
    /// The list's place in the elements.
    pub list_begin: u32,
    /// Its length.
    pub list_len: u32,
    /// The tile's first element in the list.
    pub begin: u32,
}

/// Sums over some lists; twin of the WGSL struct.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct ListSums {
    /// Low word of the number of elements.
    pub elements_low: u32,
    /// Its high word.
    pub elements_high: u32,
    /// Tiles of lists that aren't short.
    pub tiles: u32,
    /// Elements of the longest list.
    pub longest: u32,
}

/// Runs the kernel; see the contract.
///
/// # Errors
/// [`Error::InvalidInput`]; [`Error::LimitExceeded`] by the contract's limits and for lists or elements beyond one binding,
/// which fewer views per call avoid; [`Error::OutOfMemory`]; [`Error::Unsupported`] when the driver ends loops early.
pub fn run(
    device: &GpuDevice,
    mesh: &GpuMesh,
    views: &[View],
    params: &RasterizeLhbParams,
) -> Result<Lhb<GpuBackend>> {
    let list_count = params.check(views)?;
    device.expect_bindable::<u32>("offsets of layered hit buffers", list_count + 1)?;
    device.expect_bindable::<View>("views", views.len())?;
    // One more, 0, so that the scan ends with the total.
    let counts = device.zeroed::<u32>(list_count + 1)?;
    let mut offsets = device.zeroed::<u32>(list_count + 1)?;
    let cover = Cover::count(device, mesh, views, params, &counts)?;
    let lists = Lists::measure(device, params, &counts)?;
    let total = scan::run(device, &counts, &mut offsets)?;
    if total != lists.element_count {
        return Err(Error::Internal(format!("{total} elements, {} by another way", lists.element_count)));
    }
    let elements = device.zeroed::<LhbElement>(total as usize)?;
    cover.fill(&counts, &offsets, &elements)?;
    lists.sort(&offsets, &elements)?;
    let left_out = device.zeroed::<u32>(if params.layer_cap > 0 { list_count } else { 0 })?;
    let (offsets, elements) = if params.layer_cap > 0 {
        lists.cap(&counts, offsets, elements, &left_out)?
    } else {
        (offsets, elements)
    };
    Ok(LhbBuffers { size: params.size, view_count: views.len() as u32, offsets, elements, left_out })
}
