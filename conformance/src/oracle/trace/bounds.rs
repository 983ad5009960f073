//! One ray, one triangle: the f64 truth and how far the contract's f32 formula may stray from it.
//!
//! WGSL lets + − × round either way, so each is off by at most one ulp, η = 2⁻²³ of its result; a division by 2.5 ulp.
//! The bounds follow the contract operation by operation; since a driver may reorder a sum, a rounding counts η of the
//! sum of magnitudes, not of the sum. Second-order terms go into [`ETA`].

use glam::DVec3;
use twinlight_core::kernels::trace::Ray;
use twinlight_core::transport::intersect::{
    MIN_DIRECTION, PAD_COORDINATE, PAD_EXTENT, SIDE_ERROR, SLAB_FAR_FACTOR,
};

/// One ulp, 2⁻²³, and 2⁻¹⁰ of it for products of errors.
const ETA: f64 = 1.001 / 8_388_608.0;

/// A closed interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    /// Least value.
    pub low: f64,
    /// Greatest value.
    pub high: f64,
}

impl Interval {
    const ANY: Self = Self { low: f64::NEG_INFINITY, high: f64::INFINITY };

    fn around(middle: f64, error: f64) -> Self {
        Self { low: middle - error, high: middle + error }
    }

    fn and(self, other: Self) -> Self {
        Self { low: self.low.max(other.low), high: self.high.min(other.high) }
    }

    fn or(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// Where clamping to this range takes a number of `other`.
    fn pull(self, other: Self) -> Self {
        Self { low: other.low.clamp(self.low, self.high), high: other.high.clamp(self.low, self.high) }
    }
}

/// A hit that the f32 formula may report.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Possible {
    /// Whether it must report it when nothing is in front.
    pub certain: bool,
    /// Where the ray parameter must lie.
    pub t: Interval,
    /// Where the second vertex's weight must lie.
    pub u: Interval,
    /// Where the third vertex's weight must lie.
    pub v: Interval,
}

/// Widens a position or direction.
pub fn wide(p: [f32; 3]) -> DVec3 {
    DVec3::new(f64::from(p[0]), f64::from(p[1]), f64::from(p[2]))
}

/// A ray whose direction is known up to an error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Aim {
    /// Start.
    pub origin: DVec3,
    /// Direction, any length but 0.
    pub direction: DVec3,
    /// Absolute error of each component of `direction`.
    pub error: f64,
    /// As [`Ray::t_min`].
    pub t_min: f64,
    /// As [`Ray::t_max`].
    pub t_max: f64,
}

impl From<&Ray> for Aim {
    fn from(ray: &Ray) -> Self {
        Self {
            origin: wide(ray.origin),
            direction: wide(ray.direction),
            error: 0.0,
            t_min: f64::from(ray.t_min),
            t_max: f64::from(ray.t_max),
        }
    }
}

/// What may be reported for a ray and three corners; `None` when nothing may.
pub fn possible_hit(ray: &Aim, corners: &[[f32; 3]; 3]) -> Option<Possible> {
    let direction = ray.direction;
    let relative = corners.map(|p| wide(p) - ray.origin);
    let exact = moller_trumbore(&relative, direction);
    // Share of the dominant component by which the direction may be off.
    let spread = ray.error / direction.abs().max_element();
    let errors = EdgeErrors::of(&relative, direction, spread);

    // [1] Edge functions: mixed signs beyond doubt miss, equal signs beyond doubt hit.
    let above = |i: usize| exact.edges[i] > errors.edges[i];
    let below = |i: usize| exact.edges[i] < -errors.edges[i];
    let any = |side: &dyn Fn(usize) -> bool| (0..3).any(side);
    if any(&above) && any(&below) {
        return None;
    }
    let determinant = exact.edges.iter().sum::<f64>().abs();
    let slack =
        errors.edges.iter().sum::<f64>() + 2.0 * ETA * exact.edges.iter().map(|e| e.abs()).sum::<f64>();
    let inside = ((0..3).all(above) || (0..3).all(below)) && determinant > slack;

    // [2] The box.
    let slab = slab(ray, corners);
    let meets = slab.meets?;

    // [3] The distance: a mean of the corners' depths with weights that are not negative, moved by the weights' errors.
    let depths = relative.map(|a| a[errors.axis] / direction[errors.axis]);
    let reach = depths.iter().fold(0.0_f64, |m, z| m.max(z.abs()));
    // sz·a: 1 + 2.5 + 1; times an edge function: 1; two additions: 2; division and its divisor's two additions: 4.5.
    let rounding = (12.0 * ETA + spread) * reach;
    let hull = Interval {
        low: depths.iter().fold(f64::INFINITY, |m, &z| m.min(z)) - rounding,
        high: depths.iter().fold(f64::NEG_INFINITY, |m, &z| m.max(z)) + rounding,
    };
    let mut t_edge = hull;
    let (mut u, mut v) = (weight_range(), weight_range());
    if determinant > slack {
        let divisor = determinant - slack;
        let moved: f64 = (0..3).map(|i| errors.edges[i] * (depths[i] - exact.t).abs()).sum::<f64>() / divisor;
        t_edge = t_edge.and(Interval::around(exact.t, moved + rounding));
        let weight = |i: usize| {
            let w = exact.edges[i].abs() / determinant;
            weight_range().and(Interval::around(w, (errors.edges[i] + w * slack) / divisor + 2.5 * ETA * w))
        };
        (u, v) = (weight(1), weight(2));
    }
    let plane = Plane::of(ray, &relative);
    if plane.left == Some(true) {
        return None;
    }
    let t = match plane.aside {
        Some(true) => hull.pull(plane.t),
        Some(false) => t_edge,
        None => hull.pull(plane.t).or(t_edge),
    };
    let (t_min, t_max) = (ray.t_min, ray.t_max);
    // t_i = max(t, near).
    let t_i = Interval { low: t.low.max(slab.near.low), high: t.high.max(slab.near.high) };
    if t.high <= t_min || t_i.low > t_max {
        return None;
    }
    let in_range = t.low > t_min && t_i.high <= t_max;
    let certain = inside && meets && in_range && plane.left == Some(false);
    Some(Possible { certain, t: t_i.and(Interval { low: t_min, high: t_max }), u, v })
}

/// A ray and a triangle's plane; `None` where rounding decides.
struct Plane {
    /// Whether the ray starts off the plane.
    aside: Option<bool>,
    /// Whether it does and goes away from it.
    left: Option<bool>,
    /// Where it meets the plane.
    t: Interval,
}

impl Plane {
    fn of(ray: &Aim, relative: &[DVec3; 3]) -> Self {
        let normal = (relative[1] - relative[0]).cross(relative[2] - relative[0]).normalize_or_zero();
        let reach = relative.iter().fold(0.0_f64, |m, a| m.max(a.abs().max_element()));
        let doubt = reach * f64::from(SIDE_ERROR);
        // One rounding of the difference, half of one of the normal (made on the host), one of the product, two of the sum.
        let error = |v: DVec3| 4.5 * ETA * normal.abs().dot(v.abs());
        let (height, slope) = (-normal.dot(relative[0]), normal.dot(ray.direction));
        // And of the doubt: one of the product, one of a distance.
        let height_error = error(relative[0]) + 2.0 * ETA * doubt;
        let slope_error = error(ray.direction) + normal.abs().element_sum() * ray.error;
        let surely = |holds: bool, fails: bool| if holds { Some(true) } else { fails.then_some(false) };
        let aside = surely(height.abs() > doubt + height_error, height.abs() <= doubt - height_error);
        // Off the plane the sign of the height is sure.
        let away = slope * height.signum();
        let goes = surely(away > slope_error, away < -slope_error);
        let left = match (aside, goes) {
            (Some(true), goes) => goes,
            (Some(false), _) | (None, Some(false)) => Some(false),
            (None, _) => None,
        };
        let t = -height / slope;
        let divisor = slope.abs() - slope_error;
        let moved = (height_error + t.abs() * slope_error) / divisor + 2.5 * ETA * t.abs();
        let t = if divisor > 0.0 { Interval::around(t, moved) } else { Interval::ANY };
        Self { aside, left, t }
    }
}

/// Weights of accepted hits: quotients of a part and a sum of three that are not negative, with four roundings.
fn weight_range() -> Interval {
    Interval { low: 0.0, high: 1.0 + 5.5 * ETA }
}

struct Exact {
    /// Edge functions of the three corners in the scale of the sheared plane, up to one common sign.
    edges: [f64; 3],
    t: f64,
}

/// Möller & Trumbore 1997, numerators kept so that triangles seen edge-on divide by nothing.
fn moller_trumbore(relative: &[DVec3; 3], direction: DVec3) -> Exact {
    let (e1, e2) = (relative[1] - relative[0], relative[2] - relative[0]);
    let s = -relative[0];
    let (p, q) = (direction.cross(e2), s.cross(e1));
    let (determinant, u, v) = (e1.dot(p), s.dot(p), direction.dot(q));
    // The shear scales areas by 1 over the dominant component.
    let scale = 1.0 / direction.abs().max_element();
    Exact { edges: [determinant - u - v, u, v].map(|e| e * scale), t: e2.dot(q) / determinant }
}

struct EdgeErrors {
    edges: [f64; 3],
    /// The dominant axis.
    axis: usize,
}

impl EdgeErrors {
    fn of(relative: &[DVec3; 3], direction: DVec3, spread: f64) -> Self {
        let axis = (0..3).fold(0, |k, i| if direction[i].abs() > direction[k].abs() { i } else { k });
        let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
        // (coordinate, error) in the sheared plane: a_k − s·a_z with one rounding of each difference to the origin,
        // 2.5 of the shear, one of the product, one of the subtraction; a direction that is off by `spread` in both its
        // components moves the shear by twice that.
        let sheared = |a: &DVec3, k: usize| {
            let product = direction[k] / direction[axis] * a[axis];
            let error = ETA * (2.0 * a[k].abs() + 5.5 * product.abs()) + 2.0 * spread * a[axis].abs();
            (a[k] - product, error)
        };
        let x = [0, 1, 2].map(|c| sheared(&relative[c], i));
        let y = [0, 1, 2].map(|c| sheared(&relative[c], j));
        // U = c_x·b_y − c_y·b_x and its likes: errors of the factors, of two products and of the subtraction.
        let product = |p: (f64, f64), q: (f64, f64)| {
            p.1 * q.0.abs() + q.1 * p.0.abs() + p.1 * q.1 + 2.0 * ETA * (p.0 * q.0).abs()
        };
        let edge = |b: usize, c: usize| product(x[c], y[b]) + product(y[c], x[b]);
        Self { edges: [edge(1, 2), edge(2, 0), edge(0, 1)], axis }
    }
}

struct Slab {
    /// `Some(true)` surely met, `Some(false)` perhaps, `None` surely not.
    meets: Option<bool>,
    near: Interval,
}

fn slab(ray: &Aim, corners: &[[f32; 3]; 3]) -> Slab {
    let points = corners.map(wide);
    let (min, max) = (points[0].min(points[1]).min(points[2]), points[0].max(points[1]).max(points[2]));
    let pad = (max - min).max_element() * f64::from(PAD_EXTENT)
        + min.abs().max(max.abs()).max_element() * f64::from(PAD_COORDINATE);
    let mut sides = [(Interval { low: 0.0, high: 0.0 }, Interval { low: 0.0, high: 0.0 }); 3];
    for (axis, side) in sides.iter_mut().enumerate() {
        let d = ray.direction[axis];
        let magnitude = d.abs().max(f64::from(MIN_DIRECTION));
        let inverse = 1.0 / magnitude * if d < 0.0 { -1.0 } else { 1.0 };
        let origin = ray.origin[axis];
        // A component that may as well be 0 or change its sign says nothing about this axis.
        let relative =
            if ray.error < magnitude { ray.error / (magnitude - ray.error) } else { f64::INFINITY };
        // One rounding of the padded bound (and three of the small pad), one of the difference, 2.5 of the
        // reciprocal, one of the product.
        let plane = |bound: f64| {
            let t = (bound - origin) * inverse;
            let rounding = ETA * ((bound.abs() + 3.0 * pad) * inverse.abs() + 4.5 * t.abs());
            if relative > 1.0 {
                Interval::ANY
            } else {
                Interval::around(t, rounding + 2.0 * relative * t.abs())
            }
        };
        let (a, b) = (plane(min[axis] - pad), plane(max[axis] + pad));
        *side = if inverse < 0.0 { (b, a) } else { (a, b) };
    }
    let out = |t: f64| if t < 0.0 { t } else { t * f64::from(SLAB_FAR_FACTOR) * (1.0 + ETA) };
    let near = Interval {
        low: sides.iter().fold(f64::NEG_INFINITY, |m, s| m.max(s.0.low)),
        // An axis about which the direction says nothing bounds nothing.
        high: sides.iter().map(|s| s.0.high).filter(|h| h.is_finite()).fold(f64::NEG_INFINITY, f64::max),
    };
    let far_high = sides.iter().fold(f64::INFINITY, |m, s| m.min(out(s.1.high)));
    if near.low.max(0.0) > far_high {
        return Slab { meets: None, near };
    }
    // Entry and exit of one axis share the reciprocal, so rounding can't swap them; only two axes can disagree.
    let apart = (0..3).all(|i| (0..3).all(|j| i == j || sides[i].0.high <= sides[j].1.low));
    let ahead = sides.iter().all(|s| s.1.low >= 0.0);

    Slab { meets: Some(apart && ahead), near }
}
