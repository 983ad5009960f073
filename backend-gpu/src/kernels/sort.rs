// kernel family: sort
// contract core/src/kernels/sort.rs
// cpu backend-cpu/src/kernels/sort.rs
// gpu backend-gpu/src/kernels/sort.wgsl
// oracle conformance/src/oracle/sort.rs
//! Host side of `sort`.

use crate::buffer::{BufferRef, GpuBuffer};
use crate::device::GpuDevice;
use crate::kernels::scan::{self, Scan};
use crate::source::{KernelSource, WgslFile};
use bytemuck::{Pod, Zeroable};
use twinlight_core::kernels::sort::MAX_LEN;
use twinlight_core::{Error, Result};

/// The WGSL.
pub const SOURCE: KernelSource = KernelSource {
    stem: "sort",
    files: &[WgslFile { path: "backend-gpu/src/kernels/sort.wgsl", text: include_str!("sort.wgsl") }],
};

/// Pairs per workgroup; twin of the WGSL constant.
pub const TILE_SIZE: u32 = 2048;
/// Bits sorted by in one pass; twin of the WGSL constant.
pub const DIGIT_BITS: u32 = 4;
/// Values of a digit; twin of the WGSL constant.
pub const DIGITS: u32 = 16;

/// Counts up to this many are scanned by one workgroup: on software adapters two dispatches less are worth more than
/// a second thread, and on a GPU four rounds of one workgroup cost about as much as two dispatches.
const SHORT_SCAN: u32 = 4 * scan::TILE_SIZE;

/// Twin of the WGSL struct.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct SortParams {
    /// Pairs.
    pub count: u32,
    /// Tiles that hold them.
    pub tile_count: u32,
    /// Words per key: 1, or 2 with the low one first.
    pub key_words: u32,
    /// The word that this pass sorts by.
    pub word: u32,
    /// The digit's lowest bit in it.
    pub shift: u32,
}

/// Runs the kernel on keys of one or two words; see the contract.
///
/// # Errors
/// [`Error::InvalidInput`] when the lengths differ, [`Error::LimitExceeded`] beyond [`MAX_LEN`] or a binding's size.
pub fn run<K: Pod>(device: &GpuDevice, keys: &mut GpuBuffer<K>, payload: &mut GpuBuffer<u32>) -> Result<()> {
    if keys.len() != payload.len() {
        return Err(Error::invalid("sort", format!("{} keys, {} payloads", keys.len(), payload.len())));
    }
    if keys.len() > MAX_LEN {
        return Err(Error::limit("pairs of sort", keys.len() as u64, MAX_LEN as u64));
    }
    if keys.len() < 2 {
        return Ok(());
    }
    let count = keys.len() as u32;
    let key_words = (size_of::<K>() / size_of::<u32>()) as u32;
    let tile_count = count.div_ceil(TILE_SIZE);
    let count_digits = device.pipeline(&SOURCE, "count_digits")?;
    let scatter_pairs = device.pipeline(&SOURCE, "scatter_pairs")?;
    let scan = Scan::new(device)?;

    let digit_count = DIGITS * tile_count;
    let short = digit_count <= SHORT_SCAN;
    let keys_back = device.zeroed::<K>(keys.len())?;
    let payload_back = device.zeroed::<u32>(payload.len())?;
    let digit_counts = device.zeroed::<u32>(digit_count as usize + 1)?;
    let digit_offsets = device.zeroed::<u32>(if short { 0 } else { digit_count as usize })?;
    let tile_sums = device.zeroed::<u32>(digit_count.div_ceil(scan::TILE_SIZE) as usize + 1)?;

    let mut front = (keys.binding(), payload.binding());
    let mut back = (keys_back.binding(), payload_back.binding());
    let offsets: BufferRef<'_> = if short { digit_counts.binding() } else { digit_offsets.binding() };
    let mut recorder = device.record("sort pairs by key");
    for word in 0..key_words {
        for shift in (0..u32::BITS).step_by(DIGIT_BITS as usize) {
            let params = SortParams { count, tile_count, key_words, word, shift };
            let buffers = [("keys_front", front.0), ("digit_counts", digit_counts.binding())];
            recorder.dispatch("count digits", &count_digits, &params, &buffers, tile_count)?;
            if short {
                scan.record_in_place(&mut recorder, digit_count, digit_counts.binding())?;
            } else {
                let len = (digit_count as usize, scan::chunk(device));
                scan.record(&mut recorder, &digit_counts, &tile_sums, &digit_offsets, len)?;
            }
            let buffers = [
                ("keys_front", front.0),
                ("payload_front", front.1),
                ("digit_offsets", offsets),
                ("keys_back", back.0),
                ("payload_back", back.1),
            ];
            recorder.dispatch("scatter pairs", &scatter_pairs, &params, &buffers, tile_count)?;
            std::mem::swap(&mut front, &mut back);
        }
    }
    // 8 or 16 passes: the last one wrote the caller's buffers.
    recorder.run()
}
