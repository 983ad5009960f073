//! Triangles that follow each other, in words of two 16-bit halves: a vector of them meets a view's rows in one instruction.

use crate::simd::prefetch;
use bytemuck::{Pod, Zeroable};

/// Triangles of a run: the lanes of a vector.
pub(crate) const RUN: usize = 8;

/// The corners of as many triangles, one to a lane.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(crate) struct Run {
    /// x in the low half, y in the high one, of each corner.
    pub(crate) xy: [[u32; RUN]; 3],
    /// z of corner 0 in the low half, of corner 1 in the high one.
    pub(crate) z01: [u32; RUN],
    /// z of corner 2 in the low half.
    pub(crate) z2: [u32; RUN],
}

impl Run {
    /// Of up to [`RUN`] triangles; the others are points.
    pub(super) fn of(vertices: &[[i16; 3]], triangles: &[[u32; 3]]) -> Self {
        let mut run = Self::zeroed();
        for (lane, triangle) in triangles.iter().enumerate() {
            let corners = triangle.map(|v| vertices[v as usize]);
            for (xy, [x, y, _]) in run.xy.iter_mut().zip(corners) {
                xy[lane] = halves(x, y);
            }
            run.z01[lane] = halves(corners[0][2], corners[1][2]);
            run.z2[lane] = halves(corners[2][2], 0);
        }
        run
    }

    /// Asks for its cache lines.
    #[inline(always)]
    pub(crate) fn prefetch(&self) {
        prefetch(&self.xy[0]);
        prefetch(&self.xy[2]);
        prefetch(&self.z2[RUN - 1]);
    }

    /// The corners of the triangle in a lane.
    #[inline(always)]
    pub(crate) fn corners(&self, lane: usize) -> [[i32; 3]; 3] {
        let z = [low(self.z01[lane]), high(self.z01[lane]), low(self.z2[lane])];
        let [a, b, c] = [self.xy[0][lane], self.xy[1][lane], self.xy[2][lane]];
        [[low(a), high(a), z[0]], [low(b), high(b), z[1]], [low(c), high(c), z[2]]]
    }
}

/// Boxes around as many runs, one to a lane.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(crate) struct Boxes {
    /// Least x in the low half, least y in the high one.
    pub(crate) least: [u32; RUN],
    /// Greatest x in the low half, greatest y in the high one.
    pub(crate) greatest: [u32; RUN],
    /// Least z in the low half, greatest in the high one.
    pub(crate) z: [u32; RUN],
}

impl Boxes {
    /// The box of lane `i` becomes that around `triangles`.
    pub(super) fn set(&mut self, i: usize, vertices: &[[i16; 3]], triangles: &[[u32; 3]]) {
        let (mut least, mut greatest) = ([i16::MAX; 3], [i16::MIN; 3]);
        for &v in triangles.as_flattened() {
            for (axis, &c) in vertices[v as usize].iter().enumerate() {
                least[axis] = least[axis].min(c);
                greatest[axis] = greatest[axis].max(c);
            }
        }
        self.least[i] = halves(least[0], least[1]);
        self.greatest[i] = halves(greatest[0], greatest[1]);
        self.z[i] = halves(least[2], greatest[2]);
    }
}

/// A word of two halves.
pub(crate) fn halves(low: i16, high: i16) -> u32 {
    u32::from(low as u16) | u32::from(high as u16) << 16
}

#[inline(always)]
fn low(word: u32) -> i32 {
    i32::from(word as i16)
}

#[inline(always)]
fn high(word: u32) -> i32 {
    word as i32 >> 16
}
