//! What is refused, and buffers that no rasterizer made.

use super::inputs::{Kind, elements, one_pixel, some_pair};
use super::{SIDES, all_from, downloaded, same, uploaded};
use crate::oracle::rasterize_lhb::Lists;
use crate::trial::{Check, Context, Failure, Listing, ensure, list_trials};
use twinlight_core::kernels::merge_lhb::MergeLhbParams;
use twinlight_core::kernels::rasterize_lhb::{Lhb, LhbElement, MAX_TRIANGLES};
use twinlight_core::{Backend, Error};
use twinlight_fixtures::random::Random;

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "merge_lhb":
        bad_parameters_are_refused, unlike_shapes_are_refused, impossible_shapes_are_refused,
        offsets_of_other_origin_stay_within_buffers,
    );
}

/// The kind of an error.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Refusal {
    Invalid,
    Limit,
}

fn refusal<B: Backend>(
    cx: &Context<'_, B>,
    kept: &Lhb<B>,
    added: &Lhb<B>,
    params: &MergeLhbParams,
) -> Result<Refusal, Failure> {
    match cx.backend.merge_lhb(kept, added, params) {
        Err(Error::InvalidInput { .. }) => Ok(Refusal::Invalid),
        Err(Error::LimitExceeded { .. }) => Ok(Refusal::Limit),
        Err(other) => Err(other.into()),
        Ok(lhb) => Err(Failure::Mismatch(format!("not refused: {lhb:?}"))),
    }
}

fn bad_parameters_are_refused<B: Backend>(cx: &Context<'_, B>) -> Check {
    let pair = some_pair(&mut Random::new(21), 4, 2, Kind { longest: 3, depths: 4, capped: false });
    let [kept, added] = [&pair.kept, &pair.added].map(|lists| uploaded(cx, 4, 2, lists));
    let (kept, added) = (kept?, added?);
    let beyond = MAX_TRIANGLES as u32 + 1;
    for (params, want) in [
        (MergeLhbParams { cap_side: 2, ..all_from(0) }, Refusal::Invalid),
        (MergeLhbParams { cap_side: u32::MAX, ..all_from(0) }, Refusal::Invalid),
        (all_from(beyond), Refusal::Limit),
        (all_from(u32::MAX), Refusal::Limit),
    ] {
        let got = refusal(cx, &kept, &added, &params).map_err(|f| f.within(&format!("{params:?}")))?;
        ensure(got == want, || format!("{params:?}: {got:?}, want {want:?}"))?;
    }
    // A refused call leaves its inputs and the backend as they were.
    same(cx, 4, &downloaded(cx, &kept)?, &pair.kept)?;
    pair.agrees(cx, &all_from(1))
}

/// Sizes, views and lengths that differ, with as many lists or others; numbers left out that are there without a cap, or not
/// there with one, on either side.
fn unlike_shapes_are_refused<B: Backend>(cx: &Context<'_, B>) -> Check {
    let lists = |size: u32, views: u32, offsets: usize, left_out: usize| {
        let lists = Lists { offsets: vec![0; offsets], elements: Vec::new(), left_out: vec![0; left_out] };
        uploaded(cx, size, views, &lists)
    };
    let (sound, capped) = (lists(4, 2, 33, 0)?, lists(4, 2, 33, 32)?);
    let all = all_from(3);
    let cap = MergeLhbParams { layer_cap: 2, ..all };
    for (what, params, sound, other) in [
        ("another size", all, &sound, lists(5, 2, 51, 0)?),
        ("another number of views", all, &sound, lists(4, 3, 49, 0)?),
        ("as many lists of another size", all, &sound, lists(2, 8, 33, 0)?),
        ("no views", all, &sound, lists(4, 0, 1, 0)?),
        ("an offset too few", all, &sound, lists(4, 2, 32, 0)?),
        ("an offset too many", all, &sound, lists(4, 2, 34, 0)?),
        ("no offsets", all, &sound, lists(4, 2, 0, 0)?),
        ("numbers left out of no cap", all, &sound, lists(4, 2, 33, 32)?),
        ("no numbers left out", cap, &capped, lists(4, 2, 33, 0)?),
        ("a number left out too few", cap, &capped, lists(4, 2, 33, 31)?),
        ("a number left out too many", cap, &capped, lists(4, 2, 33, 33)?),
    ] {
        for (kept, added, side) in [(sound, &other, "added"), (&other, sound, "kept")] {
            let got = refusal(cx, kept, added, &params).map_err(|f| f.within(&format!("{what}, {side}")))?;
            ensure(got == Refusal::Invalid, || format!("{what}, {side}: {got:?}"))?;
        }
    }
    let got = refusal(cx, &sound, &sound, &cap)?;
    ensure(got == Refusal::Invalid, || format!("a cap of buffers without: {got:?}"))
}

/// No pixels, and sizes and views whose number of lists is beyond 64 bits, or falls on a small one modulo 2⁶⁴.
fn impossible_shapes_are_refused<B: Backend>(cx: &Context<'_, B>) -> Check {
    let none = Lists { offsets: vec![0], ..Lists::default() };
    for (size, view_count) in
        [(0, 3), (u32::MAX, u32::MAX), (1 << 31, 4), (1 << 20, 1 << 24), (u32::MAX, 1), (1, u32::MAX)]
    {
        let lhb = uploaded(cx, size, view_count, &none)?;
        let place = format!("{view_count} views of {size}²");
        refusal(cx, &lhb, &lhb, &all_from(0)).map_err(|f| f.within(&place))?;
    }
    Ok(())
}

/// Pixels per row and column, and views, of foreign buffers.
const FOREIGN: (u32, u32) = (9, 2);
const LISTS: usize = 162;

/// Offsets that fall, that begin beyond the start, that leave the elements by one and by 2³².
fn foreign_offsets(random: &mut Random) -> Vec<(&'static str, Vec<u32>)> {
    let each = |offset: &dyn Fn(usize) -> u32| (0..=LISTS).map(offset).collect::<Vec<u32>>();
    let mut random = |most: usize| (0..=LISTS).map(|_| random.index(most) as u32).collect::<Vec<u32>>();
    vec![
        ("in no order", random(80)),
        ("in no order, beyond the elements", random(100_000)),
        ("falling", each(&|i| (LISTS - i) as u32 / 3)),
        ("from 3 on", each(&|i| 3 + i as u32 / 4)),
        ("one too far", each(&|i| if i == LISTS { 81 } else { 0 })),
        ("to the end of 32 bits", each(&|i| if i == LISTS { u32::MAX } else { 0 })),
        ("at the end of 32 bits", each(&|_| u32::MAX)),
        ("to and fro", each(&|i| if i % 2 == 0 { 0 } else { u32::MAX })),
        ("to and fro within", each(&|i| if i % 2 == 0 { 80 } else { 0 })),
    ]
}

/// Whatever the offsets say: lists of what is in the buffers, or an error that is no defect's, and the next call is sound.
fn offsets_of_other_origin_stay_within_buffers<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 23);
    let (size, views) = FOREIGN;
    // Nothing is promised about order, so it does not matter that these are in none.
    let elements: Vec<LhbElement> =
        (0..80).map(|i| LhbElement { surface: i, depth: 0xabcd_0000 + (i * 37) % 80 }).collect();
    let rising = (0..=LISTS).map(|i| (i * 80 / LISTS) as u32).collect();
    for (what, offsets) in foreign_offsets(&mut random) {
        for held in [80, 1, 0] {
            for layer_cap in [0, 3] {
                for foreign_side in [0, 1, 2] {
                    let with = |offsets: &Vec<u32>, held: usize| {
                        let left_out = vec![0; if layer_cap > 0 { LISTS } else { 0 }];
                        let elements = elements[..held].to_vec();
                        uploaded(cx, size, views, &Lists { offsets: offsets.clone(), elements, left_out })
                    };
                    let kept = if foreign_side == 1 { with(&rising, 80)? } else { with(&offsets, held)? };
                    let added = if foreign_side == 0 { with(&rising, 80)? } else { with(&offsets, held)? };
                    let cap_side = SIDES[foreign_side % 2];
                    let params = MergeLhbParams { layer_cap, cap_side, ..all_from(0) };
                    within_buffers(cx, &kept, &added, &params).map_err(|f| {
                        f.within(&format!("offsets {what}, {held} elements, side {foreign_side}, {params:?}"))
                    })?;
                }
            }
        }
    }
    one_pixel(&self::elements(&[(1, 2)]), &self::elements(&[(1, 1)])).agrees(cx, &all_from(1))
}

/// Depths are those of the elements that there are, or 0, what a device reads where there is nothing.
fn within_buffers<B: Backend>(
    cx: &Context<'_, B>,
    kept: &Lhb<B>,
    added: &Lhb<B>,
    params: &MergeLhbParams,
) -> Check {
    match cx.backend.merge_lhb(kept, added, params) {
        Ok(lhb) => {
            let lists = downloaded(cx, &lhb)?;
            let foreign = |e: &&LhbElement| e.depth != 0 && !(0xabcd_0000..0xabcd_0050).contains(&e.depth);
            let found = lists.elements.iter().find(foreign);
            ensure(found.is_none(), || format!("{found:?} is in neither buffer"))
        }
        Err(Error::Internal(text)) => Err(Failure::Mismatch(format!("a defect: {text}"))),
        Err(Error::DeviceLost { reason, .. }) => Err(Failure::Mismatch(format!("device lost: {reason}"))),
        Err(_) => Ok(()),
    }
}
