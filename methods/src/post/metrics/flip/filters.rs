//! The filters of ꟻLIP: contrast sensitivity of the eye (4.1.1), edges and points (4.2.1).

use super::super::convolve::{Plane, filter_columns, filter_rows, gaussian, normalised, offsets};
use std::f64::consts::PI;

/// One term `a sqrt(pi / b) exp(-pi^2 d^2 / b)` of a contrast sensitivity filter; d in degrees.
struct Term {
    a: f64,
    b: f64,
}

/// Table 1 of the paper.
const ACHROMATIC: &[Term] = &[Term { a: 1.0, b: 0.0047 }];
const RED_GREEN: &[Term] = &[Term { a: 1.0, b: 0.0053 }];
const BLUE_YELLOW: &[Term] = &[Term { a: 34.1, b: 0.04 }, Term { a: 13.5, b: 0.025 }];

/// The largest b, which sets the radius of all three filters.
const WIDEST: f64 = 0.04;

/// Peak-to-trough distance of the edge detector, in degrees: two standard deviations.
const FEATURE_WIDTH: f64 = 0.082;

/// All filters for one viewing distance. Every kernel has `2 * radius + 1` taps (the features' end in zeros), so
/// that one padded plane serves them all.
pub(super) struct Filters {
    pub radius: usize,
    pub achromatic: Blur,
    pub red_green: Blur,
    pub blue_yellow: Blur,
    pub feature_blur: Vec<f64>,
    pub edge: Vec<f64>,
    pub point: Vec<f64>,
}

impl Filters {
    pub fn new(pixels_per_degree: f64) -> Self {
        // Three standard deviations of the widest blur; the feature filters' three are always narrower.
        let radius = (3.0 * (WIDEST / (2.0 * PI * PI)).sqrt() * pixels_per_degree).ceil() as usize;
        let sigma = 0.5 * FEATURE_WIDTH * pixels_per_degree;
        let feature_radius = (3.0 * sigma).ceil() as usize;
        let blur = |terms| Blur::new(terms, pixels_per_degree, radius);

        let bell = gaussian(sigma, feature_radius);
        let derivative = |weight: fn(f64) -> f64| {
            let taps = offsets(feature_radius).zip(&bell).map(|(x, g)| weight(x / sigma) * g).collect();
            padded(signed_normalised(taps), radius)
        };
        Self {
            radius,
            achromatic: blur(ACHROMATIC),
            red_green: blur(RED_GREEN),
            blue_yellow: blur(BLUE_YELLOW),
            edge: derivative(|x| -x),
            point: derivative(|x| x * x - 1.0),
            feature_blur: padded(normalised(bell), radius),
        }
    }
}

/// A sum of separable Gaussians whose weights add up to 1.
pub(super) struct Blur {
    radius: usize,
    terms: Vec<(f64, Vec<f64>)>,
}

impl Blur {
    fn new(terms: &[Term], pixels_per_degree: f64, radius: usize) -> Self {
        let mut terms: Vec<(f64, Vec<f64>)> = terms
            .iter()
            .map(|term| {
                // exp(-pi^2 (i / ppd)^2 / b) as a Gaussian of this sigma, in pixels.
                let kernel = gaussian((term.b / 2.0).sqrt() / PI * pixels_per_degree, radius);
                let sum: f64 = kernel.iter().sum();
                // The paper normalises the sum of both terms, so each counts by its own volume.
                (term.a * (PI / term.b).sqrt() * sum * sum, normalised(kernel))
            })
            .collect();
        let total: f64 = terms.iter().map(|(weight, _)| weight).sum();
        terms.iter_mut().for_each(|(weight, _)| *weight /= total);
        Self { radius, terms }
    }

    pub fn apply(&self, plane: &Plane) -> Plane {
        let margin = 2 * self.radius;
        let mut sum = Plane::from_fn(plane.width - margin, plane.height - margin, |_, _| 0.0);
        for (weight, kernel) in &self.terms {
            let part = filter_columns(&filter_rows(plane, kernel), kernel);
            sum.values.iter_mut().zip(&part.values).for_each(|(sum, value)| *sum += weight * value);
        }
        sum
    }
}

/// Positive weights sum to 1, negative ones to -1: a full step gives 1 (4.2.1). The kernel times a normalised bell
/// on the other axis is normalised the same way, because the bell is positive.
fn signed_normalised(mut kernel: Vec<f64>) -> Vec<f64> {
    let positive: f64 = kernel.iter().filter(|&&tap| tap > 0.0).sum();
    let negative: f64 = -kernel.iter().filter(|&&tap| tap < 0.0).sum::<f64>();
    kernel.iter_mut().for_each(|tap| *tap /= if *tap < 0.0 { negative } else { positive });
    kernel
}

/// Zeros on both sides up to `2 * radius + 1` taps.
fn padded(kernel: Vec<f64>, radius: usize) -> Vec<f64> {
    let side = (2 * radius + 1 - kernel.len()) / 2;
    let mut wide = vec![0.0; 2 * radius + 1];
    wide[side..side + kernel.len()].copy_from_slice(&kernel);
    wide
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sum(kernel: &[f64]) -> f64 {
        kernel.iter().sum()
    }

    #[test]
    fn radii_of_the_papers_viewer() {
        let filters = Filters::new(67.0);
        // ceil(3 * 3.016) = 10 for colour, ceil(3 * 2.747) = 9 for features.
        assert_eq!(filters.radius, 10);
        assert_eq!((filters.edge[0], filters.point[20]), (0.0, 0.0));
        assert!(filters.edge[1] > 0.0 && filters.edge[19] < 0.0);
    }

    #[test]
    fn blurs_keep_a_constant_and_features_ignore_it() {
        for pixels_per_degree in [1.0, 7.5, 67.0, 300.0] {
            let filters = Filters::new(pixels_per_degree);
            let taps = 2 * filters.radius + 1;
            let flat = Plane::from_fn(taps, taps, |_, _| 3.0);
            // Tens of f64 roundings.
            for blur in [&filters.achromatic, &filters.red_green, &filters.blue_yellow] {
                assert!((blur.apply(&flat).values[0] - 3.0).abs() < 1e-13);
            }
            assert!((sum(&filters.feature_blur) - 1.0).abs() < 1e-14);
            for kernel in [&filters.edge, &filters.point] {
                assert!(sum(kernel).abs() < 1e-14);
                assert!((kernel.iter().map(|tap| tap.abs()).sum::<f64>() - 2.0).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn blue_is_blurred_most() {
        let centre = |blur: &Blur| blur.terms.iter().map(|(w, k)| w * k[10] * k[10]).sum::<f64>();
        let filters = Filters::new(67.0);
        assert!(centre(&filters.achromatic) > centre(&filters.red_green));
        assert!(centre(&filters.red_green) > centre(&filters.blue_yellow));
    }
}
