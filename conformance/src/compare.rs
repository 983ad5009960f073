//! The comparator: what differed, where, by how much, and how much was allowed.

mod dump;
mod record;

pub use record::{Field, Kind, Record};

use crate::trial::{Check, Context, Failure};
use std::fmt::Write as _;

/// Differences described in full; the rest is counted.
const SHOWN: usize = 5;

/// How element numbers turn into coordinates in messages.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    /// A list.
    Line,
    /// Rows of pixels.
    Image {
        /// Pixels per row.
        width: usize,
    },
}

impl Shape {
    fn place(self, index: usize) -> String {
        match self {
            Self::Line => format!("[{index}]"),
            Self::Image { width } => {
                format!("[{index}] (x {}, y {})", index % width.max(1), index / width.max(1))
            }
        }
    }
}

/// Collects differences of one output.
#[derive(Debug)]
pub struct Evidence {
    what: String,
    shape: Shape,
    checked: usize,
    wrong: usize,
    first: String,
}

impl Evidence {
    /// Starts a comparison of `what`.
    pub fn new(what: impl Into<String>, shape: Shape) -> Self {
        Self { what: what.into(), shape, checked: 0, wrong: 0, first: String::new() }
    }

    fn note(&mut self, index: usize, text: impl FnOnce() -> String) {
        self.wrong += 1;
        if self.wrong <= SHOWN {
            let _ = write!(self.first, "\n  {} {}", self.shape.place(index), text());
        }
    }

    /// Compares the bits of one field.
    pub fn bits(&mut self, index: usize, field: &str, kind: Kind, got: u64, want: u64) {
        self.checked += 1;
        if got != want {
            self.note(index, || {
                format!("{field}: got {}, want {}{}", kind.show(got), kind.show(want), gap(kind, got, want))
            });
        }
    }

    /// Checks that a float lies in `low..=high`; NaN never does. `because` says where the interval comes from.
    pub fn interval(&mut self, index: usize, field: &str, got: f32, low: f64, high: f64, because: &str) {
        self.checked += 1;
        let inside = f64::from(got) >= low && f64::from(got) <= high;
        if !inside {
            let got = Kind::Float.show(u64::from(got.to_bits()));
            self.note(index, || format!("{field}: got {got}, allowed {low:e} to {high:e} ({because})"));
        }
    }

    /// Checks that an id is one of a few.
    pub fn one_of(&mut self, index: usize, field: &str, got: u32, allowed: &[u32]) -> bool {
        self.checked += 1;
        let inside = allowed.contains(&got);
        if !inside {
            self.note(index, || format!("{field}: got {got} ({got:#010x}), allowed {allowed:?}"));
        }
        inside
    }

    /// Checks a statement about one element.
    pub fn holds(&mut self, index: usize, holds: bool, text: impl FnOnce() -> String) {
        self.checked += 1;
        if !holds {
            self.note(index, text);
        }
    }

    /// Number of values found wrong so far.
    pub fn wrong(&self) -> usize {
        self.wrong
    }

    /// The verdict.
    ///
    /// # Errors
    /// [`Failure::Mismatch`] with the counts and the first differences.
    pub fn finish(self) -> Check {
        if self.wrong == 0 {
            return Ok(());
        }
        let more = if self.wrong > SHOWN {
            format!("\n  … and {} more", self.wrong - SHOWN)
        } else {
            String::new()
        };
        Err(Failure::Mismatch(format!(
            "{}: {} of {} values wrong{}{more}",
            self.what, self.wrong, self.checked, self.first
        )))
    }
}

fn gap(kind: Kind, got: u64, want: u64) -> String {
    match kind {
        Kind::Float => match ulps(f32::from_bits(got as u32), f32::from_bits(want as u32)) {
            Some(n) => format!(", {n} ulp apart"),
            None => ", one is not a number".into(),
        },
        Kind::Unsigned | Kind::Unsigned64 => format!(", off by {}", i128::from(got) - i128::from(want)),
    }
}

/// Number of floats from `a` to `b`, counting −0 and 0 as one; `None` with a NaN.
pub fn ulps(a: f32, b: f32) -> Option<u64> {
    let line = |x: f32| {
        let magnitude = i64::from(x.to_bits() & 0x7fff_ffff);
        if x.is_sign_negative() { -magnitude } else { magnitude }
    };
    if a.is_nan() || b.is_nan() { None } else { Some(line(a).abs_diff(line(b))) }
}

/// Compares two arrays bit for bit, field by field, and leaves both in the dump folder when they differ.
///
/// # Errors
/// [`Failure::Mismatch`] with the first differences and the files written.
pub fn exact<T: Record, B>(cx: &Context<'_, B>, what: &str, got: &[T], want: &[T], shape: Shape) -> Check {
    if got.len() != want.len() {
        let text = format!("{what}: got {} elements, want {}", got.len(), want.len());
        return Err(Failure::Mismatch(text));
    }
    let mut evidence = Evidence::new(what, shape);
    for (index, (g, w)) in got.iter().zip(want).enumerate() {
        if bytemuck::bytes_of(g) != bytemuck::bytes_of(w) {
            T::each(g, w, |field, kind, g, w| evidence.bits(index, field, kind, g, w));
        }
    }
    evidence.checked = got.len();
    let checked = evidence.finish();
    match (&checked, &cx.options.dump_dir) {
        (Err(Failure::Mismatch(text)), Some(folder)) => {
            Err(Failure::Mismatch(format!("{text}{}", dump::pair(folder, cx.name, what, got, want))))
        }
        _ => checked,
    }
}

#[cfg(test)]
mod tests;
