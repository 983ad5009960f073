//! The tester tested: every planted bug must be caught, and the wrapper that plants them must be sound itself.

#[path = "common/list.rs"]
mod list;

use std::process::ExitCode;
use twinlight_backend_cpu::CpuBackend;
use twinlight_conformance::faults::{FAULTS, Fault, caught_by};
use twinlight_conformance::{Verdict, kernels};

fn main() -> ExitCode {
    let mut list = list::List::from_args();
    for kernel in kernels::STEMS {
        list.add(format!("{kernel} without a bug passes"), move || {
            match caught_by(&CpuBackend::new(), Fault::None, kernel, 0) {
                None => Verdict::Passed,
                Some(trial) => Verdict::Failed(format!("{trial} fails on a sound backend")),
            }
        });
        list.add(format!("{kernel} has planted bugs"), move || {
            let count = FAULTS.iter().filter(|(_, of, _)| *of == kernel).count();
            if count >= 5 { Verdict::Passed } else { Verdict::Failed(format!("only {count}")) }
        });
    }
    for &(fault, kernel, story) in FAULTS {
        list.add(format!("{kernel} {fault:?} is caught"), move || {
            match caught_by(&CpuBackend::new(), fault, kernel, 0) {
                Some(_) => Verdict::Passed,
                None => Verdict::Failed(format!("no trial of {kernel} notices that {story}")),
            }
        });
    }
    list.run()
}
