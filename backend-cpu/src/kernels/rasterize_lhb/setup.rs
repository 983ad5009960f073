//! What is worked out once per triangle and view: edges and the plane of depth.

use crate::mesh::Run;
use twinlight_core::kernels::rasterize_lhb::LhbElement;
use twinlight_core::lattice::{DEPTH_ORIGIN, View};

/// A triangle on the screen, turned so that its area is positive.
#[derive(Debug, Clone, Copy)]
pub(super) struct Setup {
    /// Screen coordinates.
    corners: [[i32; 2]; 3],
    /// Twice the area.
    area: i32,
    /// Twice the triangle's number, and its facing.
    surface: u32,
    /// The first column and row whose centres are within the bounds.
    pub(super) first: [i32; 2],
    /// Columns and rows whose centres are.
    pub(super) extent: [i32; 2],
    /// Edge functions at the centre of the first pixel, less 1 for edges whose points are not inside.
    pub(super) edges: [i32; 3],
    /// What they grow by from column to column.
    pub(super) across: [i32; 3],
    /// From row to row.
    pub(super) along: [i32; 3],
}

/// The plane of depth over a triangle's pixels.
#[derive(Debug, Clone, Copy)]
pub(super) struct Plane {
    at_first: i32,
    pub(super) across: i32,
    along: i32,
    least: i32,
    greatest: i32,
    surface: u32,
}

/// The set-up of a triangle with these corners on the screen, or `None` when it is seen edge-on.
#[inline(always)]
pub(super) fn setup(mut corners: [[i32; 2]; 3], triangle: u32, bits: u32) -> Option<Setup> {
    let mut area = edge(corners[0], corners[1], corners[2]);
    if area == 0 {
        return None;
    }
    let front = area < 0;
    if front {
        corners.swap(1, 2);
        area = -area;
    }
    let half = 1_i32 << (bits - 1);
    let mut first = [0; 2];
    let mut extent = [0; 2];
    for axis in 0..2 {
        let [a, b, c] = [corners[0][axis], corners[1][axis], corners[2][axis]];
        first[axis] = (a.min(b).min(c) + half - 1) >> bits;
        extent[axis] = ((a.max(b).max(c) + half) >> bits) - first[axis];
    }
    let centre = [(first[0] << bits) + half, (first[1] << bits) + half];
    let mut edges = [0; 3];
    let mut across = [0; 3];
    let mut along = [0; 3];
    for i in 0..3 {
        let (from, to) = (corners[i], corners[(i + 1) % 3]);
        let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
        // Without branches: nobody can predict where an edge points.
        let owns = i32::from((dy < 0) | ((dy == 0) & (dx > 0)));
        edges[i] = edge(from, to, centre) - 1 + owns;
        across[i] = -(dy << bits);
        along[i] = dx << bits;
    }
    let surface = triangle << 1 | u32::from(front);
    Some(Setup { corners, area, surface, first, extent, edges, across, along })
}

/// Twice the area of the triangle from `a` to `b` to `p`, positive when they run clockwise as seen.
#[inline(always)]
fn edge(a: [i32; 2], b: [i32; 2], p: [i32; 2]) -> i32 {
    (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])
}

impl Setup {
    /// Edge functions at a pixel of the bounds, `column` and `row` counted from the first.
    #[inline(always)]
    pub(super) fn edges_at(&self, column: i32, row: i32) -> [i32; 3] {
        let mut edges = self.edges;
        for (edge, (across, along)) in edges.iter_mut().zip(self.across.iter().zip(&self.along)) {
            *edge = edge.wrapping_add(column.wrapping_mul(*across)).wrapping_add(row.wrapping_mul(*along));
        }
        edges
    }

    /// The plane of depth of the triangle, which is in a lane of a run.
    #[inline(always)]
    pub(super) fn plane(&self, run: &Run, lane: usize, view: &View, bits: u32) -> Plane {
        let [a, b, c] = run.corners(lane);
        let [z0, z1, z2] = [distance(view, a), distance(view, b), distance(view, c)];
        let [z1, z2] = if self.surface & 1 == 1 { [z2, z1] } else { [z1, z2] };
        let [p0, p1, p2] = self.corners;
        let (dz1, dz2) = (i64::from(z1 - z0), i64::from(z2 - z0));
        let nx = dz1 * i64::from(p2[1] - p0[1]) - dz2 * i64::from(p1[1] - p0[1]);
        let ny = dz2 * i64::from(p1[0] - p0[0]) - dz1 * i64::from(p2[0] - p0[0]);
        let half = 1 << (bits - 1);
        let to_x = i64::from((self.first[0] << bits) + half - p0[0]);
        let to_y = i64::from((self.first[1] << bits) + half - p0[1]);
        let inverse = 1.0 / f64::from(self.area);
        let single = self.extent[0] * self.extent[1] == 1;
        Plane {
            at_first: z0.wrapping_add(divided(nx * to_x + ny * to_y, self.area, inverse)),
            // Divisions are the dearest part of a small triangle.
            across: if single { 0 } else { divided(nx << bits, self.area, inverse) },
            along: if single { 0 } else { divided(ny << bits, self.area, inverse) },
            least: z0.min(z1).min(z2),
            greatest: z0.max(z1).max(z2),
            surface: self.surface,
        }
    }
}

/// Distance of a position from the plane through the lattice's centre, 2⁻¹⁴ steps.
#[inline(always)]
fn distance(view: &View, p: [i32; 3]) -> i32 {
    let f = view.forward;
    f[0] * p[0] + f[1] * p[1] + f[2] * p[2]
}

/// The nearest integer to n / area, halves up, modulo 2³².
///
/// Dividing 64-bit integers was a third of a build. The product with the inverse is within 2⁻⁵¹ of the quotient, so that a quotient
/// below 2⁴⁹ is off by one at most, which the remainder tells.
#[inline(always)]
fn divided(n: i64, area: i32, inverse: f64) -> i32 {
    let (n, area) = (n + i64::from(area >> 1), i64::from(area));
    let estimate = n as f64 * inverse;
    if estimate.abs() >= CERTAIN {
        return n.div_euclid(area) as i32;
    }
    let quotient = estimate as i64;
    let rest = n - quotient * area;
    (quotient - i64::from(rest < 0) + i64::from(rest >= area)) as i32
}

/// 2⁴⁸.
const CERTAIN: f64 = 281_474_976_710_656.0;

impl Plane {
    /// z before clamping, `column` and `row` counted from the first pixel.
    #[inline(always)]
    pub(super) fn at(&self, column: i32, row: i32) -> i32 {
        self.at_first
            .wrapping_add(column.wrapping_mul(self.across))
            .wrapping_add(row.wrapping_mul(self.along))
    }

    /// What the list of a pixel with that z is sorted by.
    #[inline(always)]
    pub(super) fn key(&self, z: i32) -> u64 {
        let depth = z.max(self.least).min(self.greatest) + DEPTH_ORIGIN;
        u64::from(depth as u32) << 32 | u64::from(self.surface)
    }
}

/// The element that a key stands for.
#[inline(always)]
pub(super) fn element(key: u64) -> LhbElement {
    LhbElement { surface: key as u32, depth: (key >> 32) as u32 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn quotients_are_those_of_integers(n in -(1_i64 << 62)..1 << 62, shift in 0..62_u32, area in 1..=1_i32 << 30) {
            for n in [n, n >> shift, (n >> shift) / i64::from(area) * i64::from(area) - i64::from(area / 2)] {
                let exact = (i128::from(n) + i128::from(area / 2)).div_euclid(area.into());
                prop_assert_eq!(divided(n, area, 1.0 / f64::from(area)), exact as i32);
            }
        }
    }
}
