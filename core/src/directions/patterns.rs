//! Directions from points of the square, uniform in (φ, cosθ).

use crate::circle::circle_point;
use glam::DVec3;

/// Height z, longitude `index`/`count` of a turn.
fn at(z: f64, index: u64, count: u64) -> DVec3 {
    let (x, y) = circle_point(index, count);
    let radius = ((1.0 - z) * (1.0 + z)).sqrt();
    DVec3::new(radius * x, radius * y, z).normalize()
}

/// The digits of `index` mirrored at the point, as an exact fraction.
fn radical_inverse(mut index: u32, base: u64) -> (u64, u64) {
    let (mut digits, mut scale) = (0, 1);
    while index > 0 {
        digits = digits * base + u64::from(index) % base;
        scale *= base;
        index /= base as u32;
    }
    (digits, scale)
}

/// Halton points of the upper hemisphere, each followed by its opposite.
pub(super) fn halton(count: u32) -> Vec<DVec3> {
    let point = |i: u32| {
        // Point 0 is the pole with any longitude.
        let (height, of) = radical_inverse(i / 2 + 1, 2);
        let (turn, turns) = radical_inverse(i / 2 + 1, 3);
        at((of - height) as f64 / of as f64, turn, turns)
    };
    (0..count).map(|i| if i % 2 == 0 { point(i) } else { -point(i) }).collect()
}

/// The first half of a grid's directions; the second half are the opposites of these. `columns` is even.
pub(super) fn uv_grid_half(rows: u32, columns: u32) -> Vec<DVec3> {
    let point = |i: u32| {
        let (row, column) = (i / columns, i % columns);
        let z = f64::from(rows - 2 * row - 1) / f64::from(rows);
        at(z, u64::from(2 * column + 1), u64::from(2 * columns))
    };
    (0..rows * columns / 2).map(point).collect()
}
