//! Cases and laws of every kernel, in pipeline order.

mod property;
pub mod scan;
pub mod sort;
pub mod trace;

use crate::trial::Listing;
use twinlight_core::Backend;

/// Stems of the kernels the suite knows, in pipeline order.
pub const STEMS: [&str; 3] = ["scan", "sort", "trace"];

/// Lists every kernel's trials.
pub fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    scan::list(list);
    sort::list(list);
    trace::list(list);
}
