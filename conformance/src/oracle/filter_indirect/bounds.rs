//! Means in f64, and how far the contract's f32 formula may stray from them.
//!
//! WGSL lets + − × round either way, so each is off by at most one ulp, η = 2⁻²³ of its result; a division by 2.5 ulp. Since a driver
//! may reorder a sum, a rounding counts η of the sum of magnitudes, not of the sum. Results must be ordinary numbers: what a device
//! flushes is not accounted for.

use super::Picture;
use crate::oracle::trace::wide;
use glam::DVec3;
use twinlight_core::kernels::filter_indirect::LEAST_ALBEDO;
use twinlight_core::kernels::shade_primary::GBufferTexel;
use twinlight_core::kernels::trace::NO_HIT;

/// One ulp, and 2⁻¹⁰ of it for products of errors.
const ETA: f64 = 1.001 / 8_388_608.0;

/// What a channel of a pixel may hold.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Allowed {
    /// The input's bits.
    Copied,
    /// A number between two.
    Within {
        /// Least value.
        low: f64,
        /// Greatest value.
        high: f64,
    },
    /// An infinity or no number.
    NotFinite,
    /// Anything: it depends on a neighbour in doubt, or on where f32 ends.
    Any,
}

/// What a pixel may hold.
#[derive(Debug, Clone, Copy)]
pub struct Pixel {
    /// Per channel.
    pub rgb: [Allowed; 3],
    /// Neighbours of which rounding decides whether they are joined.
    pub undecided: usize,
}

/// Every f32 result that the contract allows for one pixel.
pub fn possible(picture: &Picture, at: usize) -> Pixel {
    if !picture.is_diffuse(at) {
        return Pixel { rgb: [Allowed::Copied; 3], undecided: 0 };
    }
    let p = &picture.gbuffer[at];
    let judged = picture.window(at).into_iter().map(|(other, quarters)| {
        let is_joined = joined(picture, p, &picture.gbuffer[other]);
        Neighbour { at: other, weight: f64::from(quarters) * 0.25, is_joined }
    });
    let around: Vec<Neighbour> = judged.filter(|q| q.is_joined != Some(false)).collect();
    let undecided = around.iter().filter(|q| q.is_joined.is_none()).count();
    Pixel { rgb: [0, 1, 2].map(|c| channel(picture, p, c, &around)), undecided }
}

struct Neighbour {
    at: usize,
    weight: f64,
    /// `None` where rounding decides.
    is_joined: Option<bool>,
}

/// Whether q is a joined neighbour of p.
fn joined(picture: &Picture, p: &GBufferTexel, q: &GBufferTexel) -> Option<bool> {
    if q.triangle == NO_HIT || q.material != p.material {
        return Some(false);
    }
    let params = &picture.params;
    let magnitude = |a: DVec3, b: DVec3| a.abs().dot(b.abs());
    // One rounding of each product, two of the sum.
    let (a, b) = (wide(p.shading_normal), wide(q.shading_normal));
    let turned = decided(a.dot(b) - f64::from(params.least_cosine), 3.0 * ETA * magnitude(a, b));
    // One more, of the difference; and two of the limit's products.
    let (normal, apart) = (wide(p.geometric_normal), wide(q.position) - wide(p.position));
    let limit = f64::from(params.footprint) * f64::from(params.window) * f64::from(p.depth);
    let doubt = 4.0 * ETA * magnitude(normal, apart) + 2.0 * ETA * limit.abs();
    let near = decided(limit - normal.dot(apart).abs(), doubt);
    match (turned, near) {
        (Some(false), _) | (_, Some(false)) => Some(false),
        (Some(true), Some(true)) => Some(true),
        _ => None,
    }
}

/// Whether a difference is at least 0, unless doubt is larger. Comparisons with what is no number fail.
fn decided(difference: f64, doubt: f64) -> Option<bool> {
    if difference >= doubt {
        Some(true)
    } else if difference < -doubt || difference.is_nan() {
        Some(false)
    } else {
        None
    }
}

fn channel(picture: &Picture, p: &GBufferTexel, c: usize, around: &[Neighbour]) -> Allowed {
    let of = |texel: &GBufferTexel| texel.albedo[c];
    if !(of(p) >= LEAST_ALBEDO) {
        return Allowed::Copied;
    }
    let terms = |is_joined: Option<bool>| -> Vec<Term> {
        let lit = around.iter().filter(|q| q.is_joined == is_joined);
        let lit = lit.filter(|q| of(&picture.gbuffer[q.at]) >= LEAST_ALBEDO);
        let value =
            |q: &Neighbour| f64::from(picture.input[q.at].rgb[c]) / f64::from(of(&picture.gbuffer[q.at]));
        lit.map(|q| Term { weight: q.weight, value: value(q) }).collect()
    };
    interval(f64::from(of(p)), &terms(Some(true)), &terms(None))
}

/// Irradiance that counts with a weight.
#[derive(Debug, Clone, Copy)]
pub(super) struct Term {
    pub weight: f64,
    pub value: f64,
}

/// The products of an albedo and a mean of all certain terms and some of those in doubt.
pub(super) fn interval(albedo: f64, certain: &[Term], doubtful: &[Term]) -> Allowed {
    if certain.iter().any(|term| !term.value.is_finite()) {
        return Allowed::NotFinite;
    }
    if certain.is_empty() && doubtful.is_empty() {
        return Allowed::Copied;
    }
    let sum: f64 = certain.iter().chain(doubtful).map(|term| term.weight * term.value.abs()).sum();
    // Without a certain term there may be none at all; and sums beyond the largest f32 are what the order makes of them.
    if certain.is_empty() || !(sum < f64::from(f32::MAX) * 0.5) {
        return Allowed::Any;
    }
    let mapped = |map: fn(f64) -> f64| {
        let of =
            |terms: &[Term]| terms.iter().map(|t| Term { value: map(t.value), ..*t }).collect::<Vec<_>>();
        least_mean(of(certain), of(doubtful))
    };
    let (low, high, magnitude) = (mapped(|v| v), -mapped(|v| -v), -mapped(|v| -v.abs()));
    // 2.5 of the quotient, none of the product with a power of two, one of each addition but the first, one of the product with
    // albedo, 2.5 of the division; the sum of weights is exact.
    let roundings = (certain.len() + doubtful.len()) as f64 + 5.0;
    let error = roundings * ETA * magnitude;
    Allowed::Within { low: albedo * (low - error), high: albedo * (high + error) }
}

/// The least mean: terms in doubt lower it as long as they are below it, the lowest first.
fn least_mean(certain: Vec<Term>, mut doubtful: Vec<Term>) -> f64 {
    let mut sum: f64 = certain.iter().map(|t| t.weight * t.value).sum();
    let mut weight: f64 = certain.iter().map(|t| t.weight).sum();
    doubtful.sort_by(|a, b| a.value.total_cmp(&b.value));
    for term in doubtful {
        if term.value * weight < sum {
            sum += term.weight * term.value;
            weight += term.weight;
        }
    }
    sum / weight
}
