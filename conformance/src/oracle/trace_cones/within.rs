//! Intervals that every f32 result is in.
//!
//! WGSL lets + − × round either way, so each is off by at most one ulp, η = 2⁻²³ of its result; a division by 2.5 ulp. Since a driver may
//! reorder a sum, a rounding of one counts η of both magnitudes. What is flushed to zero is below 2⁻¹²⁶, and so is 2⁻¹⁰⁰ after a factor of
//! 2²⁶, which radiance and positions stay below. A result that f32 has, of operands that are known, is exact.

use std::ops::{Add, Mul, Sub};

/// One ulp, and 2⁻¹⁰ of it for products of errors.
const ETA: f64 = 1.001 / 8_388_608.0;
/// What flushed numbers can amount to, 2⁻¹⁰⁰.
const FLUSHED: f64 = 7.888_609_052_210_118e-31;

/// All numbers from `low` to `high`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Within {
    /// Least.
    pub low: f64,
    /// Greatest.
    pub high: f64,
}

impl Within {
    /// A number that is known.
    pub const fn exactly(x: f64) -> Self {
        Self { low: x, high: x }
    }

    /// Whether a result is in it.
    pub fn holds(&self, found: f32) -> bool {
        (self.low..=self.high).contains(&f64::from(found))
    }

    /// Both, and all between.
    pub fn hull(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// The greater of two.
    pub fn max(self, other: Self) -> Self {
        Self { low: self.low.max(other.low), high: self.high.max(other.high) }
    }

    /// The lesser of two.
    pub fn min(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.min(other.high) }
    }

    /// What is in both of two that have something in common.
    pub fn common(self, other: Self) -> Self {
        let (low, high) = (self.low.max(other.low), self.high.min(other.high));
        if low <= high { Self { low, high } } else { self }
    }

    /// Times a power of two, without a rounding.
    pub fn scaled(self, power: f64) -> Self {
        Self { low: self.low * power, high: self.high * power }
    }

    /// The magnitude.
    pub fn abs(self) -> Self {
        let most = self.greatest();
        let least =
            if self.low <= 0.0 && self.high >= 0.0 { 0.0 } else { self.low.abs().min(self.high.abs()) };
        Self { low: least, high: most }
    }

    /// The quotient by what is above zero; anything where that can be nothing.
    pub fn over(self, divisor: Self) -> Self {
        if divisor.low <= 0.0 {
            return Self { low: f64::NEG_INFINITY, high: f64::INFINITY };
        }
        let ends = [
            self.low / divisor.low,
            self.low / divisor.high,
            self.high / divisor.low,
            self.high / divisor.high,
        ];
        Self::around(ends).widened(2.5)
    }

    /// As an f32.
    pub fn rounded(self) -> Self {
        self.widened(1.0)
    }

    /// After `count` roundings of products, quotients and sums of one sign.
    pub fn rounded_often(self, count: u32) -> Self {
        self.widened(2.5 * f64::from(count))
    }

    /// Whether it is more than `other`; `None` where a rounding decides.
    pub fn is_more(self, other: Self) -> Option<bool> {
        if self.low > other.high {
            Some(true)
        } else if self.high <= other.low {
            Some(false)
        } else {
            None
        }
    }

    /// Whether it is at least `other`; `None` where a rounding decides.
    pub fn is_at_least(self, other: Self) -> Option<bool> {
        other.is_more(self).map(|more| !more)
    }

    /// Whether it is one number that f32 has and no device flushes: rounded either way, it is what it is.
    fn is_known(self) -> bool {
        let is_f32 = f64::from(self.low as f32) == self.low;
        self.low == self.high && is_f32 && (self.low == 0.0 || self.low.abs() > FLUSHED)
    }

    fn greatest(self) -> f64 {
        self.low.abs().max(self.high.abs())
    }

    fn around(ends: [f64; 4]) -> Self {
        let low = ends.into_iter().fold(f64::INFINITY, f64::min);
        Self { low, high: ends.into_iter().fold(f64::NEG_INFINITY, f64::max) }
    }

    /// With so many ulp of itself on either side.
    fn widened(self, ulps: f64) -> Self {
        self.with(ulps * ETA * self.greatest() + FLUSHED)
    }

    /// With `error` on either side; infinite ends are where they are.
    fn with(self, error: f64) -> Self {
        let moved = |end: f64, by: f64| if end.is_finite() { end + by } else { end };
        Self { low: moved(self.low, -error), high: moved(self.high, error) }
    }
}

impl Add for Within {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let sum = Self { low: self.low + other.low, high: self.high + other.high };
        let is_exact = sum.low - self.low == other.low && sum.low - other.low == self.low;
        if is_exact && sum.is_known() {
            return sum;
        }
        sum.with(ETA * (self.greatest() + other.greatest()) + FLUSHED)
    }
}

impl Sub for Within {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + Self { low: -other.high, high: -other.low }
    }
}

impl Mul for Within {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        // Nothing times what is boundless is nothing here: boundless is only what isn't known.
        let times = |a: f64, b: f64| if a == 0.0 || b == 0.0 { 0.0 } else { a * b };
        let ends = [
            times(self.low, other.low),
            times(self.low, other.high),
            times(self.high, other.low),
            times(self.high, other.high),
        ];
        let product = Self::around(ends);
        // The product of two f32 fits into an f64.
        if product.is_known() { product } else { product.widened(1.0) }
    }
}
