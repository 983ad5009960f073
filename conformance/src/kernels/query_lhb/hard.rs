//! Hard cases of scene intake as lookups see them, and lists that a cap has cut.

use super::inputs::{anywhere, from, some_queries};
use super::{Seen, both_ways};
use crate::kernels::rasterize_lhb::inputs::{
    front, lattice_directions, separate, snapped, some_directions, views,
};
use crate::oracle::query_lhb::NOTHING;
use crate::oracle::rasterize_lhb::{Lists, rasterize};
use crate::scenes::flat;
use crate::trial::{Check, Context, Listing, ensure, list_trials};
use twinlight_core::Backend;
use twinlight_core::kernels::query_lhb::LhbQuery;
use twinlight_core::kernels::rasterize_lhb::{CAP_FAR, CAP_NEAR, LhbElement, RasterizeLhbParams};
use twinlight_fixtures::meshes;
use twinlight_fixtures::random::Random;

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "query_lhb": g5_no_area_is_never_entered, g6_slivers, g10_flat_bounds, r7_capped_lists);
}

/// Rounding may give collinear corners an area on the screen, but their plane has no sides: within the window nobody is before it,
/// beyond it depth decides, as for any other.
fn g5_no_area_is_never_entered<B: Backend>(cx: &Context<'_, B>) -> Check {
    let (a, b, c) = ([400, -16_000, 72], [-8_000, 12_000, 30], [-3_800, -2_000, 51]);
    let wall = [[-9_000, -18_000, 9_000], [-9_000, 18_000, 9_000], [18_000, 0, 9_000]];
    let mesh = separate(&[[a, a, b], [a, c, b], [b, b, b], wall]);
    let at = |surface: u32, z: i32| LhbElement { surface, depth: ((1 << 29) + (z << 14)) as u32 };
    let list: Vec<LhbElement> =
        [-60, -10, 10, 60].iter().flat_map(|&z| (0..6).map(move |surface| at(surface, z))).collect();
    let list = [list, vec![at(7, 9_000)]].concat();
    let seen = Seen { mesh, views: vec![front()], size: 2, lists: Lists::of([&list[..]; 4]) };
    let all: Vec<LhbQuery> = (-70..=70)
        .flat_map(|z| [0, 1].map(|ray| (z, ray)))
        .flat_map(|(z, ray)| [0, 1, 2, 7, 9].map(|leaves| LhbQuery { leaves, ..from([0, 0, z], ray) }))
        .flat_map(|query| [0, 40 << 14, 100 << 14, 1 << 30].map(|window| LhbQuery { window, ..query }))
        .collect();
    for (query, hit) in all.iter().zip(seen.agreed(cx, &all)?) {
        let entered = query.window >= 200 << 14 && hit != NOTHING && hit.triangle() < 3;
        ensure(!entered, || format!("{query:?} enters {hit:?}"))?;
    }
    Ok(())
}

fn g6_slivers<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 79);
    let mut shapes: Vec<_> = [1e-2, 1e-3, 1e-6].map(|aspect| meshes::slivers(100, aspect, 79)).into();
    shapes.push(meshes::needles(150, 71));
    for mesh in shapes {
        let seen = Seen::new(snapped(&mesh), views(&some_directions(2, 83), 100), 100);
        seen.agrees(cx, &some_queries(&seen, &mut random, 1_500))?;
    }
    Ok(())
}

fn g10_flat_bounds<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 84);
    for axes in 1..=3 {
        let seen = Seen::new(snapped(&flat(axes)), views(&lattice_directions(), 16), 16);
        let mut queries = some_queries(&seen, &mut random, 1_500);
        queries.extend((0..52).map(|ray| from(anywhere(&mut random), ray)));
        let hits = seen.agreed(cx, &queries)?;
        let met = hits.iter().filter(|hit| **hit != NOTHING).count();
        ensure((met == 0) == (axes > 1), || format!("{axes} flat axes: {met} hits"))?;
    }
    Ok(())
}

/// A list that was cut is read as any other, whatever was left out of it.
fn r7_capped_lists<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 37);
    let whole = Seen::new(snapped(&meshes::soup(200, 0.5, 37)), views(&some_directions(2, 41), 16), 16);
    for layer_cap in [1, 3] {
        for cap_side in [CAP_NEAR, CAP_FAR] {
            let params = RasterizeLhbParams { layer_cap, cap_side, ..RasterizeLhbParams::new(16) };
            let seen = Seen { lists: rasterize(&whole.mesh, &whole.views, &params), ..whole.clone() };
            ensure(seen.lists.left_out.iter().any(|n| *n > 0), || "nothing was left out".into())?;
            both_ways(&seen.agreed(cx, &some_queries(&seen, &mut random, 1_000))?)?;
        }
    }
    Ok(())
}
