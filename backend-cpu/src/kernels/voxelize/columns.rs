//! The voxels of one triangle, column after column of its bounds: what [`VoxelTriangle::column`] and [`VoxelTriangle::meets`] say, with
//! products taken once per triangle and sums per cell.

use super::marks::Marks;
use std::ops::Range;
use twinlight_core::lattice::{VoxelTriangle, others};

/// What a projection's three edges say at a cell: all are at least 0 inside.
#[derive(Clone, Copy)]
struct Edges {
    at: [i32; 3],
    /// From one cell to the next, along either axis of the projection. They wrap, as `at` may outside of the grid.
    steps: [[i32; 3]; 2],
}

impl Edges {
    /// Of the projection along `axis`, at the first cell of the bounds.
    #[inline(always)]
    fn of(triangle: &VoxelTriangle, axis: usize) -> Self {
        let (b, c) = others(axis);
        let (s, turn) = (triangle.subvoxel_bits, triangle.turns[axis]);
        let half = 1 << (s - 1);
        let (x, y) = ((triangle.low[b] << s) + half, (triangle.low[c] << s) + half);
        let mut edges = Self { at: [0; 3], steps: [[0; 3]; 2] };
        for e in 0..3 {
            let (from, to) = (triangle.corners[e], triangle.corners[(e + 1) % 3]);
            let (dx, dy) = ((to[b] - from[b]) * turn, (to[c] - from[c]) * turn);
            let value = dx.wrapping_mul(y - from[c]).wrapping_sub(dy.wrapping_mul(x - from[b]));
            edges.at[e] = value.wrapping_add(triangle.allowance([dx, dy]));
            edges.steps[0][e] = dy.wrapping_neg() << s;
            edges.steps[1][e] = dx << s;
        }
        edges
    }

    /// `count` cells further along an axis of the projection.
    #[inline(always)]
    fn moved(self, along: usize, count: i32) -> Self {
        let mut moved = self;
        for e in 0..3 {
            moved.at[e] = self.at[e].wrapping_add(self.steps[along][e].wrapping_mul(count));
        }
        moved
    }

    #[inline(always)]
    fn is_inside(&self) -> bool {
        (self.at[0] | self.at[1] | self.at[2]) >= 0
    }
}

/// Marks what `triangle` meets in some rows of its bounds in the dominant projection, counted from the first.
#[inline(always)]
pub(super) fn mark(triangle: &VoxelTriangle, rows: Range<i32>, marks: &Marks<'_>) {
    let axis = triangle.axis;
    let (b, c) = others(axis);
    let (first, second) = (Edges::of(triangle, b), Edges::of(triangle, c));
    let mut row = Edges::of(triangle, axis).moved(1, rows.start);
    let columns = triangle.high[b] - triangle.low[b];
    let mut heights = Heights::new(triangle);
    for j in rows {
        // b's projection has c and the dominant axis, c's the dominant axis and b.
        let first = first.moved(0, j);
        let mut cell = row;
        heights.start_row(j);
        for i in 0..=columns {
            if cell.is_inside() {
                let (low, high) = heights.range();
                for k in low..=high {
                    let up = k - triangle.low[axis];
                    if first.moved(1, up).is_inside() && second.moved(1, i).moved(0, up).is_inside() {
                        marks.set(triangle.voxel(triangle.low[b] + i, triangle.low[c] + j, k));
                    }
                }
            }
            cell = cell.moved(0, 1);
            heights.step();
        }
        row = row.moved(1, 1);
    }
}

/// Where the plane crosses the columns of a row.
///
/// ⌊q / n⌋ is taken in f64. q is an integer below 2⁵³, n one below 2³¹, their quotient at most 2¹⁹: rounded to f64 it moves by less than 2⁻³⁴,
/// and where n is no divisor of q the next integer is 1/n or more away. So rounding never reaches one.
struct Heights<'a> {
    triangle: &'a VoxelTriangle,
    /// n·(c − p₀) without its dominant term, at the row's first column, then where the row is.
    q: f64,
    along: f64,
    across: f64,
    start: f64,
    normal: f64,
    /// What conservative voxels allow for.
    reach: f64,
}

impl<'a> Heights<'a> {
    #[inline(always)]
    fn new(triangle: &'a VoxelTriangle) -> Self {
        let (b, c) = others(triangle.axis);
        let (s, normal) = (triangle.subvoxel_bits, triangle.normal.map(f64::from));
        let half = 1 << (s - 1);
        let p0 = triangle.corners[0];
        let first = |axis: usize| normal[axis] * f64::from((triangle.low[axis] << s) + half - p0[axis]);
        let width = f64::from(1 << s);
        let sum = normal[0].abs() + normal[1].abs() + normal[2].abs();
        Self {
            triangle,
            q: 0.0,
            along: normal[b] * width,
            across: normal[c] * width,
            start: first(b) + first(c),
            normal: normal[triangle.axis],
            reach: sum * f64::from(triangle.half_width()),
        }
    }

    #[inline(always)]
    fn start_row(&mut self, j: i32) {
        self.q = self.start + self.across * f64::from(j);
    }

    #[inline(always)]
    fn step(&mut self) {
        self.q += self.along;
    }

    /// First and last voxel of the column.
    #[inline(always)]
    fn range(&self) -> (i32, i32) {
        let triangle = self.triangle;
        let (axis, s) = (triangle.axis, triangle.subvoxel_bits);
        let (low, high) = (triangle.low[axis], triangle.high[axis]);
        if self.normal == 0.0 {
            return (low, high);
        }
        let p = triangle.corners[0][axis];
        if !triangle.conservative {
            let k = (p + floor(-self.q / self.normal)) >> s;
            return (k.max(low), if k < low { low - 1 } else { k.min(high) });
        }
        let half = 1 << (s - 1);
        let top = p + floor((self.reach - self.q) / self.normal);
        let bottom = p - floor((self.reach + self.q) / self.normal);
        (low.max((bottom + half - 1) >> s), high.min((top - half) >> s))
    }
}

/// ⌊x⌋ for |x| below 2³¹, without the function call that `f64::floor` is where there is no SSE4.1.
#[inline(always)]
fn floor(x: f64) -> i32 {
    let whole = x as i32;
    whole - i32::from(f64::from(whole) > x)
}
