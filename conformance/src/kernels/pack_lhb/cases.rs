//! Edge ladders, random lists, the ends of every bin, and lists that are longer than any chunk.

use super::inputs::{capped, pixel, some_list, some_views};
use super::{AS_LISTS, SIDES, Views, near};
use crate::kernels::property::hold;
use crate::oracle::rasterize_lhb::Lists;
use crate::trial::{Check, Context, Listing, ensure, list_trials};
use proptest::prelude::*;
use twinlight_core::Backend;
use twinlight_core::kernels::pack_lhb::{MAX_TRIANGLES, PackLhbParams};
use twinlight_core::kernels::rasterize_lhb::LhbElement;
use twinlight_fixtures::random::Random;

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "pack_lhb":
        g9_nothing_to_pack, one_element, ends_of_bins, element_ladder, list_ladder, random_lists, r8_long_lists, r9_every_size,
    );
}

/// No views, no elements, with numbers left out and without.
fn g9_nothing_to_pack<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 1);
    for (size, view_count) in [(1, 0), (1_024, 0), (1, 1), (7, 3)] {
        let none = some_views(&mut random, size, view_count, 0);
        for views in [capped(&mut random, none.clone()), none] {
            for params in [AS_LISTS, near(1), near(16)] {
                views.agrees(cx, &params)?;
            }
        }
    }
    Ok(())
}

/// Words whose bits are known, of the least and the greatest that they hold.
fn one_element<B: Backend>(cx: &Context<'_, B>) -> Check {
    let most = 2 * (MAX_TRIANGLES - 1);
    for ((surface, depth), word, back) in [
        ((0, 0), 0, 1 << 18),
        ((5, (3 << 19) + 77), 3 << 21 | 5, (3 << 19) + (1 << 18)),
        ((most, 1 << 29), 1024 << 21 | 0x1f_fffc, (1 << 29) + (1 << 18)),
        ((most + 1, (1 << 30) - 1), u32::MAX - 2, (1 << 30) - (1 << 18)),
        ((1, 1 << 30), 2047 << 21 | 1, (1 << 30) - (1 << 18)),
        ((1, u32::MAX), 2047 << 21 | 1, (1 << 30) - (1 << 18)),
    ] {
        for params in [AS_LISTS, near(1), near(3)] {
            let (packed, lists) = pixel(&[(surface, depth)]).agreed(cx, &params)?;
            let found = (packed.words[0], lists.elements.as_slice());
            ensure(found == (word, &[LhbElement { surface, depth: back }]), || {
                format!("{found:x?} of surface {surface}, depth {depth:x}; want {word:x}, {back:x}")
            })?;
        }
    }
    Ok(())
}

/// The first and the last depth of every bin come back within half a bin, in order.
fn ends_of_bins<B: Backend>(cx: &Context<'_, B>) -> Check {
    let depths: Vec<u32> = (0..2048_u32).flat_map(|bin| [bin << 19, (bin << 19) + (1 << 19) - 1]).collect();
    let elements: Vec<(u32, u32)> =
        depths.iter().zip(0..).map(|(&depth, surface)| (surface, depth)).collect();
    for params in [AS_LISTS, near(4_096)] {
        let (packed, lists) = pixel(&elements).agreed(cx, &params)?;
        ensure(packed.words.is_sorted(), || "words that fall".into())?;
        let far = lists.elements.iter().zip(&depths).find(|(e, depth)| e.depth.abs_diff(**depth) > 1 << 18);
        ensure(far.is_none(), || format!("{far:?} are farther apart than half a bin"))?;
    }
    Ok(())
}

/// Numbers of elements around every chunk or workgroup size a backend is likely to use, in one list.
fn element_ladder<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 2);
    for count in [2, 63, 64, 65, 255, 256, 257, 1_025, 16_383, 16_384, 16_385] {
        let list = some_list(&mut random, count);
        let views = Views::one_pixel(Lists::of([list.as_slice()]));
        views.agrees(cx, &AS_LISTS)?;
        views.agrees(cx, &near(count as u32 - 1))?;
    }
    Ok(())
}

/// Numbers of lists, as views of one pixel and as pixels of one view.
fn list_ladder<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 3);
    let powers = [256, 1_024].into_iter().flat_map(|n| [(1, n - 1), (1, n), (1, n + 1)]);
    for (size, view_count) in [(2, 1), (3, 2), (17, 9), (31, 2), (33, 1), (64, 1)].into_iter().chain(powers) {
        let views = some_views(&mut random, size, view_count, 4);
        views.agrees(cx, &AS_LISTS)?;
        views.agrees(cx, &near(3))?;
    }
    Ok(())
}

fn random_lists<B: Backend>(cx: &Context<'_, B>) -> Check {
    let shape = (any::<u64>(), 1..20_u32, 1..4_u32, 0..30_usize);
    hold(cx, (shape, 0..20_u32, 0..4_u32), |((seed, size, view_count, longest), layers, kind)| {
        let mut random = Random::new(seed);
        let views = some_views(&mut random, size, view_count, longest);
        let views = if kind & 2 == 0 { views } else { capped(&mut random, views) };
        views.agrees(cx, &PackLhbParams { layers, cap_side: SIDES[kind as usize & 1] })
    })
}

/// A million layers in one pixel, in as many, in sixteen, and in more.
fn r8_long_lists<B: Backend>(cx: &Context<'_, B>) -> Check {
    let element = |i: u32| LhbElement { surface: i, depth: 1_000 * i };
    let list: Vec<LhbElement> = (0..1_000_000).map(element).collect();
    let views = Views::one_pixel(Lists::of([list.as_slice()]));
    views.agrees(cx, &AS_LISTS)?;
    for (layers, cap_side, lost) in
        [(16, SIDES[0], 999_984), (16, SIDES[1], 999_984), (1_000_001, SIDES[1], 0)]
    {
        let (packed, _) = views.agreed(cx, &PackLhbParams { layers, cap_side })?;
        ensure(packed.left_out == [lost], || format!("{:?} lost of {lost}", packed.left_out))?;
    }
    Ok(())
}

/// One pixel, primes, powers of two and their neighbours, up to the largest.
fn r9_every_size<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 4);
    for size in [1, 2, 3, 13, 61, 127, 128, 129, 1_024] {
        let count = size * size;
        let mut lists = vec![&[] as &[LhbElement]; count as usize];
        let some: Vec<_> =
            (0..40).map(|i| (random.index(count as usize), some_list(&mut random, i / 8))).collect();
        for (pixel, list) in &some {
            lists[*pixel] = list;
        }
        let views = Views { size, view_count: 1, lists: Lists::of(lists) };
        views.agrees(cx, &near(2))?;
    }
    Ok(())
}
