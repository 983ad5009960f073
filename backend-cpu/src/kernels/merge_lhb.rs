// kernel family: merge_lhb
// contract core/src/kernels/merge_lhb.rs
// cpu backend-cpu/src/kernels/merge_lhb.rs
// gpu backend-gpu/src/kernels/merge_lhb.wgsl
// oracle conformance/src/oracle/merge_lhb.rs
//! `merge_lhb`: lists are taken in chunks of a fixed number. Without a cap the inputs' own offsets say where a chunk's elements
//! go, so that one pass over memory adds offsets and merges elements; with one, a pass over the offsets sizes the lists
//! before. Most lists have nothing added: runs of them are copied as one.

use crate::buffer::try_zeroed;
use crate::{CpuBackend, CpuBuffer};
use rayon::prelude::*;
use twinlight_core::kernels::merge_lhb::MergeLhbParams;
use twinlight_core::kernels::rasterize_lhb::{Lhb, LhbBuffers, LhbElement, check_elements};
use twinlight_core::{Error, Result};

mod lists;
mod pair;

use lists::Lists;
use pair::Pair;

/// Lists per task: their offsets and elements stay in a core's cache between the steps of a task.
const CHUNK: usize = 2048;

pub(crate) fn merge_lhb(
    kept: &Lhb<CpuBackend>,
    added: &Lhb<CpuBackend>,
    params: &MergeLhbParams,
) -> Result<Lhb<CpuBackend>> {
    let (kept_lists, added_lists) = (Lists::of(kept)?, Lists::of(added)?);
    let list_count = kept_lists.len();
    let chunks = (0..list_count).step_by(CHUNK).map(|begin| begin..list_count.min(begin + CHUNK));
    let pairs = chunks
        .map(|chunk| {
            Ok(Pair { kept: kept_lists.part(chunk.clone())?, added: added_lists.part(chunk)?, params })
        })
        .collect::<Result<Vec<Pair<'_>>>>()?;
    let is_capped = params.layer_cap > 0;
    let mut offsets = try_zeroed::<u32>(list_count + 1)?;
    let mut left_out = try_zeroed::<u32>(if is_capped { list_count } else { 0 })?;
    // [1] size
    let sizes: Vec<u64> = if is_capped {
        let ends = offsets[1..].par_chunks_mut(CHUNK);
        let outs = ends.zip(left_out.par_chunks_mut(CHUNK)).zip(&pairs);
        outs.map(|((ends, left_out), pair)| pair.size(ends, left_out)).collect::<Result<_>>()?
    } else {
        pairs.iter().map(Pair::len).collect()
    };
    // [2] scan
    let first = if is_capped { 0 } else { kept_lists.begin() + added_lists.begin() };
    let (begins, total) = scan(first, &sizes);
    let count = check_elements(total)? as usize;
    offsets[0] = first as u32;
    let mut elements = try_zeroed::<LhbElement>(count)?;
    // [3] merge
    let parts = split(&mut elements[first as usize..], &sizes);
    let outs = parts.into_par_iter().zip(offsets[1..].par_chunks_mut(CHUNK));
    outs.zip(&pairs).zip(begins).try_for_each(|(((elements, ends), pair), begin)| {
        if is_capped {
            pair.shift(ends, begin as u32)
        } else {
            pair.add(ends)?
        }
        pair.merge(begin as u32, ends, elements);
        Ok::<_, Error>(())
    })?;
    Ok(LhbBuffers {
        size: kept.size,
        view_count: kept.view_count,
        offsets: CpuBuffer::from(offsets),
        elements: CpuBuffer::from(elements),
        left_out: CpuBuffer::from(left_out),
    })
}

/// Where each chunk begins, the first at `first`, and where the last ends.
fn scan(first: u64, sizes: &[u64]) -> (Vec<u64>, u64) {
    let mut end = first;
    let mut begins = Vec::with_capacity(sizes.len());
    for size in sizes {
        begins.push(end);
        end += size;
    }
    (begins, end)
}

/// Consecutive parts of `elements`.
fn split<'a>(mut elements: &'a mut [LhbElement], sizes: &[u64]) -> Vec<&'a mut [LhbElement]> {
    sizes.iter().map(|&size| elements.split_off_mut(..size as usize).unwrap_or_default()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use twinlight_core::kernels::rasterize_lhb::{CAP_FAR, CAP_NEAR};

    const FIRST: u32 = 1000;

    /// A number below `below`, of a hash.
    fn random(state: &mut u32, below: u32) -> u32 {
        *state = state.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
        (*state >> 8) % below
    }

    /// Lists of sorted elements; `density` in 16 are not empty, up to `longest` elements long.
    fn lists(size: u32, density: u32, longest: u32, cap: u32, seed: u32) -> Lhb<CpuBackend> {
        let (mut state, mut offsets, mut elements, mut left_out) = (seed, vec![0], Vec::new(), Vec::new());
        for list in 0..size * size {
            // Every density of every stretch: runs that are long and short.
            let is_there = random(&mut state, 16) < if list / 512 % 2 == 0 { density } else { 16 - density };
            let len = if is_there { random(&mut state, longest + 1) } else { 0 };
            let mut depths: Vec<u32> = (0..len).map(|_| random(&mut state, 20)).collect();
            depths.sort_unstable();
            elements
                .extend(depths.iter().map(|&depth| LhbElement { surface: random(&mut state, 2000), depth }));
            offsets.push(elements.len() as u32);
            left_out.push(random(&mut state, u32::MAX));
        }
        left_out.truncate(if cap > 0 { left_out.len() } else { 0 });
        LhbBuffers {
            size,
            view_count: 1,
            offsets: offsets.into(),
            elements: elements.into(),
            left_out: left_out.into(),
        }
    }

    fn list(lhb: &Lhb<CpuBackend>, i: usize) -> &[LhbElement] {
        let offsets = lhb.offsets.as_slice();
        &lhb.elements.as_slice()[offsets[i] as usize..offsets[i + 1] as usize]
    }

    /// Runs of every kind, across chunks, with and without caps, are what a stable sort of each list gives.
    #[test]
    fn lists_are_those_of_a_stable_sort() {
        for (kept, added) in [(14, 1), (1, 1), (8, 8), (0, 16), (16, 0), (16, 16), (0, 0)] {
            for (cap, side) in [(0, CAP_NEAR), (2, CAP_NEAR), (2, CAP_FAR), (9, CAP_FAR)] {
                let kept = lists(70, kept, 3, cap, 1);
                let added = lists(70, added, 5, cap, 2);
                let params =
                    MergeLhbParams { first_triangle: FIRST, layer_cap: cap, cap_side: side, padding: 0 };
                let merged = merge_lhb(&kept, &added, &params).unwrap();
                for i in 0..70 * 70 {
                    let renumbered = |e: &LhbElement| LhbElement { surface: e.surface + 2 * FIRST, ..*e };
                    let mut want = list(&kept, i).to_vec();
                    want.extend(list(&added, i).iter().map(renumbered));
                    want.sort_by_key(|element| element.depth);
                    let cut = if cap > 0 { want.len().saturating_sub(cap as usize) } else { 0 };
                    want.drain(if side == CAP_NEAR { want.len() - cut..want.len() } else { 0..cut });
                    assert_eq!(list(&merged, i), want, "list {i}, {params:?}");
                    if cap > 0 {
                        let left_out = |lhb: &Lhb<CpuBackend>| lhb.left_out.as_slice()[i];
                        let before = left_out(&kept).wrapping_add(left_out(&added));
                        assert_eq!(left_out(&merged), before.wrapping_add(cut as u32));
                    }
                }
            }
        }
    }

    /// Offsets that fall or leave the elements anywhere are an error, with and without a cap.
    #[test]
    fn malformed_offsets_are_an_error() {
        for cap in [0, 3] {
            let params =
                MergeLhbParams { first_triangle: FIRST, layer_cap: cap, cap_side: CAP_NEAR, padding: 0 };
            let (kept, added) = (lists(70, 8, 3, cap, 1), lists(70, 8, 3, cap, 2));
            for place in [0, 1, 2047, 2048, 2049, 4899, 4900] {
                for wrong in [u32::MAX, 1 << 31] {
                    let mut broken = kept.clone();
                    broken.offsets.as_mut_slice()[place] = wrong;
                    for (kept, added) in [(&broken, &added), (&added, &broken)] {
                        let result = merge_lhb(kept, added, &params);
                        assert!(matches!(result, Err(Error::InvalidInput { .. })), "{place}, {wrong}");
                    }
                }
            }
        }
    }
}
