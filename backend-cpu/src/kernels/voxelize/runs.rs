//! Eight small triangles at once, thin.
//!
//! In a fine mesh most triangles are within two voxels along every axis: at most eight voxels are theirs, and most meet none of them. Whether a voxel is met is said
//! by nine edge functions and a plane; both are linear, so that what holds at the first voxel's centre holds at the others' after a sum.
//!
//! *How 32 bits suffice.* A triangle has extents below 2v: its edges' steps too, n is at most 8v², centres are within 2v of
//! its corners, and n·(c − p₀) is at most 48v³: below 2³¹ for v up to 2⁸. Wider voxels take the other road.

use super::marks::Marks;
use crate::mesh::{RUN, Run};
use crate::simd::Words;
use twinlight_core::lattice::{SCALE_BITS, VoxelGrid, others};

/// Most bits of a voxel's width.
pub(super) const MAX_SUBVOXEL_BITS: u32 = 8;
/// Most cells of a triangle that is marked here.
pub(super) const MAX_CELLS: u32 = 4;

/// What became of a run: bit i is lane i's.
pub(super) struct Done {
    /// Are beyond two voxels along some axis: nothing was done with them.
    pub(super) left: u32,
    /// Have no area.
    pub(super) empty: u32,
}

/// A grid, in words for vectors.
pub(super) struct Runs<'a, U> {
    marks: &'a Marks<'a>,
    scale: U,
    offset: [U; 3],
    /// The last coordinate.
    last: [U; 3],
    subvoxel_bits: u32,
    half: U,
    width: U,
    zero: U,
    one: U,
}

impl<'a, U: Words> Runs<'a, U> {
    #[inline(always)]
    pub(super) fn new(token: U::Token, grid: &VoxelGrid, marks: &'a Marks<'a>) -> Self {
        let s = grid.subvoxel_bits;
        let zero = U::splat(token, 0);
        let (mut offset, mut last) = ([zero; 3], [zero; 3]);
        for axis in 0..3 {
            offset[axis] = U::splat(token, grid.offset[axis] as u32);
            last[axis] = U::splat(token, (grid.dims[axis] << s) - 1);
        }
        Self {
            marks,
            scale: U::splat(token, grid.scale as u32),
            offset,
            last,
            subvoxel_bits: s,
            half: U::splat(token, 1 << (s - 1)),
            width: U::splat(token, 1 << s),
            zero,
            one: U::splat(token, 1),
        }
    }

    /// Marks what a run's triangles meet, of those whose bounds have at most two voxels along every axis.
    #[inline(always)]
    pub(super) fn mark(&self, token: U::Token, run: &Run) -> Done {
        let p = self.placed(token, run);
        let s = self.subvoxel_bits;
        let mut low = [self.zero; 3];
        let (mut left, mut both) = (0, [0; 3]);
        for axis in 0..3 {
            let least = p[0][axis].least_signed(p[1][axis]).least_signed(p[2][axis]);
            let greatest = p[0][axis].greatest_signed(p[1][axis]).greatest_signed(p[2][axis]);
            low[axis] = least.shift_right_by(s);
            let more = greatest.shift_right_by(s) - low[axis];
            left |= more.greater_signed(self.one);
            both[axis] = more.greater_signed(self.zero);
        }
        let mut centre = low;
        for c in &mut centre {
            *c = *c * self.width + self.half;
        }
        let normal = self.normal(&p);
        let plane = self.plane(&p[0], &centre, normal);
        let mut inside = [[0; 4]; 3];
        for (axis, inside) in inside.iter_mut().enumerate() {
            *inside = self.inside(axis, &p, &centre, normal[axis]);
        }
        let (mut met, mut any) = ([0_u32; 8], 0);
        for (o, met) in met.iter_mut().enumerate() {
            let [x, y, z] = [o & 1, o >> 1 & 1, o >> 2];
            let mut there = !left;
            for (axis, both) in both.into_iter().enumerate() {
                if o >> axis & 1 == 1 {
                    there &= both;
                }
            }
            *met = plane.met[o] & inside[0][y + 2 * z] & inside[1][z + 2 * x] & inside[2][x + 2 * y] & there;
            any |= *met;
        }
        if any != 0 {
            self.set(low, met, any);
        }
        Done { left, empty: plane.empty & !left }
    }

    /// Corners in grid coordinates.
    #[inline(always)]
    fn placed(&self, token: U::Token, run: &Run) -> [[U; 3]; 3] {
        let [a, b, c] = [U::load(token, &run.xy[0]), U::load(token, &run.xy[1]), U::load(token, &run.xy[2])];
        let (ab, cz) = (U::load(token, &run.z01), U::load(token, &run.z2));
        [
            [self.place(self.low_half(a), 0), self.place(high_half(a), 1), self.place(self.low_half(ab), 2)],
            [self.place(self.low_half(b), 0), self.place(high_half(b), 1), self.place(high_half(ab), 2)],
            [self.place(self.low_half(c), 0), self.place(high_half(c), 1), self.place(self.low_half(cz), 2)],
        ]
    }

    /// Low halves, with their signs.
    #[inline(always)]
    fn low_half(&self, words: U) -> U {
        words.dot_halves(self.one)
    }

    #[inline(always)]
    fn abs(&self, words: U) -> U {
        words.greatest_signed(self.zero - words)
    }

    #[inline(always)]
    fn place(&self, point: U, axis: usize) -> U {
        let sum = self.scale * point + self.offset[axis];
        sum.shift_right_signed::<{ SCALE_BITS as i32 }>().clamp_signed(self.last[axis])
    }

    /// (p₁−p₀) × (p₂−p₀).
    #[inline(always)]
    fn normal(&self, p: &[[U; 3]; 3]) -> [U; 3] {
        let (mut a, mut b) = ([self.zero; 3], [self.zero; 3]);
        for axis in 0..3 {
            a[axis] = p[1][axis] - p[0][axis];
            b[axis] = p[2][axis] - p[0][axis];
        }
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    }

    /// Which of the eight voxels hold the plane's crossing of their columns; bit i is lane i's.
    #[inline(always)]
    fn plane(&self, p0: &[U; 3], centre: &[U; 3], normal: [U; 3]) -> Plane {
        let [x, y, z] = [self.abs(normal[0]), self.abs(normal[1]), self.abs(normal[2])];
        let is_x = !y.greater_signed(x) & !z.greater_signed(x);
        let is_y = !is_x & !z.greater_signed(y);
        let mut falls = [0; 3];
        for (falls, n) in falls.iter_mut().zip(normal) {
            *falls = self.zero.greater_signed(n);
        }
        let turned = is_x & falls[0] | is_y & falls[1] | !(is_x | is_y) & falls[2];
        let greatest = x.greatest_signed(y).greatest_signed(z);
        let reach = greatest * self.half;
        let (most, least) = (reach, self.zero - reach);
        // −h < d ≤ h, or, where the normal is to be turned, −h ≤ d < h.
        let (below_least, below_most) = (least - self.one, most - self.one);
        let mut steps = normal;
        for step in &mut steps {
            *step = *step * self.width;
        }
        let first = normal[0] * (centre[0] - p0[0])
            + normal[1] * (centre[1] - p0[1])
            + normal[2] * (centre[2] - p0[2]);
        let empty = greatest.equal(self.zero);
        let mut met = [0; 8];
        for (o, met) in met.iter_mut().enumerate() {
            let mut d = first;
            for (axis, step) in steps.into_iter().enumerate() {
                if o >> axis & 1 == 1 {
                    d = d + step;
                }
            }
            let straight = d.greater_signed(least) & !d.greater_signed(most);
            let other = d.greater_signed(below_least) & !d.greater_signed(below_most);
            *met = (straight & !turned | other & turned) & !empty;
        }
        Plane { met, empty }
    }

    /// Which of four cells are inside the triangle's projection along an axis, first along its first axis; bit i is lane i's.
    #[inline(always)]
    fn inside(&self, axis: usize, p: &[[U; 3]; 3], centre: &[U; 3], normal: U) -> [u32; 4] {
        let (b, c) = others(axis);
        // All ones where the projection runs clockwise: x ^ t − t negates there.
        let turn = normal.shift_right_signed::<31>();
        let mut least = [self.zero; 4];
        for e in 0..3 {
            let (from, to) = (&p[e], &p[(e + 1) % 3]);
            let dx = ((to[b] - from[b]) ^ turn) - turn;
            let dy = ((to[c] - from[c]) ^ turn) - turn;
            let value = dx * (centre[c] - from[c]) - dy * (centre[b] - from[b]);
            let longer = self.abs(dx).greatest_signed(self.abs(dy));
            let at = value + longer * self.half;
            let (along, across) = (at - dy * self.width, dx * self.width);
            let cells = [at, along, at + across, along + across];
            for (least, cell) in least.iter_mut().zip(cells) {
                *least = if e == 0 { cell } else { least.least_signed(cell) };
            }
        }
        let minus_one = self.zero - self.one;
        let mut inside = [0; 4];
        for (inside, least) in inside.iter_mut().zip(least) {
            *inside = least.greater_signed(minus_one);
        }
        inside
    }

    /// Marks the voxels that `met` has; `any` is the lanes that meet some.
    #[inline(always)]
    fn set(&self, low: [U; 3], met: [u32; 8], any: u32) {
        let [x, y, z] = [low[0].to_array(), low[1].to_array(), low[2].to_array()];
        let mut left = any;
        while left != 0 {
            let lane = left.trailing_zeros() as usize % RUN;
            left &= left - 1;
            for (o, met) in met.iter().enumerate() {
                if met >> lane & 1 == 1 {
                    let [dx, dy, dz] = [o & 1, o >> 1 & 1, o >> 2].map(|o| o as i32);
                    self.marks.set([x[lane] as i32 + dx, y[lane] as i32 + dy, z[lane] as i32 + dz]);
                }
            }
        }
    }
}

struct Plane {
    met: [u32; 8],
    /// Lanes without area.
    empty: u32,
}

#[inline(always)]
fn high_half<U: Words>(words: U) -> U {
    words.shift_right_signed::<16>()
}
