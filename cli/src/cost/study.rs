//! Measures one setting after the other.

use super::judge::Judge;
use super::page::title;
use super::pictures::Pictures;
use super::progress::State;
use super::records::{Point, Records, StepLine, What, Words};
use super::setup::Setup;
use crate::exit::{Failure, Stage};
use crate::report;
use crate::source;
use std::time::{Duration, Instant};
use twinlight::methods::cost::{Effort, Measured, Setting, Sweep, Tried, errors, measure};
use twinlight::methods::post::image::Image;
use twinlight::{Backend, Error};

/// How a study ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// Nothing was left to try.
    Complete,
    /// Time was up.
    Time,
    /// A signal.
    Signal(i32),
}

/// What is measured, and what is known already.
pub struct Study<'a> {
    pub setup: &'a Setup<'a>,
    pub judge: &'a Judge,
    pub methods: &'a [&'static str],
    pub sweep: Sweep,
    pub records: Records,
    pub pictures: &'a Pictures,
    /// What the finest settings made in this run, for their splits.
    pub finest: Vec<(Words, Image)>,
}

impl Study<'_> {
    /// Measures until nothing is left, time is up or a signal comes, and splits errors.
    ///
    /// # Errors
    /// A lost device, and files that can't be written. What was measured before is noted down.
    pub fn run<B: Backend>(&mut self, backend: &B) -> Result<End, Failure> {
        let mut end = self.settings(backend)?;
        if !matches!(end, End::Signal(_)) {
            self.splits(backend)?;
        }
        if let Some(signal) = self.setup.interrupt.caught() {
            end = End::Signal(signal);
        }
        Ok(end)
    }

    /// Seconds of this and earlier runs.
    pub fn spent(&self) -> f64 {
        self.judge.taken.map_or(0.0, |taken| taken.seconds) + self.records.spent()
    }

    /// Says what is done next.
    pub fn begin(&self, doing: &str) {
        let state = State {
            spent: self.spent(),
            limit: self.setup.args.time_limit,
            points: self.records.points().count(),
            planned: self.sweep.planned(&self.tried()),
        };
        self.setup.progress.begin(&state, doing);
    }

    fn tried(&self) -> Vec<Tried> {
        self.records.all().iter().filter_map(|record| record.tried()).collect()
    }

    fn settings<B: Backend>(&mut self, backend: &B) -> Result<End, Failure> {
        loop {
            let Some(setting) = self.sweep.next(&self.tried()) else { return Ok(End::Complete) };
            if self.spent() + self.splits_to_come() >= self.setup.args.time_limit {
                return Ok(End::Time);
            }
            self.setting(backend, &setting)?;
            if let Some(signal) = self.setup.interrupt.caught() {
                return Ok(End::Signal(signal));
            }
        }
    }

    /// Measures a setting and notes it down, unless a signal comes.
    fn setting<B: Backend>(&mut self, backend: &B, setting: &Setting) -> Result<(), Failure> {
        let (words, setup) = (Words::of(setting), self.setup);
        self.begin(&title(&words));
        let start = Instant::now();
        let job = setup.job(setting.method(), setting.flags(), setup.args.seed)?;
        let (scene, effort) = (&setup.prepared.compiled, self.effort(start));
        let go_on = || setup.interrupt.caught().is_none();
        let bytes = source::compiled_bytes(scene);
        let what = match measure(backend, scene, &job.camera, &job.plan, bytes, &effort, go_on) {
            Ok(None) => return Ok(()),
            Ok(Some(measured)) => self.point(words, measured)?,
            Err(why @ (Error::Unsupported(_) | Error::LimitExceeded { .. } | Error::OutOfMemory { .. })) => {
                setup.progress.clear();
                report::notice(&format!("left out: {}: {why}", title(&words)));
                What::Failed { setting: words, why: why.to_string() }
            }
            Err(error) => return Err(Failure::Library(Stage::Device, error)),
        };
        self.records.add(start.elapsed().as_secs_f64(), what)
    }

    /// Of a setting that begins now: beyond the time limit, nothing is rendered twice.
    fn effort(&self, now: Instant) -> Effort {
        let left = (self.setup.args.time_limit - self.spent()).max(0.0);
        Effort { until: Some(now + Duration::from_secs_f64(left)), ..Effort::default() }
    }

    fn point(&mut self, setting: Words, measured: Measured) -> Result<What, Failure> {
        let image = self.setup.image(measured.radiance)?;
        let found = errors(&image, self.judge.reference.image(), &self.setup.tone);
        self.pictures.keep(&setting, &image)?;
        if setting.is_finest() {
            self.finest.push((setting.clone(), image));
        }
        let steps = measured.steps.into_iter().map(|step| StepLine {
            name: step.name,
            calls: step.calls,
            seconds: step.seconds,
            spread: step.spread.into(),
        });
        Ok(What::Point(Point {
            setting,
            seconds: measured.seconds.into(),
            runs: measured.runs,
            steps: steps.collect(),
            bytes: measured.bytes,
            errors: found.map_err(Failure::Pictures)?.map(|value| Some(value).filter(|v| v.is_finite())),
        }))
    }
}
