// kernel family: merge_lhb
// contract core/src/kernels/merge_lhb.rs
// cpu backend-cpu/src/kernels/merge_lhb.rs
// gpu backend-gpu/src/kernels/merge_lhb.wgsl
// oracle conformance/src/oracle/merge_lhb.rs
//! Host side of `merge_lhb`.

use crate::backend::GpuBackend;
use crate::buffer::{BufferRef, GpuBuffer};
use crate::device::GpuDevice;
use crate::kernels::{scan, status};
use crate::shared;
use crate::source::{KernelSource, WgslFile};
use bytemuck::{Pod, Zeroable};
use twinlight_core::kernels::merge_lhb::MergeLhbParams;
use twinlight_core::kernels::rasterize_lhb::{Lhb, LhbBuffers, LhbElement, check_elements};
use twinlight_core::{Error, Result};

/// The WGSL.
pub const SOURCE: KernelSource = KernelSource {
    stem: "merge_lhb",
    files: &[
        shared::DISPATCH,
        WgslFile { path: "backend-gpu/src/kernels/merge_lhb.wgsl", text: include_str!("merge_lhb.wgsl") },
    ],
};

/// Lists or elements per workgroup; twin of the WGSL constant.
pub const WORKGROUP_SIZE: u32 = 256;
/// Word of the status that tells of offsets that fall or leave their elements; twin of the WGSL constant.
pub const MALFORMED: u32 = 1;
/// Word of the status that tells of lists beyond one invocation's work; twin of the WGSL constant.
pub const HAS_LONG_LISTS: u32 = 2;

/// Twin of the WGSL struct.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct MergeLhbBlock {
    /// The contract's parameters.
    pub call: MergeLhbParams,
    /// Number of lists.
    pub list_count: u32,
    /// Elements of what is kept.
    pub kept_count: u32,
    /// Elements of what is added.
    pub added_count: u32,
    /// Elements of the result.
    pub element_count: u32,
    /// For `loops_run`.
    pub loop_rounds: u32,
}

/// Runs the kernel; see the contract. Lists of more than 1024 elements in both inputs are merged by search, which supposes that
/// they are sorted, as those of `rasterize_lhb` are.
///
/// # Errors
/// [`Error::InvalidInput`], also for offsets that fall or leave their elements; [`Error::LimitExceeded`] by the contract's limits
/// and for lists or elements beyond one binding, which fewer views per call avoid; [`Error::OutOfMemory`];
/// [`Error::Unsupported`] when the driver ends loops early.
pub fn run(
    device: &GpuDevice,
    kept: &Lhb<GpuBackend>,
    added: &Lhb<GpuBackend>,
    params: &MergeLhbParams,
) -> Result<Lhb<GpuBackend>> {
    let merge = Merge::new(device, kept, added, params)?;
    let left_out = device.zeroed::<u32>(kept.left_out.len())?;
    let (sizes, has_long_lists) = merge.size(&left_out)?;
    let (offsets, element_count) = if params.layer_cap > 0 {
        let mut offsets = device.zeroed::<u32>(sizes.len())?;
        let total = scan::run(device, &sizes, &mut offsets)?;
        (offsets, total)
    } else {
        let total = device.download_range(&sizes, sizes.len() - 1, 1)?[0];
        (sizes, total)
    };
    let elements = merge.merge(&offsets, element_count, has_long_lists)?;
    Ok(LhbBuffers { size: kept.size, view_count: kept.view_count, offsets, elements, left_out })
}

/// A call.
struct Merge<'a> {
    device: &'a GpuDevice,
    kept: &'a Lhb<GpuBackend>,
    added: &'a Lhb<GpuBackend>,
    params: MergeLhbBlock,
}

impl<'a> Merge<'a> {
    /// Checks the inputs.
    ///
    /// # Errors
    /// [`Error::InvalidInput`] by the contract; [`Error::LimitExceeded`] for inputs that are beyond a binding or, before the cap, as
    /// long as no offset can tell.
    fn new(
        device: &'a GpuDevice,
        kept: &'a Lhb<GpuBackend>,
        added: &'a Lhb<GpuBackend>,
        params: &MergeLhbParams,
    ) -> Result<Self> {
        let list_count = params.check(kept, added, GpuBuffer::len)?;
        device.expect_bindable::<u32>("offsets of layered hit buffers", list_count + 1)?;
        let counts = [kept, added].map(|lhb| lhb.elements.len());
        // From here on, sums of offsets are below 2³².
        check_elements(counts[0] as u64 + counts[1] as u64)?;
        let params = MergeLhbBlock {
            call: *params,
            list_count: list_count as u32,
            kept_count: counts[0] as u32,
            added_count: counts[1] as u32,
            element_count: 0,
            loop_rounds: status::LOOP_ROUNDS,
        };
        Ok(Self { device, kept, added, params })
    }

    /// The inputs by their WGSL names, and `own` behind them.
    fn buffers_and<'b>(
        &'b self,
        own: &[(&'static str, BufferRef<'b>)],
    ) -> Vec<(&'static str, BufferRef<'b>)> {
        let mut buffers = vec![
            ("kept_offsets", self.kept.offsets.binding()),
            ("kept_elements", self.kept.elements.binding()),
            ("kept_left_out", self.kept.left_out.binding()),
            ("added_offsets", self.added.offsets.binding()),
            ("added_elements", self.added.elements.binding()),
            ("added_left_out", self.added.left_out.binding()),
        ];
        buffers.extend_from_slice(own);
        buffers
    }

    /// The WGSL's `sizes`, of which there is one more than lists, and whether there are long lists.
    fn size(&self, left_out: &GpuBuffer<u32>) -> Result<(GpuBuffer<u32>, bool)> {
        let device = self.device;
        // With a cap the last stays 0, so that the scan ends with the total.
        let sizes = device.zeroed::<u32>(self.kept.offsets.len())?;
        let status = status::new(device)?;
        let mut recorder = device.record("size merged lists");
        let pipeline = device.pipeline(&SOURCE, "size_lists")?;
        let buffers = self.buffers_and(&[
            ("sizes", sizes.binding()),
            ("left_out", left_out.binding()),
            ("status", status.binding()),
        ]);
        let workgroups = (self.params.list_count + 1).div_ceil(WORKGROUP_SIZE);
        recorder.dispatch("size lists", &pipeline, &self.params, &buffers, workgroups)?;
        recorder.run()?;
        let words = status::read(device, &status, "merge_lhb")?;
        if words[MALFORMED as usize] != 0 {
            return Err(Error::invalid("merge_lhb", "offsets fall or leave their elements"));
        }
        Ok((sizes, words[HAS_LONG_LISTS as usize] != 0))
    }

    /// The elements.
    fn merge(
        &self,
        offsets: &GpuBuffer<u32>,
        element_count: u32,
        has_long_lists: bool,
    ) -> Result<GpuBuffer<LhbElement>> {
        let device = self.device;
        device.expect_bindable::<LhbElement>("elements of layered hit buffers", element_count as usize)?;
        let elements = device.zeroed::<LhbElement>(element_count as usize)?;
        let params = MergeLhbBlock { element_count, ..self.params };
        let status = status::new(device)?;
        let buffers = self.buffers_and(&[
            ("offsets", offsets.binding()),
            ("elements", elements.binding()),
            ("status", status.binding()),
        ]);
        let mut recorder = device.record("merge lists");
        let pipeline = device.pipeline(&SOURCE, "merge_lists")?;
        let workgroups = params.list_count.div_ceil(WORKGROUP_SIZE);
        recorder.dispatch("merge lists", &pipeline, &params, &buffers, workgroups)?;
        if has_long_lists {
            let pipeline = device.pipeline(&SOURCE, "merge_long_lists")?;
            let workgroups = element_count.div_ceil(WORKGROUP_SIZE);
            recorder.dispatch("merge long lists", &pipeline, &params, &buffers, workgroups)?;
        }
        recorder.run()?;
        status::read(device, &status, "merge_lhb")?;
        Ok(elements)
    }
}
