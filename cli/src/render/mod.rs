//! `render`: a scene in, pictures out.

mod job;
mod layers;
mod output;
mod passes;
mod progress;
mod run;
mod sidecar;
mod summary;

use crate::args::{ModeName, ProgressMode, RenderArgs};
use crate::device::Device;
use crate::exit::{Failure, Stage};
use crate::interrupt::Interrupt;
use crate::{device, report, source};
use job::Job;
use output::Outputs;
use passes::Stop;
use std::time::Instant;
use twinlight::Error;
use twinlight::methods::post::tonemap::Display;

/// Runs the command.
///
/// # Errors
/// Everything in [`Failure`] but comparisons.
pub fn run(args: &RenderArgs) -> Result<(), Failure> {
    let start = Instant::now();
    let display = Display::new(args.tone.exposure, args.tone.tonemap).map_err(Failure::Pictures)?;
    let outputs = Outputs::plan(&args.outputs, &source::stem(&args.scene))?;
    let prepared = source::prepare(&args.scene, &args.load, args.camera.map(|c| c.0))?;
    let job = Job::new(args, &prepared)?;
    outputs.prepare_folders()?;
    let interrupt = Interrupt::watch()
        .map_err(|e| Failure::Library(Stage::Device, Error::Internal(format!("signal handlers: {e}"))))?;

    let mut notices = Vec::new();
    let mut tell = |text: String| {
        report::notice(&text);
        notices.push(text);
    };
    prepared.notices.iter().cloned().for_each(&mut tell);
    let (device, unavailable) = device::open(&args.backend, args.mode, args.threads)?;
    unavailable.into_iter().for_each(&mut tell);
    if args.mode == Some(ModeName::Portable) && matches!(device, Device::Cpu(_)) {
        tell(
            "--mode portable is for GPUs: the CPU, which renders this, always computes as in strict mode"
                .into(),
        );
    }
    let done = run::render(device, args, &prepared, &job, &interrupt, &mut tell)?;

    let write_start = Instant::now();
    let pictures = layers::Pictures::new(&done.taken.film, done.gbuffer.as_deref(), display)?;
    outputs.write(&pictures, &sidecar::attributes(args, &job, &done))?;
    let times = sidecar::Times { write: write_start.elapsed(), total: start.elapsed() };
    outputs.write_sidecar(&sidecar::json(args, &prepared, &job, &done, &outputs, &notices, &times))?;
    report::print(&outputs.list())?;
    if matches!(args.progress, ProgressMode::Auto | ProgressMode::Plain) {
        report::status(&summary::line(&done));
    }
    match (done.taken.lost, done.taken.stop) {
        (Some(lost), _) => Err(Failure::Library(Stage::Device, lost)),
        (None, Stop::Signal(signal)) => Err(Failure::Signal(signal)),
        (None, _) => Ok(()),
    }
}
