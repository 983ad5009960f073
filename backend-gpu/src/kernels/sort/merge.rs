//! Sorted chunks become one: every pair is told its place among all, then every window of the result is filled.

use super::{Pairs, SOURCE, SortParams, WORKGROUP_SIZE};
use crate::buffer::GpuBuffer;
use crate::device::GpuDevice;
use crate::dispatch::Recorder;
use bytemuck::{Pod, Zeroable};
use std::ops::Range;
use twinlight_core::Result;

/// Records the merge of the sorted `parts` of `front` into `back`. `ranks` is zeroed, a word per pair.
pub(super) fn record<'a, K: Pod>(
    device: &GpuDevice,
    recorder: &mut Recorder<'a>,
    front: Pairs<'a, K>,
    back: Pairs<'a, K>,
    ranks: &'a GpuBuffer<u32>,
    parts: &[Range<usize>],
) -> Result<()> {
    let add_ranks = device.pipeline(&SOURCE, "add_ranks")?;
    let place_pairs = device.pipeline(&SOURCE, "place_pairs")?;
    for (i, part) in parts.iter().enumerate() {
        let own =
            SortParams { count: part.len() as u32, key_words: front.key_words(), ..SortParams::zeroed() };
        let workgroups = own.count.div_ceil(WORKGROUP_SIZE);
        let keys = ("keys_front", front.keys.binding_of(part.clone()));
        let ranks = ("ranks", ranks.binding_of(part.clone()));
        for (k, other) in parts.iter().enumerate().filter(|(k, _)| *k != i) {
            // Chunks are in input order, which equal keys keep.
            let params = SortParams { other_count: other.len() as u32, other_first: u32::from(k < i), ..own };
            let buffers = [keys, ranks, ("keys_other", front.keys.binding_of(other.clone()))];
            recorder.dispatch("rank among another chunk", &add_ranks, &params, &buffers, workgroups)?;
        }
        for window in parts {
            let window_begin = window.start as u32;
            let params = SortParams { window_begin, window_count: window.len() as u32, ..own };
            let buffers = [
                keys,
                ranks,
                ("payload_front", front.payload.binding_of(part.clone())),
                ("keys_back", back.keys.binding_of(window.clone())),
                ("payload_back", back.payload.binding_of(window.clone())),
            ];
            recorder.dispatch("fill a window", &place_pairs, &params, &buffers, workgroups)?;
        }
    }
    Ok(())
}
