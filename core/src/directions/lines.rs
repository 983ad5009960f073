//! Directions and their opposites.

use glam::DVec3;
use std::collections::HashMap;

/// Where a direction lies among the lines of its set.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct OnLine {
    /// Index into [`super::DirectionSet::lines`].
    pub line: u32,
    /// Whether the direction is the negative of the line's vector.
    pub reversed: bool,
}

/// The vectors, then their negatives.
pub(super) fn opposites_after(mut half: Vec<DVec3>) -> Vec<DVec3> {
    half.extend_from_within(..);
    let middle = half.len() / 2;
    half[middle..].iter_mut().for_each(|d| *d = -*d);
    half
}

/// Directions that are exact negatives of each other share a line.
pub(super) fn find_lines(directions: &[DVec3]) -> (Vec<OnLine>, Vec<DVec3>) {
    // Adding 0 makes −0 a 0: they differ in bits, not in value.
    let key = |d: DVec3| (d + DVec3::ZERO).to_array().map(f64::to_bits);
    let mut numbers = HashMap::new();
    let mut lines = Vec::new();
    let on_lines = directions.iter().map(|&d| match numbers.get(&key(-d)) {
        Some(&line) => OnLine { line, reversed: true },
        None => {
            let line = lines.len() as u32;
            numbers.insert(key(d), line);
            lines.push(d);
            OnLine { line, reversed: false }
        }
    });
    (on_lines.collect(), lines)
}
