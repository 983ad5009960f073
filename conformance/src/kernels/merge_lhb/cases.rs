//! Edge ladders, random lists, ties, numbers, and lists that only one side has.

use super::inputs::{Kind, elements, one_pixel, some_list, some_pair};
use super::{Pair, SIDES, all_from};
use crate::kernels::property::hold;
use crate::oracle::rasterize_lhb::Lists;
use crate::trial::{Check, Context, Listing, ensure, list_trials};
use proptest::prelude::*;
use twinlight_core::Backend;
use twinlight_core::kernels::merge_lhb::MergeLhbParams;
use twinlight_core::kernels::rasterize_lhb::{LhbElement, MAX_TRIANGLES};
use twinlight_fixtures::random::Random;

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "merge_lhb":
        g9_nothing_to_merge, one_and_one, element_ladder, list_ladder, random_lists, r6_equal_depths_go_to_the_kept,
        lists_only_one_side_has, r8_long_lists, numbers_wrap,
    );
}

const FEW_DEPTHS: Kind = Kind { longest: 12, depths: 5, capped: false };

/// No views; nothing on either side, on the kept or on the added: no elements, the other, renumbered or not.
fn g9_nothing_to_merge<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 1);
    for (size, view_count) in [(1, 0), (1_024, 0), (1, 1), (7, 3)] {
        for capped in [false, true] {
            let some = some_pair(&mut random, size, view_count, Kind { capped, ..FEW_DEPTHS });
            let none = some_pair(&mut random, size, view_count, Kind { longest: 0, capped, ..FEW_DEPTHS });
            for (kept, added) in [(&none, &none), (&none, &some), (&some, &none)] {
                let pair = Pair { size, view_count, kept: kept.kept.clone(), added: added.added.clone() };
                for cap_side in SIDES {
                    let layer_cap = if capped { 4 } else { 0 };
                    pair.agrees(cx, &MergeLhbParams { layer_cap, cap_side, ..all_from(77) })?;
                }
            }
        }
    }
    Ok(())
}

/// The added one before the kept one, at it and behind it.
fn one_and_one<B: Backend>(cx: &Context<'_, B>) -> Check {
    for (depth, first) in [(1_u32, 21), (4, 21), (5, 6), (6, 6), (9, 6)] {
        let pair = one_pixel(&elements(&[(6, 5)]), &elements(&[(1, depth)]));
        let lists = pair.agreed(cx, &all_from(10))?;
        let surface = lists.elements[0].surface;
        ensure(surface == first, || format!("surface {surface} first of depths 5 and {depth}"))?;
    }
    Ok(())
}

/// Numbers of elements around every chunk or workgroup size a backend is likely to use, in one list: as many on either side, and
/// one against all the others.
fn element_ladder<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 2);
    for power in 0..=if cx.full() { 17 } else { 10 } {
        for count in [(1_usize << power) - 1, 1 << power, (1 << power) + 1] {
            for (kept, added) in [(count / 2, count - count / 2), (1, count), (count, 1)] {
                let [kept, added] = [kept, added].map(|n| some_list(&mut random, n, count / 2 + 1));
                one_pixel(&kept, &added).agrees(cx, &all_from(1_000))?;
            }
        }
    }
    Ok(())
}

/// Numbers of lists, as views of one pixel and as pixels of one view, and sizes that are no powers of two.
fn list_ladder<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 3);
    let mut shapes =
        vec![(2, 1), (3, 2), (5, 3), (16, 1), (17, 9), (31, 2), (33, 1), (61, 1), (64, 1), (100, 1)];
    for power in [5, 6, 7, 8, 9, 10, 16] {
        if power <= 8 || cx.full() {
            shapes.extend([(1, (1 << power) - 1), (1, 1 << power), (1, (1 << power) + 1)]);
        }
    }
    if cx.full() {
        shapes.extend([(257, 1), (1_023, 1), (1_024, 1)]);
    }
    for (size, view_count) in shapes {
        some_pair(&mut random, size, view_count, Kind { longest: 3, ..FEW_DEPTHS })
            .agrees(cx, &all_from(9))?;
    }
    Ok(())
}

fn random_lists<B: Backend>(cx: &Context<'_, B>) -> Check {
    let shape = (any::<u64>(), 1..24_u32, 1..4_u32, 0..30_usize);
    let params = (0..40_u32, 0..2_u32, 0..5_000_u32);
    hold(
        cx,
        (shape, params, 1..40_usize),
        |((seed, size, views, longest), (cap, cap_side, first), depths)| {
            // Half of them have no cap.
            let layer_cap = cap.saturating_sub(20);
            let kind = Kind { longest, depths, capped: layer_cap > 0 };
            let pair = some_pair(&mut Random::new(seed), size, views, kind);
            pair.agrees(cx, &MergeLhbParams { layer_cap, cap_side, ..all_from(first) })
        },
    )
}

/// Of equal depths the kept go first, all of them, each side in its own order, whatever the numbers.
fn r6_equal_depths_go_to_the_kept<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 4);
    for depths in [1, 2, 3] {
        let kind = Kind { longest: 40, depths, capped: false };
        let pair = some_pair(&mut random, 8, 2, kind);
        // Added triangles are numbered among the kept ones: their numbers decide nothing.
        for first in [0, 3, 1_000] {
            pair.agrees(cx, &all_from(first))?;
        }
        // The contract orders by depth alone: numbers that fall, as merges of renumbered parts may have, stay so.
        let falling = |lists: &Lists| {
            let mut lists = lists.clone();
            for i in 1..lists.offsets.len() {
                let list = &mut lists.elements[lists.offsets[i - 1] as usize..lists.offsets[i] as usize];
                list.sort_by_key(|e| (e.depth, !e.triangle()));
            }
            lists
        };
        let falling = Pair { kept: falling(&pair.kept), added: falling(&pair.added), ..pair };
        falling.agrees(cx, &all_from(2))?;
    }
    let [ones, others] =
        [(0..50), (50..90)].map(|s: std::ops::Range<u32>| s.map(|s| (s, 7)).collect::<Vec<_>>());
    let lists = one_pixel(&elements(&ones), &elements(&others)).agreed(cx, &all_from(0))?;
    let rises = lists.elements.windows(2).all(|w| w[0].surface < w[1].surface);
    ensure(rises, || format!("equal depths: {:?}", lists.elements))
}

/// Lists that only the kept have next to lists that only the added have, and next to none: borders between lists.
fn lists_only_one_side_has<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 5);
    for (size, every) in [(5, 2), (8, 3), (20, 2)] {
        let has = |lists: &Lists, residue: usize| {
            let none: &[LhbElement] = &[];
            let each = lists.each().enumerate();
            Lists::of(each.map(|(i, list)| if i % every == residue { list } else { none }))
        };
        let full = some_pair(&mut random, size, 2, FEW_DEPTHS);
        let pair = Pair { kept: has(&full.kept, 0), added: has(&full.added, 1), ..full };
        let lists = pair.agreed(cx, &all_from(1_000))?;
        let of_added = |i: usize| i % every == 1;
        let whole = lists
            .each()
            .enumerate()
            .all(|(i, list)| list.iter().all(|e| (e.triangle() >= 1_000) == of_added(i)));
        ensure(whole, || format!("an element in another list, size {size}"))?;
    }
    Ok(())
}

/// Lists longer than any chunk, and than the 65535 rounds after which loops end on some drivers: in turn, one behind the other, all at
/// one depth, one element against all, and beside short lists.
fn r8_long_lists<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 6);
    let ladder = |from: u32, step: u32| move |i: u32| LhbElement { surface: i, depth: from + step * i };
    for count in [1_000_u32, 70_000] {
        let of = |from, step| (0..count).map(ladder(from, step)).collect::<Vec<_>>();
        let (even, odd, level) = (of(0, 2), of(1, 2), of(5, 0));
        let one = [LhbElement { surface: 1, depth: count }];
        let behind = of(2 * count, 1);
        let pairs: [(&[_], &[_]); 7] = [
            (&even, &odd),
            (&odd, &even),
            (&even, &behind),
            (&behind, &even),
            (&level, &level),
            (&one, &even),
            (&even, &one),
        ];
        for (kept, added) in pairs {
            one_pixel(kept, added).agrees(cx, &all_from(count))?;
        }
    }
    let long = some_list(&mut random, 70_000, 500);
    let short = some_pair(&mut random, 4, 1, FEW_DEPTHS);
    let amid = |lists: &Lists| {
        let each = lists.each().enumerate();
        Lists::of(each.map(|(i, list)| if i == 6 { long.as_slice() } else { list }))
    };
    Pair { kept: amid(&short.kept), ..short.clone() }.agrees(cx, &all_from(1_000))?;
    Pair { kept: amid(&short.kept), added: amid(&short.added), ..short }.agrees(cx, &all_from(1_000))
}

/// Numbers are added modulo 2³², twice the first triangle's, and facing stays; those of the kept stay too. Depths of every size are
/// compared as they are.
fn numbers_wrap<B: Backend>(cx: &Context<'_, B>) -> Check {
    let most = MAX_TRIANGLES as u32;
    let surfaces = [0, 1, 2, 3, 1 << 31, (1 << 31) + 1, u32::MAX - 2, u32::MAX - 1, u32::MAX];
    let depths = [0, 1, (1 << 30) - 1, 1 << 30, i32::MAX as u32, 1 << 31, u32::MAX - 1, u32::MAX];
    let list: Vec<LhbElement> =
        depths.iter().flat_map(|&depth| surfaces.map(|surface| LhbElement { surface, depth })).collect();
    for first in [0, 1, 2, 12_345, 1 << 30, most - 1, most] {
        let lists = one_pixel(&list, &list).agreed(cx, &all_from(first))?;
        let fronts = lists.elements.iter().filter(|e| e.is_front()).count();
        ensure(fronts == 2 * 5 * depths.len(), || format!("{fronts} fronts, numbered from {first}"))?;
        one_pixel(&[], &list).agrees(cx, &all_from(first))?;
    }
    Ok(())
}
