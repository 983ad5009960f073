//! The part that needs a backend: renders the reference, the settings and what splits errors.

use super::command::{Flags, Render};
use super::pictures::Pictures;
use super::progress::Display;
use super::records::{Parts, Point, Records, StepLine, What, Words};
use crate::args::CostArgs;
use crate::exit::{Failure, Stage};
use crate::interrupt::Interrupt;
use crate::render::Job;
use crate::report;
use crate::source::{self, Prepared};
use std::cell::Cell;
use std::time::{Duration, Instant};
use twinlight::methods::cost::{
    Effort, METRICS, Measured, Reference, Setting, Sweep, Tried, errors, measure, split,
};
use twinlight::methods::plan::Plan;
use twinlight::methods::post::image::Image;
use twinlight::methods::post::metrics::Metric;
use twinlight::methods::post::tonemap;
use twinlight::methods::reference::{Control, Progress, Settings, StopReason};
use twinlight::{Backend, Error};

/// Most samples per pixel of a half of the reference, if nobody asks for more.
const MOST_SAMPLES: u32 = 4096;

/// The reference's share of the time limit, if nobody asks for samples.
const REFERENCE_SHARE: f64 = 1.0 / 3.0;

/// Added to the seed of what is measured, for the two halves of the reference and the second picture of a split: none has a random number in common with another.
const SEEDS: [u32; 3] = [0x5eed_0001, 0x5eed_0002, 0x5eed_0003];

/// Metrics whose error is a sum of bias and noise.
const SPLIT_METRICS: [Metric; 2] = [Metric::RelMse, Metric::Mse];

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
    pub args: &'a CostArgs,
    pub prepared: &'a Prepared<'a>,
    pub bounces: Option<u32>,
    pub tone: tonemap::Display,
    pub sweep: Sweep,
    pub methods: &'a [&'static str],
    pub records: &'a mut Records,
    pub pictures: &'a Pictures,
    pub progress: &'a Display,
    pub interrupt: &'a Interrupt,
}

impl Study<'_> {
    /// Measures until nothing is left, time is up or a signal comes. `None` without a reference, by which nothing can be judged.
    ///
    /// # Errors
    /// Of the reference, what the backend refuses; of everything, files that can't be written.
    pub fn run<B: Backend>(&mut self, backend: &B) -> Result<(End, Option<Reference>), Failure> {
        let Some(reference) = self.reference(backend)? else { return Ok((self.stopped(), None)) };
        let mut end = self.settings(backend, &reference)?;
        if !matches!(end, End::Signal(_)) {
            self.splits(backend, &reference)?;
            if self.interrupt.caught().is_some() {
                end = self.stopped();
            }
        }
        Ok((end, Some(reference)))
    }

    fn stopped(&self) -> End {
        self.interrupt.caught().map_or(End::Time, End::Signal)
    }

    fn job(&self, method: &'static str, flags: Flags, seed: u32) -> Result<Job, Failure> {
        let render = Render { args: self.args, bounces: self.bounces, seed, method, flags };
        Job::new(&render.picture()?, None, self.prepared)
    }

    fn begin(&self, doing: &str) {
        self.progress.begin(self.records.spent(), self.args.time_limit, self.records.points().count(), doing);
    }

    /// The one of the flag, else that of an earlier run, else a new one.
    fn reference<B: Backend>(&mut self, backend: &B) -> Result<Option<Reference>, Failure> {
        let size = (self.args.size.0, self.args.size.1);
        if let Some(path) = &self.args.reference {
            return self.pictures.read_reference(path, size).map(Some);
        }
        let is_there = self.records.all().iter().any(|record| matches!(record.what, What::Reference { .. }));
        if let Some(known) = self.pictures.kept_reference().filter(|_| is_there) {
            return Ok(Some(known));
        }
        self.begin("the reference");
        let start = Instant::now();
        let (mut halves, mut samples) = (Vec::new(), 0);
        for seed in &SEEDS[..2] {
            let Some((image, taken)) = self.half(backend, *seed)? else { return Ok(None) };
            halves.push(image);
            samples += taken;
        }
        let [first, second] = halves.try_into().unwrap_or_else(|_| unreachable!("two seeds"));
        self.pictures.keep_reference(&first, &second, samples)?;
        self.records.add(start.elapsed().as_secs_f64(), What::Reference { samples })?;
        Reference::of_halves(first, second).map(Some).map_err(Failure::Pictures)
    }

    /// Half of the reference, and its samples per pixel.
    fn half<B: Backend>(&self, backend: &B, seed: u32) -> Result<Option<(Image, u32)>, Failure> {
        let samples = self.args.reference_spp.map_or(MOST_SAMPLES, |spp| spp.div_ceil(2));
        let seed = self.args.seed.wrapping_add(seed);
        let job = self.job("reference", vec![("--spp", samples.to_string())], seed)?;
        let whole = Cell::new(0);
        let observe = |progress: Progress| {
            whole.set(progress.samples);
            if self.interrupt.caught().is_some() { Control::Stop } else { Control::Continue }
        };
        let limit = (0.5 * REFERENCE_SHARE * self.args.time_limit).min(31_536_000.0);
        let time = self.args.reference_spp.is_none().then(|| Duration::from_secs_f64(limit));
        let plan = with_time(&job.plan, time);
        let picture = plan.run(backend, &self.prepared.compiled, &job.camera, observe);
        let picture = picture.map_err(Failure::at(Stage::Device))?;
        if picture.rendered.stop == StopReason::Cancelled {
            return Ok(None);
        }
        Ok(Some((self.image(picture.radiance())?, whole.get())))
    }

    fn image(&self, radiance: Vec<[f32; 3]>) -> Result<Image, Failure> {
        Image::new(self.args.size.0, self.args.size.1, radiance).map_err(Failure::Pictures)
    }

    fn settings<B: Backend>(&mut self, backend: &B, reference: &Reference) -> Result<End, Failure> {
        loop {
            let tried: Vec<Tried> = self.records.all().iter().filter_map(|record| record.tried()).collect();
            let Some(setting) = self.sweep.next(&tried) else { return Ok(End::Complete) };
            if self.interrupt.caught().is_some() {
                return Ok(self.stopped());
            }
            if self.records.spent() + self.splits_to_come() >= self.args.time_limit {
                return Ok(End::Time);
            }
            if !self.setting(backend, reference, &setting)? {
                return Ok(self.stopped());
            }
        }
    }

    /// Measures a setting and notes it down; `false` after a signal.
    fn setting<B: Backend>(
        &mut self,
        backend: &B,
        reference: &Reference,
        setting: &Setting,
    ) -> Result<bool, Failure> {
        let words = Words::of(setting);
        self.begin(&super::page::title(&words));
        let start = Instant::now();
        let job = self.job(setting.method(), setting.flags(), self.args.seed)?;
        let bytes = source::compiled_bytes(&self.prepared.compiled);
        let go_on = || self.interrupt.caught().is_none();
        let (scene, effort) = (&self.prepared.compiled, Effort::default());
        let what = match measure(backend, scene, &job.camera, &job.plan, bytes, &effort, go_on) {
            Ok(None) => return Ok(false),
            Ok(Some(measured)) => self.point(words, measured, reference)?,
            Err(why @ (Error::Unsupported(_) | Error::LimitExceeded { .. } | Error::OutOfMemory { .. })) => {
                What::Failed { setting: words, why: why.to_string() }
            }
            Err(error) => return Err(Failure::Library(Stage::Device, error)),
        };
        if let What::Failed { setting, why } = &what {
            report::notice(&format!("{} left out: {why}", super::page::title(setting)));
        }
        self.records.add(start.elapsed().as_secs_f64(), what)?;
        Ok(true)
    }

    fn point(&self, setting: Words, measured: Measured, reference: &Reference) -> Result<What, Failure> {
        let image = self.image(measured.radiance)?;
        let found = errors(&image, reference.image(), &self.tone).map_err(Failure::Pictures)?;
        self.pictures.keep(&setting, &image)?;
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
            errors: found.map(|value| Some(value).filter(|value| value.is_finite())),
        }))
    }

    /// The setting whose error is split: the finest that was measured, by the least MSE if that failed.
    fn split_setting(&self, method: &str) -> Option<&Point> {
        let mse = METRICS.iter().position(|metric| *metric == Metric::Mse).unwrap_or(0);
        let of_method = || self.records.points().filter(|point| point.setting.method == method);
        let finest = |point: &&Point| {
            point.setting.setting().is_some_and(|setting| setting == Setting::finest(setting.method()))
        };
        let best = || of_method().min_by(|a, b| a.distances()[mse].total_cmp(&b.distances()[mse]));
        of_method().find(finest).or_else(best)
    }

    fn splits_left(&self) -> Vec<Words> {
        let points = self.methods.iter().filter_map(|method| self.split_setting(method));
        let is_known = |setting: &Words| self.records.parts().any(|parts| parts.setting == *setting);
        points.map(|point| point.setting.clone()).filter(|setting| !is_known(setting)).collect()
    }

    /// Seconds that splits are going to take, two renders each.
    fn splits_to_come(&self) -> f64 {
        let left = self.splits_left();
        let points = self.records.points().filter(|point| left.contains(&point.setting));
        points.map(|point| 2.0 * point.seconds.median).sum()
    }

    fn splits<B: Backend>(&mut self, backend: &B, reference: &Reference) -> Result<(), Failure> {
        for words in self.splits_left() {
            let Some(setting) = words.setting() else { continue };
            self.begin(&format!("bias and noise of {}", super::page::title(&words)));
            let start = Instant::now();
            let mut images = Vec::new();
            for seed in [0, SEEDS[2]] {
                let Some(image) = self.picture(backend, &setting, self.args.seed.wrapping_add(seed))? else {
                    return Ok(());
                };
                images.push(image);
            }
            let mut splits = Vec::new();
            for metric in SPLIT_METRICS {
                let found = split(&images, reference, metric).map_err(Failure::Pictures)?;
                splits.extend(found.map(|split| (metric, split)));
            }
            self.records.add(start.elapsed().as_secs_f64(), What::Split(Parts::new(words, &splits)))?;
        }
        Ok(())
    }

    /// A render of a setting; `None` after a signal.
    fn picture<B: Backend>(
        &self,
        backend: &B,
        setting: &Setting,
        seed: u32,
    ) -> Result<Option<Image>, Failure> {
        let job = self.job(setting.method(), setting.flags(), seed)?;
        let observe = |_: Progress| {
            if self.interrupt.caught().is_some() { Control::Stop } else { Control::Continue }
        };
        let picture = job.plan.run(backend, &self.prepared.compiled, &job.camera, observe);
        let picture = picture.map_err(Failure::at(Stage::Device))?;
        let is_whole = picture.rendered.stop == StopReason::Samples;
        is_whole.then(|| self.image(picture.radiance())).transpose()
    }
}

fn with_time(plan: &Plan, time: Option<Duration>) -> Plan {
    let mut plan = plan.clone();
    plan.request.picture = Settings { time, ..plan.request.picture };
    plan
}
