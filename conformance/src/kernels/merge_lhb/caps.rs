//! Caps from either side, and what they leave out.

use super::inputs::{Kind, elements, one_pixel, some_list, some_pair, with_nothing_left_out};
use super::{Pair, SIDES, all_from};
use crate::kernels::property::hold;
use crate::oracle::merge_lhb::merge;
use crate::oracle::rasterize_lhb::Lists;
use crate::trial::{Check, Context, Failure, Listing, ensure, list_trials};
use proptest::prelude::*;
use twinlight_core::Backend;
use twinlight_core::kernels::merge_lhb::MergeLhbParams;
use twinlight_core::kernels::rasterize_lhb::{CAP_FAR, CAP_NEAR, LhbElement, RasterizeLhbParams};
use twinlight_fixtures::random::Random;

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "merge_lhb":
        r7_caps_keep_the_right_end, caps_cut_through_ties, left_out_adds_up, caps_of_parts_are_caps_of_the_whole,
        caps_of_long_lists,
    );
}

/// Caps of one element, of one less than there are, of all and of more.
fn r7_caps_keep_the_right_end<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 11);
    let pair = some_pair(&mut random, 9, 3, Kind { longest: 9, depths: 12, capped: true });
    let lengths = pair.kept.each().zip(pair.added.each()).map(|(kept, added)| kept.len() + added.len());
    let deepest = lengths.max().unwrap_or(0) as u32;
    ensure(deepest > 9, || format!("only {deepest} layers"))?;
    for layer_cap in [1, 2, 5, deepest - 1, deepest, deepest + 1, u32::MAX] {
        for cap_side in SIDES {
            let lists = pair.agreed(cx, &MergeLhbParams { layer_cap, cap_side, ..all_from(1_000) })?;
            let longest = lists.each().map(<[LhbElement]>::len).max().unwrap_or(0) as u32;
            ensure(longest == deepest.min(layer_cap), || format!("{longest} elements within {layer_cap}"))?;
        }
    }
    Ok(())
}

/// Of equal depths the near cap keeps those of the kept, the far cap those of the added.
fn caps_cut_through_ties<B: Backend>(cx: &Context<'_, B>) -> Check {
    let level: Vec<(u32, u32)> = (0..20).map(|surface| (surface, 7)).collect();
    let mut pair = one_pixel(&elements(&level), &elements(&level));
    (pair.kept, pair.added) = (with_nothing_left_out(&pair.kept), with_nothing_left_out(&pair.added));
    for layer_cap in [1, 19, 20, 21, 39] {
        for (cap_side, end) in [(CAP_NEAR, 0), (CAP_FAR, 40 - layer_cap)] {
            let lists = pair.agreed(cx, &MergeLhbParams { layer_cap, cap_side, ..all_from(10) })?;
            let numbers: Vec<u32> = lists.elements.iter().map(|e| e.surface).collect();
            let want: Vec<u32> = (end..end + layer_cap).collect();
            ensure(numbers == want, || format!("side {cap_side}, cap {layer_cap}: {numbers:?}"))?;
        }
    }
    Ok(())
}

/// Elements that are there and those that were left out: as many after the merge as in both inputs, modulo 2³².
fn left_out_adds_up<B: Backend>(cx: &Context<'_, B>) -> Check {
    let shape = (any::<u64>(), 1..12_u32, 1..4_u32);
    hold(cx, (shape, 1..9_u32, 0..2_u32), |((seed, size, view_count), layer_cap, cap_side)| {
        let mut random = Random::new(seed);
        let mut pair = some_pair(&mut random, size, view_count, Kind { longest: 9, depths: 6, capped: true });
        for left_out in [&mut pair.kept.left_out, &mut pair.added.left_out] {
            // Small ones, ones whose sum wraps, and ones that wrap by what is cut off here.
            left_out.iter_mut().for_each(|n| {
                *n = [random.index(5) as u32, random.next_u32(), u32::MAX - random.index(3) as u32, 0]
                    [random.index(4)];
            });
        }
        let lists = pair.agreed(cx, &MergeLhbParams { layer_cap, cap_side, ..all_from(5) })?;
        let all = |lists: &Lists| -> Vec<u32> {
            let each = lists.each().zip(&lists.left_out);
            each.map(|(list, left_out)| left_out.wrapping_add(list.len() as u32)).collect()
        };
        let parts = all(&pair.kept).iter().zip(all(&pair.added)).map(|(a, b)| a.wrapping_add(b)).collect();
        let (got, want): (Vec<u32>, Vec<u32>) = (all(&lists), parts);
        ensure(got == want, || format!("{got:?} elements, kept and left out, of {want:?}"))
    })
}

/// The ends of merged ends are the ends of what is merged whole: what the parts' caps cut off is missed by nobody.
fn caps_of_parts_are_caps_of_the_whole<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 13);
    let whole = some_pair(&mut random, 10, 2, Kind { longest: 14, depths: 8, capped: false });
    for layer_cap in [1, 3, 8, 14, 20] {
        for cap_side in SIDES {
            let cap = RasterizeLhbParams { layer_cap, cap_side, ..RasterizeLhbParams::new(10) };
            let parts = Pair { kept: whole.kept.capped(&cap), added: whole.added.capped(&cap), ..whole };
            let got = parts.agreed(cx, &MergeLhbParams { layer_cap, cap_side, ..all_from(1_000) })?;
            let want = merge(&whole.kept, &whole.added, &all_from(1_000)).capped(&cap);
            let place = |f: Failure| f.within(&format!("cap {layer_cap}, side {cap_side}"));
            super::same(cx, 10, &got, &want).map_err(place)?;
        }
    }
    Ok(())
}

fn caps_of_long_lists<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 14);
    let [kept, added] = [70_000, 66_000].map(|count| some_list(&mut random, count, 300));
    let mut pair = one_pixel(&kept, &added);
    (pair.kept, pair.added) = (with_nothing_left_out(&pair.kept), with_nothing_left_out(&pair.added));
    for layer_cap in [1, 100, 65_536, 70_001, 135_999] {
        for cap_side in SIDES {
            pair.agrees(cx, &MergeLhbParams { layer_cap, cap_side, ..all_from(1_000) })?;
        }
    }
    Ok(())
}
