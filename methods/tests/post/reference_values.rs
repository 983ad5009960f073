//! Agreement with the authors' ꟻLIP and with scikit-image's SSIM.
//!
//! How the numbers were obtained, with the patterns of `patterns.rs` in numpy (`float32(byte) / float32(255)`):
//! - `authors`: `flip_evaluator.evaluate(reference, test, "LDR", inputsRGB=False, applyMagma=False, parameters=…)`
//!   of flip-evaluator 1.7 (no parameters, or `{"ppd": 20.0}`), mean of the map in `float64`; probes from the map.
//!   It computes in `f32`.
//! - `in_f64`: the paper's formulas transcribed to numpy in `float64`, with full two-dimensional kernels and
//!   `scipy.ndimage.correlate(…, mode="nearest")`. It separates our rounding from the authors'.
//! - MSSIM: `skimage.metrics.structural_similarity(…, gaussian_weights=True, sigma=1.5,
//!   use_sample_covariance=False, data_range=1)` of scikit-image 0.26.0 on the sRGB-encoded luminance in `float64`.

use crate::patterns::{checker, gradient, line, noise_colour, noisy_gradient, picture};
use twinlight_methods::post::image::Image;
use twinlight_methods::post::metrics::flip::{DEFAULT_PIXELS_PER_DEGREE, flip};
use twinlight_methods::post::metrics::mssim::mssim;
use twinlight_methods::post::tonemap::Display;

/// The authors' `f32` rounds opponent values of about 100 to 4e-6, and errors near zero are roots of differences:
/// 1e-7 becomes 3e-4 at single pixels of flat regions. Their mean is off by up to 3.1e-5 (`lost_line`).
const MEAN_TOLERANCE: f64 = 5e-5;
/// The same at the probed pixels.
const PIXEL_TOLERANCE: f64 = 1e-4;
/// Roots of `f64` roundings: 1e-16 becomes 1e-8 at single pixels, whose mean was off by up to 6e-11.
const F64_TOLERANCE: f64 = 1e-9;
/// Both sides compute in `f64`, without roots.
const SSIM_TOLERANCE: f64 = 1e-12;

struct Expected {
    authors: f64,
    in_f64: f64,
    /// Column, row and the authors' value.
    probes: [(usize, usize, f64); 4],
}

fn check_flip(reference: &Image, test: &Image, ppd: f64, expected: &Expected) {
    let result = flip(test, reference, &Display::default(), ppd).unwrap();
    let mean = result.mean;
    assert!((mean - expected.authors).abs() < MEAN_TOLERANCE, "mean {mean} against {}", expected.authors);
    assert!((mean - expected.in_f64).abs() < F64_TOLERANCE, "mean {mean} against {}", expected.in_f64);
    for (x, y, expected) in expected.probes {
        let value = f64::from(result.map.values()[y * reference.width() as usize + x]);
        assert!((value - expected).abs() < PIXEL_TOLERANCE, "({x}, {y}): {value} against {expected}");
    }
}

fn check_mssim(reference: &Image, test: &Image, expected: f64) {
    let value = mssim(test, reference, &Display::default()).unwrap();
    assert!((value - expected).abs() < SSIM_TOLERANCE, "{value} against {expected}");
}

#[test]
fn gradient_with_noise() {
    let (reference, test) = (picture(48, 40, gradient), picture(48, 40, noisy_gradient));
    let probes = [
        (0, 0, 0.43207886815071106),
        (24, 20, 0.1280241310596466),
        (47, 39, 0.13708728551864624),
        (16, 38, 0.07958220690488815),
    ];
    let expected = Expected { authors: 0.09072142700121427, in_f64: 0.09072141782921044, probes };
    check_flip(&reference, &test, DEFAULT_PIXELS_PER_DEGREE, &expected);
    check_mssim(&reference, &test, 0.7482921630345521);
}

#[test]
fn gradient_with_noise_from_nearby() {
    let (reference, test) = (picture(48, 40, gradient), picture(48, 40, noisy_gradient));
    let probes = [
        (0, 0, 0.47202301025390625),
        (24, 20, 0.22931796312332153),
        (47, 39, 0.1772906631231308),
        (16, 38, 0.1866394281387329),
    ];
    let expected = Expected { authors: 0.2296103123187398, in_f64: 0.2296103239739727, probes };
    check_flip(&reference, &test, 20.0, &expected);
}

#[test]
fn checker_shifted_by_a_pixel() {
    let (reference, test) = (picture(64, 64, checker), picture(64, 64, |x, y| checker(x + 1, y)));
    let probes = [
        (0, 0, 0.07950109988451004),
        (32, 32, 0.2929691672325134),
        (63, 63, 0.984710693359375),
        (21, 62, 0.4973553717136383),
    ];
    let expected = Expected { authors: 0.313328064961481, in_f64: 0.313324712141402, probes };
    check_flip(&reference, &test, DEFAULT_PIXELS_PER_DEGREE, &expected);
    check_mssim(&reference, &test, 0.656493288535399);
}

/// Higher than two bands of the filter, so that a seam between bands would show.
#[test]
fn noise_against_noise() {
    let (reference, test) = (picture(40, 150, noise_colour(0)), picture(40, 150, noise_colour(1)));
    let probes = [
        (0, 0, 0.5609422922134399),
        (20, 75, 0.48522400856018066),
        (39, 149, 0.7030830979347229),
        (13, 148, 0.44758355617523193),
    ];
    let expected = Expected { authors: 0.40181651965218285, in_f64: 0.4018165210789833, probes };
    check_flip(&reference, &test, DEFAULT_PIXELS_PER_DEGREE, &expected);
    check_mssim(&reference, &test, 0.02114967166933725);
}

#[test]
fn noise_against_noise_from_nearby() {
    let (reference, test) = (picture(40, 150, noise_colour(0)), picture(40, 150, noise_colour(1)));
    let probes = [
        (0, 0, 0.4855392277240753),
        (20, 75, 0.4532092213630676),
        (39, 149, 0.8235355019569397),
        (13, 148, 0.9755699038505554),
    ];
    let expected = Expected { authors: 0.8068881209542353, in_f64: 0.8068881303738535, probes };
    check_flip(&reference, &test, 20.0, &expected);
}

/// The pair that defines the end of the scale.
#[test]
fn green_against_blue() {
    let (reference, test) = (picture(16, 16, |_, _| [0, 255, 0]), picture(16, 16, |_, _| [0, 0, 255]));
    let probes = [(0, 0, 1.0), (8, 8, 1.0), (15, 15, 1.0), (5, 14, 1.0)];
    let expected = Expected { authors: 1.0, in_f64: 1.0, probes };
    check_flip(&reference, &test, DEFAULT_PIXELS_PER_DEGREE, &expected);
    check_mssim(&reference, &test, 0.617203522935017);
}

/// Smaller than every filter: the border is repeated far beyond the image.
#[test]
fn five_by_three() {
    let (reference, test) = (picture(5, 3, noise_colour(2)), picture(5, 3, noise_colour(3)));
    let probes = [
        (0, 0, 0.5881394743919373),
        (2, 1, 0.4637380838394165),
        (4, 2, 0.5994300842285156),
        (1, 1, 0.4114539921283722),
    ];
    let expected = Expected { authors: 0.542532612880071, in_f64: 0.542532759869477, probes };
    check_flip(&reference, &test, DEFAULT_PIXELS_PER_DEGREE, &expected);
}

#[test]
fn lost_line() {
    let (reference, test) = (picture(33, 17, line), picture(33, 17, |_, _| [0; 3]));
    let probes = [(0, 0, 0.0), (16, 8, 0.9757386445999146), (32, 16, 0.0), (11, 15, 0.00816767942160368)];
    let expected = Expected { authors: 0.16004321131516586, in_f64: 0.16007378334939557, probes };
    check_flip(&reference, &test, DEFAULT_PIXELS_PER_DEGREE, &expected);
    check_mssim(&reference, &test, 0.5679632133067903);
}
