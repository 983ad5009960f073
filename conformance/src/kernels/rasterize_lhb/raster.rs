//! Hard cases of rasterization that are settled by the oracle; `HARD-CASES.md` lists them.

use super::inputs::{
    Case, Corners, SIDE, case, front, lattice_directions, mixed_sizes, separate, some_directions, views,
};
use super::{agreed, agrees, agrees_on_every_path, drawn, same};
use crate::kernels::property::hold;
use crate::oracle::rasterize_lhb::on_screen;
use crate::trial::{Check, Context, Listing, ensure, list_trials};
use glam::DVec3;
use twinlight_core::kernels::rasterize_lhb::{
    PATH_BLOCKS, PATH_LINEAR, PATH_MICRO, PATH_SPANS, RasterizeLhbParams,
};
use twinlight_core::lattice::{LatticeMesh, REACH, View};
use twinlight_core::{Backend, Error};
use twinlight_fixtures::random::Random;

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "rasterize_lhb":
        r3_edges_on_block_borders, r4_edge_functions_at_their_limits, r5_edge_on_is_nothing, r9_every_size,
        r10_the_view_holds_the_lattice, r12_whole_blocks_like_pixels,
    );
}

/// Rectangles whose sides run along the borders of 4 × 4 blocks, a sub-pixel beside them, and through the centres next to
/// them.
fn r3_edges_on_block_borders<B: Backend>(cx: &Context<'_, B>) -> Check {
    let size = 32;
    // A pixel is 2048 steps, a block 8192, a sub-pixel 2.
    let mut corners: Vec<Corners> = Vec::new();
    for beside in [0_i16, 2, -2, 1_024, -1_024, 1_026] {
        let (left, top) = (-16_384 + beside, -8_192 - beside);
        let (right, bottom) = (8_192 + beside, 16_384 - beside);
        let [a, b, c, d] = [[left, top, 0], [right, top, 3], [right, bottom, 9], [left, bottom, 6]];
        corners.extend([[a, b, c], [d, a, c], [b, d, a], [c, d, b]]);
    }
    let mesh = separate(&corners);
    let mirrored = View { right: [-16_384, 0, 0, 0], forward: [0, 0, -16_384, 0], ..front() };
    agrees_on_every_path(cx, &mesh, &[front(), mirrored], size)
}

/// Points as far out as points can be.
fn extremes() -> Vec<[i16; 3]> {
    let reach = REACH as i16;
    let along = |d: &DVec3| {
        let steps = if d.length_squared() == 1.0 { reach } else { (f64::from(REACH) / d.length()) as i16 };
        d.to_array().map(|c| c as i16 * steps)
    };
    lattice_directions().iter().map(along).collect()
}

/// Triangles a sub-pixel wide along the diagonals, through the centres there: their planes rise by the whole depth within that
/// sub-pixel, so that gradients of rows and columns are beyond 32 bits and all but cancel.
fn diagonal_slivers() -> Vec<Corners> {
    let ends = |flip: i16| [[-16_000, -16_000 * flip, 23_000], [16_000, 16_000 * flip, -23_000]];
    let sliver = |flip: i16, side: i16| {
        let [p, q] = ends(flip);
        [p, q, [2 * side, -2 * side * flip, 32_000 * flip]]
    };
    vec![sliver(1, 1), sliver(1, -1), sliver(-1, 1), sliver(-1, -1)]
}

/// Triangles from end to end of the screen and of the depths, at every number of sub-pixels; slivers among them divide the
/// largest numerators by the least areas.
fn r4_edge_functions_at_their_limits<B: Backend>(cx: &Context<'_, B>) -> Check {
    let points = extremes();
    let mut random = Random::new(cx.options.seed ^ 29);
    let mut point = || points[random.index(points.len())];
    let mut corners: Vec<Corners> = (0..30).map(|_| std::array::from_fn(|_| point())).collect();
    for _ in 0..30 {
        // Two corners side by side, their depths far apart.
        let [a, b, c] = [point(), point(), point()];
        let a = a.map(|x| x / 2);
        corners.push([a, b, [a[0] + 2, a[1] + 4, c[2] / 2]]);
    }
    corners.extend(diagonal_slivers());
    let mesh = separate(&corners);
    let turned =
        [DVec3::X, DVec3::new(-1.0, 1.0, 0.0), DVec3::new(1.0, 1.0, 1.0), DVec3::new(0.2, 0.1, -0.9)];
    for size in [1, 2, 3, 4, 7, 8, 16, 33] {
        let mut views = views(&turned, size);
        if size.is_power_of_two() {
            views.push(front());
        }
        agrees_on_every_path(cx, &mesh, &views, size)?;
    }
    let slivers = separate(&diagonal_slivers());
    let lists = drawn(cx, &slivers, &[front()], &RasterizeLhbParams::new(64))?;
    ensure(lists.elements.len() > 60, || format!("only {} centres on slivers", lists.elements.len()))?;
    let few = [[points[0], points[8], points[17]], [points[25], points[1], points[14]]];
    for &size in if cx.full() { &[128, 1000, 1024][..] } else { &[128, 1024] } {
        agrees_on_every_path(cx, &separate(&few), &views(&turned[2..3], size), size)?;
        agrees_on_every_path(cx, &slivers, &views(&[DVec3::Z], size), size)?;
    }
    Ok(())
}

/// Seen edge-on a triangle is nothing, be its line through pixel centres or between them. Along the axis that it faces it is
/// there.
fn r5_edge_on_is_nothing<B: Backend>(cx: &Context<'_, B>) -> Check {
    let flat = |axis: usize, at: i16| -> Corners {
        [[-9_000, -9_000], [9_000, -7_000], [-3_000, 9_000]].map(|[u, v]| {
            let mut p = [at; 3];
            (p[(axis + 1) % 3], p[(axis + 2) % 3]) = (u, v);
            p
        })
    };
    let corners: Vec<Corners> =
        (0..3).flat_map(|axis| [-10_240, 0, 2_048].map(|at| flat(axis, at))).collect();
    let mesh = separate(&corners);
    let lists = agreed(cx, &mesh, &views(&[DVec3::X, DVec3::Y, DVec3::Z], 16), &RasterizeLhbParams::new(16))?;
    for axis in 0..3 {
        let of_view = lists.offsets[axis * 256] as usize..lists.offsets[(axis + 1) * 256] as usize;
        let shown: Vec<u32> = lists.elements[of_view].iter().map(|e| e.triangle()).collect();
        for triangle in 0..9 {
            let faces = triangle as usize / 3 == axis;
            let text = || format!("triangle {triangle} in the view along axis {axis}");
            ensure(shown.contains(&triangle) == faces, text)?;
        }
    }
    Ok(())
}

/// One pixel, primes, powers of two and their neighbours, up to the largest; larger ones are refused.
fn r9_every_size<B: Backend>(cx: &Context<'_, B>) -> Check {
    let whole = [[-20_000, -20_000, -8_000], [20_000, -18_000, 3_000], [-2_000, 24_000, 11_000]];
    let small = [[100, 50, -70], [900, -333, 12], [777, 1_234, 99]];
    let speck = [[-4_000, 3_000, 0], [-3_990, 3_001, 0], [-3_999, 3_011, 4]];
    let thin = [[-30_000, -5, 0], [30_000, 0, 500], [30_000, 60, -500]];
    let (mesh, few) = (separate(&[whole, small, speck, thin]), separate(&[small, speck, thin]));
    let sizes = [1, 2, 3, 4, 5, 6, 7, 8, 9, 15, 16, 17, 31, 32, 33, 61, 63, 64, 65, 97, 100, 127, 128, 129];
    for size in sizes {
        let views = views(&[DVec3::Z, DVec3::new(0.4, -0.3, 0.8)], size);
        agrees(cx, &LatticeMesh::default(), &views, &RasterizeLhbParams::new(size))?;
        agrees(cx, &separate(&[small]), &views, &RasterizeLhbParams::new(size))?;
        agrees(cx, &mesh, &views, &RasterizeLhbParams::new(size))?;
    }
    for size in [251, 257, 512, 513, 1000, 1021, 1023, 1024] {
        let views = views(&[DVec3::new(0.4, -0.3, 0.8)], size);
        let mesh = if cx.full() { &mesh } else { &few };
        agrees(cx, mesh, &views, &RasterizeLhbParams::new(size))?;
    }
    let resident = cx.backend.upload_mesh(&mesh)?;
    for size in [1025, 2048, 16_384] {
        let refused = cx.backend.rasterize_lhb(&resident, &[front()], &RasterizeLhbParams::new(size));
        let limit = matches!(refused, Err(Error::LimitExceeded { .. }));
        ensure(limit, || format!("size {size}: {refused:?}, want LimitExceeded"))?;
    }
    Ok(())
}

/// A view shows the whole lattice, so there is nothing to clip: what is as far out as it can be is in the image.
fn r10_the_view_holds_the_lattice<B: Backend>(cx: &Context<'_, B>) -> Check {
    let points = extremes();
    // A triangle of a few pixels at every extreme, towards the middle.
    let inwards = |p: [i16; 3], by: [i16; 3]| -> [i16; 3] {
        std::array::from_fn(|i| (i32::from(p[i]) * 3 / 4 + i32::from(by[i])) as i16)
    };
    let corner = |&p: &[i16; 3]| [p, inwards(p, [2_500, -900, 1_300]), inwards(p, [-1_700, 2_100, -800])];
    let mesh = separate(&points.iter().map(corner).collect::<Vec<_>>());
    for size in [5, 16, 100] {
        let mut directions = lattice_directions();
        directions.extend(some_directions(6, 47));
        let views = views(&directions, size);
        let edge = 2 * on_screen(&views[0], size, [0; 3])[0];
        let inside = |view: &View| {
            let inside = |&p: &[i16; 3]| on_screen(view, size, p)[..2].iter().all(|c| (0..=edge).contains(c));
            points.iter().all(inside)
        };
        ensure(views.iter().all(inside), || format!("a point outside the image at size {size}"))?;
        let lists = agreed(cx, &mesh, &views, &RasterizeLhbParams::new(size))?;
        let mut shown: Vec<u32> = lists.elements.iter().map(|e| e.triangle()).collect();
        shown.sort_unstable();
        shown.dedup();
        // At 100 pixels each covers centres in some view.
        let all = size < 100 || shown.len() == points.len();
        ensure(all, || format!("{} of {} shown", shown.len(), points.len()))?;
    }
    let side = 14_000;
    let beyond = separate(&[[[-SIDE, -SIDE, 0], [SIDE, -SIDE, side], [-SIDE, SIDE, -side]]]);
    agrees_on_every_path(cx, &beyond, &views(&lattice_directions(), 12), 12)
}

/// Blocks, runs and spans that are accepted or refused whole, against every pixel on its own.
fn r12_whole_blocks_like_pixels<B: Backend>(cx: &Context<'_, B>) -> Check {
    hold(cx, case(mixed_sizes()), |Case { mesh, views, params }| {
        let with = |path| RasterizeLhbParams { path, ..params };
        let want = agreed(cx, &mesh, &views, &with(PATH_MICRO))?;
        for path in [PATH_BLOCKS, PATH_LINEAR, PATH_SPANS] {
            let got = drawn(cx, &mesh, &views, &with(path))?;
            same(cx, params.size, &got, &want).map_err(|f| f.within(&format!("path {path}")))?;
        }
        Ok(())
    })
}
