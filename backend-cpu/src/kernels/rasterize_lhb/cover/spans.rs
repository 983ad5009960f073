//! The edge table: where each row enters and leaves the triangle, by division.

use super::super::setup::Setup;
use super::{Sink, stepped};

#[inline(always)]
pub(super) fn spans(setup: &Setup, sink: &mut Sink<'_>) {
    let mut edges = setup.edges;
    for row in 0..setup.extent[1] {
        let (begin, end) = span(edges, setup.across, setup.extent[0]);
        sink.put_span(begin, end, row);
        edges = stepped(edges, setup.along);
    }
}

/// The columns of a row whose three edge functions are not negative, from the first to before the second. They are one
/// run, because a triangle is convex.
#[inline(always)]
fn span(edges: [i32; 3], across: [i32; 3], columns: i32) -> (i32, i32) {
    let (mut begin, mut end) = (0, columns);
    for i in 0..3 {
        let (e, step) = (edges[i], across[i]);
        if step > 0 {
            // The first column c with e + c·step ≥ 0.
            if e < 0 {
                begin = begin.max((-e as u32).div_ceil(step as u32) as i32);
            }
        } else if e < 0 {
            return (0, 0);
        } else if step < 0 {
            // The last one is ⌊e / −step⌋.
            end = end.min(e / -step + 1);
        }
    }
    (begin, end.max(begin))
}
