//! `render`: a scene in, pictures out.

mod job;
mod layers;
mod moment;
mod output;
mod passes;
mod progress;
mod run;
mod sequence;
mod show;
mod sidecar;
mod studio;
mod summary;

use crate::args::{ProgressMode, RenderArgs};
use crate::budget::{self, Wish};
use crate::device;
use crate::exit::{Failure, Stage};
use crate::interrupt::Interrupt;
use crate::report;
use crate::source::{self, Loaded};
pub use job::Job;
use moment::{Moment, Plan};
use output::Outputs;
use passes::Stop;
use std::time::{Duration, Instant};
use studio::Studio;
use twinlight::Error;
use twinlight::methods::post::tonemap;

/// Runs the command.
///
/// # Errors
/// Everything in [`Failure`] but comparisons.
pub fn run(args: &RenderArgs) -> Result<(), Failure> {
    let start = Instant::now();
    let tone = tonemap::Display::new(args.picture.tone.exposure, args.picture.tone.tonemap)
        .map_err(Failure::Pictures)?;
    if let Some(show) = args.show {
        let loaded = source::load(&args.picture.scene, &args.picture.load, args.picture.camera.map(|c| c.0))?;
        let prepared = loaded.at(args.at.unwrap_or(0.0))?;
        return show::run(args, &prepared, show);
    }
    let outputs = Outputs::plan(&args.outputs, &source::stem(&args.picture.scene))?;
    let loaded = source::load(&args.picture.scene, &args.picture.load, args.picture.camera.map(|c| c.0))?;
    let moment = match Plan::new(args, &loaded.scene)? {
        Plan::Still => None,
        Plan::Moment(moment) => Some(moment),
        Plan::Frames(frames) => {
            sequence::prepare_folders(&outputs, &frames)?;
            let mut studio = Studio::new(args, tone, device::open(&args.device)?, watch()?);
            return sequence::run(args, &loaded, &frames, &outputs, &mut studio);
        }
    };
    picture(args, tone, &loaded, moment, &outputs, start)
}

/// Renders and saves one picture, or as much of it as there is when it ends early.
fn picture(
    args: &RenderArgs,
    tone: tonemap::Display,
    loaded: &Loaded,
    moment: Option<Moment>,
    outputs: &Outputs,
    start: Instant,
) -> Result<(), Failure> {
    let mut prepared = loaded.at(moment.map_or(0.0, |moment| moment.seconds))?;
    if moment.is_some() && args.at.is_none() {
        let seconds = loaded.scene.motion.duration;
        prepared.notices.push(format!(
            "the scene moves for {seconds:.3} s, and this is how it begins: --frames 0.. renders all of it, --at SECONDS \
             another moment"
        ));
    }
    let begin = Instant::now();
    outputs.prepare_folders()?;
    let opened = device::open(&args.device)?;
    let settled = args.wish().map(|wish| budget::settle(args, wish, &prepared, &opened.0)).transpose()?;
    let args = settled.as_ref().map_or(args, |settled| &settled.args);
    let mut job = Job::new(&args.picture, args.time, &prepared)?;
    if let Some((settled, wish)) = settled.as_ref().zip(args.wish()) {
        if let Wish::Within(budget) = wish {
            job.end_by(begin, budget, Duration::from_secs_f64(settled.chosen.after));
        }
        job.chosen = Some((wish, settled.chosen.clone()));
    }
    let mut studio = Studio::new(args, tone, opened, watch()?);
    let rendered = studio.render(&prepared, &job, &mut progress::Display::new(args.progress, None))?;
    studio.save(&prepared, &job, &rendered, moment, outputs, start)?;
    let done = rendered.0;
    if matches!(args.progress, ProgressMode::Auto | ProgressMode::Plain) {
        report::status(&summary::line(&done));
    }
    match (done.taken.lost, done.taken.stop) {
        (Some(lost), _) => Err(Failure::Library(Stage::Device, lost)),
        (None, Stop::Signal(signal)) => Err(Failure::Signal(signal)),
        (None, _) => Ok(()),
    }
}

fn watch() -> Result<Interrupt, Failure> {
    Interrupt::watch()
        .map_err(|e| Failure::Library(Stage::Device, Error::Internal(format!("signal handlers: {e}"))))
}
