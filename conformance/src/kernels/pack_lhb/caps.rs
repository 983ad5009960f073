//! Layers that are too few, from either side, and what they have no room for.

use super::inputs::{capped, some_views};
use super::{Checked, SIDES, Views};
use crate::kernels::property::hold;
use crate::oracle::rasterize_lhb::Lists;
use crate::trial::{Check, Context, Listing, ensure, list_trials};
use proptest::prelude::*;
use twinlight_core::Backend;
use twinlight_core::kernels::pack_lhb::PackLhbParams;
use twinlight_core::kernels::rasterize_lhb::RasterizeLhbParams;
use twinlight_fixtures::random::Random;

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "pack_lhb":
        r7_layers_keep_the_right_end, left_out_adds_up, layers_of_caps_are_layers_of_all,
    );
}

/// One layer, one less than the deepest pixel has, as many, and more.
fn r7_layers_keep_the_right_end<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 11);
    let views = some_views(&mut random, 9, 3, 12);
    let deepest = views.lists.each().map(<[_]>::len).max().unwrap_or(0) as u32;
    ensure(deepest > 9, || format!("only {deepest} layers"))?;
    for layers in [1, 2, 5, deepest - 1, deepest, deepest + 1] {
        for cap_side in SIDES {
            let (packed, lists) = views.agreed(cx, &PackLhbParams { layers, cap_side })?;
            let longest = lists.each().map(<[_]>::len).max().unwrap_or(0) as u32;
            ensure(longest == deepest.min(layers), || format!("{longest} elements in {layers} layers"))?;
            let lost: u64 = packed.left_out.iter().map(|&n| u64::from(n)).sum();
            let whole = (lists.elements.len() as u64 + lost) == views.lists.elements.len() as u64;
            ensure(whole, || format!("{lost} lost in {layers} layers"))?;
        }
    }
    Ok(())
}

/// What a cap left out before and what layers have no room for, modulo 2³².
fn left_out_adds_up<B: Backend>(cx: &Context<'_, B>) -> Check {
    let shape = (any::<u64>(), 1..12_u32, 1..4_u32);
    hold(cx, (shape, 1..9_u32, 0..2_u32), |((seed, size, view_count), layers, cap_side)| {
        let mut random = Random::new(seed);
        let views = some_views(&mut random, size, view_count, 9);
        let views = capped(&mut random, views);
        let (_, lists) = views.agreed(cx, &PackLhbParams { layers, cap_side })?;
        let all = |lists: &Lists| -> Vec<u32> {
            let each = lists.each().zip(&lists.left_out);
            each.map(|(list, left_out)| left_out.wrapping_add(list.len() as u32)).collect()
        };
        let (got, want) = (all(&lists), all(&views.lists));
        ensure(got == want, || format!("{got:?} elements, there and left out, of {want:?}"))
    })
}

/// What a rasterizer's cap cut off before is missed by nobody, if it is on the same side and the layers are no more.
fn layers_of_caps_are_layers_of_all<B: Backend>(cx: &Context<'_, B>) -> Check {
    let whole = some_views(&mut Random::new(cx.options.seed ^ 13), 10, 2, 14);
    for (layer_cap, layers) in [(1, 1), (5, 2), (9, 9), (14, 3)] {
        for cap_side in SIDES {
            let cap = RasterizeLhbParams { layer_cap, cap_side, ..RasterizeLhbParams::new(10) };
            let cut = Views { lists: whole.lists.capped(&cap), ..whole };
            let packed = |views: &Views| -> Checked<_> {
                Ok(views.agreed(cx, &PackLhbParams { layers, cap_side })?.0)
            };
            super::same_words(cx, &packed(&cut)?, &packed(&whole)?)?;
        }
    }
    Ok(())
}
