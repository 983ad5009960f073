//! What is refused, and buffers that no kernel made.

use super::inputs::{pixel, some_views};
use super::{AS_LISTS, Views, downloaded, near, uploaded_words};
use crate::oracle::pack_lhb::{Packed, element_of};
use crate::oracle::rasterize_lhb::Lists;
use crate::trial::{Check, Context, Failure, Listing, ensure, list_trials};
use twinlight_core::kernels::pack_lhb::{EMPTY, MAX_TRIANGLES, PackLhbParams};
use twinlight_core::kernels::rasterize_lhb::LhbElement;
use twinlight_core::{Backend, Error};
use twinlight_fixtures::random::Random;

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "pack_lhb":
        bad_parameters_are_refused, unlike_lengths_are_refused, impossible_shapes_are_refused, triangles_beyond_are_refused,
        malformed_offsets, words_of_other_origin,
    );
}

/// The kind of an error.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Refusal {
    Invalid,
    Limit,
}

fn refused<T: std::fmt::Debug>(result: Result<T, Error>, want: Refusal) -> Check {
    let got = match result {
        Err(Error::InvalidInput { .. }) => Refusal::Invalid,
        Err(Error::LimitExceeded { .. }) => Refusal::Limit,
        Err(other) => return Err(other.into()),
        Ok(lhb) => return Err(Failure::Mismatch(format!("not refused: {lhb:?}"))),
    };
    ensure(got == want, || format!("{got:?}, want {want:?}"))
}

fn bad_parameters_are_refused<B: Backend>(cx: &Context<'_, B>) -> Check {
    let views = some_views(&mut Random::new(31), 64, 1, 1);
    let lhb = views.uploaded(cx)?;
    for (layers, cap_side, want) in [
        (0, 2, Refusal::Invalid),
        (3, u32::MAX, Refusal::Invalid),
        (1 << 20, 0, Refusal::Limit),
        (u32::MAX, 1, Refusal::Limit),
    ] {
        let params = PackLhbParams { layers, cap_side };
        refused(cx.backend.pack_lhb(&lhb, &params), want).map_err(|f| f.within(&format!("{params:?}")))?;
    }
    // A refused call leaves its input and the backend as they were.
    views.agrees(cx, &near(2))
}

/// Offsets, numbers left out and words that are one too few or too many.
fn unlike_lengths_are_refused<B: Backend>(cx: &Context<'_, B>) -> Check {
    for (offsets, left_out) in [(32, 0), (34, 0), (0, 0), (33, 31), (33, 33)] {
        let lists = Lists { offsets: vec![0; offsets], elements: Vec::new(), left_out: vec![0; left_out] };
        let lhb = Views { size: 4, view_count: 2, lists }.uploaded(cx)?;
        for params in [AS_LISTS, near(2)] {
            let place = format!("{offsets} offsets, {left_out} left out, {params:?}");
            refused(cx.backend.pack_lhb(&lhb, &params), Refusal::Invalid).map_err(|f| f.within(&place))?;
        }
    }
    for (layers, offsets, words, left_out) in [
        (0, 32, 5, 0),
        (0, 34, 5, 0),
        (0, 33, 5, 31),
        (3, 33, 96, 32),
        (3, 0, 95, 32),
        (3, 0, 97, 32),
        (3, 0, 96, 0),
        (3, 0, 96, 33),
    ] {
        let packed = Packed { offsets: vec![0; offsets], words: vec![0; words], left_out: vec![0; left_out] };
        let packed = uploaded_words(cx, [4, 2, layers], &packed)?;
        let place = format!("{layers} layers, {offsets} offsets, {words} words, {left_out} left out");
        refused(cx.backend.unpack_lhb(&packed), Refusal::Invalid).map_err(|f| f.within(&place))?;
    }
    Ok(())
}

/// No pixels, and sizes and views whose number of lists or of words is beyond 64 bits, or falls on a small one modulo 2⁶⁴.
fn impossible_shapes_are_refused<B: Backend>(cx: &Context<'_, B>) -> Check {
    let none = Lists { offsets: vec![0], ..Lists::default() };
    for (size, view_count, want) in [
        (0, 3, Refusal::Invalid),
        (1_025, 1, Refusal::Limit),
        (16_384, 1, Refusal::Limit),
        (u32::MAX, u32::MAX, Refusal::Limit),
        (1 << 31, 4, Refusal::Limit),
        (1, u32::MAX, Refusal::Limit),
    ] {
        let lhb = Views { size, view_count, lists: none.clone() }.uploaded(cx)?;
        let place = |f: Failure| f.within(&format!("{view_count} views of {size}²"));
        for layers in [0, 1, u32::MAX] {
            refused(cx.backend.pack_lhb(&lhb, &near(layers)), want).map_err(place)?;
            let packed = uploaded_words(cx, [size, view_count, layers], &Packed::default())?;
            refused(cx.backend.unpack_lhb(&packed), want).map_err(place)?;
        }
    }
    Ok(())
}

/// The last number of 20 bits and those beyond, if they are packed; the error names how many triangles there would be.
fn triangles_beyond_are_refused<B: Backend>(cx: &Context<'_, B>) -> Check {
    for surface in [2 * MAX_TRIANGLES, 2 * MAX_TRIANGLES + 1, 1 << 30, u32::MAX - 1, u32::MAX] {
        let views = pixel(&[(1, 3), (surface, 5), (2, 7)]);
        let lhb = views.uploaded(cx)?;
        for params in [AS_LISTS, near(2), near(3)] {
            let result = cx.backend.pack_lhb(&lhb, &params);
            let text = result.as_ref().map_or_else(ToString::to_string, |_| String::new());
            refused(result, Refusal::Limit)?;
            let count = u64::from(surface / 2) + 1;
            let digits: String = text.chars().filter(char::is_ascii_digit).collect();
            ensure(digits.contains(&count.to_string()), || format!("'{text}' does not name {count}"))?;
        }
        // What layers have no room for is not packed.
        views.agrees(cx, &near(1))?;
    }
    Ok(())
}

/// Lists copy offsets whatever they say; layers refuse those that fall or leave their elements, before they ask for triangles.
fn malformed_offsets<B: Backend>(cx: &Context<'_, B>) -> Check {
    let sound = some_views(&mut Random::new(cx.options.seed ^ 33), 20, 2, 3);
    let count = sound.lists.elements.len() as u32;
    for (place, wrong) in [(0, count + 1), (7, u32::MAX), (300, 0), (799, 1 << 31), (800, count + 1)] {
        let mut views = sound.clone();
        views.lists.offsets[place] = wrong;
        let lhb = views.uploaded(cx)?;
        let within = |f: Failure| f.within(&format!("offset {place} is {wrong}"));
        refused(cx.backend.pack_lhb(&lhb, &near(3)), Refusal::Invalid).map_err(within)?;
        views.agrees(cx, &AS_LISTS).map_err(within)?;
        let mut beyond = views.clone();
        beyond.lists.elements[0].surface = u32::MAX;
        refused(cx.backend.pack_lhb(&beyond.uploaded(cx)?, &near(3)), Refusal::Invalid).map_err(within)?;
    }
    Ok(())
}

/// Any word is an element of a list. Layers with empty words among others unpack to elements that there are.
fn words_of_other_origin<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 34);
    let words: Vec<u32> =
        (0..7 * 162).map(|_| [EMPTY, random.next_u32(), random.next_u32()][random.index(3)]).collect();
    let lists = Packed { offsets: vec![9; 163], words: words.clone(), left_out: Vec::new() };
    let got = downloaded(cx, &cx.backend.unpack_lhb(&uploaded_words(cx, [9, 2, 0], &lists)?)?)?;
    super::same_lists(cx, 9, &got, &crate::oracle::pack_lhb::unpack(&lists, 0))?;
    let layers = Packed { offsets: Vec::new(), words, left_out: vec![0; 162] };
    let got = downloaded(cx, &cx.backend.unpack_lhb(&uploaded_words(cx, [9, 2, 7], &layers)?)?)?;
    let known: Vec<LhbElement> = layers.words.iter().map(|word| element_of(*word)).collect();
    ensure(got.offsets.is_sorted() && got.offsets[162] as usize == got.elements.len(), || "no lists".into())?;
    let foreign = got.elements.iter().find(|e| !known.contains(e));
    ensure(foreign.is_none(), || format!("{foreign:?} is not in the words"))
}
