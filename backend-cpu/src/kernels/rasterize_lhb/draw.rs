//! From triangles to fragments.
//!
//! Most triangles of a fine mesh have no pixel's centre within their bounds. Neighbours in a mesh are neighbours in space, so that the box
//! around a run of them tells it of all at once. Eight boxes take about 40 instructions, and so do eight triangles whose box does hold a
//! centre. Only those that do themselves are set up.

use super::Fragment;
use super::cover::{Candidate, cover};
use super::project::Projection;
use crate::mesh::{Boxes, CpuMesh, RUN, Run};
use crate::simd::Words;
use twinlight_core::kernels::rasterize_lhb::RasterizeLhbParams;
use twinlight_core::lattice::View;

/// Runs between the one that is drawn and the one that is fetched: a memory latency. Those between them are passed over, so that the
/// processor's own prefetching doesn't know what comes.
const AHEAD: usize = 8;

/// Appends the fragments of all triangles. `kept` is working memory.
#[inline(always)]
pub(super) fn draw<U: Words>(
    token: U::Token,
    mesh: &CpuMesh,
    view: &View,
    params: &RasterizeLhbParams,
    kept: &mut Vec<u32>,
    fragments: &mut Vec<Fragment>,
) {
    let projection = Projection::<U>::new(token, view, params.size);
    keep_runs(token, &projection, &mesh.boxes, kept);
    let runs = mesh.clusters.as_flattened();
    for (i, &number) in kept.iter().enumerate() {
        if let Some(&later) = kept.get(i + AHEAD) {
            runs[later as usize].prefetch();
        }
        let run = &runs[number as usize];
        draw_run(token, &projection, run, number * RUN as u32, view, params, fragments);
    }
}

/// Lists the runs whose boxes hold a centre, in order.
#[inline(always)]
fn keep_runs<U: Words>(token: U::Token, projection: &Projection<U>, boxes: &[Boxes], kept: &mut Vec<u32>) {
    kept.clear();
    for (i, boxes) in boxes.iter().enumerate() {
        let mut left = projection.boxes_with_a_centre(token, boxes);
        while left != 0 {
            kept.push((i * RUN) as u32 + left.trailing_zeros());
            left &= left - 1;
        }
    }
}

/// Appends the fragments of a run whose first triangle has that number.
#[inline(always)]
fn draw_run<U: Words>(
    token: U::Token,
    projection: &Projection<U>,
    run: &Run,
    first: u32,
    view: &View,
    params: &RasterizeLhbParams,
    fragments: &mut Vec<Fragment>,
) {
    let corners = projection.corners(token, run);
    let mut left = projection.triangles_with_a_centre(corners);
    if left == 0 {
        return;
    }
    let [x, y] = projection.on_screen(corners);
    while left != 0 {
        let lane = left.trailing_zeros() as usize;
        left &= left - 1;
        let corner = |i: usize| [x[i][lane] as i32, y[i][lane] as i32];
        let corners = [corner(0), corner(1), corner(2)];
        cover(&Candidate { triangle: first + lane as u32, corners, run, lane }, view, params, fragments);
    }
}
