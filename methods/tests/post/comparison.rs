//! Known answers of small pictures, and every awkward input.

use crate::patterns::{noise_colour, picture};
use twinlight_methods::post::PostError;
use twinlight_methods::post::image::Image;
use twinlight_methods::post::metrics::{CompareSettings, Comparison, Metric};
use twinlight_methods::post::tonemap::{Display, Operator};

fn image(width: u32, pixels: &[[f32; 3]]) -> Image {
    Image::new(width, pixels.len() as u32 / width, pixels.to_vec()).unwrap()
}

fn compare(test: &Image, reference: &Image) -> Comparison {
    Comparison::new(test, reference, &CompareSettings::default()).unwrap()
}

/// Equality up to `relative`; the sums below have a handful of `f64` roundings.
fn assert_close(value: f64, expected: f64) {
    assert!((value - expected).abs() <= 1e-14 * expected.abs(), "{value} against {expected}");
}

#[test]
fn two_pixels_by_hand() {
    // Every number is a sum of powers of two, so the f32 inputs are exact.
    let reference = image(2, &[[0.0, 0.5, 1.0], [2.0, 0.25, 0.0]]);
    let test = image(2, &[[0.5, 0.5, 0.5], [3.0, 0.0, 0.0]]);
    let result = compare(&test, &reference);
    // Errors: 1/2, 0, -1/2 | 1, -1/4, 0.
    assert_close(result.mae, 2.25 / 6.0);
    assert_close(result.mse, (0.25 + 0.25 + 1.0 + 0.0625) / 6.0);
    assert_close(result.nrmse, (1.5625f64 / 6.0).sqrt() / 2.0);
    let relative = 0.25 / 0.01 + 0.25 / 1.01 + 1.0 / 4.01 + 0.0625 / (0.0625 + 0.01);
    assert_close(result.rel_mse, relative / 6.0);
    assert_close(result.radiance_ratio, 4.5 / 3.75);
    assert_eq!(result.mean_test, [1.75, 0.25, 0.25]);
    assert_eq!(result.mean_reference, [1.0, 0.375, 0.5]);
    assert_eq!((result.max_abs, result.max_abs_at), (1.0, (1, 0)));
    assert_eq!((result.differing_pixels, result.compared_pixels), (2, 2));
    let fields = [
        result.mae,
        result.mse,
        result.nrmse,
        result.rel_mse,
        result.psnr,
        result.mssim,
        result.flip,
        result.radiance_ratio,
    ];
    assert_eq!(Metric::ALL.map(|metric| result.value(metric)), fields);
    assert!(fields.iter().all(|value| value.is_finite()));
}

#[test]
fn psnr_of_black_and_white() {
    // One channel of six is off by the whole display range: 10 log10(6).
    let reference = image(2, &[[0.0; 3], [1.0; 3]]);
    let test = image(2, &[[0.0; 3], [1.0, 1.0, 0.0]]);
    assert_close(compare(&test, &reference).psnr, 10.0 * 6f64.log10());
    // Grey 0.25 has the sRGB value 0.5371 (byte 137): PSNR sees the encoded difference.
    let encoded = 1.055 * 0.25f64.powf(1.0 / 2.4) - 0.055;
    let (grey, black) = (image(1, &[[0.25; 3]]), image(1, &[[0.0; 3]]));
    assert_close(compare(&grey, &black).psnr, -20.0 * encoded.log10());
    // Both beyond the display: radiance differs, the display shows the same.
    let (bright, brighter) = (image(1, &[[2.0; 3]]), image(1, &[[3.0; 3]]));
    let result = compare(&brighter, &bright);
    assert_eq!((result.psnr, result.mssim, result.flip), (f64::INFINITY, 1.0, 0.0));
    assert_eq!(result.mse, 1.0);
}

#[test]
fn mssim_of_constants_by_hand() {
    // No variance: (2 a b + C1) / (a^2 + b^2 + C1) with a = 1, b = 0.
    let (white, black) = (Image::filled(20, 12, [1.0; 3]).unwrap(), Image::filled(20, 12, [0.0; 3]).unwrap());
    let expected = 1e-4 / (1.0 + 1e-4);
    // The window's weights sum to 1 within rounding, which the small numerator magnifies: 1e-16 / 1e-4.
    assert!((compare(&white, &black).mssim - expected).abs() < 1e-11);
}

#[test]
fn mssim_leaves_out_the_window_of_a_non_finite_pixel() {
    // 11x12 pixels have two whole windows; the NaN is the centre of the lower one.
    let (test, reference) = (picture(11, 12, noise_colour(0)), picture(11, 12, noise_colour(1)));
    let with_centre = |image: &Image, rows: usize, colour: [f32; 3]| {
        let mut pixels = image.pixels()[..11 * rows].to_vec();
        pixels[6 * 11 + 5] = colour;
        Image::new(11, rows as u32, pixels).unwrap()
    };
    let value = compare(&with_centre(&test, 12, [f32::NAN; 3]), &reference).mssim;
    // The upper window alone, with the pixel black in both.
    let upper = compare(&with_centre(&test, 11, [0.0; 3]), &with_centre(&reference, 11, [0.0; 3])).mssim;
    assert_eq!(value, upper);
    assert_ne!(value, compare(&test, &reference).mssim);
}

#[test]
fn bits_are_compared_as_bits() {
    let (zero, minus) = (image(2, &[[0.0; 3], [f32::NAN; 3]]), image(2, &[[-0.0; 3], [f32::NAN; 3]]));
    assert_eq!(compare(&minus, &zero).differing_pixels, 1);
    assert_eq!(compare(&zero, &zero).differing_pixels, 0);
}

#[test]
fn images_of_zeros() {
    let black = Image::filled(3, 3, [0.0; 3]).unwrap();
    let grey = Image::filled(3, 3, [0.25; 3]).unwrap();
    let same = compare(&black, &black);
    assert_eq!((same.nrmse, same.rel_mse, same.radiance_ratio), (0.0, 0.0, 1.0));
    assert_eq!((same.psnr, same.mssim, same.flip), (f64::INFINITY, 1.0, 0.0));
    let lit = compare(&grey, &black);
    assert_eq!((lit.nrmse, lit.radiance_ratio), (f64::INFINITY, f64::INFINITY));
    assert_eq!((lit.mse, lit.rel_mse), (0.0625, 6.25));
    assert_eq!(compare(&black, &grey).radiance_ratio, 0.0);
}

#[test]
fn sizes_must_agree() {
    let (wide, high) = (Image::filled(3, 2, [0.0; 3]).unwrap(), Image::filled(2, 3, [0.0; 3]).unwrap());
    let error = Comparison::new(&wide, &high, &CompareSettings::default()).unwrap_err();
    assert_eq!(error, PostError::SizeMismatch { left: (3, 2), right: (2, 3) });
    assert_eq!(error.to_string(), "the images differ in size: 3x2 against 2x3");
}

#[test]
fn non_finite_pixels_are_counted_and_left_out() {
    let mut pixels = vec![[0.5f32; 3]; 15 * 15];
    let reference = image(15, &pixels);
    pixels[7 * 15 + 7] = [0.5, f32::NAN, 0.5];
    pixels[3] = [f32::INFINITY, 0.5, 0.5];
    let test = image(15, &pixels);
    for (result, counts) in [(compare(&test, &reference), (2, 0)), (compare(&reference, &test), (0, 2))] {
        assert_eq!((result.non_finite_test, result.non_finite_reference), counts);
        assert_eq!((result.compared_pixels, result.differing_pixels), (223, 2));
        // What is left is equal, so nothing of the two pixels may leak into any number.
        assert_eq!((result.mae, result.rel_mse, result.radiance_ratio), (0.0, 0.0, 1.0));
        assert_eq!((result.psnr, result.mssim, result.flip), (f64::INFINITY, 1.0, 0.0));
        assert_eq!(result.flip_map.values().iter().filter(|value| value.is_nan()).count(), 2);
    }
}

#[test]
fn nothing_finite_is_an_error() {
    let (nan, inf) =
        (Image::filled(2, 2, [f32::NAN; 3]).unwrap(), Image::filled(2, 2, [f32::INFINITY; 3]).unwrap());
    let error = Comparison::new(&nan, &inf, &CompareSettings::default()).unwrap_err();
    assert_eq!(error, PostError::NoFinitePixels { test: 4, reference: 4 });
    // One finite pixel, but not at the centre of the only window.
    let corner = image(3, &[[0.5; 3], [f32::NAN; 3], [f32::NAN; 3]].repeat(3));
    let error = Comparison::new(&corner, &corner, &CompareSettings::default()).unwrap_err();
    assert_eq!(error, PostError::NoFinitePixels { test: 6, reference: 6 });
}

#[test]
fn largest_floats_do_not_overflow() {
    let (huge, black) = (Image::filled(2, 2, [f32::MAX; 3]).unwrap(), Image::filled(2, 2, [0.0; 3]).unwrap());
    let result = compare(&huge, &black);
    assert!(result.mse.is_finite() && result.rel_mse.is_finite() && result.flip.is_finite());
}

#[test]
fn viewing_distance_outside_its_range_is_an_error() {
    let grey = Image::filled(2, 2, [0.5; 3]).unwrap();
    for pixels_per_degree in [0.0, 0.99, 1001.0, f64::NAN, f64::INFINITY] {
        let settings = CompareSettings { pixels_per_degree, ..CompareSettings::default() };
        let error = Comparison::new(&grey, &grey, &settings).unwrap_err();
        assert!(matches!(error, PostError::OutOfRange { name: "pixels per degree", .. }));
    }
}

#[test]
fn display_changes_display_metrics_only() {
    let (dim, dimmer) =
        (Image::filled(12, 12, [0.02; 3]).unwrap(), Image::filled(12, 12, [0.015; 3]).unwrap());
    let plain = compare(&dimmer, &dim);
    let display = Display::new(4.0, Operator::Aces).unwrap();
    let lit = Comparison::new(&dimmer, &dim, &CompareSettings { display, ..plain.settings }).unwrap();
    assert_eq!((lit.mse, lit.rel_mse, lit.nrmse), (plain.mse, plain.rel_mse, plain.nrmse));
    assert!(lit.flip > plain.flip && lit.psnr < plain.psnr);
}
