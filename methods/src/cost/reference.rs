//! What pictures are judged by.

use crate::post::PostError;
use crate::post::image::Image;
use crate::post::metrics::{CompareSettings, Comparison, Metric};
use crate::post::tonemap::Display;

/// What is measured of every picture.
pub const METRICS: [Metric; 6] =
    [Metric::RelMse, Metric::Flip, Metric::Mse, Metric::Nrmse, Metric::Mssim, Metric::RadianceRatio];

/// A value per metric of [`METRICS`].
pub type Errors = [f64; METRICS.len()];

/// How far a picture is from the reference, by every metric.
///
/// # Errors
/// [`PostError::SizeMismatch`], [`PostError::NoFinitePixels`].
pub fn errors(picture: &Image, reference: &Image, display: &Display) -> Result<Errors, PostError> {
    let settings = CompareSettings { display: *display, ..CompareSettings::default() };
    let comparison = Comparison::new(picture, reference, &settings)?;
    Ok(METRICS.map(|metric| comparison.value(metric)))
}

/// How far a value is from that of a perfect picture: 0 is best for every metric but PSNR, which is infinite there.
pub fn distance(metric: Metric, value: f64) -> f64 {
    match metric {
        Metric::Mssim => 1.0 - value,
        Metric::RadianceRatio => (value - 1.0).abs(),
        Metric::Psnr => -value,
        Metric::Mae | Metric::Mse | Metric::Nrmse | Metric::RelMse | Metric::Flip => value,
    }
}

/// A reference picture and, where it was rendered in two halves, its own noise.
#[derive(Debug, Clone, PartialEq)]
pub struct Reference {
    image: Image,
    halves: Option<[Image; 2]>,
}

impl Reference {
    /// The mean of two pictures that differ in nothing but their seed.
    ///
    /// # Errors
    /// [`PostError::SizeMismatch`].
    pub fn of_halves(first: Image, second: Image) -> Result<Self, PostError> {
        first.expect_same_size(&second)?;
        let both = first.pixels().iter().zip(second.pixels());
        let mean = both.map(|(a, b)| [0, 1, 2].map(|c| (0.5 * (f64::from(a[c]) + f64::from(b[c]))) as f32));
        let image = Image::new(first.width(), first.height(), mean.collect())?;
        Ok(Self { image, halves: Some([first, second]) })
    }

    /// A picture whose noise nobody knows.
    pub fn single(image: Image) -> Self {
        Self { image, halves: None }
    }

    /// The picture.
    pub fn image(&self) -> &Image {
        &self.image
    }

    /// The value that each metric has for a perfect picture, because of the noise that is left in this one; `None` where that is unknown.
    ///
    /// A half r₁ differs from the mean r by (r₁ − r₂)/2, whose variance is that of r itself. So far is a perfect picture from r, give or take.
    ///
    /// # Errors
    /// [`PostError::NoFinitePixels`].
    pub fn noise(&self, display: &Display) -> Result<Option<Errors>, PostError> {
        let halves = self.halves.as_ref();
        halves.map(|[first, _]| errors(first, &self.image, display)).transpose()
    }

    /// Variance of a value, estimated from the halves alone; 0 where it is unknown.
    pub(super) fn variance(&self, pixel: usize, channel: usize) -> f64 {
        self.halves.as_ref().map_or(0.0, |[first, second]| {
            let half = 0.5 * f64::from(first.pixels()[pixel][channel] - second.pixels()[pixel][channel]);
            half * half
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use twinlight_core::math::hash::{mix_pair, to_unit};

    /// Light and dark tiles.
    fn truth(x: u32, y: u32) -> f32 {
        if (x / 8 + y / 8).is_multiple_of(2) { 0.25 } else { 0.65 }
    }

    fn noisy(seed: u32, side: u32) -> Image {
        let noise = |x, y| to_unit(mix_pair(mix_pair(seed, x), y)) - 0.5;
        Image::from_fn(side, side, |x, y| [truth(x, y) + 0.2 * noise(x, y); 3]).unwrap()
    }

    /// A picture without noise is as far from the reference as the reference says that it is.
    #[test]
    fn the_floor_is_where_a_perfect_picture_is() {
        let reference = Reference::of_halves(noisy(1, 64), noisy(2, 64)).unwrap();
        let floor = reference.noise(&Display::default()).unwrap().unwrap();
        let perfect = Image::from_fn(64, 64, |x, y| [truth(x, y); 3]).unwrap();
        let found = errors(&perfect, reference.image(), &Display::default()).unwrap();
        for (metric, (floor, found)) in METRICS.into_iter().zip(floor.into_iter().zip(found)) {
            let (floor, found) = (distance(metric, floor), distance(metric, found));
            match metric {
                // One number of a picture, whose spread is 0.2/√(12 · 2 · 4096) of 0.45: four times that.
                Metric::RadianceRatio => assert!(floor < 6e-3 && found < 6e-3, "{floor} {found}"),
                // A half and the mean share noise, which counts as structure of both.
                Metric::Mssim => assert!((floor / found - 1.0).abs() < 0.2, "{floor} {found}"),
                // Means of 4096 values, to 3 % for squares, and of fewer where a metric sees the neighbourhood too.
                _ => assert!((floor / found - 1.0).abs() < 0.1, "{metric:?}: {floor} {found}"),
            }
        }
    }

    #[test]
    fn what_is_unknown_is_not_made_up() {
        let image = noisy(1, 16);
        assert_eq!(Reference::single(image.clone()).noise(&Display::default()), Ok(None));
        assert_eq!(Reference::of_halves(image.clone(), image.clone()).unwrap().image(), &image);
        assert!(Reference::of_halves(image, noisy(1, 17)).is_err());
    }

    #[test]
    fn distances_are_least_for_equal_pictures() {
        let image = noisy(1, 16);
        let equal = errors(&image, &image, &Display::default()).unwrap();
        for (metric, value) in METRICS.into_iter().zip(equal) {
            assert!(distance(metric, value).abs() < 1e-12, "{metric:?}: sums of rounded terms, {value}");
        }
        assert_eq!(distance(Metric::RadianceRatio, 0.75), 0.25);
        assert!(distance(Metric::Psnr, 30.0) < distance(Metric::Psnr, 20.0));
    }
}
