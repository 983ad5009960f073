// kernel family: scan
// contract core/src/kernels/scan.rs
// cpu backend-cpu/src/kernels/scan.rs
// gpu backend-gpu/src/kernels/scan.wgsl
// oracle conformance/src/oracle/scan.rs
//! `scan`: one pass over memory. Threads take chunks in order; each sums its chunk, finds the sum of all before it, and
//! scans the chunk again from cache. Memory is read once and written once, as by a copy.
//!
//! *Source.* Merrill & Garland, "Single-pass parallel prefix scan with decoupled look-back", 2016. Deviation: where an
//! earlier chunk's sum isn't known yet, it is computed again instead of waited for. No thread ever waits for another,
//! so a thread that the system has put to sleep costs one chunk's work, not a stall.

use crate::parallel::in_order;
use std::sync::atomic::{AtomicU64, Ordering};

mod prefix;

use prefix::{prefix, sum};

/// Elements per chunk: 128 KiB, so that it is still in a core's L2 cache when it is read again.
pub(crate) const CHUNK: usize = 1 << 15;

/// From this length on results go to memory past the caches: they wouldn't stay there, and a line that is written
/// through a cache is first read from memory, a third more traffic.
const STREAM_LEN: usize = 1 << 22;

/// The chunk's own sum is in the low word.
const SUM: u64 = 1 << 32;
/// The sum of the chunk and all before it is in the low word.
const INCLUSIVE: u64 = 2 << 32;

/// Writes the exclusive prefix sums of `input` to `output` (of the same length) and returns the total, modulo 2³².
pub(crate) fn scan(input: &[u32], output: &mut [u32]) -> u32 {
    let stream = input.len() >= STREAM_LEN;
    if input.len() <= CHUNK {
        return prefix(input, output, 0, stream);
    }
    let states: Vec<AtomicU64> = input.chunks(CHUNK).map(|_| AtomicU64::new(0)).collect();
    let chunks = output.chunks_mut(CHUNK).zip(input.chunks(CHUNK)).enumerate();
    in_order(chunks, |(i, (out, chunk))| {
        // [1] reduce
        let own = sum(chunk);
        states[i].store(SUM | u64::from(own), Ordering::Relaxed);
        // [2] look back
        let before = sum_before(&states, input, i);
        states[i].store(INCLUSIVE | u64::from(before.wrapping_add(own)), Ordering::Relaxed);
        // [3] scan
        prefix(chunk, out, before, stream);
    });
    states.last().map_or(0, |state| state.load(Ordering::Relaxed) as u32)
}

/// The sum of all chunks before `chunk`. A state is one word that holds its own meaning, so relaxed loads suffice.
fn sum_before(states: &[AtomicU64], input: &[u32], chunk: usize) -> u32 {
    let mut before = 0_u32;
    for earlier in (0..chunk).rev() {
        let state = states[earlier].load(Ordering::Relaxed);
        if state & INCLUSIVE != 0 {
            return before.wrapping_add(state as u32);
        }
        let known = state & SUM != 0;
        let value = if known { state as u32 } else { sum(&input[earlier * CHUNK..(earlier + 1) * CHUNK]) };
        before = before.wrapping_add(value);
    }
    before
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The look-back gives the same sum from every mixture of what other threads have published.
    #[test]
    fn sums_that_are_not_published_are_computed() {
        let input: Vec<u32> = (0..6 * CHUNK as u32).map(|i| i.wrapping_mul(0x9E37_79B9)).collect();
        let sums: Vec<u32> = input.chunks(CHUNK).map(sum).collect();
        let inclusive = |n: usize| sums[..=n].iter().fold(0_u32, |a, &b| a.wrapping_add(b));
        for mixture in 0..3_usize.pow(5) {
            let state = |i: usize| match mixture / 3_usize.pow(i as u32) % 3 {
                0 => 0,
                1 => SUM | u64::from(sums[i]),
                _ => INCLUSIVE | u64::from(inclusive(i)),
            };
            let states: Vec<AtomicU64> = (0..5).map(|i| AtomicU64::new(state(i))).collect();
            assert_eq!(sum_before(&states, &input, 5), inclusive(4), "mixture {mixture}");
            assert_eq!(sum_before(&states, &input, 0), 0);
        }
    }
}
