//! The suite on every GPU adapter of this machine, in strict and in portable mode, and each against the CPU.
//!
//! `TWINLIGHT_REQUIRE_GPU=1` turns missing adapters into failures; on Linux both software adapters are demanded.

#[path = "common/list.rs"]
mod list;
#[path = "common/suite.rs"]
mod suite;

use std::process::ExitCode;
use twinlight_backend_cpu::CpuBackend;
use twinlight_backend_gpu::{AdapterReport, AdapterSelector, DeviceOptions, GpuBackend, Mode, adapters};
use twinlight_conformance::{Effort, Verdict, cross, kernels, own, require};

fn main() -> ExitCode {
    let mut list = list::List::from_args();
    let reports = adapters();
    let names: Vec<String> = reports.iter().map(ToString::to_string).collect();
    let missing = require::missing(&names, cfg!(target_os = "linux"));
    list.add("adapters are there".into(), move || match missing.as_slice() {
        [] => Verdict::Passed,
        missing if require::gpu_required() => Verdict::Failed(format!("missing: {}", missing.join(", "))),
        missing => Verdict::Skipped(format!("missing: {}", missing.join(", "))),
    });
    for (index, report) in reports.iter().enumerate() {
        for mode in [Mode::Strict, Mode::Portable] {
            add_mode(&mut list, index, report, mode);
        }
    }
    list.run()
}

fn add_mode(list: &mut list::List, index: usize, report: &AdapterReport, mode: Mode) {
    let label = format!("{} ({})", report.name, mode.name());
    if let Some(why) = report.unusable.clone() {
        return list.add(label, move || Verdict::Skipped(why));
    }
    if mode == Mode::Strict && !report.strict {
        return list.add(label, || Verdict::Skipped("the adapter takes no SPIR-V, so no strict mode".into()));
    }
    let options = DeviceOptions {
        adapter: AdapterSelector::Index(index),
        mode: Some(mode),
        ..DeviceOptions::default()
    };
    match GpuBackend::open(&options) {
        Ok(backend) => {
            // One device per adapter and mode for the life of the process: devices are dear, leaks of them too.
            let backend: &'static GpuBackend = Box::leak(Box::new(backend));
            suite::add(list, &label, backend, own::gpu_suite, Effort::Quick, kernels_of(mode));
            for (name, check) in own::gpu_checks() {
                list.add(format!("{label} against cpu: {name}"), move || {
                    cross::judge(check(&CpuBackend::new(), backend))
                });
            }
        }
        Err(error) => list.add(format!("{label} opens"), move || Verdict::Failed(error.to_string())),
    }
}

/// The kernels whose trials run in a mode. Modes differ in float arithmetic: those of the dear kernels that have none run in portable
/// mode, and strict mode compares them with the CPU.
fn kernels_of(mode: Mode) -> Vec<String> {
    let is_run = |stem: &&str| {
        let exact =
            ["rasterize_lhb", "merge_lhb", "pack_lhb", "query_lhb", "voxelize", "sum_voxels", "reduce_mips"];
        mode == Mode::Portable || !exact.contains(stem)
    };
    kernels::STEMS.into_iter().filter(is_run).map(String::from).collect()
}
