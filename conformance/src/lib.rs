//! The suite that shows how far a twinlight backend agrees with the contracts, and two backends with each other.
//!
//! A backend joins with one line: implement [`twinlight_core::Backend`], then call [`run`].
//!
//! ```
//! use twinlight_backend_cpu::CpuBackend;
//! use twinlight_conformance::{Effort, Options, run};
//!
//! let options = Options { effort: Effort::Quick, kernels: vec!["scan".into()], ..Options::default() };
//! let report = run(&CpuBackend::new(), &options, "2026-01-31");
//! assert!(report.is_ok(), "{}", report.table());
//! ```
//!
//! *What is compared with what.* Never a backend with itself. [`oracle`] holds a third opinion per kernel: serial,
//! naive on purpose, exact or in f64. [`kernels`] holds cases (edge ladders, proptest strategies with fixed seeds) and
//! laws (permutation, splits, scale by powers of two). [`cross`] compares two backends on whole scenes.
//! [`faults`] lists planted bugs, and a suite that lets one of them through fails its own test.
//!
//! *To add a kernel*: `oracle/<stem>.rs`, `kernels/<stem>.rs` (listed in [`suite`]), `faulty/<stem>.rs` with its rows in
//! [`faults::FAULTS`].

pub mod compare;
pub mod cross;
pub mod expectations;
pub mod faults;
pub mod faulty;
pub mod kernels;
pub mod oracle;
pub mod own;
pub mod report;
pub mod require;
pub mod scenes;
pub mod trial;

pub use expectations::{Expectation, Verdict};
pub use report::Report;
pub use trial::{Check, Context, Effort, Failure, Options, Outcome, Trial};

use twinlight_core::Backend;

/// Every trial for one backend, in pipeline order. Nothing has run yet.
pub fn suite<'a, B: Backend + Sync>(backend: &'a B, options: &'a Options) -> Vec<Trial<'a>> {
    let mut list = trial::Listing::new(backend, options);
    kernels::list(&mut list);
    list.finish()
}

/// Runs the suite one trial after the other. `date` goes into the report as it is; the library reads no clock but for
/// durations.
pub fn run<B: Backend + Sync>(backend: &B, options: &Options, date: &str) -> Report {
    let mut report = Report::new(backend.info(), date);
    for trial in suite(backend, options) {
        report.run(&trial, expectations::KNOWN);
    }
    report
}
