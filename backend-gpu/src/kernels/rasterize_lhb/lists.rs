//! Sizes, order and cap of the lists.

use super::{LISTS_PER_LANE, ListSums, ListTile, RasterizeLhbBlock, SOURCE, TILE_SIZE, WORKGROUP_SIZE};
use crate::buffer::GpuBuffer;
use crate::device::GpuDevice;
use crate::kernels::{scan, status};
use bytemuck::Zeroable;
use twinlight_core::kernels::rasterize_lhb::{LhbElement, RasterizeLhbParams, check_elements};
use twinlight_core::{Error, Result};

/// The lists of a call, and what must be known before there are any.
pub(super) struct Lists<'a> {
    device: &'a GpuDevice,
    params: RasterizeLhbBlock,
    pub(super) element_count: u32,
    longest: u32,
}

/// Offsets and elements.
type Contents = (GpuBuffer<u32>, GpuBuffer<LhbElement>);

impl<'a> Lists<'a> {
    /// Sums up `counts`, one per list and a 0.
    ///
    /// # Errors
    /// [`Error::LimitExceeded`] for more elements than `offsets` or a binding can hold.
    pub(super) fn measure(
        device: &'a GpuDevice,
        call: &RasterizeLhbParams,
        counts: &GpuBuffer<u32>,
    ) -> Result<Self> {
        let params = RasterizeLhbBlock {
            call: *call,
            list_count: counts.len() as u32 - 1,
            loop_rounds: status::LOOP_ROUNDS,
            ..RasterizeLhbBlock::zeroed()
        };
        let groups = params.list_count.div_ceil(WORKGROUP_SIZE * LISTS_PER_LANE);
        let sums = device.zeroed::<ListSums>(groups as usize)?;
        let mut recorder = device.record("sum up layers");
        let pipeline = device.pipeline(&SOURCE, "sum_lists")?;
        let buffers = [("counts", counts.binding()), ("list_sums", sums.binding())];
        recorder.dispatch("sum lists", &pipeline, &params, &buffers, groups)?;
        recorder.run()?;
        let sums = device.download(&sums)?;
        let of = |s: &ListSums| u64::from(s.elements_high) << 32 | u64::from(s.elements_low);
        let element_count = check_elements(sums.iter().map(of).sum())?;
        device.expect_bindable::<LhbElement>("elements of layered hit buffers", element_count as usize)?;
        let longest = sums.iter().map(|s| s.longest).max().unwrap_or(0);
        // Tiles are fewer than elements.
        let tile_count = sums.iter().map(|s| s.tiles).sum();
        Ok(Self { device, params: RasterizeLhbBlock { tile_count, ..params }, element_count, longest })
    }

    /// Sorts every list.
    pub(super) fn sort(&self, offsets: &GpuBuffer<u32>, elements: &GpuBuffer<LhbElement>) -> Result<()> {
        if self.element_count == 0 {
            return Ok(());
        }
        let (device, params) = (self.device, &self.params);
        let status = status::new(device)?;
        let tiles = device.zeroed::<ListTile>(params.tile_count as usize)?;
        let several_tiles = self.longest > TILE_SIZE;
        let moved = device.zeroed::<LhbElement>(if several_tiles { elements.len() } else { 0 })?;
        let mut recorder = device.record("sort layers");
        let pipeline = device.pipeline(&SOURCE, "sort_lists")?;
        let buffers = [
            ("offsets", offsets.binding()),
            ("elements", elements.binding()),
            ("new_tiles", tiles.binding()),
            ("status", status.binding()),
        ];
        let workgroups = params.list_count.div_ceil(WORKGROUP_SIZE);
        recorder.dispatch("sort short lists", &pipeline, params, &buffers, workgroups)?;
        let pipeline = device.pipeline(&SOURCE, "sort_tiles")?;
        let (tiles, elements) = (("tiles", tiles.binding()), elements.binding());
        let buffers = [tiles, ("elements", elements)];
        recorder.dispatch("sort tiles", &pipeline, params, &buffers, params.tile_count)?;
        if several_tiles {
            let pipeline = device.pipeline(&SOURCE, "merge_runs")?;
            let (mut from, mut to) = (elements, moved.binding());
            for round in 0..merge_rounds(self.longest) {
                let params = RasterizeLhbBlock { run: TILE_SIZE << round, ..*params };
                let buffers = [tiles, ("elements", from), ("moved", to)];
                recorder.dispatch("merge runs", &pipeline, &params, &buffers, params.tile_count)?;
                std::mem::swap(&mut from, &mut to);
            }
        }
        recorder.run()?;
        let words = status::read(device, &status, "rasterize_lhb")?;
        if words[1] != params.tile_count {
            return Err(Error::Internal(format!("{} tiles, {} were expected", words[1], params.tile_count)));
        }
        Ok(())
    }

    /// What the cap keeps; overwrites `counts`.
    pub(super) fn cap(
        &self,
        counts: &GpuBuffer<u32>,
        offsets: GpuBuffer<u32>,
        elements: GpuBuffer<LhbElement>,
        left_out: &GpuBuffer<u32>,
    ) -> Result<Contents> {
        let device = self.device;
        let mut recorder = device.record("cap layers");
        let pipeline = device.pipeline(&SOURCE, "cap_lists")?;
        let buffers =
            [("offsets", offsets.binding()), ("counts", counts.binding()), ("left_out", left_out.binding())];
        let workgroups = self.params.list_count.div_ceil(WORKGROUP_SIZE);
        recorder.dispatch("cap lists", &pipeline, &self.params, &buffers, workgroups)?;
        recorder.run()?;
        let mut starts = device.zeroed::<u32>(offsets.len())?;
        let element_count = scan::run(device, counts, &mut starts)?;
        let kept = device.zeroed::<LhbElement>(element_count as usize)?;
        let mut recorder = device.record("copy what the cap keeps");
        let pipeline = device.pipeline(&SOURCE, "copy_capped")?;
        let params = RasterizeLhbBlock { element_count, ..self.params };
        let buffers = [
            ("offsets", offsets.binding()),
            ("elements", elements.binding()),
            ("starts", starts.binding()),
            ("moved", kept.binding()),
        ];
        let workgroups = element_count.div_ceil(WORKGROUP_SIZE);
        recorder.dispatch("copy elements", &pipeline, &params, &buffers, workgroups)?;
        recorder.run()?;
        Ok((starts, kept))
    }
}

/// Rounds of merging until runs are as long as the longest list: an even number, so that they end where they began.
fn merge_rounds(longest: u32) -> u32 {
    longest.div_ceil(TILE_SIZE).next_power_of_two().trailing_zeros().next_multiple_of(2)
}
