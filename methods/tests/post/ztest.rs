//! The z-test on synthetic estimators: what it must let pass and what it must catch.

use crate::patterns::noise;
use twinlight_methods::post::PostError;
use twinlight_methods::post::image::Image;
use twinlight_methods::post::metrics::ztest::{Estimate, ZTest, ZTestSettings};

/// Mean and variance-of-mean images.
struct Images {
    mean: Image,
    variance: Image,
}

impl Images {
    fn filled(mean: f32, variance: f32) -> Self {
        Self { mean: flat(mean), variance: flat(variance) }
    }

    fn estimate(&self) -> Estimate<'_> {
        Estimate { mean: &self.mean, variance_of_mean: &self.variance }
    }
}

fn flat(value: f32) -> Image {
    Image::filled(4, 4, [value; 3]).unwrap()
}

fn run(a: &Images, b: &Images, settings: ZTestSettings) -> Result<ZTest, PostError> {
    ZTest::new(a.estimate(), b.estimate(), settings)
}

const STRICT: ZTestSettings = ZTestSettings { alpha: 0.01, allowed_fraction: 0.0 };

/// An estimator of `truth`: mean and variance of the mean of 32 uniform samples of width 1 per channel.
fn sampled(truth: f64, seed: u32, size: u32) -> Images {
    const SAMPLES: u32 = 32;
    let moments = |x: u32, y: u32, channel: u32| {
        let samples: Vec<f64> = (0..SAMPLES)
            .map(|sample| {
                // Two bytes of noise per sample, at places far apart.
                let (px, py) = (x * SAMPLES + sample, y + 4096 * channel);
                let value = noise(px, py, seed) * 256 + noise(px, py, seed + 77);
                truth + (f64::from(value) + 0.5) / 65536.0 - 0.5
            })
            .collect();
        let mean = samples.iter().sum::<f64>() / f64::from(SAMPLES);
        let squares: f64 = samples.iter().map(|sample| (sample - mean) * (sample - mean)).sum();
        (mean as f32, (squares / f64::from(SAMPLES - 1) / f64::from(SAMPLES)) as f32)
    };
    let image = |pick: fn((f32, f32)) -> f32| {
        Image::from_fn(size, size, |x, y| [0, 1, 2].map(|channel| pick(moments(x, y, channel)))).unwrap()
    };
    Images { mean: image(|m| m.0), variance: image(|m| m.1) }
}

#[test]
fn z_by_hand() {
    // Difference 3, standard deviation sqrt(0.75 + 0.25) = 1, in 48 values.
    let result = run(&Images::filled(4.0, 0.75), &Images::filled(1.0, 0.25), STRICT).unwrap();
    // The rounding term adds 5 * 2^-24 squared to a variance of 1: 1e-13.
    assert!((result.max_abs_z - 3.0).abs() < 1e-12);
    assert_eq!((result.worst, result.values), ((0, 0, 0), 48));
    for channel in 0..3 {
        // Sum of 16 differences of 3 over sqrt(16).
        assert!((result.bias_z[channel] - 12.0).abs() < 1e-11);
        assert_eq!(result.signed_ratio[channel], 1.0);
    }
    // Šidák for 48 tests at 0.01 is p = 2.0936e-4, two-sided z = 3.7075: 3 is no surprise, a bias of 12 is.
    assert!((result.threshold - 3.7075).abs() < 1e-3, "{}", result.threshold);
    // For the three channels p = 3.3445e-3, z = 2.9342.
    assert!((result.bias_threshold - 2.9342).abs() < 1e-3, "{}", result.bias_threshold);
    assert!(result.pixels_pass() && !result.bias_passes() && !result.passes());
}

#[test]
fn equal_expectations_pass_and_unequal_ones_do_not() {
    let reference = sampled(1.0, 1, 24);
    let same = run(&sampled(1.0, 2, 24), &reference, ZTestSettings::default()).unwrap();
    assert!(same.passes(), "{:?} {:?} {}", same.bias_z, same.bias_threshold, same.failures);
    // The statistics are not idle: noise moves z, and about as far as 1728 normal values should.
    assert!(same.max_abs_z > 2.5 && same.max_abs_z < same.threshold);
    assert!(same.corrected_p > 0.01 && same.corrected_p < 1.0);

    // 1 % darker: invisible in any pixel (the deviation of a mean is 5 %), plain in the sum.
    let darker = run(&sampled(0.99, 2, 24), &reference, ZTestSettings::default()).unwrap();
    assert!(darker.pixels_pass() && !darker.bias_passes());
    assert!(darker.bias_z.iter().all(|&z| z < 0.0));
}

#[test]
fn signed_ratio_by_hand() {
    // Twelve differences of 3 and four of -1 in red: (36 - 4) / (36 + 4); green and blue cancel or agree.
    let means = |x: u32| if x < 3 { [3.0, 1.0, 0.0] } else { [-1.0, -3.0, 0.0] };
    let a = Images { mean: Image::from_fn(4, 4, |x, _| means(x)).unwrap(), variance: flat(1.0) };
    let result = run(&a, &Images::filled(0.0, 1.0), STRICT).unwrap();
    assert_eq!(result.signed_ratio, [0.8, 0.0, 0.0]);
}

#[test]
fn one_wrong_pixel_is_found() {
    let good = Images::filled(1.0, 0.01);
    let mut pixels = good.mean.pixels().to_vec();
    pixels[9][1] = 2.0;
    let bad = Images { mean: Image::new(4, 4, pixels).unwrap(), variance: flat(0.01) };
    let result = run(&bad, &good, STRICT).unwrap();
    assert_eq!((result.failures, result.worst), (1, (1, 2, 1)));
    assert!(result.map.values()[9] > 7.0 && result.map.values()[8] == 0.0);
    assert!(!result.pixels_pass() && result.corrected_p < 1e-9);
    // One of 48 values is 2.1 %.
    let lenient = ZTestSettings { allowed_fraction: 0.03, ..STRICT };
    assert!(run(&bad, &good, lenient).unwrap().pixels_pass());
}

#[test]
fn without_noise_only_rounding_is_forgiven() {
    let exact = Images::filled(1.0, 0.0);
    let neighbour = Images::filled(1.0 + f32::EPSILON, 0.0);
    let result = run(&exact, &exact, STRICT).unwrap();
    assert_eq!((result.max_abs_z, result.bias_z, result.corrected_p), (0.0, [0.0; 3], 1.0));
    assert!(run(&exact, &neighbour, STRICT).unwrap().pixels_pass());
    assert!(!run(&exact, &Images::filled(1.00001, 0.0), STRICT).unwrap().pixels_pass());
    let black = Images::filled(0.0, 0.0);
    assert!(run(&black, &black, STRICT).unwrap().passes());
}

#[test]
fn exchanging_the_estimators_changes_the_sign_only() {
    let (a, b) = (sampled(0.5, 3, 8), sampled(0.7, 4, 8));
    let (there, back) = (run(&a, &b, STRICT).unwrap(), run(&b, &a, STRICT).unwrap());
    assert_eq!(there.bias_z, back.bias_z.map(|z| -z));
    assert_eq!((there.failures, &there.map), (back.failures, &back.map));
}

#[test]
fn non_finite_pixels_are_counted_and_left_out() {
    let good = Images::filled(1.0, 0.01);
    let mut means = good.mean.pixels().to_vec();
    means[0][2] = f32::NAN;
    let mut variances = good.variance.pixels().to_vec();
    variances[5][0] = f32::INFINITY;
    let bad =
        Images { mean: Image::new(4, 4, means).unwrap(), variance: Image::new(4, 4, variances).unwrap() };
    let result = run(&bad, &good, STRICT).unwrap();
    assert_eq!((result.non_finite_pixels, result.values), (2, 42));
    assert!(result.passes() && result.map.values()[5].is_nan());
    let error = run(&Images::filled(f32::NAN, 0.0), &good, STRICT).unwrap_err();
    assert_eq!(error, PostError::NoFinitePixels { test: 16, reference: 0 });
}

#[test]
fn wrong_input_is_an_error() {
    let good = Images::filled(1.0, 0.01);
    let mut variances = good.variance.pixels().to_vec();
    variances[6] = [0.0, -0.5, 0.0];
    let negative = Images { mean: flat(1.0), variance: Image::new(4, 4, variances).unwrap() };
    let expected = PostError::NegativeVariance { x: 2, y: 1, channel: 1, value: -0.5 };
    assert_eq!(run(&good, &negative, STRICT).unwrap_err(), expected);
    let small = Images { mean: flat(1.0), variance: Image::filled(2, 2, [0.0; 3]).unwrap() };
    assert!(matches!(run(&good, &small, STRICT), Err(PostError::SizeMismatch { .. })));
    for (alpha, allowed_fraction) in [(0.0, 0.0), (1.0, 0.0), (f64::NAN, 0.0), (0.1, 1.0), (0.1, -0.1)] {
        let settings = ZTestSettings { alpha, allowed_fraction };
        assert!(matches!(run(&good, &good, settings), Err(PostError::OutOfRange { .. })));
    }
}
