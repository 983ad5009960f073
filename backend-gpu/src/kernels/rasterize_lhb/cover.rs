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

/// Items per submission, of at most 2¹⁰ pixels each: a submission that takes seconds looks like a device that hangs.
const MAX_ITEMS: u32 = 1 << 18;

/// The traversal after the first round.
pub(super) struct Cover<'a> {
    device: &'a GpuDevice,
    mesh: &'a GpuMesh,
    views: GpuBuffer<View>,
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
        let most = device.elements_per_binding(size_of::<u32>()).clamp(1, MAX_PAIRS);
        let mut cover = Self {
            device,
            mesh,
            views: upload(device, "views", views)?,
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
        for params in batches(views.len() as u32, mesh.triangle_count(), params, most as u32) {
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

    fn inputs(&self) -> [(&'static str, BufferRef<'_>); 3] {
        let [vertices, triangles] = self.mesh.buffers();
        [("views", self.views.binding()), vertices, triangles]
    }
}

/// The pairs of `triangles` triangles and `views` views in batches of at most `most`.
fn batches(
    views: u32,
    triangles: u32,
    call: &RasterizeLhbParams,
    most: u32,
) -> impl Iterator<Item = RasterizeLhbBlock> {
    let call = *call;
    let per_view = triangles.min(most).max(1);
    let view_step = most / per_view;
    (0..views).step_by(view_step as usize).flat_map(move |view_begin| {
        let view_count = view_step.min(views - view_begin);
        (0..triangles).step_by(per_view as usize).map(move |triangle_begin| {
            let triangle_count = per_view.min(triangles - triangle_begin);
            let pair_count = view_count * triangle_count;
            let zero = RasterizeLhbBlock::zeroed();
            RasterizeLhbBlock { call, view_begin, triangle_begin, triangle_count, pair_count, ..zero }
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn batches_hold_every_pair_once() {
        for (views, triangles, most) in
            [(0, 5, 4), (3, 0, 4), (1, 1, 1), (7, 3, 10), (3, 10, 7), (5, 4, 4), (2, 9, 1)]
        {
            let mut seen = vec![0; (views * triangles) as usize];
            for batch in batches(views, triangles, &RasterizeLhbParams::new(8), most) {
                assert!(batch.pair_count <= most);
                for pair in 0..batch.pair_count {
                    let view = batch.view_begin + pair / batch.triangle_count;
                    let triangle = batch.triangle_begin + pair % batch.triangle_count;
                    seen[(view * triangles + triangle) as usize] += 1;
                }
            }
            assert!(seen.iter().all(|&times| times == 1), "{views} {triangles} {most}: {seen:?}");
        }
    }
}
