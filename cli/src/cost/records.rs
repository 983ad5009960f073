//! What was measured, in a file that grows by a line at a time: a run that ends early loses nothing, and the next goes on.

use crate::exit::{Failure, Stage};
use serde::{Deserialize, Serialize};
use std::fs::OpenOptions;
use std::io::Write;
use std::path::{Path, PathBuf};
use twinlight::Error;
use twinlight::methods::cost::{Errors, METRICS, Setting, Split, Spread, Tried, distance};
use twinlight::methods::post::metrics::Metric;

/// A line of the file.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Record {
    /// Of the conditions it was measured under: lines of others are of no use.
    key: String,
    /// Seconds that it took, all renders together.
    pub spent: f64,
    /// What.
    #[serde(flatten)]
    pub what: What,
}

/// What a line says.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum What {
    /// A setting was measured.
    Point(Point),
    /// A setting could not be rendered.
    Failed {
        /// Which.
        setting: Words,
        /// Why not.
        why: String,
    },
    /// A method's error in its parts.
    Split(Parts),
}

/// A setting as words.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Words {
    /// As on the command line.
    pub method: String,
    /// Flags and values.
    pub flags: Vec<(String, String)>,
}

/// What a setting takes and gives.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Point {
    /// Which.
    pub setting: Words,
    /// Of a render.
    pub seconds: Times,
    /// Timed runs.
    pub runs: usize,
    /// Of the median run.
    pub steps: Vec<StepLine>,
    /// On the device.
    pub bytes: u64,
    /// By [`METRICS`]; what is no number is null.
    pub errors: [Option<f64>; METRICS.len()],
}

/// A [`Spread`].
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub struct Times {
    pub median: f64,
    pub least: f64,
    pub most: f64,
}

impl From<Spread> for Times {
    fn from(spread: Spread) -> Self {
        Self { median: spread.median, least: spread.least, most: spread.most }
    }
}

/// Calls of a kernel or a transfer.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct StepLine {
    pub name: String,
    pub calls: u64,
    pub seconds: f64,
    /// Of all runs.
    pub spread: Times,
}

/// [`Split`]s of a setting by the metrics that have one.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Parts {
    /// Which.
    pub setting: Words,
    /// By the metric's key: bias, its standard error, noise.
    pub parts: Vec<(String, [f64; 3])>,
}

impl Words {
    /// Of a setting.
    pub fn of(setting: &Setting) -> Self {
        let flags = setting.flags().into_iter().map(|(flag, value)| (flag.to_owned(), value));
        Self { method: setting.method().into(), flags: flags.collect() }
    }

    /// The setting; `None` where the sweep has changed since.
    pub fn setting(&self) -> Option<Setting> {
        Setting::read(&self.method, self.flags.iter().map(|(flag, value)| (flag.as_str(), value.as_str())))
    }

    /// Whether it is the finest setting of its method.
    pub fn is_finest(&self) -> bool {
        self.setting().is_some_and(|setting| setting == Setting::finest(setting.method()))
    }
}

impl Parts {
    /// Of a metric.
    pub fn new(setting: Words, splits: &[(Metric, Split)]) -> Self {
        let part = |(metric, split): &(Metric, Split)| {
            (metric.key().to_owned(), [split.bias, split.bias_error, split.noise])
        };
        Self { setting, parts: splits.iter().map(part).collect() }
    }
}

impl Point {
    /// Distances from a perfect picture; not a number where there is none.
    pub fn distances(&self) -> Errors {
        std::array::from_fn(|i| distance(METRICS[i], self.errors[i].unwrap_or(f64::NAN)))
    }
}

impl Record {
    /// What it is about; `None` where the sweep has changed since.
    fn setting(&self) -> Option<Setting> {
        match &self.what {
            What::Point(Point { setting, .. })
            | What::Failed { setting, .. }
            | What::Split(Parts { setting, .. }) => setting.setting(),
        }
    }

    /// For the search of what to measure next. Its fronts are those of relMSE and ꟻLIP: one of radiance, one of what is seen.
    pub fn tried(&self) -> Option<Tried> {
        let (seconds, errors) = match &self.what {
            What::Point(point) => (point.seconds.median, point.distances()[..2].to_vec()),
            What::Failed { .. } => (f64::NAN, vec![f64::NAN; 2]),
            What::Split(_) => return None,
        };
        Some(Tried { setting: self.setting()?, seconds, errors, spent: self.spent })
    }
}

/// The file, and what is in it.
pub struct Records {
    path: PathBuf,
    key: String,
    all: Vec<Record>,
}

impl Records {
    /// Reads what was measured under the conditions of `key`. Lines of other conditions, those of settings that the sweep has no more, and one that
    /// a crash left half-written are passed over.
    ///
    /// # Errors
    /// [`Error::Io`] unless there is no such file.
    pub fn open(path: PathBuf, key: &str) -> Result<Self, Failure> {
        let bytes = match std::fs::read(&path) {
            Ok(bytes) => bytes,
            Err(source) if source.kind() == std::io::ErrorKind::NotFound => Vec::new(),
            Err(source) => return Err(io(&path, source)),
        };
        let lines = bytes.split(|&byte| byte == b'\n').filter_map(|line| serde_json::from_slice(line).ok());
        let all = lines.filter(|record: &Record| record.key == key && record.setting().is_some()).collect();
        Ok(Self { path, key: key.into(), all })
    }

    /// In the order in which they were measured.
    pub fn all(&self) -> &[Record] {
        &self.all
    }

    /// Those of settings that were measured.
    pub fn points(&self) -> impl Iterator<Item = &Point> {
        self.all.iter().filter_map(|record| match &record.what {
            What::Point(point) => Some(point),
            _ => None,
        })
    }

    /// Those of errors in their parts.
    pub fn parts(&self) -> impl Iterator<Item = &Parts> {
        self.all.iter().filter_map(|record| match &record.what {
            What::Split(parts) => Some(parts),
            _ => None,
        })
    }

    /// Seconds that everything took.
    pub fn spent(&self) -> f64 {
        self.all.iter().map(|record| record.spent).sum()
    }

    /// Adds a line.
    ///
    /// # Errors
    /// [`Error::Io`].
    pub fn add(&mut self, spent: f64, what: What) -> Result<(), Failure> {
        let record = Record { key: self.key.clone(), spent, what };
        let line = serde_json::to_string(&record)
            .map_err(|e| Failure::Library(Stage::Output, Error::Internal(format!("record: {e}"))))?;
        // The line break comes first: behind a line that a crash left half-written, this one is whole.
        let written = OpenOptions::new().create(true).append(true).open(&self.path);
        written
            .and_then(|mut file| file.write_all(format!("\n{line}").as_bytes()))
            .map_err(|source| io(&self.path, source))?;
        self.all.push(record);
        Ok(())
    }
}

fn io(path: &Path, source: std::io::Error) -> Failure {
    Failure::Library(Stage::Output, Error::Io { path: path.into(), source })
}
