//! Deterministic parallel loops: chunks of fixed size whatever the number of threads, results by index.

use rayon::prelude::*;

/// Elements per chunk of 32-bit words: 128 KiB, so that input and output of one chunk stay in a core's L2 cache.
pub(crate) const CHUNK: usize = 1 << 15;

/// Elements per task of [`fill`]: enough to hide the cost of a task, few enough to balance uneven rays.
const FILL_CHUNK: usize = 256;

/// Sets every element to `value` of its index.
pub(crate) fn fill<T: Send>(out: &mut [T], value: impl Fn(usize) -> T + Sync) {
    out.par_chunks_mut(FILL_CHUNK).enumerate().for_each(|(chunk, elements)| {
        for (i, element) in elements.iter_mut().enumerate() {
            *element = value(chunk * FILL_CHUNK + i);
        }
    });
}
