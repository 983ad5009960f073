//! What holds for all lists: the second packing changes nothing, layers are lists cut off, and order is kept.

use super::inputs::some_views;
use super::{AS_LISTS, SIDES, Views, both_ways, downloaded, near};
use crate::kernels::rasterize_lhb::inputs::{snapped, some_directions, views};
use crate::oracle::rasterize_lhb::Lists;
use crate::trial::{Check, Context, Listing, ensure, list_trials};
use twinlight_core::Backend;
use twinlight_core::kernels::pack_lhb::PackLhbParams;
use twinlight_core::kernels::rasterize_lhb::{LhbElement, RasterizeLhbParams};
use twinlight_fixtures::meshes;
use twinlight_fixtures::random::Random;

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "pack_lhb":
        packed_again, layers_are_lists_cut_off, r6_equal_bins_keep_their_order, drawn_lists,
    );
}

/// What was read back packs to the same words.
fn packed_again<B: Backend>(cx: &Context<'_, B>) -> Check {
    let views = some_views(&mut Random::new(cx.options.seed ^ 21), 14, 2, 9);
    for params in [AS_LISTS, near(3), near(9)] {
        let (words, lists) = views.agreed(cx, &params)?;
        let lists = Lists { left_out: words.left_out.clone(), ..lists };
        let (again, _) = Views { lists, ..views }.agreed(cx, &params)?;
        super::same_words(cx, &again, &words)?;
    }
    Ok(())
}

/// K layers, read back, are what a cap of K leaves of the lists, packed and read back.
fn layers_are_lists_cut_off<B: Backend>(cx: &Context<'_, B>) -> Check {
    let views = some_views(&mut Random::new(cx.options.seed ^ 22), 13, 2, 9);
    for layers in [1, 4, 12] {
        for cap_side in SIDES {
            let (_, of_layers) = views.agreed(cx, &PackLhbParams { layers, cap_side })?;
            let cap = RasterizeLhbParams { layer_cap: layers, cap_side, ..RasterizeLhbParams::new(13) };
            let cut = Views { lists: views.lists.capped(&cap), ..views };
            let (_, of_lists) = cut.agreed(cx, &AS_LISTS)?;
            super::same_lists(cx, 13, &of_layers, &of_lists)?;
        }
    }
    Ok(())
}

/// Elements of one bin stay as they were, by depth and not by number.
fn r6_equal_bins_keep_their_order<B: Backend>(cx: &Context<'_, B>) -> Check {
    let falling: Vec<LhbElement> =
        (0..50).map(|i| LhbElement { surface: 100 - 2 * i, depth: (9 << 19) + 10 * i }).collect();
    let views = Views::one_pixel(Lists::of([falling.as_slice()]));
    for params in [AS_LISTS, near(50), near(60)] {
        let (_, lists) = views.agreed(cx, &params)?;
        let same = lists.elements.iter().zip(&falling).all(|(got, want)| got.surface == want.surface);
        let level = lists.elements.iter().all(|e| e.depth == (9 << 19) + (1 << 18));
        ensure(same && level, || format!("{params:?}: {:?}", lists.elements))?;
    }
    Ok(())
}

/// Buffers as the device's rasterizer leaves them, with a cap and without.
fn drawn_lists<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mesh = snapped(&meshes::soup(120, 0.6, 23 ^ cx.options.seed));
    let views = views(&some_directions(3, 29), 40);
    let resident = cx.backend.upload_mesh(&mesh)?;
    for layer_cap in [0, 5] {
        let params = RasterizeLhbParams { layer_cap, ..RasterizeLhbParams::new(40) };
        let lhb = cx.backend.rasterize_lhb(&resident, &views, &params)?;
        let lists = downloaded(cx, &lhb)?;
        ensure(lists.elements.len() > 5_000, || format!("only {} elements", lists.elements.len()))?;
        for params in [AS_LISTS, near(4), PackLhbParams { layers: 4, cap_side: SIDES[1] }] {
            both_ways(cx, &lhb, &lists, &params)?;
        }
    }
    Ok(())
}
