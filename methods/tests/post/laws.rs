//! What must hold for any pair of pictures.

use crate::patterns::{gradient, noise, picture};
use proptest::prelude::*;
use twinlight_methods::post::image::Image;
use twinlight_methods::post::metrics::{CompareSettings, Comparison, Metric};

fn compare(test: &Image, reference: &Image) -> Comparison {
    Comparison::new(test, reference, &CompareSettings::default()).unwrap()
}

fn arbitrary_pair() -> impl Strategy<Value = (Image, Image)> {
    (1u32..20, 1u32..20).prop_flat_map(|(width, height)| {
        let pixels = || prop::collection::vec(prop::array::uniform3(0.0f32..1.5), (width * height) as usize);
        (pixels(), pixels()).prop_map(move |(a, b)| {
            (Image::new(width, height, a).unwrap(), Image::new(width, height, b).unwrap())
        })
    })
}

fn map_pixels(image: &Image, width: u32, height: u32, at: impl Fn(u32, u32) -> (u32, u32)) -> Image {
    Image::from_fn(width, height, |x, y| {
        let (from_x, from_y) = at(x, y);
        image.pixels()[(from_y * image.width() + from_x) as usize]
    })
    .unwrap()
}

fn transposed(image: &Image) -> Image {
    map_pixels(image, image.height(), image.width(), |x, y| (y, x))
}

fn mirrored(image: &Image) -> Image {
    let width = image.width();
    map_pixels(image, width, image.height(), |x, y| (width - 1 - x, y))
}

/// Sums in another order: `f64` roundings of at most a few hundred terms; ꟻLIP and MSSIM divide by small numbers or
/// take roots, which magnifies them.
fn assert_nearly_equal(a: &Comparison, b: &Comparison) -> Result<(), TestCaseError> {
    for metric in Metric::ALL {
        let (a, b) = (a.value(metric), b.value(metric));
        prop_assert!(a == b || (a - b).abs() < 1e-6 * (1.0 + b.abs()), "{}: {a} {b}", metric.name());
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn an_image_equals_itself((image, _) in arbitrary_pair()) {
        let result = compare(&image, &image);
        prop_assert_eq!(result.differing_pixels, 0);
        prop_assert_eq!((result.mae, result.mse, result.nrmse, result.rel_mse), (0.0, 0.0, 0.0, 0.0));
        prop_assert_eq!((result.psnr, result.mssim, result.flip), (f64::INFINITY, 1.0, 0.0));
        prop_assert_eq!((result.radiance_ratio, result.max_abs), (1.0, 0.0));
    }

    #[test]
    fn values_stay_in_their_ranges((test, reference) in arbitrary_pair()) {
        let result = compare(&test, &reference);
        prop_assert!((0.0..=1.0).contains(&result.flip));
        prop_assert!(result.flip_map.values().iter().all(|value| (0.0..=1.0).contains(value)));
        prop_assert!((-1.0..=1.0).contains(&result.mssim));
        // Jensen: the mean of squares is at least the square of the mean; equal for one value, hence rounding.
        prop_assert!(result.mse >= result.mae * result.mae * (1.0 - 1e-14));
        prop_assert!(result.mae <= result.max_abs);
    }

    #[test]
    fn symmetric_metrics_are_symmetric((test, reference) in arbitrary_pair()) {
        let (there, back) = (compare(&test, &reference), compare(&reference, &test));
        for metric in [Metric::Mae, Metric::Mse, Metric::Psnr, Metric::Mssim, Metric::Flip] {
            prop_assert_eq!(there.value(metric), back.value(metric));
        }
    }

    #[test]
    fn the_same_numbers_twice((test, reference) in arbitrary_pair()) {
        prop_assert_eq!(compare(&test, &reference), compare(&test, &reference));
    }

    #[test]
    fn turning_the_pictures_turns_nothing_else((test, reference) in arbitrary_pair()) {
        let upright = compare(&test, &reference);
        assert_nearly_equal(&compare(&transposed(&test), &transposed(&reference)), &upright)?;
        assert_nearly_equal(&compare(&mirrored(&test), &mirrored(&reference)), &upright)?;
    }
}

#[test]
fn more_noise_is_worse_by_every_metric() {
    let reference = picture(48, 40, gradient);
    let results = [1, 2, 4, 8, 16].map(|amplitude| {
        let noisy = picture(48, 40, |x, y| {
            let clean = gradient(x, y);
            // Zero-mean to within the clamp: 2 * amplitude + 1 equally likely steps around the clean value.
            [0, 1, 2].map(|c| {
                let offset = noise(x, y, 7 + c as u32) % (2 * amplitude + 1);
                (clean[c] + offset).saturating_sub(amplitude)
            })
        });
        compare(&noisy, &reference)
    });
    for pair in results.windows(2) {
        for metric in [
            Metric::Mae,
            Metric::Mse,
            Metric::Nrmse,
            Metric::RelMse,
            Metric::Psnr,
            Metric::Mssim,
            Metric::Flip,
        ] {
            assert!(metric.is_worse(pair[1].value(metric), pair[0].value(metric)), "{}", metric.name());
        }
    }
}

#[test]
fn radiance_ratio_is_the_scale() {
    let reference = picture(48, 40, gradient);
    let doubled =
        Image::from_fn(48, 40, |x, y| reference.pixels()[(y * 48 + x) as usize].map(|v| 2.0 * v)).unwrap();
    // Doubling is exact in every partial sum.
    assert_eq!(compare(&doubled, &reference).radiance_ratio, 2.0);
}
