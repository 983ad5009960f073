// kernel family: pack_lhb
// contract core/src/kernels/pack_lhb.rs
// cpu backend-cpu/src/kernels/pack_lhb.rs
// gpu backend-gpu/src/kernels/pack_lhb.wgsl
// oracle conformance/src/oracle/pack_lhb.rs
//! Host side of `pack_lhb`.

use crate::backend::GpuBackend;
use crate::buffer::{BufferRef, GpuBuffer};
use crate::device::GpuDevice;
use crate::kernels::{scan, status};
use crate::shared;
use crate::source::{KernelSource, WgslFile};
use bytemuck::{Pod, Zeroable};
use twinlight_core::Result;
use twinlight_core::kernels::pack_lhb::{
    PackLhbParams, PackedLhb, PackedLhbBuffers, PackedShape, check_triangles, malformed,
};
use twinlight_core::kernels::rasterize_lhb::{CAP_NEAR, Lhb, LhbBuffers, LhbElement};

/// The WGSL.
pub const SOURCE: KernelSource = KernelSource {
    stem: "pack_lhb",
    files: &[
        shared::DISPATCH,
        shared::PACKED,
        WgslFile { path: "backend-gpu/src/kernels/pack_lhb.wgsl", text: include_str!("pack_lhb.wgsl") },
    ],
};

/// Words or lists per workgroup; twin of the WGSL constant.
pub const WORKGROUP_SIZE: u32 = 256;
/// Word of the status that tells of offsets that fall or leave their elements; twin of the WGSL constant.
pub const MALFORMED: u32 = 1;
/// Word of the status that tells of a triangle beyond the limit; twin of the WGSL constant.
pub const TRIANGLES: u32 = 2;

/// Twin of the WGSL struct.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct PackLhbBlock {
    /// Words per pixel, 0 for lists as long as they are.
    pub layers: u32,
    /// One of the `CAP_…` constants.
    pub cap_side: u32,
    /// Number of lists.
    pub list_count: u32,
    /// Number of elements.
    pub element_count: u32,
    /// Number of words.
    pub word_count: u32,
    /// 1 where it is known what was left out before.
    pub has_left_out: u32,
    /// For `loops_run`.
    pub loop_rounds: u32,
    /// Unused, 0.
    pub padding: u32,
}

impl PackLhbBlock {
    fn new(call: PackLhbParams, shape: PackedShape) -> Self {
        Self {
            layers: call.layers,
            cap_side: call.cap_side,
            list_count: shape.lists as u32,
            element_count: 0,
            word_count: shape.words,
            has_left_out: 0,
            loop_rounds: status::LOOP_ROUNDS,
            padding: 0,
        }
    }
}

/// Runs the kernel; see the contract.
///
/// # Errors
/// As [`twinlight_core::Backend::pack_lhb`]; [`twinlight_core::Error::LimitExceeded`] also for offsets, elements and words beyond one
/// binding, which fewer views per call avoid.
pub fn pack(
    device: &GpuDevice,
    lhb: &Lhb<GpuBackend>,
    params: &PackLhbParams,
) -> Result<PackedLhb<GpuBackend>> {
    let shape = params.check(lhb, GpuBuffer::len, lhb.elements.len())?;
    expect_bindable(device, shape, lhb.elements.len())?;
    let words = device.zeroed::<u32>(shape.words as usize)?;
    let (entry, offsets, left_out) = if params.layers > 0 {
        ("fill_layers", device.zeroed(0)?, device.zeroed(shape.lists)?)
    } else {
        ("pack_elements", device.copied(&lhb.offsets)?, device.copied(&lhb.left_out)?)
    };
    let block = PackLhbBlock {
        element_count: lhb.elements.len() as u32,
        has_left_out: u32::from(!lhb.left_out.is_empty()),
        ..PackLhbBlock::new(*params, shape)
    };
    let status = dispatched(
        device,
        entry,
        &block,
        block.word_count,
        &[
            ("list_offsets", lhb.offsets.binding()),
            ("list_elements", lhb.elements.binding()),
            ("list_left_out", lhb.left_out.binding()),
            ("words", words.binding()),
            ("left_out", left_out.binding()),
        ],
    )?;
    if status[MALFORMED as usize] != 0 {
        return Err(malformed());
    }
    check_triangles(status[TRIANGLES as usize].saturating_sub(1))?;
    let PackLhbParams { layers, .. } = *params;
    Ok(PackedLhbBuffers { size: lhb.size, view_count: lhb.view_count, layers, offsets, words, left_out })
}

/// Runs the way back; see the contract.
///
/// # Errors
/// As [`twinlight_core::Backend::unpack_lhb`]; [`twinlight_core::Error::LimitExceeded`] also for offsets, elements and words beyond one
/// binding.
pub fn unpack(device: &GpuDevice, packed: &PackedLhb<GpuBackend>) -> Result<Lhb<GpuBackend>> {
    let shape = packed.check(GpuBuffer::len)?;
    expect_bindable(device, shape, 0)?;
    let block = PackLhbBlock::new(PackLhbParams { layers: packed.layers, cap_side: CAP_NEAR }, shape);
    let (entry, offsets, element_count) = if packed.layers > 0 {
        let (offsets, element_count) = sized(device, packed, &block)?;
        ("unpack_layers", offsets, element_count)
    } else {
        ("unpack_words", device.copied(&packed.offsets)?, shape.words)
    };
    device.expect_bindable::<LhbElement>("elements of layered hit buffers", element_count as usize)?;
    let elements = device.zeroed::<LhbElement>(element_count as usize)?;
    let buffers = [
        ("packed_words", packed.words.binding()),
        ("offsets", offsets.binding()),
        ("elements", elements.binding()),
    ];
    dispatched(device, entry, &block, block.word_count, &buffers)?;
    let left_out = device.copied(&packed.left_out)?;
    Ok(LhbBuffers { size: packed.size, view_count: packed.view_count, offsets, elements, left_out })
}

/// Refuses what kernels need at once and one binding has no room for.
fn expect_bindable(device: &GpuDevice, shape: PackedShape, elements: usize) -> Result<()> {
    device.expect_bindable::<u32>("offsets of layered hit buffers", shape.lists + 1)?;
    device.expect_bindable::<LhbElement>("elements of layered hit buffers", elements)?;
    device.expect_bindable::<u32>("words of packed layered hit buffers", shape.words as usize)
}

/// The offsets of lists in layers, and the number of their elements.
fn sized(
    device: &GpuDevice,
    packed: &PackedLhb<GpuBackend>,
    block: &PackLhbBlock,
) -> Result<(GpuBuffer<u32>, u32)> {
    let sizes = device.zeroed::<u32>(block.list_count as usize + 1)?;
    let buffers = [("packed_words", packed.words.binding()), ("sizes", sizes.binding())];
    dispatched(device, "size_layers", block, block.list_count, &buffers)?;
    let mut offsets = device.zeroed::<u32>(sizes.len())?;
    let total = scan::run(device, &sizes, &mut offsets)?;
    Ok((offsets, total))
}

/// Runs an entry point for `count` invocations; returns the status.
fn dispatched(
    device: &GpuDevice,
    entry: &'static str,
    block: &PackLhbBlock,
    count: u32,
    buffers: &[(&'static str, BufferRef<'_>)],
) -> Result<Vec<u32>> {
    let status = status::new(device)?;
    let buffers = [buffers, &[("status", status.binding())]].concat();
    let pipeline = device.pipeline(&SOURCE, entry)?;
    let mut recorder = device.record(entry);
    recorder.dispatch(entry, &pipeline, block, &buffers, count.div_ceil(WORKGROUP_SIZE))?;
    recorder.run()?;
    status::read(device, &status, "pack_lhb")
}
