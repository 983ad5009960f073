//! Frames one after the other. Each is saved when it is complete; one that is not, is not: what is there can be trusted, and
//! the rest rendered later.

use super::job::Job;
use super::moment::Frames;
use super::output::Outputs;
use super::passes::Stop;
use super::progress::Display;
use super::studio::Studio;
use super::summary;
use crate::args::{ProgressMode, RenderArgs};
use crate::exit::{Failure, Stage};
use crate::report;
use crate::source::Loaded;
use std::time::Instant;
use twinlight::BackendInfo;

/// Where every frame goes; makes the folders and sees whether files can be made in them.
///
/// # Errors
/// As [`Outputs::of_frame`] and [`Outputs::prepare_folders`].
pub fn prepare_folders(outputs: &Outputs, frames: &Frames) -> Result<(), Failure> {
    for number in frames.range.clone() {
        outputs.of_frame(number, frames.digits())?.prepare_folders()?;
    }
    Ok(())
}

/// Renders the frames.
///
/// # Errors
/// [`Failure::Frame`] for what ended one.
pub fn run(
    args: &RenderArgs,
    loaded: &Loaded,
    frames: &Frames,
    outputs: &Outputs,
    studio: &mut Studio,
) -> Result<(), Failure> {
    let start = Instant::now();
    let mut display = Display::new(args.progress, Some(frames.range.clone()));
    let mut info = None;
    for number in frames.range.clone() {
        display.begin_frame(number);
        let outputs = outputs.of_frame(number, frames.digits())?;
        let rendered = frame(args, loaded, frames, number, &outputs, studio, &mut display);
        info = Some(rendered.map_err(|failure| Failure::Frame(number, Box::new(failure)))?);
    }
    let said = matches!(args.progress, ProgressMode::Auto | ProgressMode::Plain);
    if let Some(info) = info.filter(|_| said) {
        report::status(&summary::frames_line(frames.range.len() as u32, start.elapsed(), &info));
    }
    Ok(())
}

fn frame(
    args: &RenderArgs,
    loaded: &Loaded,
    frames: &Frames,
    number: u32,
    outputs: &Outputs,
    studio: &mut Studio,
    display: &mut Display,
) -> Result<BackendInfo, Failure> {
    let (start, moment) = (Instant::now(), frames.moment(number));
    if let Some(signal) = studio.interrupt.caught() {
        return Err(Failure::Signal(signal));
    }
    let prepared = loaded.at(moment.seconds)?;
    let job = Job::new(&args.picture, args.time, &prepared)?;
    let mut rendered = studio.render(&prepared, &job, display)?;
    let taken = &mut rendered.0.taken;
    if let Some(lost) = taken.lost.take() {
        return Err(Failure::Library(Stage::Device, lost));
    }
    if let Stop::Signal(signal) = taken.stop {
        return Err(Failure::Signal(signal));
    }
    studio.save(&prepared, &job, &rendered, Some(moment), outputs, start)?;
    Ok(rendered.0.info)
}
