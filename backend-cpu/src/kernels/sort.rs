// kernel family: sort
// contract core/src/kernels/sort.rs
// cpu backend-cpu/src/kernels/sort.rs
// gpu backend-gpu/src/kernels/sort.wgsl
// oracle conformance/src/oracle/sort.rs
//! `sort`: stable.

use rayon::prelude::*;
use twinlight_core::Result;

/// Sorts `keys` with `payload` (of the same length), stably and ascending.
pub(crate) fn sort<K: Copy + Ord + Send + Sync>(keys: &mut [K], payload: &mut [u32]) -> Result<()> {
    let mut pairs: Vec<(K, u32)> = keys.iter().copied().zip(payload.iter().copied()).collect();
    pairs.par_sort_by_key(|pair| pair.0);
    for ((key, value), pair) in keys.iter_mut().zip(payload).zip(pairs) {
        (*key, *value) = pair;
    }
    Ok(())
}
