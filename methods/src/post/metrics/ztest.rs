//! Can two noisy estimates have one expectation? A z-test per pixel and channel with Šidák's correction (as
//! Mitsuba 3's render tests), and a test of the signed sum of differences (OSPRay's idea: noise cancels over an
//! image, bias does not).
//!
//! Assumptions, to be kept in mind where a result surprises: means of enough samples are close to normal; the
//! given variances are good estimates (from few samples the tails are Student's and heavier, and a pixel whose rare
//! bright path was never sampled has too small a variance: hence `allowed_fraction`); pixels are independent of each
//! other (Šidák stays valid, on the safe side, for the positive correlation of the channels of one pixel).

mod normal;

use crate::post::PostError;
use crate::post::image::{ErrorMap, Image, is_finite};
use normal::{sidak, two_sided_p, two_sided_threshold};

/// What is computed, for printing. ma, mb are the means, va, vb their variances, of one channel of one pixel.
pub const FORMULA: &str = "z = (ma - mb) / sqrt(va + vb + s^2), s = 2^-24 (|ma| + |mb|); \
    |z| <= z*, two-sided p(z*) = 1 - (1 - alpha)^(1/n); \
    bias per channel: sum (ma - mb) / sqrt(sum (va + vb + s^2)), same test with n = 3";

/// Half a unit in the last place of an `f32` in [1, 2): what storing a mean may have cost.
const F32_ROUNDING: f64 = 1.0 / (1u32 << 24) as f64;

/// An estimator's image: the mean of its samples and the variance **of that mean** (sample variance / samples).
#[derive(Clone, Copy, Debug)]
pub struct Estimate<'a> {
    /// Mean per pixel and channel.
    pub mean: &'a Image,
    /// Variance of the mean per pixel and channel, radiance squared.
    pub variance_of_mean: &'a Image,
}

/// How strict the test is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ZTestSettings {
    /// Probability with which equal expectations may fail, over the whole image; in (0, 1).
    pub alpha: f64,
    /// Fraction of all values that may fail, in [0, 1): variances are estimates too.
    pub allowed_fraction: f64,
}

impl Default for ZTestSettings {
    /// Mitsuba 3's: α 0.01, 0.25 % of the values.
    fn default() -> Self {
        Self { alpha: 0.01, allowed_fraction: 0.0025 }
    }
}

/// The result: plain fields.
#[derive(Clone, Debug, PartialEq)]
pub struct ZTest {
    /// The settings it was made with.
    pub settings: ZTestSettings,
    /// Values tested: three per pixel that is finite everywhere.
    pub values: u64,
    /// Pixels left out because a mean or a variance is NaN or infinite.
    pub non_finite_pixels: u64,
    /// |z| above this fails.
    pub threshold: f64,
    /// Values that fail.
    pub failures: u64,
    /// Largest |z|.
    pub max_abs_z: f64,
    /// Column, row and channel of the first value with the largest |z|.
    pub worst: (u32, u32, usize),
    /// Probability of a |z| this large or larger anywhere in the image, were the expectations equal.
    pub corrected_p: f64,
    /// Signed-bias statistic per channel; positive where the first estimator is brighter.
    pub bias_z: [f64; 3],
    /// |bias z| above this fails.
    pub bias_threshold: f64,
    /// Σ(a − b) / Σ|a − b| per channel, in [-1, 1]; 0 where nothing differs. Descriptive: not tested.
    pub signed_ratio: [f64; 3],
    /// Largest |z| of each pixel's channels; NaN where a pixel was left out.
    pub map: ErrorMap,
}

impl ZTest {
    /// Tests estimator `a` against estimator `b`.
    ///
    /// # Errors
    /// [`PostError::SizeMismatch`], [`PostError::NegativeVariance`], [`PostError::NoFinitePixels`],
    /// [`PostError::OutOfRange`] (α or the allowed fraction).
    pub fn new(a: Estimate, b: Estimate, settings: ZTestSettings) -> Result<Self, PostError> {
        check_settings(&settings)?;
        for image in [a.variance_of_mean, b.mean, b.variance_of_mean] {
            a.mean.expect_same_size(image)?;
        }
        check_variances(a.variance_of_mean)?;
        check_variances(b.variance_of_mean)?;

        let width = a.mean.width() as usize;
        let mut sums = Sums::default();
        let mut scores = Vec::with_capacity(a.mean.pixels().len());
        let mut map = Vec::with_capacity(a.mean.pixels().len());
        for index in 0..a.mean.pixels().len() {
            let score = score(&a, &b, index).map(|values| sums.add(values));
            // The sum saw the pixel; what stays is z per channel.
            map.push(score.map_or(f32::NAN, |z| largest(z) as f32));
            scores.push(score);
        }
        let values = 3 * scores.iter().flatten().count() as u64;
        if values == 0 {
            let (test, reference) = (unusable(&a), unusable(&b));
            return Err(PostError::NoFinitePixels { test, reference });
        }
        let threshold = two_sided_threshold(sidak(settings.alpha, values));
        let (max_abs_z, worst) = worst_of(&scores, width);
        Ok(Self {
            settings,
            values,
            non_finite_pixels: scores.iter().filter(|score| score.is_none()).count() as u64,
            threshold,
            failures: scores.iter().flatten().flatten().filter(|z| z.abs() > threshold).count() as u64,
            max_abs_z,
            worst,
            corrected_p: normal::any_of(two_sided_p(max_abs_z), values),
            bias_z: sums.bias_z(),
            bias_threshold: two_sided_threshold(sidak(settings.alpha, 3)),
            signed_ratio: sums.signed_ratio(),
            map: ErrorMap::new(a.mean.width(), a.mean.height(), map)?,
        })
    }

    /// Whether no more values fail than allowed.
    pub fn pixels_pass(&self) -> bool {
        self.failures as f64 <= self.settings.allowed_fraction * self.values as f64
    }

    /// Whether no channel's signed bias is significant.
    pub fn bias_passes(&self) -> bool {
        self.bias_z.iter().all(|z| z.abs() <= self.bias_threshold)
    }

    /// Both tests.
    pub fn passes(&self) -> bool {
        self.pixels_pass() && self.bias_passes()
    }
}

fn check_settings(settings: &ZTestSettings) -> Result<(), PostError> {
    if !(settings.alpha > 0.0 && settings.alpha < 1.0) {
        return Err(PostError::OutOfRange { name: "alpha", range: "(0, 1)", value: settings.alpha });
    }
    if !(0.0..1.0).contains(&settings.allowed_fraction) {
        let value = settings.allowed_fraction;
        return Err(PostError::OutOfRange { name: "allowed fraction", range: "[0, 1)", value });
    }
    Ok(())
}

fn check_variances(image: &Image) -> Result<(), PostError> {
    for (index, pixel) in image.pixels().iter().enumerate() {
        if let Some(channel) = pixel.iter().position(|&value| value < 0.0) {
            let width = image.width() as usize;
            let (x, y) = ((index % width) as u32, (index / width) as u32);
            return Err(PostError::NegativeVariance { x, y, channel, value: pixel[channel] });
        }
    }
    Ok(())
}

/// Difference and its variance per channel.
type Score = [(f64, f64); 3];

/// `None` if anything about the pixel is NaN or infinite.
fn score(a: &Estimate, b: &Estimate, index: usize) -> Option<Score> {
    let pixels = [a.mean, a.variance_of_mean, b.mean, b.variance_of_mean].map(|image| image.pixels()[index]);
    if !pixels.iter().all(is_finite) {
        return None;
    }
    let [ma, va, mb, vb] = pixels.map(|pixel| pixel.map(f64::from));
    Some(std::array::from_fn(|c| {
        // Two noiseless estimators may still round to neighbouring f32 values; without this term any such
        // difference over a variance of zero would be an infinite z.
        let rounding = F32_ROUNDING * (ma[c].abs() + mb[c].abs());
        (ma[c] - mb[c], va[c] + vb[c] + rounding * rounding)
    }))
}

/// Sums for the bias test. Differences are summed as they are, not as z: mean and sample variance of skewed
/// estimates are correlated, so a sum of z would show a bias that is not there.
#[derive(Default)]
struct Sums {
    signed: [f64; 3],
    absolute: [f64; 3],
    variance: [f64; 3],
}

impl Sums {
    /// Takes a pixel in and returns its z per channel.
    fn add(&mut self, score: Score) -> [f64; 3] {
        for (c, (difference, variance)) in score.into_iter().enumerate() {
            self.signed[c] += difference;
            self.absolute[c] += difference.abs();
            self.variance[c] += variance;
        }
        score.map(|(difference, variance)| quotient(difference, variance.sqrt()))
    }

    fn bias_z(&self) -> [f64; 3] {
        std::array::from_fn(|c| quotient(self.signed[c], self.variance[c].sqrt()))
    }

    fn signed_ratio(&self) -> [f64; 3] {
        std::array::from_fn(|c| quotient(self.signed[c], self.absolute[c]))
    }
}

/// 0 / 0 is no evidence of a difference.
fn quotient(a: f64, b: f64) -> f64 {
    if a == 0.0 { 0.0 } else { a / b }
}

fn largest(z: [f64; 3]) -> f64 {
    z.iter().fold(0.0, |most: f64, z| most.max(z.abs()))
}

fn worst_of(scores: &[Option<[f64; 3]>], width: usize) -> (f64, (u32, u32, usize)) {
    let mut worst = (-1.0, (0, 0, 0));
    for (index, z) in scores.iter().enumerate().filter_map(|(index, z)| z.map(|z| (index, z))) {
        for (channel, z) in z.iter().enumerate() {
            if z.abs() > worst.0 {
                worst = (z.abs(), ((index % width) as u32, (index / width) as u32, channel));
            }
        }
    }
    worst
}

fn unusable(estimate: &Estimate) -> u64 {
    let both = estimate.mean.pixels().iter().zip(estimate.variance_of_mean.pixels());
    both.filter(|(mean, variance)| !is_finite(mean) || !is_finite(variance)).count() as u64
}
