//! More than two parts, and parts that move, come and go.

use super::inputs::{Kind, some_lists};
use super::laws::{drawn, merge_params};
use super::{Checked, SIDES, all_from, downloaded, merged, same, uploaded};
use crate::kernels::rasterize_lhb::inputs::{separate, snapped, some_directions, views};
use crate::oracle::rasterize_lhb::{Lists, rasterize};
use crate::trial::{Check, Context, Listing, ensure, list_trials};
use twinlight_core::Backend;
use twinlight_core::kernels::merge_lhb::MergeLhbParams;
use twinlight_core::kernels::rasterize_lhb::{Lhb, RasterizeLhbParams};
use twinlight_core::lattice::LatticeMesh;
use twinlight_fixtures::meshes;
use twinlight_fixtures::random::Random;

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "merge_lhb":
        a_moving_part, what_is_added_is_gone_again, three_parts_in_either_order, triangle_by_triangle,
    );
}

/// An icosahedron whose middle is at x, on the lattice of everything else.
fn at(x: i16) -> LatticeMesh {
    let small = snapped(&meshes::icosphere(1));
    let vertices = small.vertices().iter().map(|p| [p[0] / 5 + x, p[1] / 5 - 2_000, p[2] / 5]).collect();
    LatticeMesh::new(vertices, small.triangles().to_vec()).expect("an icosahedron within reach")
}

/// A body goes through a room: in every frame what is drawn anew is the room and the body where it is now, and in the last,
/// where it is as in the first, the bits of the first.
fn a_moving_part<B: Backend>(cx: &Context<'_, B>) -> Check {
    let room = snapped(&meshes::soup(80, 0.7, 51 ^ cx.options.seed));
    let size = 24;
    let views = views(&some_directions(3, 53), size);
    for (layer_cap, cap_side) in [(0, SIDES[0]), (3, SIDES[0]), (3, SIDES[1])] {
        let params = RasterizeLhbParams { layer_cap, cap_side, ..RasterizeLhbParams::new(size) };
        let kept = drawn(cx, &room, &views, &params)?;
        let mut frames: Vec<Lists> = Vec::new();
        for x in [-20_000, -8_000, 1_000, 1_001, 15_000, -20_000] {
            let added = drawn(cx, &at(x), &views, &params)?;
            let merged = merged(cx, &kept, &added, &merge_params(&params, 80))?;
            let frame = downloaded(cx, &merged)?;
            let want = rasterize(&room.followed_by(&at(x))?, &views, &params);
            same(cx, size, &frame, &want).map_err(|f| f.within(&format!("body at {x}, {params:?}")))?;
            frames.push(frame);
        }
        let moves = frames.windows(2).all(|pair| pair[0] != pair[1]);
        ensure(moves, || "two frames are alike: the case shows nothing".into())?;
        same(cx, size, &frames[5], &frames[0])?;
    }
    Ok(())
}

/// After any number of merges the kept buffers are those that were drawn, and merged with nothing they are a copy.
fn what_is_added_is_gone_again<B: Backend>(cx: &Context<'_, B>) -> Check {
    let room = snapped(&meshes::icosphere(4));
    let views = views(&some_directions(2, 57), 32);
    for layer_cap in [0, 1] {
        let params = RasterizeLhbParams { layer_cap, ..RasterizeLhbParams::new(32) };
        let count = room.triangles().len();
        let kept = drawn(cx, &room, &views, &params)?;
        let before = downloaded(cx, &kept)?;
        for x in [0, 4_000] {
            let added = drawn(cx, &at(x), &views, &params)?;
            let merge = merged(cx, &kept, &added, &merge_params(&params, count))?;
            let more = downloaded(cx, &merge)?;
            ensure(more != before, || format!("nothing was added at {x}"))?;
            same(cx, 32, &downloaded(cx, &kept)?, &before)?;
        }
        let nothing = drawn(cx, &LatticeMesh::default(), &views, &params)?;
        let copy = merged(cx, &kept, &nothing, &merge_params(&params, count))?;
        same(cx, 32, &downloaded(cx, &copy)?, &before)?;
    }
    Ok(())
}

/// (a + b) + c is a + (b + c), when each is numbered behind all before it.
fn three_parts_in_either_order<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 61);
    for layer_cap in [0, 1, 4, 30] {
        for cap_side in SIDES {
            let kind = Kind { longest: 9, depths: 4, capped: layer_cap > 0 };
            let size = 12;
            let numbered = |first| MergeLhbParams { layer_cap, cap_side, ..all_from(first) };
            let parts: Vec<Lhb<B>> = (0..3)
                .map(|_| uploaded(cx, size, 2, &within_cap(some_lists(&mut random, 288, kind), &numbered(0))))
                .collect::<Checked<_>>()?;
            let [a, b, c] = &parts[..] else { return ensure(false, || "not three parts".into()) };
            let left = merged(cx, &merged(cx, a, b, &numbered(1_000))?, c, &numbered(2_000))?;
            let right = merged(cx, a, &merged(cx, b, c, &numbered(1_000))?, &numbered(1_000))?;
            let check = same(cx, size, &downloaded(cx, &left)?, &downloaded(cx, &right)?);
            check.map_err(|f| f.within(&format!("cap {layer_cap}, side {cap_side}")))?;
        }
    }
    Ok(())
}

/// Lists as a rasterizer with that cap leaves them.
fn within_cap(lists: Lists, params: &MergeLhbParams) -> Lists {
    let MergeLhbParams { layer_cap, cap_side, .. } = *params;
    lists.capped(&RasterizeLhbParams { layer_cap, cap_side, ..RasterizeLhbParams::new(1) })
}

/// A mesh in as many parts as it has triangles, each added to those before.
fn triangle_by_triangle<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 67);
    let corner = |random: &mut Random| [(); 3].map(|()| 1_024 * (random.index(31) as i16 - 15));
    let corners: Vec<_> = (0..12).map(|_| [(); 3].map(|()| corner(&mut random))).collect();
    let views = views(&some_directions(2, 71), 16);
    for layer_cap in [0, 2] {
        let params = RasterizeLhbParams { layer_cap, ..RasterizeLhbParams::new(16) };
        let mut sum = drawn(cx, &LatticeMesh::default(), &views, &params)?;
        for (i, triangle) in corners.iter().enumerate() {
            let part = drawn(cx, &separate(&[*triangle]), &views, &params)?;
            sum = merged(cx, &sum, &part, &merge_params(&params, i))?;
        }
        same(cx, 16, &downloaded(cx, &sum)?, &rasterize(&separate(&corners), &views, &params))?;
    }
    Ok(())
}
