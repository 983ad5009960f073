//! Fixed point in pairs of u32: sums whose bits don't depend on their order. Twin: `backend-gpu/src/shared/fixed.wgsl`.

/// A u64 as (low, high) words.
pub type Words = [u32; 2];

/// What [`from_float`] returns for a value that is negative, not finite or at least 2⁶² quanta.
pub const OUT_OF_RANGE: Words = [u32::MAX, u32::MAX];

/// ⌊x·2^exponent + ½⌋ for x ≥ 0 and −900 ≤ exponent ≤ 900. Subnormals count as 0: adapters flush them.
///
/// WGSL has no f64 and shifts the bits of x instead. Here f64 gives the same: the product is exact, and the sum is
/// rounded only where x·2^exponent is below 2⁻²⁹, which the floor takes to 0 either way.
#[inline(always)]
pub fn from_float(x: f32, exponent: i32) -> Words {
    let scale = f64::from_bits(((1023 + exponent) as u64) << 52);
    let scaled = f64::from(x) * scale;
    // A NaN is in no range.
    if !(0.0..4_611_686_018_427_387_904.0).contains(&scaled) {
        return OUT_OF_RANGE;
    }
    if x < f32::MIN_POSITIVE {
        return [0, 0];
    }
    // Through i64, which processors convert to in one instruction: below 2⁶³, it is the same.
    let value = (scaled + 0.5) as i64;
    [value as u32, (value >> 32) as u32]
}

/// Sum, saturating at 2⁶⁴ − 1. Saturating sums of non-negative numbers don't depend on the order either.
#[inline(always)]
pub fn add_saturating(a: Words, b: Words) -> Words {
    let wide = |w: Words| u64::from(w[1]) << 32 | u64::from(w[0]);
    let sum = wide(a).saturating_add(wide(b));
    [sum as u32, (sum >> 32) as u32]
}

/// The value in units of radiance, exact to f64.
pub fn to_f64(words: Words, exponent: i32) -> f64 {
    let value = u64::from(words[1]) << 32 | u64::from(words[0]);
    value as f64 * f64::from(-exponent).exp2()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn wide(w: Words) -> u64 {
        u64::from(w[1]) << 32 | u64::from(w[0])
    }

    /// The conversion as WGSL makes it, by shifting the bits of x.
    fn by_shifting(x: f32, exponent: i32) -> Words {
        let bits = x.to_bits();
        let biased = bits >> 23;
        if biased == 0 || bits == 0x8000_0000 {
            return [0, 0];
        }
        if biased >= 255 {
            return OUT_OF_RANGE;
        }
        let mantissa = u64::from((bits & 0x007f_ffff) | 0x0080_0000);
        let shift = biased as i32 - 150 + exponent;
        let value = match shift {
            39.. => return OUT_OF_RANGE,
            0..39 => mantissa << shift,
            -24..0 => ((mantissa >> (-shift - 1)) + 1) >> 1,
            _ => 0,
        };
        [value as u32, (value >> 32) as u32]
    }

    proptest! {
        #[test]
        fn conversion_is_the_shift(bits in 0_u32..0x8000_0000, exponent in -60_i32..80) {
            let x = f32::from_bits(bits);
            prop_assert_eq!(from_float(x, exponent), by_shifting(x, exponent));
        }

        #[test]
        fn ordinary_values_too(x in 1e-9_f32..1e9, exponent in -20_i32..60) {
            prop_assert_eq!(from_float(x, exponent), by_shifting(x, exponent));
        }

        #[test]
        fn conversion_rounds_half_up(x in 1e-6_f32..1e6, exponent in -20_i32..40) {
            let exact = f64::from(x) * f64::from(exponent).exp2();
            if exact < 4.6e18 {
                prop_assert_eq!(wide(from_float(x, exponent)), (exact + 0.5).floor() as u64);
            }
        }

        #[test]
        fn addition_is_that_of_u64(a: u64, b: u64) {
            let split = |x: u64| [x as u32, (x >> 32) as u32];
            prop_assert_eq!(wide(add_saturating(split(a), split(b))), a.saturating_add(b));
        }
    }

    #[test]
    fn edges() {
        assert_eq!(from_float(0.0, 40), [0, 0]);
        assert_eq!(from_float(-0.0, 40), [0, 0]);
        assert_eq!(from_float(1e-40, 40), [0, 0]);
        assert_eq!(from_float(0.5, 0), [1, 0]);
        assert_eq!(from_float(0.25, 0), [0, 0]);
        assert_eq!(from_float(0.499, 0), [0, 0]);
        assert_eq!(from_float(1.0, 61), [0, 1 << 29]);
        for bad in [-1.0, f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 4.0] {
            assert_eq!(from_float(bad, 61), OUT_OF_RANGE, "{bad}");
        }
    }
}
