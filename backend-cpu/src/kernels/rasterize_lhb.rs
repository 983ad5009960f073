// kernel family: rasterize_lhb
// contract core/src/kernels/rasterize_lhb.rs
// cpu backend-cpu/src/kernels/rasterize_lhb.rs
// gpu backend-gpu/src/kernels/rasterize_lhb.wgsl
// oracle conformance/src/oracle/rasterize_lhb.rs
//! `rasterize_lhb`: a view is one task. Runs of triangles and triangles that hold no pixel's centre are dropped eight at a time, the
//! rest leave fragments, and the fragments are counted, scattered into lists and sorted while they are in the core's cache. Only
//! the finished lists go to memory.
//!
//! *Cost.* Of a mesh whose triangles are much smaller than pixels, 1.5 bytes of boxes are read per triangle; of a coarse one, 21.5.

use crate::buffer::try_zeroed;
use crate::mesh::CpuMesh;
use crate::simd::{Isa, Kernel, Width, dispatch};
use crate::{CpuBackend, CpuBuffer};
use rayon::prelude::*;
use std::sync::{Mutex, PoisonError};
use twinlight_core::Result;
use twinlight_core::kernels::rasterize_lhb::{
    Lhb, LhbBuffers, LhbElement, RasterizeLhbParams, check_elements,
};
use twinlight_core::lattice::View;

mod cover;
mod draw;
mod lists;
mod project;
mod setup;
#[cfg(test)]
mod tests;

use lists::Lists;

/// What a thread needs for one view, kept for its next one.
#[derive(Debug, Default)]
struct Workspace {
    kept: Vec<u32>,
    fragments: Vec<Fragment>,
    lists: Lists,
}

/// A triangle at a pixel's centre.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Fragment {
    /// (depth, surface): what lists are sorted by.
    key: u64,
    /// Row times size plus column.
    pixel: u32,
}

/// The finished lists of one view.
#[derive(Debug)]
struct ViewLists {
    ends: Ends,
    elements: Vec<LhbElement>,
    left_out: Vec<u32>,
}

/// Where lists end.
#[derive(Debug)]
enum Ends {
    /// Of every pixel.
    All(Vec<u32>),
    /// Of pixels whose lists are not empty: the pixel and the end.
    Few(Vec<[u32; 2]>),
}

impl Ends {
    /// The end of every pixel's list, all moved by `first`.
    fn write(&self, first: u32, ends: &mut [u32]) {
        match self {
            Ends::All(all) => {
                for (end, own) in ends.iter_mut().zip(all) {
                    *end = first + own;
                }
            }
            Ends::Few(few) => {
                let (mut filled, mut before) = (0, first);
                for &[pixel, end] in few {
                    // Lists between that pixel and the one before are empty.
                    ends[filled..pixel as usize].fill(before);
                    (filled, before) = (pixel as usize, first + end);
                }
                ends[filled..].fill(before);
            }
        }
    }
}

pub(crate) fn rasterize_lhb(
    isa: Isa,
    mesh: &CpuMesh,
    views: &[View],
    params: &RasterizeLhbParams,
) -> Result<Lhb<CpuBackend>> {
    let idle: Mutex<Vec<Workspace>> = Mutex::default();
    let lock = || idle.lock().unwrap_or_else(PoisonError::into_inner);
    let rasterized: Vec<ViewLists> = views
        .par_iter()
        .with_max_len(1)
        .map(|view| {
            let mut workspace = lock().pop().unwrap_or_default();
            let lists = dispatch(isa, RasterizeView { mesh, view, params, workspace: &mut workspace });
            lock().push(workspace);
            lists
        })
        .collect();
    gather(&rasterized, views.len(), params)
}

/// One view, at whatever width.
struct RasterizeView<'a> {
    mesh: &'a CpuMesh,
    view: &'a View,
    params: &'a RasterizeLhbParams,
    workspace: &'a mut Workspace,
}

impl Kernel for RasterizeView<'_> {
    type Output = ViewLists;

    #[inline(always)]
    fn run<W: Width>(self, width: W) -> ViewLists {
        let Self { mesh, view, params, workspace } = self;
        let Workspace { kept, fragments, lists } = workspace;
        // [1] cull runs of triangles, by their boxes
        // [2] project and cull triangles
        // [3] cover
        fragments.clear();
        draw::draw::<W::U8>(width, mesh, view, params, kept, fragments);
        // [4] sort lists
        lists.sort(fragments, params)
    }
}

/// Joins the views' lists.
fn gather(views: &[ViewLists], view_count: usize, params: &RasterizeLhbParams) -> Result<Lhb<CpuBackend>> {
    let pixels = params.size as usize * params.size as usize;
    let mut first = Vec::with_capacity(views.len());
    let mut total = 0_u64;
    for view in views {
        first.push(total);
        total += view.elements.len() as u64;
    }
    let count = check_elements(total)? as usize;
    let mut offsets = try_zeroed::<u32>(view_count * pixels + 1)?;
    let mut left_out = try_zeroed::<u32>(if params.layer_cap > 0 { view_count * pixels } else { 0 })?;
    let mut elements = try_zeroed::<LhbElement>(count)?;
    // [5] gather
    let mut parts = Vec::with_capacity(views.len());
    let mut rest = elements.as_mut_slice();
    for view in views {
        let (part, behind) = rest.split_at_mut(view.elements.len());
        parts.push(part);
        rest = behind;
    }
    let ends = offsets[1..].par_chunks_mut(pixels);
    parts.into_par_iter().zip(ends).zip(views).zip(first).for_each(|(((part, ends), view), first)| {
        part.copy_from_slice(&view.elements);
        view.ends.write(first as u32, ends);
    });
    left_out.par_chunks_mut(pixels).zip(views).for_each(|(part, view)| part.copy_from_slice(&view.left_out));
    Ok(LhbBuffers {
        size: params.size,
        view_count: view_count as u32,
        offsets: CpuBuffer::from(offsets),
        elements: CpuBuffer::from(elements),
        left_out: CpuBuffer::from(left_out),
    })
}
