//! Metrics that look at one pixel at a time: MAE, MSE, NRMSE, relMSE, PSNR, radiance ratio.

use super::pair::{Pair, Side};
use crate::post::image::Image;
use crate::post::tonemap::Display;
use crate::post::{PostError, srgb};

/// Added to the square of the reference in relMSE, so that black pixels count finitely.
pub const REL_MSE_EPSILON: f64 = 0.01;

/// All pointwise metrics of a pair; formulas in [`Metric::formula`](super::Metric::formula).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pointwise {
    /// Mean absolute error, linear radiance.
    pub mae: f64,
    /// Mean squared error, linear radiance squared.
    pub mse: f64,
    /// √MSE over the reference's range. A reference without a range gives 0 where MSE is 0, else infinity.
    pub nrmse: f64,
    /// Mean of squared error over (reference² + [`REL_MSE_EPSILON`]).
    pub rel_mse: f64,
    /// Peak signal-to-noise ratio of the sRGB-encoded display image, dB; infinite where nothing differs.
    pub psnr: f64,
    /// Mean radiance per channel of the image under test.
    pub mean_test: [f64; 3],
    /// Mean radiance per channel of the reference.
    pub mean_reference: [f64; 3],
    /// Mean radiance over the reference's, all channels together. Both zero gives 1.
    pub radiance_ratio: f64,
    /// Largest absolute error of a channel, linear radiance.
    pub max_abs: f64,
    /// Pixel index (row · width + column) of the first channel that has the largest absolute error.
    pub max_abs_index: usize,
}

/// Computes every pointwise metric in one pass over the images.
///
/// # Errors
/// [`PostError::SizeMismatch`], [`PostError::NoFinitePixels`].
pub fn pointwise(test: &Image, reference: &Image, display: &Display) -> Result<Pointwise, PostError> {
    Ok(of_pair(&Pair::new(test, reference)?, display))
}

pub(super) fn of_pair(pair: &Pair, display: &Display) -> Pointwise {
    let mut sums = Sums::default();
    for (index, x, r) in pair.compared_pixels() {
        sums.add(index, x.map(f64::from), r.map(f64::from));
        let shown = [Side::Test, Side::Reference].map(|side| pair.shown(side, display, index));
        sums.add_shown(shown[0].map(srgb::encode), shown[1].map(srgb::encode));
    }
    sums.finish(pair.compared as f64)
}

struct Sums {
    absolute: f64,
    squared: f64,
    relative: f64,
    shown_squared: f64,
    test: [f64; 3],
    reference: [f64; 3],
    low: f64,
    high: f64,
    max_abs: f64,
    max_abs_index: usize,
}

impl Default for Sums {
    fn default() -> Self {
        Self {
            absolute: 0.0,
            squared: 0.0,
            relative: 0.0,
            shown_squared: 0.0,
            test: [0.0; 3],
            reference: [0.0; 3],
            low: f64::INFINITY,
            high: f64::NEG_INFINITY,
            // Below every error, so that the first compared pixel is the place of an error of zero.
            max_abs: -1.0,
            max_abs_index: 0,
        }
    }
}

impl Sums {
    fn add(&mut self, index: usize, x: [f64; 3], r: [f64; 3]) {
        for channel in 0..3 {
            let (x, r) = (x[channel], r[channel]);
            let error = x - r;
            self.absolute += error.abs();
            self.squared += error * error;
            self.relative += error * error / (r * r + REL_MSE_EPSILON);
            self.test[channel] += x;
            self.reference[channel] += r;
            self.low = self.low.min(r);
            self.high = self.high.max(r);
            if error.abs() > self.max_abs {
                (self.max_abs, self.max_abs_index) = (error.abs(), index);
            }
        }
    }

    fn add_shown(&mut self, x: [f64; 3], r: [f64; 3]) {
        for channel in 0..3 {
            let error = x[channel] - r[channel];
            self.shown_squared += error * error;
        }
    }

    fn finish(&self, pixels: f64) -> Pointwise {
        let values = 3.0 * pixels;
        let mse = self.squared / values;
        let mean_test = self.test.map(|sum| sum / pixels);
        let mean_reference = self.reference.map(|sum| sum / pixels);
        let total = |means: [f64; 3]| means[0] + means[1] + means[2];
        Pointwise {
            mae: self.absolute / values,
            mse,
            nrmse: ratio(mse.sqrt(), self.high - self.low, 0.0),
            rel_mse: self.relative / values,
            // 1 / 0 is infinity, whose logarithm is infinity: equal images need no case of their own.
            psnr: 10.0 * (values / self.shown_squared).log10(),
            mean_test,
            mean_reference,
            radiance_ratio: ratio(total(mean_test), total(mean_reference), 1.0),
            max_abs: self.max_abs,
            max_abs_index: self.max_abs_index,
        }
    }
}

/// `a / b`, and `neither` for 0 / 0.
fn ratio(a: f64, b: f64, neither: f64) -> f64 {
    if a == 0.0 && b == 0.0 { neither } else { a / b }
}
