//! How much of an error is bias, and how much is noise.

use super::Reference;
use crate::post::PostError;
use crate::post::image::Image;
use crate::post::metrics::Metric;
use crate::post::metrics::pointwise::REL_MSE_EPSILON;

/// A mean squared error in two parts: E(x − t)² = (E x − t)² + var x, with t the picture that the reference estimates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Split {
    /// (E x − t)²: what no number of samples removes. An estimate that may come out below 0 where there is hardly any.
    pub bias: f64,
    /// Standard error of `bias`, as if pixels were independent.
    pub bias_error: f64,
    /// var x, of one picture.
    pub noise: f64,
}

impl Split {
    /// What one picture's error against a perfect reference is expected to be.
    pub fn total(&self) -> f64 {
        self.bias + self.noise
    }
}

/// Splits the error of `pictures`, which differ in nothing but their seed, by [`Metric::Mse`] or [`Metric::RelMse`]; `None` for another metric, for which
/// there is no such sum, and for fewer than two pictures.
///
/// With n pictures x, their mean m and their sample variance s², and with a reference r whose own variance is v, every value of every
/// pixel has E(m − r)² = bias² + s²/n + v, so that
///
/// - noise = mean w s²,
/// - bias² = mean w ((m − r)² − s²/n − v),
///
/// without a systematic error, for weights w of 1 (MSE) or 1/(r² + 0.01) (relMSE, whose r is taken as given). v comes from the halves of the reference,
/// (r₁ − r₂)²/4; where there are none, it is taken for 0, and counts as bias.
///
/// # Errors
/// [`PostError::SizeMismatch`].
pub fn split(pictures: &[Image], reference: &Reference, metric: Metric) -> Result<Option<Split>, PostError> {
    if pictures.len() < 2 || !matches!(metric, Metric::Mse | Metric::RelMse) {
        return Ok(None);
    }
    pictures.iter().try_for_each(|picture| picture.expect_same_size(reference.image()))?;
    let mut sums = Sums::default();
    for (pixel, channel) in (0..reference.image().pixels().len()).flat_map(|p| [(p, 0), (p, 1), (p, 2)]) {
        let r = f64::from(reference.image().pixels()[pixel][channel]);
        let weight = if metric == Metric::Mse { 1.0 } else { 1.0 / (r * r + REL_MSE_EPSILON) };
        let values = pictures.iter().map(|picture| f64::from(picture.pixels()[pixel][channel]));
        sums.add(weight, values, pictures.len() as f64, r, reference.variance(pixel, channel));
    }
    Ok(Some(sums.finish()))
}

#[derive(Default)]
struct Sums {
    count: f64,
    bias: f64,
    bias_squared: f64,
    noise: f64,
}

impl Sums {
    fn add(&mut self, weight: f64, values: impl Iterator<Item = f64> + Clone, n: f64, r: f64, v: f64) {
        let mean = values.clone().sum::<f64>() / n;
        let variance = values.map(|x| (x - mean) * (x - mean)).sum::<f64>() / (n - 1.0);
        let bias = weight * ((mean - r) * (mean - r) - variance / n - v);
        // A pixel that is no number in any picture says nothing about the others.
        if bias.is_finite() {
            self.count += 1.0;
            self.bias += bias;
            self.bias_squared += bias * bias;
            self.noise += weight * variance;
        }
    }

    fn finish(self) -> Split {
        let mean = |sum: f64| sum / self.count;
        let spread = mean(self.bias_squared) - mean(self.bias) * mean(self.bias);
        let bias_error = (spread.max(0.0) / self.count).sqrt();
        Split { bias: mean(self.bias), bias_error, noise: mean(self.noise) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use twinlight_core::math::hash::{mix_pair, to_unit};

    const SIDE: u32 = 64;

    /// Pictures of truth + bias + noise of variance `spread`²/12, from hashed numbers.
    fn picture(seed: u32, bias: f64, spread: f64) -> Image {
        let noise = |x, y, channel| f64::from(to_unit(mix_pair(mix_pair(seed, x), 3 * y + channel))) - 0.5;
        Image::from_fn(SIDE, SIDE, |x, y| {
            [0, 1, 2].map(|channel| (2.0 + bias + spread * noise(x, y, channel)) as f32)
        })
        .unwrap()
    }

    fn reference(spread: f64) -> Reference {
        Reference::of_halves(picture(1001, 0.0, spread), picture(1002, 0.0, spread)).unwrap()
    }

    /// The estimates are means of 12288 values: their standard errors are below 2 % of the parts, and 5 % is beyond two of them, for numbers
    /// that are the same in every run.
    fn near(estimate: f64, truth: f64, scale: f64) {
        assert!((estimate - truth).abs() < 0.05 * scale, "{estimate} for {truth}");
    }

    #[test]
    fn known_bias_and_known_noise_come_out() {
        for (bias, spread, own) in [(0.1, 0.3, 0.2), (0.0, 0.3, 0.2), (0.1, 0.0, 0.2), (0.1, 0.3, 0.0)] {
            for count in [2, 5] {
                let pictures: Vec<Image> = (0..count).map(|seed| picture(seed, bias, spread)).collect();
                let split = split(&pictures, &reference(own), Metric::Mse).unwrap().unwrap();
                near(split.bias, bias * bias, 0.01);
                near(split.noise, spread * spread / 12.0, 0.01);
                assert!((split.bias - bias * bias).abs() <= 4.0 * split.bias_error + 1e-6, "{split:?}");
                assert_eq!(split.total(), split.bias + split.noise);
            }
        }
    }

    /// Without halves, the reference's variance is part of what looks like bias.
    #[test]
    fn unknown_noise_of_the_reference_counts_as_bias() {
        let pictures = [picture(1, 0.0, 0.3), picture(2, 0.0, 0.3)];
        let known = reference(0.4);
        let unknown = Reference::single(known.image().clone());
        let bias = |reference| split(&pictures, reference, Metric::Mse).unwrap().unwrap().bias;
        // Half the variance of a half.
        near(bias(&unknown) - bias(&known), 0.4 * 0.4 / 24.0, 0.01);
    }

    #[test]
    fn relative_errors_are_weighted() {
        let pictures = [picture(1, 0.1, 0.3), picture(2, 0.1, 0.3)];
        let of = |metric| split(&pictures, &reference(0.0), metric).unwrap();
        let (mse, relative) = (of(Metric::Mse).unwrap(), of(Metric::RelMse).unwrap());
        // The reference is 2 everywhere.
        assert!((relative.bias - mse.bias / 4.01).abs() < 1e-12, "sums of the same terms, rounded");
        assert!((relative.noise - mse.noise / 4.01).abs() < 1e-12);
        assert_eq!(of(Metric::Flip), None);
        assert_eq!(split(&pictures[..1], &reference(0.0), Metric::Mse), Ok(None));
    }

    #[test]
    fn pixels_that_are_no_numbers_are_left_out() {
        let hole = |image: Image| {
            let mut pixels = image.into_pixels();
            pixels[7][1] = f32::NAN;
            Image::new(SIDE, SIDE, pixels).unwrap()
        };
        let pictures = [hole(picture(1, 0.1, 0.3)), picture(2, 0.1, 0.3)];
        let split = split(&pictures, &reference(0.2), Metric::Mse).unwrap().unwrap();
        near(split.bias, 0.01, 0.01);
    }
}
