//! What the caller chooses.

use std::time::Duration;
use twinlight_core::kernels::trace_paths::{
    SAMPLER_INDEPENDENT, SAMPLER_SOBOL, TracePathsParams, UNLIMITED_BOUNCES,
};
use twinlight_core::scene::{Camera, CompiledScene};
use twinlight_core::{Error, Result};

/// Where random numbers come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Sampler {
    /// Owen-scrambled Sobol points: less error for the same number of samples.
    #[default]
    Sobol,
    /// Independent hashed numbers: samples whose variance can be estimated from the samples themselves.
    Independent,
}

/// Settings of a reference render.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// Pixels per row, 1 to 16384.
    pub width: u32,
    /// Rows, 1 to 16384.
    pub height: u32,
    /// Samples per pixel, at least 1.
    pub samples: u32,
    /// Index of the first sample: shards of one picture take disjoint ranges, and their films add up to it.
    pub first_sample: u32,
    /// Scattering vertices at most; `None` leaves it to roulette.
    pub bounces: Option<u32>,
    /// Seed of the picture.
    pub seed: u32,
    /// Where random numbers come from.
    pub sampler: Sampler,
    /// Vertex after which roulette begins, 1 to 1024.
    pub roulette_begin: u32,
    /// Stop after this long, but not before every pixel has a sample.
    pub time: Option<Duration>,
    /// What a pass should take, between which a render reports and can be stopped: short enough that stopping feels immediate and no driver thinks that the
    /// device hangs.
    pub pass: Duration,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            width: 512,
            height: 512,
            samples: 64,
            first_sample: 0,
            bounces: None,
            seed: 0,
            sampler: Sampler::Sobol,
            roulette_begin: 4,
            time: None,
            pass: Duration::from_millis(250),
        }
    }
}

impl Settings {
    pub(crate) fn params(&self, camera: &Camera, scene: &CompiledScene) -> Result<TracePathsParams> {
        let size = 1..=16384;
        if !size.contains(&self.width) || !size.contains(&self.height) {
            let what = format!("{}x{} is not within 1x1 and 16384x16384", self.width, self.height);
            return Err(Error::invalid("image size", what));
        }
        if self.samples == 0 {
            return Err(Error::invalid("samples", "0 samples per pixel make no picture"));
        }
        if self.first_sample.checked_add(self.samples).is_none() {
            let what = format!("{} samples from {} pass the last index", self.samples, self.first_sample);
            return Err(Error::invalid("samples", what));
        }
        Ok(TracePathsParams {
            camera: camera.record(self.width, self.height, scene.origin)?,
            width: self.width,
            height: self.height,
            pixel_begin: 0,
            pixel_count: self.width * self.height,
            sample_begin: self.first_sample,
            sample_count: self.samples,
            seed: self.seed,
            max_bounces: self.bounces.unwrap_or(UNLIMITED_BOUNCES),
            roulette_begin: self.roulette_begin,
            sampler: match self.sampler {
                Sampler::Sobol => SAMPLER_SOBOL,
                Sampler::Independent => SAMPLER_INDEPENDENT,
            },
            film_exponent: scene.film_exponent,
            moment_exponent: scene.moment_exponent,
        })
    }
}
