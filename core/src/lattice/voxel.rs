//! Which voxels a triangle meets. Twin: `backend-gpu/src/shared/voxel.wgsl`. Meaning: [`crate::kernels::voxelize`].

use super::VoxelGrid;
use crate::kernels::voxelize::{CONSERVATIVE, MARGIN};

/// Bits of fraction of [`VoxelTriangle::weights`].
pub const WEIGHT_BITS: u32 = 14;

/// A triangle in grid coordinates, set up for tests against voxels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct VoxelTriangle {
    /// Corners, grid coordinates.
    pub corners: [[i32; 3]; 3],
    /// (p₁−p₀) × (p₂−p₀), turned so that its dominant component is not negative.
    pub normal: [i32; 3],
    /// −1 where the projection along an axis runs clockwise, else 1.
    pub turns: [i32; 3],
    /// The dominant axis.
    pub axis: usize,
    /// First voxel of the bounds, per axis.
    pub low: [i32; 3],
    /// Last voxel of the bounds, per axis.
    pub high: [i32; 3],
    /// s of the grid.
    pub subvoxel_bits: u32,
    /// Whether it is [`CONSERVATIVE`].
    pub conservative: bool,
}

/// An edge in a projection: what is left of it is inside.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Edge {
    from: [i32; 2],
    step: [i32; 2],
}

impl VoxelTriangle {
    /// Sets up; `separation` is one of the constants of [`crate::kernels::voxelize`].
    #[inline(always)]
    pub fn new(grid: &VoxelGrid, corners: [[i32; 3]; 3], separation: u32) -> Self {
        let [p0, p1, p2] = corners;
        let a = [0, 1, 2].map(|i| p1[i] - p0[i]);
        let b = [0, 1, 2].map(|i| p2[i] - p0[i]);
        let cross = [0, 1, 2].map(|i| {
            let (j, k) = others(i);
            a[j] * b[k] - a[k] * b[j]
        });
        let mut axis = 0;
        for i in 1..3 {
            if cross[i].abs() > cross[axis].abs() {
                axis = i;
            }
        }
        let turns = cross.map(|c| if c < 0 { -1 } else { 1 });
        let normal = cross.map(|c| c * turns[axis]);
        let conservative = separation == CONSERVATIVE;
        let s = grid.subvoxel_bits;
        // A closed cube that ends where the margin begins is met.
        let (before, behind) = if conservative { (MARGIN + 1, MARGIN) } else { (0, 0) };
        let low = [0, 1, 2].map(|i| ((least(corners, i) - before) >> s).max(0));
        let high = [0, 1, 2].map(|i| ((greatest(corners, i) + behind) >> s).min(grid.dims[i] as i32 - 1));
        Self { corners, normal, turns, axis, low, high, subvoxel_bits: s, conservative }
    }

    /// Whether nothing is met whatever the voxel: a triangle without area that is to be thin.
    #[inline(always)]
    pub fn is_empty(&self) -> bool {
        !self.conservative && self.normal[self.axis] == 0
    }

    /// Cells of the bounds in the projection along the dominant axis: columns of voxels to look at.
    #[inline(always)]
    pub fn cells(&self) -> u32 {
        let (b, c) = others(self.axis);
        ((self.high[b] - self.low[b] + 1) * (self.high[c] - self.low[c] + 1)) as u32
    }

    /// The first and the last voxel of the column at (`x`, `y`) of the dominant projection that may be met, by the plane and by the edges of that
    /// projection; the first is beyond the last where there is none.
    #[inline(always)]
    pub fn column(&self, x: i32, y: i32) -> (i32, i32) {
        const NONE: (i32, i32) = (0, -1);
        let axis = self.axis;
        let point = [self.centre(x), self.centre(y)];
        if self.is_empty() || !self.is_inside(axis, point) {
            return NONE;
        }
        let (low, high) = (self.low[axis], self.high[axis]);
        let n = i64::from(self.normal[axis]);
        if n == 0 {
            return (low, high);
        }
        let (b, c) = others(axis);
        let p0 = self.corners[0];
        let q = i64::from(self.normal[b]) * i64::from(point[0] - p0[b])
            + i64::from(self.normal[c]) * i64::from(point[1] - p0[c]);
        let s = self.subvoxel_bits;
        if !self.conservative {
            let k = (p0[axis] + (-q).div_euclid(n) as i32) >> s;
            return if k < low || k > high { NONE } else { (k, k) };
        }
        let half = 1 << (s - 1);
        let sum: i64 = self.normal.iter().map(|c| i64::from(c.abs())).sum();
        let reach = i64::from(self.half_width()) * sum;
        // Heights of centres, rounded to the inside.
        let top = p0[axis] + (reach - q).div_euclid(n) as i32;
        let bottom = p0[axis] - (reach + q).div_euclid(n) as i32;
        (low.max((bottom + half - 1) >> s), high.min((top - half) >> s))
    }

    /// Whether a voxel that [`VoxelTriangle::column`] gives is met: the edges of the other two projections.
    #[inline(always)]
    pub fn meets(&self, voxel: [i32; 3]) -> bool {
        let (b, c) = others(self.axis);
        let centre = voxel.map(|i| self.centre(i));
        [b, c].into_iter().all(|axis| {
            let (i, j) = others(axis);
            self.is_inside(axis, [centre[i], centre[j]])
        })
    }

    /// The voxel of column (`x`, `y`) at height `k`.
    #[inline(always)]
    pub fn voxel(&self, x: i32, y: i32, k: i32) -> [i32; 3] {
        let (b, c) = others(self.axis);
        let mut voxel = [0; 3];
        voxel[self.axis] = k;
        voxel[b] = x;
        voxel[c] = y;
        voxel
    }

    /// Calls `visit` with every voxel that is met, once.
    #[inline(always)]
    pub fn for_each(&self, mut visit: impl FnMut([i32; 3])) {
        let (b, c) = others(self.axis);
        for y in self.low[c]..=self.high[c] {
            for x in self.low[b]..=self.high[b] {
                let (first, last) = self.column(x, y);
                for k in first..=last {
                    let voxel = self.voxel(x, y, k);
                    if self.meets(voxel) {
                        visit(voxel);
                    }
                }
            }
        }
    }

    /// How much each corner counts at a voxel's centre: 2⁻¹⁴ each, 2¹⁴ in all. See [`crate::kernels::sum_voxels`].
    #[inline(always)]
    pub fn weights(&self, voxel: [i32; 3]) -> [u32; 3] {
        let (b, c) = others(self.axis);
        let point = [self.centre(voxel[b]), self.centre(voxel[c])];
        // Edge 0 runs from corner 0 to 1: corner 2 is opposite to it.
        let areas = [1, 2, 0].map(|e| self.edge(self.axis, e).at(point) * self.turns[self.axis]);
        let areas = areas.map(|area| area.max(0) as u32);
        let total = areas[0] + areas[1] + areas[2];
        let shift = 15_u32.saturating_sub(total.leading_zeros());
        let areas = areas.map(|area| area >> shift);
        let total = (areas[0] + areas[1] + areas[2]).max(1);
        let [second, third] = [areas[1], areas[2]].map(|area| (area << WEIGHT_BITS) / total);
        [(1 << WEIGHT_BITS) - second - third, second, third]
    }

    /// Coordinate of a voxel's centre.
    #[inline(always)]
    fn centre(&self, i: i32) -> i32 {
        (i << self.subvoxel_bits) + (1 << (self.subvoxel_bits - 1))
    }

    #[inline(always)]
    fn edge(&self, axis: usize, e: usize) -> Edge {
        let (b, c) = others(axis);
        let (from, to) = (self.corners[e], self.corners[(e + 1) % 3]);
        Edge { from: [from[b], from[c]], step: [to[b] - from[b], to[c] - from[c]] }
    }

    /// Whether a voxel whose centre is `point` in the projection along `axis` is met by the triangle's projection, as far as its
    /// edges say.
    #[inline(always)]
    fn is_inside(&self, axis: usize, point: [i32; 2]) -> bool {
        (0..3).all(|e| {
            let edge = self.edge(axis, e);
            edge.at(point) * self.turns[axis] + self.allowance(edge.step) >= 0
        })
    }

    /// Half of what counts as a voxel's width.
    #[inline(always)]
    pub fn half_width(&self) -> i32 {
        (1 << (self.subvoxel_bits - 1)) + if self.conservative { MARGIN } else { 0 }
    }

    /// How far outside of an edge a centre may be, times the edge's step.
    #[inline(always)]
    pub fn allowance(&self, step: [i32; 2]) -> i32 {
        let [dx, dy] = step.map(i32::abs);
        self.half_width() * if self.conservative { dx + dy } else { dx.max(dy) }
    }
}

impl Edge {
    /// Twice the area of the triangle that a point makes with the edge. Within ±2³⁰ in the grid, as are its products.
    #[inline(always)]
    fn at(&self, [x, y]: [i32; 2]) -> i32 {
        let ahead = self.step[0].wrapping_mul(y - self.from[1]);
        ahead.wrapping_sub(self.step[1].wrapping_mul(x - self.from[0]))
    }
}

/// The two axes that follow `axis`, in cyclic order.
#[inline(always)]
pub fn others(axis: usize) -> (usize, usize) {
    ((axis + 1) % 3, (axis + 2) % 3)
}

#[inline(always)]
fn least(corners: [[i32; 3]; 3], axis: usize) -> i32 {
    corners[0][axis].min(corners[1][axis]).min(corners[2][axis])
}

#[inline(always)]
fn greatest(corners: [[i32; 3]; 3], axis: usize) -> i32 {
    corners[0][axis].max(corners[1][axis]).max(corners[2][axis])
}
