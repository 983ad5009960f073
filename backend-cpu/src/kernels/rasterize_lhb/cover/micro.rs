//! Pixel by pixel.

use super::super::setup::Setup;
use super::{Sink, outside, stepped};

/// Which pixels of the bounds are covered, row after row from bit 0 on. At most 32 there are.
#[inline(always)]
pub(super) fn coverage(setup: &Setup) -> u32 {
    let [columns, rows] = setup.extent;
    let mut covered = 0_u32;
    let mut bit = 0;
    let mut row_edges = setup.edges;
    for _ in 0..rows {
        let mut edges = row_edges;
        for _ in 0..columns {
            covered |= (outside(edges) ^ 1) << bit;
            bit += 1;
            edges = stepped(edges, setup.across);
        }
        row_edges = stepped(row_edges, setup.along);
    }
    covered
}

/// The pixels of [`coverage`].
#[inline(always)]
pub(super) fn put(coverage: u32, setup: &Setup, sink: &mut Sink<'_>) {
    let columns = setup.extent[0] as u32;
    let mut left = coverage;
    while left != 0 {
        let bit = left.trailing_zeros();
        left &= left - 1;
        sink.put((bit % columns) as i32, (bit / columns) as i32);
    }
}

/// Bounds of any size.
#[inline(always)]
pub(super) fn every_pixel(setup: &Setup, sink: &mut Sink<'_>) {
    let mut row_edges = setup.edges;
    for row in 0..setup.extent[1] {
        let mut edges = row_edges;
        for column in 0..setup.extent[0] {
            if outside(edges) == 0 {
                sink.put(column, row);
            }
            edges = stepped(edges, setup.across);
        }
        row_edges = stepped(row_edges, setup.along);
    }
}
