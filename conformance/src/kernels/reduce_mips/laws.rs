//! What holds for all fields: bounds, what storages have in common, and mirrors.

use super::inputs::{SPREADS, spread};
use super::{Checked, Resident, STORAGES};
use crate::kernels::property::hold;
use crate::trial::{Check, Context, Failure, Listing, ensure, list_trials};
use proptest::prelude::*;
use std::collections::BTreeMap;
use twinlight_core::Backend;
use twinlight_core::kernels::reduce_mips::{
    ANISOTROPIC, HARMONICS, HARMONICS_8, ISOTROPIC, OPAQUE, RANGES, SUMS, words_of,
};
use twinlight_fixtures::random::Random;

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "reduce_mips":
        opacity_stays_in_range, ranges_bound_sums, storages_agree_where_they_say_the_same, bytes_are_close_to_harmonics, mirrors,
    );
}

/// Random fields, up to 32 voxels to a side.
fn on_fields<B: Backend>(
    cx: &Context<'_, B>,
    law: impl Fn(&Context<'_, B>, &Resident<'_, B>) -> Check,
) -> Check {
    let dims = prop::array::uniform3(1..=32_u32);
    hold(cx, (any::<u64>(), dims, 0..4_usize, 0..400_usize), |(seed, dims, kind, count)| {
        let field = spread(&mut Random::new(seed), dims, SPREADS[kind], count);
        let place = |f: Failure| f.within(&format!("{field:?}"));
        law(cx, &Resident::new(cx, &field)?).map_err(place)
    })
}

/// The words of a storage that are opacities.
fn opacities(storage: u32) -> &'static [usize] {
    match storage {
        ISOTROPIC => &[3],
        ANISOTROPIC => &[3, 7, 11, 15, 19, 23],
        HARMONICS | HARMONICS_8 => &[0],
        _ => &[],
    }
}

fn opacity_stays_in_range<B: Backend>(cx: &Context<'_, B>) -> Check {
    on_fields(cx, |cx, resident| {
        for (storage, name) in STORAGES {
            let values = resident.values(cx, storage)?;
            for (i, value) in values.chunks(words_of(storage)?).enumerate() {
                let exponent_bits = if storage == HARMONICS_8 { 0xff << 24 } else { 0 };
                let greatest = opacities(storage).iter().map(|&word| value[word] & !exponent_bits).max();
                ensure(greatest.is_none_or(|most| most <= OPAQUE), || {
                    format!("opacity {greatest:?} of value {i}, {name}")
                })?;
            }
        }
        Ok(())
    })
}

/// A sum is between the least and the greatest times the number of leaves, and is both where there is one.
fn ranges_bound_sums<B: Backend>(cx: &Context<'_, B>) -> Check {
    on_fields(cx, |cx, resident| {
        let (sums, ranges) = (resident.values(cx, SUMS)?, resident.values(cx, RANGES)?);
        for (i, (level, code)) in places(resident).into_iter().enumerate() {
            let leaves =
                resident.field.leaves.keys().filter(|&leaf| leaf >> (3 * level) == code).count() as u64;
            let sum = u64::from(sums[2 * i]) | u64::from(sums[2 * i + 1]) << 32;
            let [least, greatest] = [0, 1].map(|end| u64::from(ranges[2 * i + end]) * leaves);
            ensure(least <= sum && sum <= greatest, || {
                format!("value {i}: {leaves} leaves of {least} to {greatest} in all sum to {sum}")
            })?;
        }
        Ok(())
    })
}

/// Opacities of harmonics, in words and bytes, are the isotropic ones. What leaves have is the same in all directions, so a₀ of their
fn storages_agree_where_they_say_the_same<B: Backend>(cx: &Context<'_, B>) -> Check {
    on_fields(cx, |cx, resident| {
        let [isotropic, harmonics, bytes] =
            [ISOTROPIC, HARMONICS, HARMONICS_8].map(|storage| resident.values(cx, storage));
        let (isotropic, harmonics, bytes) = (isotropic?, harmonics?, bytes?);
        for (i, (level, _)) in places(resident).into_iter().enumerate() {
            let own = &isotropic[4 * i..][..4];
            let opacities = [own[3], harmonics[13 * i], bytes[4 * i] & 0xff_ffff];
            ensure(opacities.iter().all(|&o| o == own[3]), || {
                format!("opacities {opacities:?} of value {i}")
            })?;
            let constant = [1, 5, 9].map(|word| harmonics[13 * i + word]);
            ensure(level > 1 || constant == own[..3], || format!("{constant:?} of {own:?}, value {i}"))?;
        }
        Ok(())
    })
}

/// Bytes are within half a step of the coefficients, and steps are as small as they can be: of the greatest coefficient the error is at
/// most one part in 127.
fn bytes_are_close_to_harmonics<B: Backend>(cx: &Context<'_, B>) -> Check {
    on_fields(cx, |cx, resident| {
        let (harmonics, bytes) = (resident.values(cx, HARMONICS)?, resident.values(cx, HARMONICS_8)?);
        for (i, (value, words)) in harmonics.chunks(13).zip(bytes.chunks(4)).enumerate() {
            let step = 1_i64 << (words[0] >> 24);
            let greatest =
                value[1..].iter().map(|word| i64::from(word.cast_signed()).abs()).max().unwrap_or(0);
            ensure(step == 1 || 127 * step <= 2 * greatest, || {
                format!("value {i} has steps of {step} for {greatest}")
            })?;
            for (k, word) in value[1..].iter().enumerate() {
                let byte = words[1 + k / 4].to_le_bytes()[k % 4];
                let digits = if k % 4 == 0 { i64::from(byte) } else { i64::from(byte.cast_signed()) };
                let (got, want) = (digits * step, i64::from(word.cast_signed()));
                let is_close = 2 * (got - want).abs() <= step && (step > 1 || got == want);
                ensure(is_close, || {
                    format!("coefficient {k} of value {i}: {got} in steps of {step}, {want}")
                })?;
            }
        }
        Ok(())
    })
}

/// A mirror along an axis swaps its two faces and turns its coefficients round, and nothing else.
fn mirrors<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 21);
    for (axis, kind) in [(0, 0), (1, 1), (2, 2), (0, 3)] {
        let field = spread(&mut random, [30, 21, 32], SPREADS[kind], 400);
        let image = field.mirrored(axis);
        let resident = [Resident::new(cx, &field)?, Resident::new(cx, &image)?];
        for (storage, name) in STORAGES {
            let [of_field, of_image] =
                [by_place(cx, &resident[0], storage)?, by_place(cx, &resident[1], storage)?];
            for (&(level, code), value) in &of_field {
                let there = of_image.get(&(level, field.mirror(level, code, axis)));
                let want = mirrored(value, storage, axis);
                ensure(there == Some(&want), || {
                    format!(
                        "{name}, code {code} of level {level} across axis {axis}: {there:?}, want {want:?}"
                    )
                })?;
            }
        }
    }
    Ok(())
}

/// A value seen in a mirror.
fn mirrored(value: &[u32], storage: u32, axis: usize) -> Vec<u32> {
    let mut image = value.to_vec();
    match storage {
        ANISOTROPIC => {
            let [plus, minus] = [8 * axis, 8 * axis + 4];
            image[plus..plus + 4].copy_from_slice(&value[minus..minus + 4]);
            image[minus..minus + 4].copy_from_slice(&value[plus..plus + 4]);
        }
        HARMONICS => {
            for channel in 0..3 {
                let word = &mut image[2 + 4 * channel + axis];
                *word = word.wrapping_neg();
            }
        }
        HARMONICS_8 => {
            for word in &mut image[1..] {
                let mut bytes = word.to_le_bytes();
                bytes[1 + axis] = bytes[1 + axis].wrapping_neg();
                *word = u32::from_le_bytes(bytes);
            }
        }
        _ => {}
    }
    image
}

/// Level and code of every value.
fn places<B: Backend>(resident: &Resident<'_, B>) -> Vec<(u32, u32)> {
    let want = &resident.want;
    let level_of = |i: usize| want.starts[1..].iter().filter(|&&end| end as usize <= i).count() as u32;
    want.active.iter().enumerate().map(|(i, &code)| (level_of(i), code)).collect()
}

fn by_place<B: Backend>(
    cx: &Context<'_, B>,
    resident: &Resident<'_, B>,
    storage: u32,
) -> Checked<BTreeMap<(u32, u32), Vec<u32>>> {
    let values = resident.values(cx, storage)?;
    let each = values.chunks(words_of(storage)?).map(<[u32]>::to_vec);
    Ok(places(resident).into_iter().zip(each).collect())
}
