// kernel family: sort
// contract core/src/kernels/sort.rs
// cpu backend-cpu/src/kernels/sort.rs
// gpu backend-gpu/src/kernels/sort.wgsl
// oracle conformance/src/oracle/sort.rs
//! Host side of `sort`.

mod merge;

use crate::buffer::{GpuBuffer, chunks};
use crate::device::GpuDevice;
use crate::dispatch::Recorder;
use crate::kernels::scan::{self, Scan};
use crate::pipeline::Pipeline;
use crate::source::{KernelSource, WgslFile};
use bytemuck::{Pod, Zeroable};
use std::ops::Range;
use std::sync::Arc;
use twinlight_core::kernels::sort::MAX_LEN;
use twinlight_core::{Error, Result};

/// The WGSL.
pub const SOURCE: KernelSource = KernelSource {
    stem: "sort",
    files: &[WgslFile { path: "backend-gpu/src/kernels/sort.wgsl", text: include_str!("sort.wgsl") }],
};

/// Invocations per workgroup, each with one pair in the merge; twin of the WGSL constant.
pub const WORKGROUP_SIZE: u32 = 256;
/// Pairs per workgroup of a pass; twin of the WGSL constant.
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
    /// Keys of the other chunk.
    pub other_count: u32,
    /// 1 when its equal keys go before this chunk's.
    pub other_first: u32,
    /// The first place of the result that the output holds.
    pub window_begin: u32,
    /// How many it holds.
    pub window_count: u32,
}

/// Runs the kernel on keys of one or two words; see the contract. More pairs than a binding holds are sorted in chunks,
/// which are then merged.
///
/// # Errors
/// [`Error::InvalidInput`] when the lengths differ, [`Error::LimitExceeded`] beyond [`MAX_LEN`] or where a binding holds
/// too little for one chunk.
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
    let keys_back = device.zeroed::<K>(keys.len())?;
    let payload_back = device.zeroed::<u32>(payload.len())?;
    let back = Pairs { keys: &keys_back, payload: &payload_back };
    let parts: Vec<Range<usize>> = chunks(keys.len(), device.elements_per_binding(size_of::<K>())).collect();
    let passes = Passes::new(device, parts[0].len())?;
    let ranks = device.zeroed::<u32>(if parts.len() > 1 { keys.len() } else { 0 })?;
    let mut recorder = device.record("sort pairs by key");
    let front = Pairs { keys, payload };
    for part in &parts {
        passes.record(&mut recorder, front, back, part.clone())?;
    }
    if parts.len() > 1 {
        merge::record(device, &mut recorder, front, back, &ranks, &parts)?;
    }
    recorder.run()?;
    if parts.len() > 1 {
        *keys = keys_back;
        *payload = payload_back;
    }
    Ok(())
}

/// Keys and payloads.
#[derive(Debug)]
struct Pairs<'a, K> {
    keys: &'a GpuBuffer<K>,
    payload: &'a GpuBuffer<u32>,
}

impl<K> Clone for Pairs<'_, K> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<K> Copy for Pairs<'_, K> {}

impl<K> Pairs<'_, K> {
    /// Words per key.
    fn key_words(&self) -> u32 {
        (size_of::<K>() / size_of::<u32>()) as u32
    }
}

/// The passes over the digits of a chunk, and what they need between them.
struct Passes {
    count_digits: Arc<Pipeline>,
    scatter_pairs: Arc<Pipeline>,
    scan: Scan,
    scan_chunk: usize,
    digit_counts: GpuBuffer<u32>,
    digit_offsets: GpuBuffer<u32>,
    tile_sums: GpuBuffer<u32>,
}

impl Passes {
    /// For chunks of at most `most` pairs.
    fn new(device: &GpuDevice, most: usize) -> Result<Self> {
        let digit_count = DIGITS * (most as u32).div_ceil(TILE_SIZE);
        let long = if digit_count <= SHORT_SCAN { 0 } else { digit_count };
        Ok(Self {
            count_digits: device.pipeline(&SOURCE, "count_digits")?,
            scatter_pairs: device.pipeline(&SOURCE, "scatter_pairs")?,
            scan: Scan::new(device)?,
            scan_chunk: scan::chunk(device),
            digit_counts: device.zeroed(digit_count as usize + 1)?,
            digit_offsets: device.zeroed(long as usize)?,
            tile_sums: device.zeroed(digit_count.div_ceil(scan::TILE_SIZE) as usize + 1)?,
        })
    }

    /// Records the sort of `part`. There are 8 or 16 passes, so that the last one writes `front`.
    fn record<'a, K: Pod>(
        &'a self,
        recorder: &mut Recorder<'a>,
        front: Pairs<'a, K>,
        back: Pairs<'a, K>,
        part: Range<usize>,
    ) -> Result<()> {
        let count = part.len() as u32;
        let tile_count = count.div_ceil(TILE_SIZE);
        let digit_count = DIGITS * tile_count;
        let counts = self.digit_counts.binding();
        let short = digit_count <= SHORT_SCAN;
        let offsets = if short { counts } else { self.digit_offsets.binding() };
        let bind = |pairs: Pairs<'a, K>| {
            (pairs.keys.binding_of(part.clone()), pairs.payload.binding_of(part.clone()))
        };
        let (mut from, mut to) = (bind(front), bind(back));
        for word in 0..front.key_words() {
            for shift in (0..u32::BITS).step_by(DIGIT_BITS as usize) {
                let key_words = front.key_words();
                let params = SortParams { count, tile_count, key_words, word, shift, ..SortParams::zeroed() };
                let buffers = [("keys_front", from.0), ("digit_counts", counts)];
                recorder.dispatch("count digits", &self.count_digits, &params, &buffers, tile_count)?;
                if short {
                    self.scan.record_in_place(recorder, digit_count, counts)?;
                } else {
                    let len = (digit_count as usize, self.scan_chunk);
                    let (counts, sums) = (&self.digit_counts, &self.tile_sums);
                    self.scan.record(recorder, counts, sums, &self.digit_offsets, len)?;
                }
                let buffers = [
                    ("keys_front", from.0),
                    ("payload_front", from.1),
                    ("digit_offsets", offsets),
                    ("keys_back", to.0),
                    ("payload_back", to.1),
                ];
                recorder.dispatch("scatter pairs", &self.scatter_pairs, &params, &buffers, tile_count)?;
                std::mem::swap(&mut from, &mut to);
            }
        }
        Ok(())
    }
}
