//! Everything that needs a device, once per adapter and mode of this machine.
//!
//! `TWINLIGHT_REQUIRE_GPU=1` turns a machine without adapters from a skip into a failure.

mod chunks;
mod cones;
mod device;
mod filters;
mod frames;
mod lhb;
mod lookups;
mod merges;
mod mips;
mod packs;
mod scan;
mod sort;
mod strict;
mod transport;
mod voxel_lights;
mod voxels;
mod walks;
mod wide;

use libtest_mimic::{Arguments, Failed, Trial};
use std::process::ExitCode;
use std::sync::{Arc, OnceLock};
use twinlight_backend_gpu::{AdapterSelector, DeviceOptions, GpuDevice, Mode, adapters};

/// What a trial runs on: options to open a device of its own, and one shared by the trials that don't break it.
pub struct Target {
    options: DeviceOptions,
    shared: OnceLock<Result<GpuDevice, String>>,
}

impl Target {
    fn device(&self) -> Result<&GpuDevice, Failed> {
        let opened =
            self.shared.get_or_init(|| GpuDevice::open(&self.options).map_err(|error| error.to_string()));
        opened.as_ref().map_err(|error| Failed::from(error.as_str()))
    }
}

type Check = fn(&Target) -> Result<(), Failed>;

fn main() -> ExitCode {
    let arguments = Arguments::from_args();
    let checks: Vec<(&str, Check)> = [
        chunks::CHECKS,
        cones::CHECKS,
        device::CHECKS,
        filters::CHECKS,
        frames::CHECKS,
        lhb::CHECKS,
        lookups::CHECKS,
        merges::CHECKS,
        mips::CHECKS,
        packs::CHECKS,
        scan::CHECKS,
        sort::CHECKS,
        strict::CHECKS,
        transport::CHECKS,
        voxels::CHECKS,
        voxel_lights::CHECKS,
        walks::CHECKS,
        wide::CHECKS,
    ]
    .concat();
    let reports = adapters();
    let mut trials = Vec::new();
    for (index, report) in reports.iter().enumerate() {
        for mode in [Mode::Strict, Mode::Portable] {
            let place = format!("{} ({})", report.name, mode.name());
            if mode == Mode::Strict && !report.strict {
                trials.push(skipped(format!("{place}: the adapter has no strict mode")));
                continue;
            }
            let options = DeviceOptions {
                adapter: AdapterSelector::Index(index),
                mode: Some(mode),
                ..DeviceOptions::default()
            };
            let target = Arc::new(Target { options, shared: OnceLock::new() });
            for &(name, check) in &checks {
                let target = Arc::clone(&target);
                trials.push(Trial::test(format!("{name} on {place}"), move || check(&target)));
            }
        }
    }
    if reports.is_empty() {
        let required = std::env::var_os("TWINLIGHT_REQUIRE_GPU").is_some_and(|value| value != "0");
        let name = "no adapter on this machine".to_owned();
        trials.push(if required {
            Trial::test(name, || Err("TWINLIGHT_REQUIRE_GPU is set".into()))
        } else {
            skipped(name)
        });
    }
    libtest_mimic::run(&arguments, trials).exit_code()
}

fn skipped(name: String) -> Trial {
    Trial::test(name, || Ok(())).with_ignored_flag(true)
}

/// Fails with the place of the first difference.
pub fn expect_same<T: PartialEq + std::fmt::Debug>(what: &str, got: &[T], want: &[T]) -> Result<(), Failed> {
    if got.len() != want.len() {
        return Err(format!("{what}: {} elements, expected {}", got.len(), want.len()).into());
    }
    match got.iter().zip(want).position(|(got, want)| got != want) {
        None => Ok(()),
        Some(at) => Err(format!("{what}: element {at} is {:?}, expected {:?}", got[at], want[at]).into()),
    }
}

/// `len` reproducible numbers (SplitMix64).
pub fn numbers(seed: u64, len: usize) -> Vec<u64> {
    let mut state = seed;
    let mut next = || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = state;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    };
    (0..len).map(|_| next()).collect()
}
