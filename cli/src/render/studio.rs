//! What pictures share: the device, the flags, what was said already.

use super::job::Job;
use super::layers::Pictures;
use super::moment::Moment;
use super::output::Outputs;
use super::progress;
use super::run::{self, Done, Kept};
use super::sidecar;
use crate::args::{ModeName, RenderArgs};
use crate::device::Device;
use crate::exit::Failure;
use crate::interrupt::Interrupt;
use crate::report;
use crate::source::Prepared;
use std::collections::BTreeSet;
use std::time::Instant;
use twinlight::methods::post::tonemap::Display;

/// A place to render in.
pub struct Studio<'a> {
    args: &'a RenderArgs,
    tone: Display,
    device: Device,
    kept: Kept,
    /// Asks for a stop.
    pub interrupt: Interrupt,
    /// Every notice so far, without its numbers: what is said of one frame need not be said of the next.
    said: BTreeSet<String>,
    /// Those about the device, which are about every picture.
    about_device: Vec<String>,
}

impl<'a> Studio<'a> {
    /// With a device that is open, and what is to be said about it.
    pub fn new(
        args: &'a RenderArgs,
        tone: Display,
        (device, unavailable): (Device, Option<String>),
        interrupt: Interrupt,
    ) -> Self {
        let mut about_device: Vec<String> = unavailable.into_iter().collect();
        if args.device.mode == Some(ModeName::Portable) && matches!(device, Device::Cpu(_)) {
            let notice =
                "--mode portable is for GPUs: the CPU, which renders this, always computes as in strict mode";
            about_device.push(notice.into());
        }
        Self { args, tone, device, kept: Kept::default(), interrupt, said: BTreeSet::new(), about_device }
    }

    /// Renders a picture; also gives the notices that are about it.
    ///
    /// # Errors
    /// What the backend and the method refuse.
    pub fn render(
        &mut self,
        prepared: &Prepared,
        job: &Job,
        display: &mut progress::Display,
    ) -> Result<(Done, Vec<String>), Failure> {
        let mut notices = Vec::new();
        let said = &mut self.said;
        let mut tell = |text: String| {
            if said.insert(text.replace(|c: char| c.is_ascii_digit(), "")) {
                report::notice(&text);
            }
            notices.push(text);
        };
        prepared.notices.iter().chain(&self.about_device).cloned().for_each(&mut tell);
        let (device, kept, interrupt) = (&self.device, &mut self.kept, &self.interrupt);
        let done = run::render(device, self.args, prepared, job, interrupt, kept, display, &mut tell)?;
        Ok((done, notices))
    }

    /// Writes a picture's files; `start` is when work on it began.
    ///
    /// # Errors
    /// [`twinlight::Error::Io`].
    pub fn save(
        &self,
        prepared: &Prepared,
        job: &Job,
        (done, notices): &(Done, Vec<String>),
        moment: Option<Moment>,
        outputs: &Outputs,
        start: Instant,
    ) -> Result<(), Failure> {
        let write_start = Instant::now();
        let pictures = Pictures::new(&done.taken.film, done.surfaces.as_ref(), self.tone)?;
        outputs.write(&pictures, &sidecar::attributes(self.args, job, done, moment))?;
        let rendered = write_start.duration_since(job.begin);
        let times = sidecar::Times { rendered, write: write_start.elapsed(), total: start.elapsed() };
        let text = sidecar::json(self.args, prepared, job, done, moment, outputs, notices, &times);
        outputs.write_sidecar(&text)?;
        report::print(&outputs.list())
    }
}
