//! The pixels that a triangle covers, on whichever path.

use super::Fragment;
use super::setup::{Plane, Setup, setup};
use crate::mesh::Run;
use twinlight_core::kernels::rasterize_lhb::{
    PATH_AUTO, PATH_BLOCKS, PATH_LINEAR, PATH_MICRO, RasterizeLhbParams,
};
use twinlight_core::lattice::{View, subpixel_bits};

mod blocks;
mod linear;
mod micro;
mod spans;

/// Pixels in the bounds of the largest triangle that is tested pixel by pixel.
const MICRO_PIXELS: i32 = 32;

/// A triangle that may cover a pixel's centre.
pub(super) struct Candidate<'a> {
    /// Number in the mesh.
    pub(super) triangle: u32,
    /// Screen coordinates.
    pub(super) corners: [[i32; 2]; 3],
    /// Where its positions are.
    pub(super) run: &'a Run,
    pub(super) lane: usize,
}

/// Appends a triangle's fragments.
#[inline(always)]
pub(super) fn cover(
    candidate: &Candidate<'_>,
    view: &View,
    params: &RasterizeLhbParams,
    fragments: &mut Vec<Fragment>,
) {
    let bits = subpixel_bits(params.size);
    let Some(setup) = setup(candidate.corners, candidate.triangle, bits) else { return };
    let is_small = setup.extent[0] * setup.extent[1] <= MICRO_PIXELS;
    if params.path == PATH_AUTO && is_small || params.path == PATH_MICRO {
        if is_small {
            let covered = micro::coverage(&setup);
            if covered != 0 {
                let plane = setup.plane(candidate.run, candidate.lane, view, bits);
                micro::put(covered, &setup, &mut Sink::new(&setup, &plane, params, fragments));
            }
            return;
        }
        let plane = setup.plane(candidate.run, candidate.lane, view, bits);
        return micro::every_pixel(&setup, &mut Sink::new(&setup, &plane, params, fragments));
    }
    let plane = setup.plane(candidate.run, candidate.lane, view, bits);
    let mut sink = Sink::new(&setup, &plane, params, fragments);
    match params.path {
        PATH_BLOCKS => blocks::blocks(&setup, &mut sink),
        PATH_LINEAR => linear::linear(&setup, &mut sink),
        _ => spans::spans(&setup, &mut sink),
    }
}

/// Where a triangle's fragments go.
struct Sink<'a> {
    plane: &'a Plane,
    /// Pixel number of the first of the bounds.
    corner: u32,
    size: u32,
    fragments: &'a mut Vec<Fragment>,
}

impl<'a> Sink<'a> {
    #[inline(always)]
    fn new(
        setup: &Setup,
        plane: &'a Plane,
        params: &RasterizeLhbParams,
        fragments: &'a mut Vec<Fragment>,
    ) -> Self {
        let corner = setup.first[1] as u32 * params.size + setup.first[0] as u32;
        Self { plane, corner, size: params.size, fragments }
    }

    /// The pixel at a column and row, counted from the first of the bounds.
    #[inline(always)]
    fn put(&mut self, column: i32, row: i32) {
        let key = self.plane.key(self.plane.at(column, row));
        self.fragments.push(Fragment { key, pixel: self.corner + row as u32 * self.size + column as u32 });
    }

    /// The pixels of a row from `begin` to before `end`.
    #[inline(always)]
    fn put_span(&mut self, begin: i32, end: i32, row: i32) {
        let first = self.corner + row as u32 * self.size;
        let mut z = self.plane.at(begin, row);
        for column in begin..end {
            self.fragments.push(Fragment { key: self.plane.key(z), pixel: first + column as u32 });
            z = z.wrapping_add(self.plane.across);
        }
    }
}

/// 0 where a point is inside of all edges, else 1: all three signs at once.
#[inline(always)]
fn outside(edges: [i32; 3]) -> u32 {
    (edges[0] | edges[1] | edges[2]) as u32 >> 31
}

/// Edge functions a step further. They are taken modulo 2³²: the one after the last pixel may be off the image.
#[inline(always)]
fn stepped(edges: [i32; 3], step: [i32; 3]) -> [i32; 3] {
    [edges[0].wrapping_add(step[0]), edges[1].wrapping_add(step[1]), edges[2].wrapping_add(step[2])]
}
