//! Progress of a study, on stderr.

use crate::args::ProgressMode;
use crate::report;
use indicatif::{ProgressBar, ProgressStyle};
use serde_json::json;
use std::io::{IsTerminal, stderr};

/// Steps of the bar.
const STEPS: u64 = 1000;

/// How far a study is.
pub struct State {
    /// Seconds so far.
    pub spent: f64,
    /// Seconds at most.
    pub limit: f64,
    /// Settings that are measured.
    pub points: usize,
    /// Settings that will be if there is time; more may follow.
    pub planned: usize,
}

impl State {
    /// Seconds to go, at most.
    fn left(&self) -> f64 {
        (self.limit - self.spent).max(0.0)
    }
}

/// Shows how far a study is.
pub enum Display {
    /// A bar that redraws itself.
    Bar(ProgressBar),
    /// A line for everything that begins.
    Plain,
    /// The same in JSON.
    Json,
    /// Nothing.
    Silent,
}

impl Display {
    /// As asked for; `auto` draws on a terminal only, so that logs stay readable.
    pub fn new(mode: ProgressMode) -> Self {
        match mode {
            ProgressMode::Auto if stderr().is_terminal() => Self::Bar(new_bar()),
            ProgressMode::Auto | ProgressMode::Never => Self::Silent,
            ProgressMode::Plain => Self::Plain,
            ProgressMode::Json => Self::Json,
        }
    }

    /// `doing` begins.
    pub fn begin(&self, state: &State, doing: &str) {
        let (left, points, planned) = (state.left(), state.points, state.planned);
        let line = || format!("{points} settings, {planned} to come, {left:.0} s left: {doing}");
        match self {
            Self::Bar(bar) => {
                // A bar that was taken away comes back.
                bar.reset();
                bar.set_position((state.spent / (state.spent + left) * STEPS as f64) as u64);
                bar.set_message(line());
            }
            Self::Plain => report::status(&line()),
            Self::Json => {
                let line = json!({
                    "points": points, "planned": planned, "spent_s": state.spent, "left_s": left, "doing": doing,
                });
                report::status(&line.to_string());
            }
            Self::Silent => {}
        }
    }

    /// Takes the bar away, so that something else can be said.
    pub fn clear(&self) {
        if let Self::Bar(bar) = self {
            bar.finish_and_clear();
        }
    }
}

fn new_bar() -> ProgressBar {
    let bar = ProgressBar::new(STEPS);
    // The template is a constant; one that can't be parsed would leave indicatif's own style.
    if let Ok(style) = ProgressStyle::with_template("measuring {bar:30} {percent:>3} %  {wide_msg}") {
        bar.set_style(style);
    }
    bar
}
