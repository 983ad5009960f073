//! The suite on the CPU backend, and what only a CPU backend can promise: the same bits for any number of threads.

#[path = "common/list.rs"]
mod list;
#[cfg(target_arch = "x86_64")]
#[path = "common/rounding.rs"]
mod rounding;
#[path = "common/suite.rs"]
mod suite;

use std::process::ExitCode;
use std::sync::mpsc;
use twinlight_backend_cpu::CpuBackend;
use twinlight_conformance::expectations::KNOWN;
use twinlight_conformance::{Check, Effort, Failure, Options, Report, cross, own};
use twinlight_core::Backend;
use twinlight_methods::reference::{Control, Settings, StopReason, render};

fn main() -> ExitCode {
    let mut list = list::List::from_args();
    // Tests outlive this function.
    let backend: &'static CpuBackend = Box::leak(Box::new(CpuBackend::new()));
    suite::add(&mut list, "cpu", backend, own::cpu_suite, Effort::Full, Vec::new());
    for threads in [1, 2, 3, 8] {
        for (name, check) in own::cpu_checks() {
            list.add(format!("cpu d8_threads {name} with {threads} threads"), move || {
                cross::judge(d8_threads(check, threads))
            });
        }
    }
    list.add("cpu d8_callers_pool_and_company".into(), || cross::judge(d8_callers_pool_and_company()));
    list.add("cpu d7_stopped_anywhere".into(), || cross::judge(d7_stopped_anywhere()));
    #[cfg(target_arch = "x86_64")]
    list.add("cpu d10_host_flushes_subnormals".into(), || cross::judge(d10_host_flushes_subnormals()));
    #[cfg(target_arch = "x86_64")]
    for (name, bits) in rounding::ADVERSARIES {
        let check = move || cross::judge(rounding::adversary_rounds(bits));
        list.add(format!("cpu adversary_rounds {name}"), check);
    }
    list.run()
}

fn failed(error: impl ToString) -> Failure {
    Failure::Mismatch(error.to_string())
}

/// Two threads are the yardstick, so that one thread and eight are both compared with something else.
fn d8_threads(check: cross::CrossCheck<CpuBackend, CpuBackend>, threads: usize) -> Check {
    let yardstick = CpuBackend::with_threads(if threads == 2 { 5 } else { 2 }).map_err(failed)?;
    check(&yardstick, &CpuBackend::with_threads(threads).map_err(failed)?)
}

/// Inside a caller's pool, and twice at once.
fn d8_callers_pool_and_company() -> Check {
    let pooled = rayon::ThreadPoolBuilder::new().num_threads(3).build().map_err(failed)?;
    let (send, receive) = mpsc::channel();
    std::thread::scope(|scope| {
        for _ in 0..2 {
            let send = send.clone();
            let pool = &pooled;
            scope.spawn(move || {
                for (_, check) in own::cpu_checks() {
                    let alone = CpuBackend::with_threads(1).map_err(failed);
                    // The receiver lives as long as the scope.
                    let _ =
                        send.send(alone.and_then(|alone| pool.install(|| check(&alone, &CpuBackend::new()))));
                }
            });
        }
    });
    drop(send);
    receive.into_iter().collect()
}

/// Stopped after any pass, a render returns what it has: whole films of finished samples, soon.
fn d7_stopped_anywhere() -> Check {
    let scene = twinlight_fixtures::scenes::cornell();
    let compiled = twinlight_conformance::scenes::compiled(&scene);
    let camera = scene.camera.ok_or_else(|| failed("no camera"))?;
    let backend = CpuBackend::new();
    let resident = backend.upload_scene(&compiled)?;
    let settings = Settings { width: 64, height: 64, samples: 100_000, ..Settings::default() };
    for passes in 1..5 {
        let (mut seen, mut stopped) = (0, std::time::Instant::now());
        let rendered = render(&backend, &resident, &compiled, &camera, &settings, |_| {
            seen += 1;
            stopped = std::time::Instant::now();
            if seen == passes { Control::Stop } else { Control::Continue }
        })?;
        // Passes are sized to a quarter of a second; a second leaves room for a loaded machine.
        let late = stopped.elapsed().as_secs_f64();
        let samples: u32 = rendered.film.texels().iter().map(|t| t.samples).sum();
        if rendered.stop != StopReason::Cancelled || samples == 0 || late > 1.0 {
            let stop = rendered.stop;
            return Err(failed(format!(
                "after pass {passes}: {stop:?}, {samples} samples, {late} s after the stop"
            )));
        }
    }
    Ok(())
}

/// A host program that set flush-to-zero and denormals-are-zero: integers and ordinary floats are untouched.
#[cfg(target_arch = "x86_64")]
fn d10_host_flushes_subnormals() -> Check {
    let pool = rounding::pool_with(rounding::FLUSH)?;
    let flushing = pool.install(|| {
        let options = Options {
            effort: Effort::Quick,
            kernels: [
                "scan",
                "sort",
                "rasterize_lhb",
                "merge_lhb",
                "pack_lhb",
                "query_lhb",
                "trace",
                "reduce_mips",
                "voxelize",
                "sum_voxels",
            ]
            .map(String::from)
            .into(),
            ..Options::default()
        };
        let backend = CpuBackend::new();
        let mut report = Report::new(backend.info(), "");
        for trial in own::cpu_suite(&backend, &options) {
            report.run(&trial, KNOWN);
        }
        if report.is_ok() { Ok(()) } else { Err(Failure::Mismatch(report.table())) }
    });
    flushing?;
    let plain = CpuBackend::with_threads(1).map_err(failed)?;
    for (_, check) in own::cpu_checks() {
        pool.install(|| check(&plain, &CpuBackend::new()))?;
    }
    Ok(())
}
