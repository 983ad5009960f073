//! The tester tested: every planted bug must be caught, and the wrapper that plants them must be sound itself.

#[path = "common/list.rs"]
mod list;

use std::process::ExitCode;
use std::sync::OnceLock;
use twinlight_backend_cpu::CpuBackend;
use twinlight_conformance::faults::{FAULTS, caught_by, passing};
use twinlight_conformance::{Verdict, kernels};

/// What [`passing`] says of each kernel.
static SOUND: [OnceLock<Result<Vec<String>, String>>; kernels::STEMS.len()] =
    [const { OnceLock::new() }; kernels::STEMS.len()];

/// A kernel's trials without a bug, run once: for the verdict, and for the order in which bugs are looked for.
fn sound(kernel: &str) -> Result<&'static [String], String> {
    let at = kernels::STEMS.iter().position(|stem| *stem == kernel);
    let cell = at.map(|at| &SOUND[at]).ok_or_else(|| format!("no kernel {kernel}"))?;
    cell.get_or_init(|| passing(&CpuBackend::new(), kernel, 0)).as_deref().map_err(String::clone)
}

fn main() -> ExitCode {
    let mut list = list::List::from_args();
    for kernel in kernels::STEMS {
        list.add(format!("{kernel} without a bug passes"), move || match sound(kernel) {
            Ok(_) => Verdict::Passed,
            Err(trial) => Verdict::Failed(format!("{trial} fails on a sound backend")),
        });
        list.add(format!("{kernel} has planted bugs"), move || {
            let count = FAULTS.iter().filter(|(_, of, _)| *of == kernel).count();
            if count >= 5 { Verdict::Passed } else { Verdict::Failed(format!("only {count}")) }
        });
    }
    for &(fault, kernel, story) in FAULTS {
        list.add(format!("{kernel} {fault:?} is caught"), move || {
            match caught_by(&CpuBackend::new(), fault, kernel, 0, sound(kernel).unwrap_or_default()) {
                Some(_) => Verdict::Passed,
                None => Verdict::Failed(format!("no trial of {kernel} notices that {story}")),
            }
        });
    }
    list.run()
}
