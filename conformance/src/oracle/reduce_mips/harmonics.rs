//! The matrix in integers as the contract has it, and bytes.

use super::{Children, Value, sum};

/// κ·2¹⁴ with κ = (3.1140 − 1.0748)/4π.
pub const NEAR_LESS_FAR: i128 = 2659;
/// ⅔·2¹⁴.
pub const TWO_THIRDS: i128 = 10923;

/// k·x/2¹⁴, towards 0.
pub fn scaled(k: i128, x: i128) -> i128 {
    k * x / (1 << 14)
}

/// Towards the nearest, halves away from 0.
fn eighth(x: i128) -> i128 {
    (x.abs() + 4) / 8 * x.signum()
}

pub(super) fn parent(children: &Children<'_>) -> Value {
    let mut value = vec![(sum(children, 0) + 4) / 8];
    for channel in 0..3 {
        let mut sums = [0; 4];
        for (octant, child) in children.iter().enumerate() {
            let Some(child) = child else { continue };
            let a = &child[1 + 4 * channel..][..4];
            sums[0] += a[0];
            for axis in 0..3 {
                let sign = if octant >> axis & 1 == 1 { 1 } else { -1 };
                sums[0] += sign * scaled(NEAR_LESS_FAR, a[axis + 1]);
                sums[axis + 1] += sign * scaled(2 * NEAR_LESS_FAR, a[0]) + scaled(TWO_THIRDS, a[axis + 1]);
            }
        }
        value.extend(sums.map(eighth));
    }
    value
}

/// Harmonics in 8 bits each.
pub fn packed(value: &[i128]) -> [u32; 4] {
    let rounded = |a: i128, e: u32| {
        let unit = 1 << e;
        (a.abs() + unit / 2) / unit * a.signum()
    };
    // The constant terms, which bytes have no sign for.
    let is_constant = |i: usize| i % 4 == 1;
    let kept = |i: usize| if is_constant(i) { value[i].max(0) } else { value[i] };
    let fits = |e: u32| {
        (1..13).all(|i| {
            let q = rounded(kept(i), e);
            if is_constant(i) { q <= 255 } else { q.abs() <= 127 }
        })
    };
    let exponent = (0..128).find(|&e| fits(e)).unwrap_or_default();
    let mut words = [(value[0] + (i128::from(exponent) << 24)) as u32, 0, 0, 0];
    for i in 1..13 {
        let byte = rounded(kept(i), exponent).rem_euclid(256) as u32;
        words[1 + (i - 1) / 4] += byte << (8 * ((i - 1) % 4));
    }
    words
}
