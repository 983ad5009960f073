//! Reading a film: u64 sums to radiance, without the code that writes them.

use crate::trial::{Failure, ensure};
use twinlight_core::kernels::trace_paths::{FilmTexel, TracePathsParams};

/// A (low, high) pair.
pub(in crate::kernels) fn wide(words: [u32; 2]) -> u64 {
    u64::from(words[0]) + (u64::from(words[1]) << 32)
}

/// (low, high) of a u64.
pub(in crate::kernels) fn words(value: u64) -> [u32; 2] {
    [value as u32, (value >> 32) as u32]
}

/// The mean over a picture.
#[derive(Debug, Clone, Copy)]
pub(in crate::kernels) struct Mean {
    pub(in crate::kernels) radiance: [f64; 3],
    /// Variance of the mean luminance, from the spread of each pixel's samples.
    variance: f64,
}

fn luminance(c: [f64; 3]) -> f64 {
    0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]
}

impl Mean {
    /// Means and variance of `film`, which must hold every sample that `params` asks for and no rejected one.
    pub(in crate::kernels) fn of(film: &[FilmTexel], params: &TracePathsParams) -> Result<Self, Failure> {
        let scale = f64::from(-params.film_exponent).exp2();
        let moment_scale = f64::from(-params.moment_exponent).exp2();
        let (n, pixels) = (f64::from(params.sample_count), film.len() as f64);
        let mut mean = Self { radiance: [0.0; 3], variance: 0.0 };
        for (at, texel) in film.iter().enumerate() {
            ensure(texel.samples == params.sample_count && texel.rejected == 0, || {
                format!("pixel {at} has {} samples and {} rejected", texel.samples, texel.rejected)
            })?;
            let channel =
                |c: usize| (wide(texel.direct[c]) as f64 + wide(texel.indirect[c]) as f64) * scale / n;
            let colour = [0, 1, 2].map(channel);
            let second = wide(texel.luminance_squared) as f64 * moment_scale / n;
            let spread = (second - luminance(colour).powi(2)).max(0.0) / (n - 1.0).max(1.0);
            mean.variance += spread / (pixels * pixels);
            for (sum, c) in mean.radiance.iter_mut().zip(colour) {
                *sum += c / pixels;
            }
        }
        Ok(mean)
    }

    /// Relative standard error of the mean.
    pub(in crate::kernels) fn standard_error(&self) -> f64 {
        let luminance = luminance(self.radiance);
        if luminance > 0.0 { self.variance.sqrt() / luminance } else { 0.0 }
    }
}
