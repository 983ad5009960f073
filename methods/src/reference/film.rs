//! The film: integer sums, and the pictures made from them.

use twinlight_core::kernels::trace_paths::{FilmTexel, TracePathsParams};
use twinlight_core::math::fixed::{OUT_OF_RANGE, Words, add_saturating, to_f64};
use twinlight_core::{Error, Result};

/// Sums of samples, one texel per pixel, row-major from the top-left.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Film {
    width: u32,
    height: u32,
    film_exponent: i32,
    moment_exponent: i32,
    texels: Vec<FilmTexel>,
}

fn sum(a: Words, b: Words) -> Words {
    add_saturating(a, b)
}

impl Film {
    /// A film from a kernel's output.
    ///
    /// # Errors
    /// [`Error::InvalidInput`] when the number of texels is not `width * height`.
    pub fn new(width: u32, height: u32, params: &TracePathsParams, texels: Vec<FilmTexel>) -> Result<Self> {
        if texels.len() as u64 != u64::from(width) * u64::from(height) {
            return Err(Error::invalid(
                "film",
                format!("{} texels for {width}x{height} pixels", texels.len()),
            ));
        }
        let (film_exponent, moment_exponent) = (params.film_exponent, params.moment_exponent);
        Ok(Self { width, height, film_exponent, moment_exponent, texels })
    }

    /// Pixels per row.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Rows.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// The sums.
    pub fn texels(&self) -> &[FilmTexel] {
        &self.texels
    }

    /// Adds another film of the same picture, taken with other samples. The result doesn't depend on the order.
    ///
    /// # Errors
    /// [`Error::InvalidInput`] when sizes or scales differ.
    pub fn merge(&mut self, other: &Self) -> Result<()> {
        let key = |f: &Self| (f.width, f.height, f.film_exponent, f.moment_exponent);
        if key(self) != key(other) {
            let what = format!("(width, height, scales) {:?} can't be added to {:?}", key(other), key(self));
            return Err(Error::invalid("film", what));
        }
        for (a, b) in self.texels.iter_mut().zip(&other.texels) {
            for c in 0..3 {
                a.direct[c] = sum(a.direct[c], b.direct[c]);
                a.indirect[c] = sum(a.indirect[c], b.indirect[c]);
            }
            a.luminance_squared = sum(a.luminance_squared, b.luminance_squared);
            a.samples = a.samples.saturating_add(b.samples);
            a.rejected = a.rejected.saturating_add(b.rejected);
        }
        Ok(())
    }

    /// The first pixel with rejected samples or a saturated sum.
    pub fn first_unusable(&self) -> Option<u32> {
        let bad =
            |t: &FilmTexel| t.rejected > 0 || t.direct.iter().chain(&t.indirect).any(|w| *w == OUT_OF_RANGE);
        self.texels.iter().position(bad).map(|i| i as u32)
    }

    fn mean(&self, texel: &FilmTexel, sums: impl Fn(&FilmTexel, usize) -> f64) -> [f32; 3] {
        let samples = f64::from(texel.samples.max(1));
        [0, 1, 2].map(|c| (sums(texel, c) / samples) as f32)
    }

    /// Mean radiance per pixel, W·sr⁻¹·m⁻²; 0 where there is no sample.
    pub fn radiance(&self) -> Vec<[f32; 3]> {
        let value = |w: Words| to_f64(w, self.film_exponent);
        let both = |t: &FilmTexel, c: usize| value(t.direct[c]) + value(t.indirect[c]);
        self.texels.iter().map(|t| self.mean(t, both)).collect()
    }

    /// The part of [`Film::radiance`] that was emitted towards the camera or scattered once.
    pub fn direct(&self) -> Vec<[f32; 3]> {
        let value = |t: &FilmTexel, c: usize| to_f64(t.direct[c], self.film_exponent);
        self.texels.iter().map(|t| self.mean(t, value)).collect()
    }

    /// The part of [`Film::radiance`] that was scattered more than once.
    pub fn indirect(&self) -> Vec<[f32; 3]> {
        let value = |t: &FilmTexel, c: usize| to_f64(t.indirect[c], self.film_exponent);
        self.texels.iter().map(|t| self.mean(t, value)).collect()
    }

    /// Estimated variance of each pixel's mean luminance, from the spread of its samples: right for independent
    /// samples, too high for Sobol points. 0 with fewer than two samples.
    pub fn variance(&self) -> Vec<f32> {
        self.texels.iter().map(|t| self.variance_of(t) as f32).collect()
    }

    fn variance_of(&self, t: &FilmTexel) -> f64 {
        if t.samples < 2 {
            return 0.0;
        }
        let n = f64::from(t.samples);
        let channel =
            |c: usize| to_f64(t.direct[c], self.film_exponent) + to_f64(t.indirect[c], self.film_exponent);
        let mean = (0.2126 * channel(0) + 0.7152 * channel(1) + 0.0722 * channel(2)) / n;
        let second = to_f64(t.luminance_squared, self.moment_exponent) / n;
        ((second - mean * mean) / (n - 1.0)).max(0.0)
    }
}
