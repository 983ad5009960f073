//! `compare`.

use super::ToneArgs;
use clap::Args;
use std::path::PathBuf;
use std::str::FromStr;
use twinlight::methods::post::metrics::Metric;

const EXAMPLES: &str = "\
Examples:
  twinlight compare out.exr reference.exr
  twinlight compare out.exr reference.exr --threshold relmse=0.01 --threshold psnr=30
      exit code 10 when an error is larger, or PSNR or MSSIM smaller
  twinlight compare a.exr b.exr --ztest
      could two noisy renders have one expectation? (render both with --sampler independent and different seeds)";

/// `METRIC=LIMIT`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Threshold {
    /// What is judged.
    pub metric: Metric,
    /// The worst value that passes.
    pub limit: f64,
}

impl FromStr for Threshold {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let keys = Metric::ALL.map(Metric::key).join(", ");
        let (key, limit) =
            text.split_once('=').ok_or_else(|| format!("write METRIC=LIMIT with a metric of {keys}"))?;
        let metric = key.parse().map_err(|_| format!("no metric is called '{key}'; there are {keys}"))?;
        match limit.parse::<f64>() {
            Ok(limit) if !limit.is_nan() => Ok(Self { metric, limit }),
            _ => Err(format!("'{limit}' is not a number")),
        }
    }
}

/// Measures how far a picture is from a reference: every metric with the formula it was computed by.
#[derive(Debug, Args)]
#[command(after_long_help = EXAMPLES, after_help = "`--help` shows examples.")]
pub struct CompareArgs {
    /// The picture under test: EXR, PNG or JPEG
    #[arg(value_name = "TEST")]
    pub test: PathBuf,
    /// The picture it should be
    #[arg(value_name = "REFERENCE")]
    pub reference: PathBuf,
    /// Exit with 10 when METRIC is worse than LIMIT; ratio's limit is its distance from 1
    #[arg(long, value_name = "METRIC=LIMIT")]
    pub threshold: Vec<Threshold>,
    /// Write a false-colour picture of ꟻLIP per pixel: dark is equal, bright is different
    #[arg(long, value_name = "PNG")]
    pub error_image: Option<PathBuf>,
    /// Test whether both have one expectation, by the variance layers of EXR files; exit with 10 when not
    #[arg(long)]
    pub ztest: bool,
    /// Print JSON; what is infinite or not a number is null
    #[arg(long)]
    pub json: bool,
    #[command(flatten)]
    pub tone: ToneArgs,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thresholds() {
        assert_eq!("psnr=30".parse(), Ok(Threshold { metric: Metric::Psnr, limit: 30.0 }));
        for bad in ["", "psnr", "rmse=1", "mse=", "mse=nan"] {
            assert!(bad.parse::<Threshold>().is_err(), "{bad}");
        }
    }
}
