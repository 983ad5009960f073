//! Runs of 32 pixels of the bounds, row after row: as a GPU deals them to its threads.

use super::super::setup::Setup;
use super::{Sink, outside};

const RUN: i32 = 32;

#[inline(always)]
pub(super) fn linear(setup: &Setup, sink: &mut Sink<'_>) {
    let columns = setup.extent[0];
    let pixels = columns * setup.extent[1];
    for begin in (0..pixels).step_by(RUN as usize) {
        let end = pixels.min(begin + RUN);
        let mut covered = 0_u32;
        for pixel in begin..end {
            let edges = setup.edges_at(pixel % columns, pixel / columns);
            covered |= (outside(edges) ^ 1) << (pixel - begin);
        }
        while covered != 0 {
            let pixel = begin + covered.trailing_zeros() as i32;
            covered &= covered - 1;
            sink.put(pixel % columns, pixel / columns);
        }
    }
}
