// kernel family: scan
// contract core/src/kernels/scan.rs
// cpu backend-cpu/src/kernels/scan.rs
// gpu backend-gpu/src/kernels/scan.wgsl
// oracle conformance/src/oracle/scan.rs
//! `scan`: sums of chunks, their prefix, then every chunk's own prefix from there.

use crate::parallel::CHUNK;
use rayon::prelude::*;

/// Writes the exclusive prefix sums of `input` to `output` (of the same length) and returns the total, modulo 2³².
pub(crate) fn scan(input: &[u32], output: &mut [u32]) -> u32 {
    // [1] reduce
    let mut offsets: Vec<u32> = input
        .par_chunks(CHUNK)
        .map(|chunk| chunk.iter().fold(0, |sum: u32, &x| sum.wrapping_add(x)))
        .collect();
    // [2] offsets of the chunks
    let total = offsets.iter_mut().fold(0_u32, |sum, x| sum.wrapping_add(std::mem::replace(x, sum)));
    // [3] scan
    output.par_chunks_mut(CHUNK).zip(input.par_chunks(CHUNK)).zip(offsets).for_each(
        |((out, chunk), offset)| {
            let mut sum = offset;
            for (o, &x) in out.iter_mut().zip(chunk) {
                *o = sum;
                sum = sum.wrapping_add(x);
            }
        },
    );
    total
}
