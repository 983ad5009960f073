//! Blocks of 4 × 4 pixels, which are outside, inside or on an edge.
//!
//! Yu tests a block's corners for being in the triangle, and loses a triangle that lies within a block. Here a block is
//! outside when all of its corners are behind one edge: nothing is lost, and what is kept for nothing is tested.

use super::super::setup::Setup;
use super::{Sink, outside, stepped};

const SIDE: i32 = 4;

#[inline(always)]
pub(super) fn blocks(setup: &Setup, sink: &mut Sink<'_>) {
    let [columns, rows] = setup.extent;
    for row in (0..rows).step_by(SIDE as usize) {
        for column in (0..columns).step_by(SIDE as usize) {
            // Cut at the bounds: beyond them edge functions could leave 32 bits.
            let end = [columns.min(column + SIDE), rows.min(row + SIDE)];
            block(setup, sink, [column, row], end);
        }
    }
}

#[inline(always)]
fn block(setup: &Setup, sink: &mut Sink<'_>, begin: [i32; 2], end: [i32; 2]) {
    let (width, height) = (end[0] - begin[0] - 1, end[1] - begin[1] - 1);
    let mut corner = setup.edges_at(begin[0], begin[1]);
    let (mut least, mut greatest) = (corner, corner);
    for i in 0..3 {
        let (across, along) = (width * setup.across[i], height * setup.along[i]);
        least[i] += across.min(0) + along.min(0);
        greatest[i] += across.max(0) + along.max(0);
    }
    if outside(greatest) != 0 {
        return;
    }
    if outside(least) == 0 {
        for row in begin[1]..end[1] {
            sink.put_span(begin[0], end[0], row);
        }
        return;
    }
    for row in begin[1]..end[1] {
        let mut edges = corner;
        for column in begin[0]..end[0] {
            if outside(edges) == 0 {
                sink.put(column, row);
            }
            edges = stepped(edges, setup.across);
        }
        corner = stepped(corner, setup.along);
    }
}
