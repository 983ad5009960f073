//! Which moments of a motion are rendered.

use crate::args::{FrameRange, RenderArgs};
use crate::exit::Failure;
use std::ops::Range;
use twinlight::scene::Scene;

/// What a picture of a scene that moves shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moment {
    /// Time of the motion, seconds.
    pub seconds: f64,
    /// Number in a sequence.
    pub frame: Option<u32>,
}

/// What is to be rendered.
#[derive(Debug, Clone, PartialEq)]
pub enum Plan {
    /// The one picture of a scene that stands still.
    Still,
    /// One moment.
    Moment(Moment),
    /// A sequence.
    Frames(Frames),
}

/// A sequence of moments.
#[derive(Debug, Clone, PartialEq)]
pub struct Frames {
    /// Their numbers.
    pub range: Range<u32>,
    rate: f64,
    /// Seconds after which the motion begins anew.
    period: Option<f64>,
}

impl Plan {
    /// As the flags say.
    ///
    /// # Errors
    /// [`Failure::Usage`] for flags about motion when nothing moves, and for frames beyond its end when no end is given.
    pub fn new(args: &RenderArgs, scene: &Scene) -> Result<Self, Failure> {
        let duration = scene.motion.duration;
        if scene.motion.is_empty() {
            let flags =
                [("--frames", args.frames.is_some()), ("--at", args.at.is_some()), ("--loop", args.looped)];
            return match flags.into_iter().find(|(_, given)| *given) {
                Some((flag, _)) => Err(Failure::Usage(format!(
                    "nothing moves in '{}': leave out {flag}",
                    args.picture.scene
                ))),
                None => Ok(Self::Still),
            };
        }
        let period = Some(duration).filter(|duration| args.looped && *duration > 0.0);
        let Some(FrameRange { first, end }) = args.frames else {
            let seconds = wrapped(args.at.unwrap_or(0.0), period);
            return Ok(Self::Moment(Moment { seconds, frame: None }));
        };
        // The moment of the end is left out, as is the end of a range: a motion that ends as it begins then loops.
        let count = (duration * args.fps).ceil().max(1.0);
        let end = end.unwrap_or(count as u32);
        if first >= end {
            let what =
                format!("the motion has {count} frames, 0 to {}: there is no frame {first}", count - 1.0);
            return Err(Failure::Usage(format!("--frames {first}..: {what}")));
        }
        Ok(Self::Frames(Frames { range: first..end, rate: args.fps, period }))
    }
}

impl Frames {
    /// What a frame shows.
    pub fn moment(&self, number: u32) -> Moment {
        Moment { seconds: wrapped(f64::from(number) / self.rate, self.period), frame: Some(number) }
    }

    /// Digits of the largest number, and of all in file names.
    pub fn digits(&self) -> usize {
        (self.range.end - 1).to_string().len().max(4)
    }
}

/// A remainder has no rounding error.
fn wrapped(seconds: f64, period: Option<f64>) -> f64 {
    period.map_or(seconds, |period| seconds % period)
}
