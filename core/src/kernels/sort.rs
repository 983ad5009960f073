// kernel family: sort
// contract core/src/kernels/sort.rs
// cpu backend-cpu/src/kernels/sort.rs
// gpu backend-gpu/src/kernels/sort.wgsl
// oracle conformance/src/oracle/sort.rs
//! `sort`: stable ascending LSD radix sort of unsigned keys with a u32 payload, in place.
//!
//! *Meaning.* After the call `keys` is non-decreasing and every (key, payload) pair of the input occurs once; pairs
//! with equal keys keep their input order (stability), so the result is one definite permutation.
//! *Shapes.* `keys` (u32, or u64 as one 64-bit word, little end first on the device) and `payload` of equal length n,
//! 0 ≤ n ≤ [`MAX_LEN`].
//! *Source.* Knuth TAOCP 3 §5.2.5; ranks come from scans of digit histograms, never from the order in which atomics
//! happen to be served.

use crate::accuracy::Accuracy;

/// The order is total once stability is required, so there is one right answer.
pub const ACCURACY: Accuracy =
    Accuracy::Exact { because: "a stable sort of integers has exactly one result" };

/// Longest input: 2²⁶ pairs.
pub const MAX_LEN: usize = 1 << 26;
