//! The traversal of all triangles in all views, once to count and once to fill.

use super::{RasterizeLhbBlock, SOURCE, WORKGROUP_SIZE};
use crate::buffer::{BufferRef, GpuBuffer};
use crate::device::GpuDevice;
use crate::kernels::scan;
use crate::mesh::GpuMesh;
use crate::pipeline::Pipeline;
use crate::scene::upload;
use bytemuck::Zeroable;
use std::sync::Arc;
use twinlight_core::Result;
use twinlight_core::kernels::rasterize_lhb::{LhbElement, RasterizeLhbParams};
use twinlight_core::lattice::View;

/// Pairs of a triangle and a view per batch: with 2¹³ items each, which is a view of 1024² cut into the smallest ones,
/// their number is a word.
const MAX_PAIRS: usize = 1 << 18;

/// Projected vertices per batch, 32 MiB, unless one view has more.
const MAX_PROJECTED: usize = 1 << 22;

/// Items per submission, of at most 2¹⁰ pixels each: a submission that takes seconds looks like a device that hangs.
const MAX_ITEMS: u32 = 1 << 18;

/// The traversal after the first round.
pub(super) struct Cover<'a> {
    device: &'a GpuDevice,
    mesh: &'a GpuMesh,
    views: GpuBuffer<View>,
    /// The vertices in the views of a batch.
    projected: GpuBuffer<[u32; 2]>,
    project_vertices: Arc<Pipeline>,
    raster_pairs: Arc<Pipeline>,
    raster_items: Arc<Pipeline>,
    batches: Vec<Batch>,
}

/// Some triangles in some views, as the parameters say.
struct Batch {
    params: RasterizeLhbBlock,
    /// The scan of the number of items per pair; nothing where there are no items.
    starts: GpuBuffer<u32>,
    item_count: u32,
}

/// What differs between the rounds.
type Outputs<'a> = [(&'static str, BufferRef<'a>); 3];

impl<'a> Cover<'a> {
    /// Adds every list's number of elements to `counts`.
    pub(super) fn count(
        device: &'a GpuDevice,
        mesh: &'a GpuMesh,
        views: &[View],
        params: &RasterizeLhbParams,
        counts: &GpuBuffer<u32>,
    ) -> Result<Self> {
        let zero = RasterizeLhbBlock::zeroed();
        let call = RasterizeLhbBlock {
            call: *params,
            view_count: views.len() as u32,
            triangle_count: mesh.triangle_count(),
            vertex_count: mesh.vertex_count(),
            ..zero
        };
        let most_pairs = device.elements_per_binding(size_of::<u32>()).clamp(1, MAX_PAIRS);
        let most_projected = device.elements_per_binding(size_of::<[u32; 2]>()).min(MAX_PROJECTED);
        let batches: Vec<_> = batches(&call, most_pairs as u32, most_projected as u32).collect();
        let projected = batches.iter().map(|batch| batch.view_count * batch.vertex_count).max();
        let mut cover = Self {
            device,
            mesh,
            views: upload(device, "views", views)?,
            projected: device.zeroed(projected.unwrap_or(0) as usize)?,
            project_vertices: device.pipeline(&SOURCE, "project_vertices")?,
            raster_pairs: device.pipeline(&SOURCE, "raster_pairs")?,
            raster_items: device.pipeline(&SOURCE, "raster_items")?,
            batches: Vec::new(),
        };
        let (no_offsets, no_elements) = (device.zeroed::<u32>(1)?, device.zeroed::<LhbElement>(1)?);
        let outputs = [
            ("counts", counts.binding()),
            ("offsets", no_offsets.binding()),
            ("elements", no_elements.binding()),
        ];
        for params in batches {
            let items = device.zeroed::<u32>(params.pair_count as usize)?;
            cover.pairs(&params, &items, outputs)?;
            let mut starts = device.zeroed::<u32>(params.pair_count as usize)?;
            let item_count = scan::run(device, &items, &mut starts)?;
            if item_count == 0 {
                starts = device.zeroed(0)?;
            }
            let batch = Batch { params, starts, item_count };
            cover.items(&batch.params, &batch, outputs)?;
            cover.batches.push(batch);
        }
        Ok(cover)
    }

    /// Writes the elements of every list, in any order; uses up `counts`.
    pub(super) fn fill(
        &self,
        counts: &GpuBuffer<u32>,
        offsets: &GpuBuffer<u32>,
        elements: &GpuBuffer<LhbElement>,
    ) -> Result<()> {
        let outputs =
            [("counts", counts.binding()), ("offsets", offsets.binding()), ("elements", elements.binding())];
        let no_items = self.device.zeroed::<u32>(1)?;
        for batch in &self.batches {
            let params = RasterizeLhbBlock { fill: 1, ..batch.params };
            self.pairs(&params, &no_items, outputs)?;
            self.items(&params, batch, outputs)?;
        }
        Ok(())
    }

    fn pairs(&self, params: &RasterizeLhbBlock, items: &GpuBuffer<u32>, outputs: Outputs<'_>) -> Result<()> {
        let mut recorder = self.device.record("rasterize small triangles");
        if params.triangle_begin == 0 {
            let buffers = [
                ("views", self.views.binding()),
                ("vertices", self.mesh.vertices()),
                ("projected", self.projected.binding()),
            ];
            let workgroups = (params.view_count * params.vertex_count).div_ceil(WORKGROUP_SIZE);
            recorder.dispatch("project vertices", &self.project_vertices, params, &buffers, workgroups)?;
        }
        let buffers = [&self.inputs()[..], &outputs, &[("items", items.binding())]].concat();
        let workgroups = params.pair_count.div_ceil(WORKGROUP_SIZE);
        recorder.dispatch("rasterize pairs", &self.raster_pairs, params, &buffers, workgroups)?;
        recorder.run()
    }

    fn items(&self, params: &RasterizeLhbBlock, batch: &Batch, outputs: Outputs<'_>) -> Result<()> {
        let buffers = [&self.inputs()[..], &outputs, &[("starts", batch.starts.binding())]].concat();
        for item_begin in (0..batch.item_count).step_by(MAX_ITEMS as usize) {
            let item_end = batch.item_count.min(item_begin.saturating_add(MAX_ITEMS));
            let params = RasterizeLhbBlock { item_begin, item_end, ..*params };
            let mut recorder = self.device.record("rasterize large triangles");
            let workgroups = (item_end - item_begin).div_ceil(WORKGROUP_SIZE);
            recorder.dispatch("rasterize items", &self.raster_items, &params, &buffers, workgroups)?;
            recorder.run()?;
        }
        Ok(())
    }

    fn inputs(&self) -> [(&'static str, BufferRef<'_>); 2] {
        [("projected", self.projected.binding()), ("triangles", self.mesh.triangles())]
    }
}

/// The pairs of the triangles and views of `call` in batches of at most `most_pairs`, view after view; and of at most
/// `most_projected` projected vertices where that is one view or more.
fn batches(
    call: &RasterizeLhbBlock,
    most_pairs: u32,
    most_projected: u32,
) -> impl Iterator<Item = RasterizeLhbBlock> {
    let call = *call;
    let per_view = call.triangle_count.min(most_pairs).max(1);
    let view_step = (most_pairs / per_view).min(most_projected / call.vertex_count.max(1)).max(1);
    (0..call.view_count).step_by(view_step as usize).flat_map(move |view_begin| {
        let view_count = view_step.min(call.view_count - view_begin);
        (0..call.triangle_count).step_by(per_view as usize).map(move |triangle_begin| {
            let triangle_count = per_view.min(call.triangle_count - triangle_begin);
            let pair_count = view_count * triangle_count;
            RasterizeLhbBlock { view_begin, view_count, triangle_begin, triangle_count, pair_count, ..call }
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn batches_hold_every_pair_once() {
        for (view_count, triangle_count, most) in
            [(0, 5, 4), (3, 0, 4), (1, 1, 1), (7, 3, 10), (3, 10, 7), (5, 4, 4), (2, 9, 1), (9, 2, 100)]
        {
            let call = RasterizeLhbBlock {
                view_count,
                triangle_count,
                vertex_count: 5,
                ..RasterizeLhbBlock::zeroed()
            };
            let mut seen = vec![0; (view_count * triangle_count) as usize];
            for batch in batches(&call, most, 17) {
                assert!(batch.pair_count <= most && batch.view_count <= 3);
                for pair in 0..batch.pair_count {
                    let view = batch.view_begin + pair / batch.triangle_count;
                    let triangle = batch.triangle_begin + pair % batch.triangle_count;
                    seen[(view * triangle_count + triangle) as usize] += 1;
                }
            }
            assert!(seen.iter().all(|&times| times == 1), "{view_count} {triangle_count} {most}: {seen:?}");
        }
    }
}
