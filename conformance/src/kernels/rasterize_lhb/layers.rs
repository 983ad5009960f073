//! Hard cases of long lists, of ties in them and of caps on them.

use super::inputs::{Corners, front, separate, snapped, some_directions, views};
use super::{PATHS, agreed, agrees, same};
use crate::trial::{Check, Context, Failure, Listing, ensure, list_trials};
use twinlight_core::kernels::rasterize_lhb::{
    CAP_FAR, CAP_NEAR, LhbElement, RasterizeLhbParams, check_elements,
};
use twinlight_core::lattice::LatticeMesh;
use twinlight_core::{Backend, Error};
use twinlight_fixtures::meshes;
use twinlight_fixtures::random::Random;

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "rasterize_lhb":
        r6_ties_go_by_number, r7_caps_keep_the_right_end, r8_many_layers_in_one_pixel,
    );
}

/// Equal depths: copies and coplanar triangles stand in the order of their numbers.
fn r6_ties_go_by_number<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 31);
    let large = [[-16_384, -16_384], [16_384, -12_288], [-8_192, 20_480]];
    let small = [[-12_288, -12_288], [4_096, 8_192], [-4_096, 12_288]];
    let corners: Vec<Corners> = (0..200)
        .map(|_| {
            let z = [-5, 0, 0, 7][random.index(4)];
            let mut corners = if random.index(2) == 0 { large } else { small };
            if random.index(2) == 0 {
                corners.swap(0, 1);
            }
            corners.map(|[x, y]| [x, y, z])
        })
        .collect();
    let lists = agreed(cx, &separate(&corners), &[front()], &RasterizeLhbParams::new(16))?;
    let rises = |w: &[LhbElement]| (w[0].depth, w[0].triangle()) < (w[1].depth, w[1].triangle());
    let ties = lists.each().flat_map(|l| l.windows(2)).filter(|w| w[0].depth == w[1].depth).count();
    ensure(ties > 1_000, || format!("only {ties} ties"))?;
    ensure(lists.each().all(|list| list.windows(2).all(rises)), || "a tie out of order".into())
}

/// Caps of nothing less than the first layer to more than there are, from either side: the ends of the whole lists.
fn r7_caps_keep_the_right_end<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mesh = snapped(&meshes::soup(300, 0.5, 37 ^ cx.options.seed));
    let size = 24;
    let views = views(&some_directions(2, 41), size);
    let whole = agreed(cx, &mesh, &views, &RasterizeLhbParams::new(size))?;
    let deepest = whole.each().map(<[LhbElement]>::len).max().unwrap_or(0) as u32;
    ensure(deepest > 8, || format!("only {deepest} layers"))?;
    for layer_cap in [1, 2, 5, deepest - 1, deepest, deepest + 1, u32::MAX] {
        for cap_side in [CAP_NEAR, CAP_FAR] {
            let params = RasterizeLhbParams { layer_cap, cap_side, ..RasterizeLhbParams::new(size) };
            let capped = agreed(cx, &mesh, &views, &params)?;
            let place = |f: Failure| f.within(&format!("{params:?} of whole lists"));
            same(cx, size, &capped, &whole.capped(&params)).map_err(place)?;
        }
    }
    for path in PATHS {
        let params =
            RasterizeLhbParams { path, layer_cap: 3, cap_side: CAP_FAR, ..RasterizeLhbParams::new(size) };
        agrees(cx, &mesh, &views, &params)?;
    }
    // No lists, and lists of nothing.
    let capped = RasterizeLhbParams { layer_cap: 1, ..RasterizeLhbParams::new(size) };
    agrees(cx, &mesh, &[], &capped)?;
    agrees(cx, &LatticeMesh::default(), &views, &capped)
}

/// A list as long as the mesh, with ties of every number in it: time square in its length would not end. What would wrap
/// is refused before.
fn r8_many_layers_in_one_pixel<B: Backend>(cx: &Context<'_, B>) -> Check {
    for layers in [1_000, if cx.full() { 1_000_000 } else { 10_000 }] {
        let mut random = Random::new(cx.options.seed ^ 43);
        let mut vertices = Vec::new();
        for z in -9_000..9_000 {
            vertices.extend([[-16_000, -16_000, z], [-16_000, 16_000, z], [20_000, 500, z]]);
        }
        let layer = |_| {
            let v = 3 * random.index(18_000) as u32;
            [v, v + 1, v + 2]
        };
        let mesh = LatticeMesh::new(vertices, (0..layers).map(layer).collect())?;
        let whole = RasterizeLhbParams::new(1);
        let lists = agreed(cx, &mesh, &[front()], &whole)?;
        ensure(lists.elements.len() == layers, || format!("{} of {layers} layers", lists.elements.len()))?;
        for cap_side in [CAP_NEAR, CAP_FAR] {
            agrees(cx, &mesh, &[front()], &RasterizeLhbParams { layer_cap: 100, cap_side, ..whole })?;
        }
    }
    let limit = u64::from(u32::MAX);
    let wraps = check_elements(limit + 1);
    ensure(check_elements(limit).is_ok_and(|n| n == u32::MAX), || "2^32 - 1 elements are refused".into())?;
    ensure(matches!(wraps, Err(Error::LimitExceeded { .. })), || format!("2^32 elements: {wraps:?}"))?;
    // One list less than the limit, and the limit.
    let views = vec![front(); 128];
    let lists = RasterizeLhbParams::new(1024).check(&views[..127]);
    ensure(lists.as_ref().is_ok_and(|&n| n == 127 << 20), || format!("127 views of 1024²: {lists:?}"))?;
    let wraps = RasterizeLhbParams::new(1024).check(&views);
    ensure(matches!(wraps, Err(Error::LimitExceeded { .. })), || format!("128 views of 1024²: {wraps:?}"))
}
