//! The normal distribution's tails, and Šidák's correction.

use std::f64::consts::{FRAC_1_SQRT_2, PI};

/// Complementary error function for `x >= 0`, to about 1e-13 relative.
///
/// Below 2 the series erf(x) = 2/√π · e^(−x²) · Σ 2ⁿ x^(2n+1) / (2n+1)!!, whose terms are all positive (no
/// cancellation); from 2 on the continued fraction (Abramowitz & Stegun 7.1.14), which keeps its relative
/// accuracy however small the tail, where 1 − erf would be all rounding.
pub(super) fn erfc(x: f64) -> f64 {
    let gauss = (-x * x).exp();
    if x < 2.0 {
        let (mut term, mut sum) = (x, x);
        for n in 1..60 {
            term *= 2.0 * x * x / f64::from(2 * n + 1);
            sum += term;
        }
        1.0 - 2.0 / PI.sqrt() * gauss * sum
    } else {
        let tail = (1..=60).rev().fold(x, |tail, n| x + 0.5 * f64::from(n) / tail);
        gauss / (PI.sqrt() * tail)
    }
}

/// Probability of a standard normal value at least as far from 0 as `z`.
pub(super) fn two_sided_p(z: f64) -> f64 {
    erfc(z.abs() * FRAC_1_SQRT_2)
}

/// The `z` whose two-sided probability is `p`, by bisection: monotone, so no starting value can mislead it.
pub(super) fn two_sided_threshold(p: f64) -> f64 {
    // p underflows to 0 near z = 38.6; nothing beyond is reachable.
    let (mut low, mut high) = (0.0, 40.0);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if two_sided_p(middle) > p { low = middle } else { high = middle }
    }
    high
}

/// Per-test level that keeps the chance of any false alarm in `tests` independent tests at `alpha`.
pub(super) fn sidak(alpha: f64, tests: u64) -> f64 {
    // 1 - (1 - alpha)^(1/n) without losing the small difference from 1.
    -((-alpha).ln_1p() / tests as f64).exp_m1()
}

/// Chance that the smallest of `tests` independent p-values is at most `p`: the inverse of [`sidak`].
pub(super) fn any_of(p: f64, tests: u64) -> f64 {
    -((-p).ln_1p() * tests as f64).exp_m1()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(a: f64, b: f64, relative: f64) -> bool {
        (a - b).abs() <= relative * b.abs()
    }

    #[test]
    fn tails_agree_with_tables() {
        // Abramowitz & Stegun's table 7.1 continued with Python's math.erfc; 1e-12 as 1 - erf(x) loses three digits
        // at the seam x = 2.
        for (x, expected) in [
            (0.0, 1.0),
            (0.5, 0.4795001221869535),
            (1.0, 0.15729920705028513),
            (1.999, 0.004698443348629488),
            (2.0, 0.004677734981047266),
            (3.0, 2.209049699858544e-05),
            (5.0, 1.5374597944280349e-12),
            (10.0, 2.088487583762545e-45),
        ] {
            assert!(close(erfc(x), expected, 1e-12), "erfc({x}) = {}", erfc(x));
        }
    }

    #[test]
    fn thresholds_of_textbooks() {
        // Quantiles of the normal distribution, 12 digits.
        assert!(close(two_sided_threshold(0.05), 1.959963984540054, 1e-12));
        assert!(close(two_sided_threshold(0.01), 2.575829303548901, 1e-12));
        assert!(close(two_sided_p(two_sided_threshold(1e-10)), 1e-10, 1e-9));
    }

    #[test]
    fn sidak_by_hand_and_back() {
        assert!(close(sidak(0.19, 2), 0.1, 1e-14));
        assert!(close(any_of(0.1, 2), 0.19, 1e-14));
        assert!(close(any_of(sidak(0.01, 786_432), 786_432), 0.01, 1e-12));
        assert_eq!(any_of(1.0, 5), 1.0);
    }
}
