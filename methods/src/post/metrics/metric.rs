//! The table of metrics: names, keys, formulas, direction.

use crate::post::PostError;

/// One number of a [`Comparison`](super::Comparison). In the formulas x is the image under test, r the reference,
/// mean the mean over pixels and channels, T(·) the display's tone-mapped colour in [0, 1], linear.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Metric {
    /// Mean absolute error.
    Mae,
    /// Mean squared error.
    Mse,
    /// Root of the mean squared error over the reference's range.
    Nrmse,
    /// Relative mean squared error.
    RelMse,
    /// Peak signal-to-noise ratio of the display image, in decibel.
    Psnr,
    /// Mean structural similarity of the display luminance.
    Mssim,
    /// Mean LDR-ꟻLIP of the display image.
    Flip,
    /// Mean radiance over the reference's: the bias of a method.
    RadianceRatio,
}

impl Metric {
    /// All metrics, in the order in which they are printed.
    pub const ALL: [Self; 8] = [
        Self::Mae,
        Self::Mse,
        Self::Nrmse,
        Self::RelMse,
        Self::Psnr,
        Self::Mssim,
        Self::Flip,
        Self::RadianceRatio,
    ];

    /// The name as literature writes it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Mae => "MAE",
            Self::Mse => "MSE",
            Self::Nrmse => "NRMSE",
            Self::RelMse => "relMSE",
            Self::Psnr => "PSNR",
            Self::Mssim => "MSSIM",
            Self::Flip => "ꟻLIP",
            Self::RadianceRatio => "ratio",
        }
    }

    /// The word for command lines and files: ASCII, lower case, stable.
    pub fn key(self) -> &'static str {
        match self {
            Self::Mae => "mae",
            Self::Mse => "mse",
            Self::Nrmse => "nrmse",
            Self::RelMse => "relmse",
            Self::Psnr => "psnr",
            Self::Mssim => "mssim",
            Self::Flip => "flip",
            Self::RadianceRatio => "ratio",
        }
    }

    /// The definition that was computed, for printing: several of these names have more than one in use.
    pub fn formula(self) -> &'static str {
        match self {
            Self::Mae => "mean |x - r|, linear radiance",
            Self::Mse => "mean (x - r)^2, linear radiance",
            Self::Nrmse => "sqrt(MSE) / (max r - min r), over all channels",
            Self::RelMse => "mean (x - r)^2 / (r^2 + 0.01), linear radiance",
            Self::Psnr => "10 log10(1 / mean (sRGB(T(x)) - sRGB(T(r)))^2) dB, peak 1",
            Self::Mssim => {
                "mean SSIM (Wang et al. 2004) of sRGB(luminance T), 11x11 Gaussian sigma 1.5, \
                 K1 0.01, K2 0.03, L 1, whole windows only"
            }
            Self::Flip => "mean LDR-FLIP (Andersson et al. 2020) of T, 0 = same, 1 = worst",
            Self::RadianceRatio => "mean x / mean r, linear radiance; 1 = no bias",
        }
    }

    /// Whether `value` is worse than `limit`: larger for errors, smaller for PSNR and MSSIM, farther from 1
    /// (relatively, in either direction) for the radiance ratio, whose limit is the allowed distance `|ratio - 1|`.
    /// NaN is always worse.
    pub fn is_worse(self, value: f64, limit: f64) -> bool {
        let holds = match self {
            Self::Psnr | Self::Mssim => value >= limit,
            Self::RadianceRatio => (value - 1.0).abs() <= limit,
            _ => value <= limit,
        };
        !holds
    }
}

impl std::str::FromStr for Metric {
    type Err = PostError;

    fn from_str(key: &str) -> Result<Self, PostError> {
        let found = Self::ALL.into_iter().find(|metric| metric.key() == key);
        found.ok_or_else(|| PostError::UnknownMetric(key.to_owned()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_ascii_unique_and_parse_back() {
        for metric in Metric::ALL {
            assert!(metric.key().bytes().all(|byte| byte.is_ascii_lowercase()));
            assert_eq!(metric.key().parse(), Ok(metric));
            assert!(!metric.name().is_empty() && !metric.formula().is_empty());
        }
        assert_eq!("rmse".parse::<Metric>(), Err(PostError::UnknownMetric("rmse".into())));
    }

    #[test]
    fn worse_knows_each_direction() {
        assert!(Metric::Mse.is_worse(0.2, 0.1) && !Metric::Mse.is_worse(0.1, 0.1));
        assert!(Metric::Psnr.is_worse(20.0, 30.0) && !Metric::Psnr.is_worse(f64::INFINITY, 30.0));
        assert!(Metric::Mssim.is_worse(0.9, 0.95) && !Metric::Mssim.is_worse(1.0, 0.95));
        assert!(Metric::RadianceRatio.is_worse(0.9, 0.05) && Metric::RadianceRatio.is_worse(1.1, 0.05));
        assert!(!Metric::RadianceRatio.is_worse(1.01, 0.05));
        for metric in Metric::ALL {
            assert!(metric.is_worse(f64::NAN, 1.0));
        }
    }
}
