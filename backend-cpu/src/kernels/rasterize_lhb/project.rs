//! Corners and boxes on the screen, eight at a time.

use crate::mesh::{Boxes, RUN, Run, halves};
use crate::simd::Words;
use twinlight_core::lattice::{View, subpixel_bits};

/// A view, in words for vectors.
///
/// A scaled coordinate is a row times a position: 2¹⁵ times the screen coordinate, before `middle` is added and it is rounded down.
/// *How 32 bits suffice.* Positions keep to the budget of the lattice. Corners of boxes may be √3 as far: their scaled coordinates are below
/// √3·2²⁹, and what is added to them is at most 2³⁰ + 2¹⁴, which is less than 2³¹ together.
pub(super) struct Projection<U> {
    axes: [Axis<U>; 2],
    /// What turns a scaled coordinate into one of the screen.
    middle: U,
    /// With half a pixel less one unit: shifted by `shift`, the first column or row whose centre is not before it.
    to_first: U,
    /// With half a pixel: the first whose centre is beyond it.
    to_end: U,
    shift: u32,
}

/// A row of the view's basis.
#[derive(Clone, Copy)]
struct Axis<U> {
    /// Of x and y.
    xy: U,
    /// Of z in the low half of a word, in the high one.
    z: [U; 2],
    /// What of x and y is positive, and what is negative: the former times the least corner of a box plus the latter times the greatest is
    /// the least product.
    parts: [U; 2],
    /// The same of z, whose least is in the low half; and for the greatest product.
    z_parts: [U; 2],
}

/// Scaled coordinates of three corners, along both axes.
type Corners<U> = [[U; 3]; 2];

impl<U: Words> Projection<U> {
    #[inline(always)]
    pub(super) fn new(token: U::Token, view: &View, size: u32) -> Self {
        let bits = subpixel_bits(size);
        let (middle, half) = ((size << (bits + 14)) + (1 << 14), 1_u32 << (bits - 1));
        Self {
            axes: [Axis::new(token, view.right), Axis::new(token, view.down)],
            middle: U::splat(token, middle),
            to_first: U::splat(token, middle + ((half - 1) << 15)),
            to_end: U::splat(token, middle + (half << 15)),
            shift: 15 + bits,
        }
    }

    /// Bit i says whether box i may hold a pixel's centre.
    #[inline(always)]
    pub(super) fn boxes_with_a_centre(&self, token: U::Token, boxes: &Boxes) -> u32 {
        let (least, greatest) = (U::load(token, &boxes.least), U::load(token, &boxes.greatest));
        let z = U::load(token, &boxes.z);
        let [x, y] = &self.axes;
        let across = x.bounds(least, greatest, z);
        let along = y.bounds(least, greatest, z);
        self.hold_a_centre(across) & self.hold_a_centre(along)
    }

    /// The corners of a run, scaled.
    #[inline(always)]
    pub(super) fn corners(&self, token: U::Token, run: &Run) -> Corners<U> {
        let [a, b, c] = [U::load(token, &run.xy[0]), U::load(token, &run.xy[1]), U::load(token, &run.xy[2])];
        let (ab, cz) = (U::load(token, &run.z01), U::load(token, &run.z2));
        let [x, y] = &self.axes;
        [
            [x.corner(a, ab, 0), x.corner(b, ab, 1), x.corner(c, cz, 0)],
            [y.corner(a, ab, 0), y.corner(b, ab, 1), y.corner(c, cz, 0)],
        ]
    }

    /// Bit i says whether the bounds of triangle i hold a centre.
    #[inline(always)]
    pub(super) fn triangles_with_a_centre(&self, [[xa, xb, xc], [ya, yb, yc]]: Corners<U>) -> u32 {
        let across = [xa.least_signed(xb).least_signed(xc), xa.greatest_signed(xb).greatest_signed(xc)];
        let along = [ya.least_signed(yb).least_signed(yc), ya.greatest_signed(yb).greatest_signed(yc)];
        self.hold_a_centre(across) & self.hold_a_centre(along)
    }

    #[inline(always)]
    fn hold_a_centre(&self, [least, greatest]: [U; 2]) -> u32 {
        let first = (least + self.to_first).shift_right_signed_by(self.shift);
        let end = (greatest + self.to_end).shift_right_signed_by(self.shift);
        end.greater_signed(first)
    }

    /// Screen coordinates.
    #[inline(always)]
    pub(super) fn on_screen(&self, [[xa, xb, xc], [ya, yb, yc]]: Corners<U>) -> [[[u32; RUN]; 3]; 2] {
        [
            [self.rounded(xa), self.rounded(xb), self.rounded(xc)],
            [self.rounded(ya), self.rounded(yb), self.rounded(yc)],
        ]
    }

    #[inline(always)]
    fn rounded(&self, scaled: U) -> [u32; RUN] {
        (scaled + self.middle).shift_right_signed::<15>().to_array()
    }
}

impl<U: Words> Axis<U> {
    #[inline(always)]
    fn new(token: U::Token, row: [i32; 4]) -> Self {
        // Components are at most 2¹⁴.
        let [x, y, z] = [row[0] as i16, row[1] as i16, row[2] as i16];
        let splat = |low, high| U::splat(token, halves(low, high));
        Self {
            xy: splat(x, y),
            z: [splat(z, 0), splat(0, z)],
            parts: [splat(x.max(0), y.max(0)), splat(x.min(0), y.min(0))],
            z_parts: [splat(z.max(0), z.min(0)), splat(z.min(0), z.max(0))],
        }
    }

    /// Of a corner whose z is in that half.
    #[inline(always)]
    fn corner(&self, xy: U, z: U, half: usize) -> U {
        self.xy.dot_halves(xy) + self.z[half].dot_halves(z)
    }

    /// Least and greatest over boxes.
    #[inline(always)]
    fn bounds(&self, least: U, greatest: U, z: U) -> [U; 2] {
        let ([up, down], [z_least, z_greatest]) = (self.parts, self.z_parts);
        [
            up.dot_halves(least) + down.dot_halves(greatest) + z_least.dot_halves(z),
            up.dot_halves(greatest) + down.dot_halves(least) + z_greatest.dot_halves(z),
        ]
    }
}
