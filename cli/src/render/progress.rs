//! Progress on stderr.

use crate::args::ProgressMode;
use indicatif::{ProgressBar, ProgressStyle};
use std::io::{IsTerminal, Write, stderr};
use std::time::{Duration, Instant};
use twinlight::methods::reference::Progress;

/// Steps of the bar.
const STEPS: u64 = 1000;

/// Least time between plain lines.
const LINE_INTERVAL: Duration = Duration::from_secs(1);

/// Shows how far a render is.
pub enum Display {
    /// A bar that redraws itself.
    Bar(ProgressBar),
    /// A line a second.
    Plain(Option<Instant>),
    /// A line of JSON per pass.
    Json,
    /// Nothing.
    Silent,
}

impl Display {
    /// As asked for; `auto` draws on a terminal only, so that logs stay readable.
    pub fn new(mode: ProgressMode) -> Self {
        match mode {
            ProgressMode::Auto if stderr().is_terminal() => Self::Bar(bar()),
            ProgressMode::Auto | ProgressMode::Never => Self::Silent,
            ProgressMode::Plain => Self::Plain(None),
            ProgressMode::Json => Self::Json,
        }
    }

    /// Shows `progress`. Nobody reading is no error.
    pub fn update(&mut self, progress: &Progress) {
        let (samples, seconds) = (progress.samples, progress.elapsed.as_secs_f64());
        match self {
            Self::Bar(bar) => {
                bar.set_position((progress.fraction * STEPS as f64) as u64);
                bar.set_message(format!("{samples} spp"));
            }
            Self::Plain(last) => {
                if last.is_none_or(|last| last.elapsed() >= LINE_INTERVAL) || progress.fraction >= 1.0 {
                    *last = Some(Instant::now());
                    let percent = progress.fraction * 100.0;
                    let _ = writeln!(stderr(), "{percent:5.1} %  {samples} spp  {seconds:.1} s");
                }
            }
            Self::Json => {
                let line = serde_json::json!({
                    "fraction": progress.fraction, "samples": samples, "elapsed_s": seconds
                });
                let _ = writeln!(stderr(), "{line}");
            }
            Self::Silent => {}
        }
    }

    /// Takes the bar away.
    pub fn finish(self) {
        if let Self::Bar(bar) = self {
            bar.finish_and_clear();
        }
    }
}

fn bar() -> ProgressBar {
    let bar = ProgressBar::new(STEPS);
    // The template is a constant; one that can't be parsed would leave indicatif's own style.
    if let Ok(style) =
        ProgressStyle::with_template("rendering {wide_bar} {percent:>3} %  {msg}  {elapsed}, {eta} left")
    {
        bar.set_style(style);
    }
    bar
}
