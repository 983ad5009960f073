//! Every metric of a pair of images at once.

use super::flip::{self, DEFAULT_PIXELS_PER_DEGREE};
use super::pair::Pair;
use super::{Metric, mssim, pointwise};
use crate::post::PostError;
use crate::post::image::{ErrorMap, Image};
use crate::post::tonemap::Display;

/// What the display metrics assume about display and viewer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CompareSettings {
    /// Exposure and tone curve of both images.
    pub display: Display,
    /// Pixels per degree of visual angle, for ꟻLIP.
    pub pixels_per_degree: f64,
}

impl Default for CompareSettings {
    /// No exposure, no tone curve (clamp only), and ꟻLIP's own viewing distance.
    fn default() -> Self {
        Self { display: Display::default(), pixels_per_degree: DEFAULT_PIXELS_PER_DEGREE }
    }
}

/// The result: plain fields. [`Metric`] gives their names, keys and formulas.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// The settings it was made with.
    pub settings: CompareSettings,
    /// Pixels per row of both images.
    pub width: u32,
    /// Rows of both images.
    pub height: u32,
    /// Pixels that are finite in both images: all means are over these.
    pub compared_pixels: u64,
    /// Pixels of the image under test with a NaN or an infinity.
    pub non_finite_test: u64,
    /// Pixels of the reference with a NaN or an infinity.
    pub non_finite_reference: u64,
    /// Pixels whose bits differ in any channel; 0 means the same image bit for bit.
    pub differing_pixels: u64,
    /// Mean absolute error.
    pub mae: f64,
    /// Mean squared error.
    pub mse: f64,
    /// √MSE over the reference's range; infinite if the reference is constant and MSE is not 0.
    pub nrmse: f64,
    /// Relative mean squared error.
    pub rel_mse: f64,
    /// Peak signal-to-noise ratio in dB; infinite if the display images are equal.
    pub psnr: f64,
    /// Mean structural similarity.
    pub mssim: f64,
    /// Mean ꟻLIP.
    pub flip: f64,
    /// ꟻLIP per pixel in [0, 1]; NaN where a pixel was left out.
    pub flip_map: ErrorMap,
    /// Mean radiance over the reference's.
    pub radiance_ratio: f64,
    /// Mean radiance per channel, image under test.
    pub mean_test: [f64; 3],
    /// Mean radiance per channel, reference.
    pub mean_reference: [f64; 3],
    /// Largest absolute error of a channel.
    pub max_abs: f64,
    /// Column and row of the first pixel with the largest absolute error.
    pub max_abs_at: (u32, u32),
}

impl Comparison {
    /// Compares `test` with `reference`.
    ///
    /// # Errors
    /// [`PostError::SizeMismatch`], [`PostError::NoFinitePixels`], [`PostError::OutOfRange`] (pixels per degree).
    pub fn new(test: &Image, reference: &Image, settings: &CompareSettings) -> Result<Self, PostError> {
        let pair = Pair::new(test, reference)?;
        let points = pointwise::of_pair(&pair, &settings.display);
        let mssim = mssim::of_pair(&pair, &settings.display)?;
        let flip = flip::of_pair(&pair, &settings.display, settings.pixels_per_degree)?;
        let width = test.width();
        // A width is at most u32::MAX, so column and row fit.
        let at = |index: usize| ((index % width as usize) as u32, (index / width as usize) as u32);
        Ok(Self {
            settings: *settings,
            width,
            height: test.height(),
            compared_pixels: pair.compared,
            non_finite_test: pair.non_finite_test,
            non_finite_reference: pair.non_finite_reference,
            differing_pixels: pair.differing(),
            mae: points.mae,
            mse: points.mse,
            nrmse: points.nrmse,
            rel_mse: points.rel_mse,
            psnr: points.psnr,
            mssim,
            flip: flip.mean,
            flip_map: flip.map,
            radiance_ratio: points.radiance_ratio,
            mean_test: points.mean_test,
            mean_reference: points.mean_reference,
            max_abs: points.max_abs,
            max_abs_at: at(points.max_abs_index),
        })
    }

    /// The number of one metric.
    pub fn value(&self, metric: Metric) -> f64 {
        match metric {
            Metric::Mae => self.mae,
            Metric::Mse => self.mse,
            Metric::Nrmse => self.nrmse,
            Metric::RelMse => self.rel_mse,
            Metric::Psnr => self.psnr,
            Metric::Mssim => self.mssim,
            Metric::Flip => self.flip,
            Metric::RadianceRatio => self.radiance_ratio,
        }
    }
}
