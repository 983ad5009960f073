//! Progress on stderr.

use crate::args::ProgressMode;
use indicatif::{ProgressBar, ProgressStyle};
use std::io::{IsTerminal, Write, stderr};
use std::ops::Range;
use std::time::{Duration, Instant};
use twinlight::methods::reference::Progress;

/// Steps of the bar.
const STEPS: u64 = 1000;

/// Least time between plain lines.
const LINE_INTERVAL: Duration = Duration::from_secs(1);

/// Shows how far a render is.
pub struct Display {
    how: How,
    frames: Option<Frames>,
}

enum How {
    /// A bar that redraws itself, while there is something to show.
    Bar(Option<ProgressBar>),
    /// A line a second.
    Plain(Option<Instant>),
    /// A line of JSON per pass.
    Json,
    /// Nothing.
    Silent,
}

/// Where in a sequence the render is.
struct Frames {
    all: Range<u32>,
    current: u32,
    start: Instant,
}

impl Display {
    /// As asked for, for one picture or for frames; `auto` draws on a terminal only, so that logs stay readable.
    pub fn new(mode: ProgressMode, frames: Option<Range<u32>>) -> Self {
        let how = match mode {
            ProgressMode::Auto if stderr().is_terminal() => How::Bar(None),
            ProgressMode::Auto | ProgressMode::Never => How::Silent,
            ProgressMode::Plain => How::Plain(None),
            ProgressMode::Json => How::Json,
        };
        let frames = frames.map(|all| Frames { current: all.start, all, start: Instant::now() });
        Self { how, frames }
    }

    /// The next frame begins.
    pub fn begin_frame(&mut self, number: u32) {
        if let Some(frames) = &mut self.frames {
            frames.current = number;
        }
    }

    /// Shows `progress`; of a sequence, how much of the whole is done. Nobody reading is no error.
    pub fn update(&mut self, progress: &Progress) {
        let (samples, frames) = (progress.samples, self.frames.as_ref());
        let fraction = frames.map_or(progress.fraction, |frames| frames.share(progress.fraction));
        let elapsed = frames.map_or(progress.elapsed, |frames| frames.start.elapsed());
        let seconds = elapsed.as_secs_f64();
        match &mut self.how {
            How::Bar(bar) => {
                let bar = bar.get_or_insert_with(|| new_bar(elapsed));
                bar.set_position((fraction * STEPS as f64) as u64);
                let frame = frames.map_or_else(String::new, |frames| format!("frame {}  ", frames.current));
                bar.set_message(format!("{frame}{samples} spp"));
            }
            How::Plain(last) => {
                if last.is_none_or(|last| last.elapsed() >= LINE_INTERVAL) || progress.fraction >= 1.0 {
                    *last = Some(Instant::now());
                    let percent = fraction * 100.0;
                    let frame =
                        frames.map_or_else(String::new, |frames| format!("  frame {}", frames.current));
                    let _ = writeln!(stderr(), "{percent:5.1} %{frame}  {samples} spp  {seconds:.1} s");
                }
            }
            How::Json => {
                let mut line = serde_json::json!({
                    "fraction": fraction, "samples": samples, "elapsed_s": seconds
                });
                if let Some(frames) = frames {
                    line["frame"] = frames.current.into();
                }
                let _ = writeln!(stderr(), "{line}");
            }
            How::Silent => {}
        }
    }

    /// Takes the bar away, so that something else can be said.
    pub fn clear(&mut self) {
        if let How::Bar(bar) = &mut self.how
            && let Some(bar) = bar.take()
        {
            bar.finish_and_clear();
        }
    }
}

impl Frames {
    /// Of the whole sequence, when `fraction` of the current frame is done.
    fn share(&self, fraction: f64) -> f64 {
        let before = f64::from(self.current - self.all.start);
        (before + fraction) / f64::from(self.all.end - self.all.start)
    }
}

fn new_bar(elapsed: Duration) -> ProgressBar {
    let bar = ProgressBar::new(STEPS).with_elapsed(elapsed);
    // The template is a constant; one that can't be parsed would leave indicatif's own style.
    if let Ok(style) =
        ProgressStyle::with_template("rendering {wide_bar} {percent:>3} %  {msg}  {elapsed}, {eta} left")
    {
        bar.set_style(style);
    }
    bar
}
