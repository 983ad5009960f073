//! Values over time.

use super::rotation::slerp;
use crate::error::{Error, Result};
use glam::{DQuat, DVec3};
use std::ops::{Add, Mul};

/// Shortest quaternion that still has a direction.
const SHORTEST: f64 = 1e-6;

/// What happens between two keyframes (glTF 2.0, §3.11 and Appendix C).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Interpolation {
    /// The value of the keyframe before.
    Step,
    /// Vectors on a line, rotations by the shortest turn at constant speed.
    Linear,
    /// A cubic Hermite spline: every keyframe has an in-tangent, a value and an out-tangent, in units per second.
    CubicSpline,
}

/// What keyframes can hold: vectors, and quaternions for rotations.
pub trait Keyed: Copy + PartialEq + Add<Output = Self> + Mul<f64, Output = Self> {
    /// Whether every component is a finite number, as tangents must be.
    fn finite(self) -> bool;
    /// Whether it can be the value of a keyframe: finite, and a quaternion has a direction.
    fn usable(self) -> bool;
    /// The value as it is used: a quaternion of length 1.
    fn settled(self) -> Self;
    /// From `a` at 0 to `b` at 1, both settled.
    fn between(a: Self, b: Self, share: f64) -> Self;
}

impl Keyed for DVec3 {
    fn finite(self) -> bool {
        self.is_finite()
    }

    fn usable(self) -> bool {
        self.is_finite()
    }

    fn settled(self) -> Self {
        self
    }

    fn between(a: Self, b: Self, share: f64) -> Self {
        a * (1.0 - share) + b * share
    }
}

impl Keyed for DQuat {
    fn finite(self) -> bool {
        self.is_finite()
    }

    fn usable(self) -> bool {
        self.is_finite() && self.length() > SHORTEST
    }

    fn settled(self) -> Self {
        // A spline between usable values can still pass through 0, where no direction is better than another.
        if self.usable() { self.normalize() } else { Self::IDENTITY }
    }

    fn between(a: Self, b: Self, share: f64) -> Self {
        slerp(a, b, share)
    }
}

/// A value over time, from keyframes. Before the first and after the last it stays what it is there.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve<T> {
    interpolation: Interpolation,
    /// Seconds, ascending.
    times: Vec<f64>,
    /// One per time, or three for splines: in-tangent, value, out-tangent.
    values: Vec<T>,
}

impl<T: Keyed> Curve<T> {
    /// The same value at all times.
    pub fn constant(value: T) -> Self {
        Self { interpolation: Interpolation::Step, times: vec![0.0], values: vec![value] }
    }

    /// A curve through keyframes at `times` in seconds. For [`Interpolation::CubicSpline`], `values` has an in-tangent, a
    /// value and an out-tangent for every time, else one value.
    ///
    /// # Errors
    /// [`Error::InvalidInput`] without keyframes, for times that are negative, not finite or don't increase, for another
    /// number of values, and for values that are not finite or rotations without a direction.
    pub fn new(interpolation: Interpolation, times: Vec<f64>, values: Vec<T>) -> Result<Self> {
        let invalid = |what: String| Err(Error::invalid("keyframes", what));
        if times.is_empty() {
            return invalid("there are none".into());
        }
        if let Some(i) = times.iter().position(|t| !(*t >= 0.0 && t.is_finite())) {
            return invalid(format!("time {} of keyframe {i} is negative or not a number", times[i]));
        }
        if let Some(i) = times.windows(2).position(|pair| !(pair[0] < pair[1])) {
            let (before, after) = (times[i], times[i + 1]);
            return invalid(format!(
                "times don't increase: {before} s, then {after} s at keyframe {}",
                i + 1
            ));
        }
        let per_key = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
        if times.len().checked_mul(per_key) != Some(values.len()) {
            return invalid(format!("{} values for {} times, {per_key} each", values.len(), times.len()));
        }
        let is_tangent = |i: usize| per_key == 3 && i % 3 != 1;
        let bad = |(i, v): (usize, &T)| if is_tangent(i) { !v.finite() } else { !v.usable() };
        if let Some(i) = values.iter().enumerate().position(bad) {
            return invalid(format!("value of keyframe {} is not finite or has no direction", i / per_key));
        }
        Ok(Self { interpolation, times, values }.shortened())
    }

    /// One keyframe where all are alike: exporters write many such curves, and what doesn't move can be kept.
    fn shortened(self) -> Self {
        let first = self.value(0);
        let alike = match self.interpolation {
            Interpolation::CubicSpline => self.values.chunks_exact(3).all(|key| {
                let still = |tangent: T| tangent == tangent * 0.0;
                key[1] == first && still(key[0]) && still(key[2])
            }),
            _ => self.values.iter().all(|&value| value == first),
        };
        if alike || self.times.len() == 1 { Self::constant(first) } else { self }
    }

    /// The value at a time in seconds.
    pub fn at(&self, seconds: f64) -> T {
        let after = self.times.partition_point(|&time| time <= seconds);
        if after == 0 || after == self.times.len() {
            return self.value(after.saturating_sub(1)).settled();
        }
        let before = after - 1;
        let length = self.times[after] - self.times[before];
        let share = (seconds - self.times[before]) / length;
        match self.interpolation {
            Interpolation::Step => self.value(before).settled(),
            Interpolation::Linear => {
                T::between(self.value(before).settled(), self.value(after).settled(), share)
            }
            Interpolation::CubicSpline => self.hermite(before, share, length).settled(),
        }
    }

    /// glTF 2.0, Appendix C.5.
    fn hermite(&self, before: usize, t: f64, length: f64) -> T {
        let (out_tangent, in_tangent) = (self.values[3 * before + 2], self.values[3 * before + 3]);
        let (t2, t3) = (t * t, t * t * t);
        self.value(before) * (2.0 * t3 - 3.0 * t2 + 1.0)
            + out_tangent * (length * (t3 - 2.0 * t2 + t))
            + self.value(before + 1) * (3.0 * t2 - 2.0 * t3)
            + in_tangent * (length * (t3 - t2))
    }

    fn value(&self, key: usize) -> T {
        match self.interpolation {
            Interpolation::CubicSpline => self.values[3 * key + 1],
            _ => self.values[key],
        }
    }

    /// Whether it is the same at all times.
    pub fn is_constant(&self) -> bool {
        self.times.len() == 1
    }

    /// Bytes of the keyframes.
    pub(super) fn bytes(&self) -> usize {
        size_of_val(&*self.times) + size_of_val(&*self.values)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn vectors(interpolation: Interpolation, times: &[f64], x: &[f64]) -> Result<Curve<DVec3>> {
        Curve::new(interpolation, times.to_vec(), x.iter().map(|&x| DVec3::new(x, 0.0, 1.0)).collect())
    }

    #[test]
    fn keyframes_are_exact_and_ends_stay() {
        let (times, x) = ([0.25, 0.5, 2.0], [0.1, 0.7, -0.3]);
        for interpolation in [Interpolation::Step, Interpolation::Linear] {
            let curve = vectors(interpolation, &times, &x).unwrap();
            for (time, x) in times.iter().zip(x) {
                assert_eq!(curve.at(*time).x, x, "{interpolation:?} {time}");
            }
            assert_eq!((curve.at(-9.0).x, curve.at(0.0).x, curve.at(1e9).x), (0.1, 0.1, -0.3));
        }
        let curve = vectors(Interpolation::Linear, &[1.0, 3.0], &[4.0, 8.0]).unwrap();
        assert_eq!((curve.at(1.5).x, curve.at(2.0).x), (5.0, 6.0));
        let curve = vectors(Interpolation::Step, &[1.0, 3.0], &[4.0, 8.0]).unwrap();
        assert_eq!((curve.at(2.999).x, curve.at(3.0).x), (4.0, 8.0));
    }

    /// Tangents of a cubic polynomial give that polynomial.
    #[test]
    fn splines_are_cubic() {
        let (f, slope) = (|t: f64| t * t * t - 2.0 * t + 5.0, |t: f64| 3.0 * t * t - 2.0);
        let times = vec![0.5, 1.0, 3.0];
        let vector = |x| DVec3::new(x, 0.0, 0.0);
        let values = times.iter().flat_map(|&t| [slope(t), f(t), slope(t)]).map(vector).collect();
        let curve = Curve::new(Interpolation::CubicSpline, times.clone(), values).unwrap();
        times.iter().for_each(|&t| assert_eq!(curve.at(t).x, f(t)));
        for i in 0..=50 {
            let t = 0.5 + 0.05 * f64::from(i);
            assert!((curve.at(t).x - f(t)).abs() < 1e-13, "{t}");
        }
    }

    #[test]
    fn curves_of_one_value_are_constant() {
        assert!(vectors(Interpolation::Linear, &[0.0, 1.0], &[2.0, 2.0]).unwrap().is_constant());
        assert!(!vectors(Interpolation::Linear, &[0.0, 1.0], &[2.0, 3.0]).unwrap().is_constant());
        let spline = |tangent: f64| {
            let values = [0.0, 2.0, tangent, 0.0, 2.0, 0.0].map(|x| DVec3::new(x, 0.0, 0.0));
            Curve::new(Interpolation::CubicSpline, vec![0.0, 1.0], values.to_vec()).unwrap()
        };
        assert!(spline(0.0).is_constant() && !spline(1.0).is_constant());
    }

    #[test]
    fn what_makes_no_curve_is_refused_by_its_reason() {
        let refused =
            |times: &[f64], x: &[f64]| vectors(Interpolation::Linear, times, x).unwrap_err().to_string();
        let cases = [
            (&[][..], &[][..], "there are none"),
            (&[-1.0], &[0.0], "time -1 of keyframe 0 is negative"),
            (&[0.0, f64::NAN], &[0.0; 2], "time NaN of keyframe 1"),
            (&[0.0, 1.0, 1.0], &[0.0; 3], "times don't increase: 1 s, then 1 s at keyframe 2"),
            (&[0.0, 1.0], &[0.0], "1 values for 2 times, 1 each"),
            (&[0.0, 1.0], &[0.0, f64::INFINITY], "value of keyframe 1 is not finite"),
        ];
        for (times, x, expected) in cases {
            assert!(refused(times, x).contains(expected), "{times:?}: {}", refused(times, x));
        }
        let zero = Curve::new(Interpolation::Linear, vec![0.0], vec![DQuat::from_array([0.0; 4])]);
        assert!(zero.is_err());
    }
}
