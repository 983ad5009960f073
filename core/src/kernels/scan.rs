// kernel family: scan
// contract core/src/kernels/scan.rs
// cpu backend-cpu/src/kernels/scan.rs
// gpu backend-gpu/src/kernels/scan.wgsl
// oracle conformance/src/oracle/scan.rs
//! `scan`: exclusive prefix sum.
//!
//! *Formula.* `output[i] = Σ input[j], j < i`, modulo 2³²; the return value is the sum of all, modulo 2³².
//! *Shapes.* Both buffers have the same length n, 0 ≤ n ≤ [`MAX_LEN`]; n = 0 gives total 0.
//! *Units.* Counts in, offsets out.
//! *Source.* Blelloch, "Prefix sums and their applications", 1990; reduce, scan, scatter without forward-progress
//! assumptions between workgroups.

use crate::accuracy::Accuracy;

/// Integer addition is associative, so any schedule gives the same bits.
pub const ACCURACY: Accuracy =
    Accuracy::Exact { because: "sums of u32 modulo 2^32 are independent of the order of addition" };

/// Longest input: 2²⁷ elements, 512 MiB.
pub const MAX_LEN: usize = 1 << 27;
