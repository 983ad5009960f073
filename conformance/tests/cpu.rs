//! The suite on the CPU backend.

#[path = "common/list.rs"]
mod list;
#[path = "common/suite.rs"]
mod suite;

use std::process::ExitCode;
use twinlight_backend_cpu::CpuBackend;
use twinlight_conformance::Effort;

fn main() -> ExitCode {
    let mut list = list::List::from_args();
    // Tests outlive this function.
    let backend: &'static CpuBackend = Box::leak(Box::new(CpuBackend::new()));
    suite::add(&mut list, "cpu", backend, Effort::Full);
    list.run()
}
