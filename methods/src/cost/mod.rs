//! What accuracy costs: every knob, which settings to measure, what a measurement is, and what follows from many.
//!
//! [`knobs`] is the one table of everything that trades accuracy for time or memory. A [`Sweep`] says which [`Setting`] to measure next,
//! [`measure`] takes its time and its memory, [`errors`] says how far its picture is from a [`Reference`], whose own noise is known.
//! [`front`] keeps the settings that no other beats, and [`split`] says how much of an error is bias and how much is noise.

mod front;
pub mod knobs;
mod measure;
mod reference;
mod setting;
mod split;
mod sweep;

pub use front::front;
pub use knobs::{KNOBS, Knob, Range};
pub use measure::{Effort, Measured, Spread, StepTime, measure};
pub use reference::{Errors, METRICS, Reference, distance, errors};
pub use setting::{METHODS, Setting};
pub use split::{Split, split};
pub use sweep::{Sweep, Tried};
