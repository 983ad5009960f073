//! How often light is scattered before nothing worth seeing is left.

use super::Facts;

/// Most bounces that a plan sets: roulette ends paths long before.
const MOST: u32 = 1024;

/// Most radiance that a pixel lacks when light is scattered `bounces` times at most.
///
/// Surfaces scatter at most S of the lights' own light, and at most the share ρ of what they get: light that was scattered k times is at most S·ρᵏ, and all that was scattered
/// more often than n times at most S·ρⁿ⁺¹/(1 − ρ).
pub(super) fn left_after(facts: &Facts, bounces: u32) -> f64 {
    let (share, direct) = (facts.reflectance, facts.direct);
    if direct == 0.0 || share == 0.0 {
        return 0.0;
    }
    if share >= 1.0 {
        return f64::INFINITY;
    }
    direct * power(share, bounces + 1) / (1.0 - share)
}

/// By products, which are the same everywhere.
fn power(base: f64, exponent: u32) -> f64 {
    (0..exponent).fold(1.0, |product, _| product * base)
}

/// The least number of bounces that leaves at most `tolerance`; `None` where no number is sure to.
pub(super) fn needed(facts: &Facts, tolerance: f64) -> Option<u32> {
    if left_after(facts, MOST) > tolerance {
        return None;
    }
    let (mut low, mut high) = (0, MOST);
    while low < high {
        let middle = (low + high) / 2;
        if left_after(facts, middle) <= tolerance { high = middle } else { low = middle + 1 }
    }
    Some(low)
}
