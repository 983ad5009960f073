//! Which part of each method's error is bias, and which is noise.

use super::page::title;
use super::records::{Parts, Point, What, Words};
use super::study::Study;
use crate::exit::{Failure, Stage};
use std::time::Instant;
use twinlight::Backend;
use twinlight::methods::cost::{METHODS, METRICS, Setting, split};
use twinlight::methods::post::image::Image;
use twinlight::methods::post::metrics::Metric;
use twinlight::methods::reference::StopReason;

/// Added to the seed, of the second of two pictures: no number that is random in one is random in the other.
const SECOND_SEED: u32 = 0x5eed_0003;

/// Metrics whose error is a sum of bias and noise.
const SPLIT_METRICS: [Metric; 2] = [Metric::RelMse, Metric::Mse];

impl Study<'_> {
    /// Splits the error of every method that has a point, unless that was done before.
    ///
    /// # Errors
    /// What the backend refuses, and a file that can't be written.
    pub fn splits<B: Backend>(&mut self, backend: &B) -> Result<(), Failure> {
        for words in self.splits_left() {
            let Some(setting) = words.setting() else { continue };
            self.begin(&format!("bias and noise of {}", title(&words)));
            let start = Instant::now();
            let first = match self.finest.iter().find(|(known, _)| *known == words) {
                Some((_, image)) => Some(image.clone()),
                None => self.picture(backend, &setting, 0)?,
            };
            let Some(first) = first else { return Ok(()) };
            let Some(second) = self.picture(backend, &setting, SECOND_SEED)? else { return Ok(()) };
            let images = [first, second];
            let mut splits = Vec::new();
            for metric in SPLIT_METRICS {
                let found = split(&images, &self.judge.reference, metric).map_err(Failure::Pictures)?;
                splits.extend(found.map(|split| (metric, split)));
            }
            self.records.add(start.elapsed().as_secs_f64(), What::Split(Parts::new(words, &splits)))?;
        }
        Ok(())
    }

    /// Seconds that splits are going to take: a render each, and another where the first is not at hand.
    pub fn splits_to_come(&self) -> f64 {
        let left = self.splits_left();
        let points = self.records.points().filter(|point| left.contains(&point.setting));
        let is_there = |setting: &Words| self.finest.iter().any(|(known, _)| known == setting);
        let renders = |point: &Point| if is_there(&point.setting) { 1.0 } else { 2.0 };
        points.map(|point| renders(point) * point.seconds.median).sum()
    }

    /// Of the settings that are split, those that were. Where a finer one was measured since, an older split says nothing any more.
    pub fn splits_known(&self) -> impl Iterator<Item = &Parts> {
        let points = METHODS.iter().filter_map(|(method, _)| self.split_point(method));
        points.filter_map(|point| self.records.parts().find(|parts| parts.setting == point.setting))
    }

    fn splits_left(&self) -> Vec<Words> {
        let points = self.methods.iter().filter_map(|method| self.split_point(method));
        let is_known = |setting: &Words| self.records.parts().any(|parts| parts.setting == *setting);
        points.map(|point| point.setting.clone()).filter(|setting| !is_known(setting)).collect()
    }

    /// That of the finest setting; if it was not measured, the one of the least MSE.
    fn split_point(&self, method: &str) -> Option<&Point> {
        let mse = METRICS.iter().position(|metric| *metric == Metric::Mse)?;
        let of_method = || self.records.points().filter(|point| point.setting.method == method);
        let best = || of_method().min_by(|a, b| a.distances()[mse].total_cmp(&b.distances()[mse]));
        of_method().find(|point| point.setting.is_finest()).or_else(best)
    }

    /// A render of a setting; `None` after a signal.
    fn picture<B: Backend>(
        &self,
        backend: &B,
        setting: &Setting,
        seed: u32,
    ) -> Result<Option<Image>, Failure> {
        let setup = self.setup;
        let seed = setup.args.seed.wrapping_add(seed);
        let job = setup.job(setting.method(), setting.flags(), seed)?;
        let scene = &setup.prepared.compiled;
        let picture = job.plan.run(backend, scene, &job.camera, |progress| setup.control(progress));
        let picture = picture.map_err(Failure::at(Stage::Device))?;
        let is_whole = picture.rendered.stop == StopReason::Samples;
        is_whole.then(|| setup.image(picture.radiance())).transpose()
    }
}
