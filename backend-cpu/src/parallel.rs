//! Deterministic parallel loops: chunks of fixed size whatever the number of threads, results by index.

use crate::simd::{Isa, Kernel, dispatch};
use rayon::prelude::*;

/// Elements per chunk of 32-bit words: 128 KiB, so that input and output of one chunk stay in a core's L2 cache.
pub(crate) const CHUNK: usize = 1 << 15;

/// Elements per task of [`fill_chunks`]: enough to hide the cost of a task, few enough to balance uneven rays.
const FILL_CHUNK: usize = 256;

/// Runs, for every chunk of `out`, the kernel that `kernel` makes of the chunk's first index and the chunk.
pub(crate) fn fill_chunks<'a, T, K>(
    isa: Isa,
    out: &'a mut [T],
    kernel: impl Fn(usize, &'a mut [T]) -> K + Sync,
) where
    T: Send,
    K: Kernel<Output = ()>,
{
    out.par_chunks_mut(FILL_CHUNK)
        .enumerate()
        .for_each(|(chunk, elements)| dispatch(isa, kernel(chunk * FILL_CHUNK, elements)));
}
