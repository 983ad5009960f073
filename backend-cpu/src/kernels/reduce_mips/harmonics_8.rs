//! Harmonics in 8 bits each, with an exponent for all.

/// Bits of the greatest constant term, and of the greatest other one.
const BITS: [u32; 2] = [8, 7];

/// The four words of harmonics.
#[inline]
pub(super) fn pack(value: &[u32; 13]) -> [u32; 4] {
    let a = |i: usize| value[1 + i].cast_signed();
    let (mut constant, mut other) = (0, 0);
    for i in 0..12 {
        if i % 4 == 0 {
            constant = constant.max(a(i).max(0).unsigned_abs());
        } else {
            other = other.max(a(i).unsigned_abs());
        }
    }
    let exponent = least_exponent(constant, BITS[0]).max(least_exponent(other, BITS[1]));
    let mut words = [value[0].wrapping_add(exponent << 24), 0, 0, 0];
    for i in 0..12 {
        let kept = if i % 4 == 0 { a(i).max(0) } else { a(i) };
        let magnitude = rounded(kept.unsigned_abs(), exponent);
        let byte = if kept < 0 { magnitude.wrapping_neg() } else { magnitude };
        words[1 + i / 4] |= (byte & 0xff) << (8 * (i % 4));
    }
    words
}

/// The least e for which r of a magnitude has so many bits: rounding may need one more than the magnitude has too many.
#[inline(always)]
fn least_exponent(magnitude: u32, bits: u32) -> u32 {
    let exponent = (32 - magnitude.leading_zeros()).saturating_sub(bits);
    exponent + (rounded(magnitude, exponent) >> bits)
}

/// To the nearest; halves up.
#[inline(always)]
fn rounded(magnitude: u32, exponent: u32) -> u32 {
    (magnitude + ((1 << exponent) >> 1)) >> exponent
}
