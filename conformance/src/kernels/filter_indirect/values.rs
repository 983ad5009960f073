//! What is copied, and values that are no ordinary numbers.

use super::inputs::{noisy_wall, patchwork, radiance, textured, wall};
use super::{agreed, agrees, filtered, shape};
use crate::compare::{Evidence, exact};
use crate::oracle::filter_indirect::Picture;
use crate::trial::{Check, Context, Listing, ensure, list_trials};
use twinlight_core::Backend;
use twinlight_core::kernels::filter_indirect::{LEAST_ALBEDO, RadianceTexel};
use twinlight_core::kernels::trace::NO_HIT;
use twinlight_fixtures::random::Random;

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "filter_indirect":
        what_is_not_diffuse_is_copied, materials_without_an_entry_are_copied, black_channels_are_copied,
        black_neighbours_do_not_count, least_albedo_counts, what_is_not_finite_reaches_joined_neighbours_only,
        what_is_not_finite_and_copied_stays_where_it_is, dark_stays_dark,
    );
}

/// Values whose bits a copy keeps and arithmetic doesn't.
fn odd_value(random: &mut Random) -> f32 {
    let values = [-0.0, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, f32::MIN_POSITIVE, 1.0e-40, 0.1, -3.0];
    let odd = f32::from_bits(0x7fc1_2345);
    let at = random.index(values.len() + 1);
    values.get(at).copied().unwrap_or(odd)
}

fn odd_light(random: &mut Random, picture: &mut Picture, of: impl Fn(&Picture, usize) -> bool) {
    for at in 0..picture.input.len() {
        if of(picture, at) {
            picture.input[at] = radiance([(); 3].map(|()| odd_value(random)));
        }
    }
}

/// Glossy materials and pixels that show nothing, beside diffuse ones that are filtered.
fn what_is_not_diffuse_is_copied<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 41);
    for window in [1, 4, 9] {
        let mut picture = patchwork(&mut random, 31, 23, window);
        odd_light(&mut random, &mut picture, |picture, at| !picture.is_diffuse(at));
        agrees(cx, &picture)?;
    }
    let mut glossy = noisy_wall(&mut random, 17, 11, 5);
    glossy.diffuse = vec![0];
    odd_light(&mut random, &mut glossy, |_, _| true);
    copied(cx, &glossy)?;
    glossy.diffuse = vec![1];
    glossy.gbuffer.iter_mut().for_each(|texel| texel.triangle = NO_HIT);
    copied(cx, &glossy)
}

fn copied<B: Backend>(cx: &Context<'_, B>, picture: &Picture) -> Check {
    exact(cx, "a copy", &filtered(cx, picture)?, &picture.input, shape(picture))
}

/// No entries at all, one too few, and materials at the end of 32 bits.
fn materials_without_an_entry_are_copied<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 42);
    let mut picture = noisy_wall(&mut random, 17, 11, 5);
    picture.diffuse.clear();
    copied(cx, &picture)?;
    for (entries, material) in [(1, 1), (1, u32::MAX), (5, 5), (64, 64), (64, 1 << 31), (64, 1 << 30)] {
        picture.diffuse = vec![1; entries];
        picture.gbuffer.iter_mut().for_each(|texel| texel.material = material);
        copied(cx, &picture)?;
        // The last one there is.
        picture.gbuffer.iter_mut().for_each(|texel| texel.material = entries as u32 - 1);
        let got = agreed(cx, &picture)?;
        ensure(got != picture.input, || format!("material {} of {entries} is copied", entries - 1))?;
    }
    Ok(())
}

/// Channels without albedo have no irradiance: their bits stay, and the other channels are filtered.
fn black_channels_are_copied<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 43);
    let mut picture = noisy_wall(&mut random, 17, 11, 5);
    textured(&mut random, &mut picture);
    let black = [0.0, -0.0, LEAST_ALBEDO.next_down(), -1.0, f32::NAN, 1e-30];
    for at in 0..picture.gbuffer.len() {
        for c in 0..3 {
            if random.index(3) == 0 {
                picture.gbuffer[at].albedo[c] = black[random.index(black.len())];
                picture.input[at].rgb[c] = odd_value(&mut random);
            }
        }
    }
    agrees(cx, &picture)
}

/// One lit pixel among black ones has no neighbour to share with, nor to be dimmed by.
fn black_neighbours_do_not_count<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut picture = wall(9, 9, 5);
    for at in (0..81).filter(|at| *at != 40) {
        picture.gbuffer[at].albedo = [0.0, 1.0, LEAST_ALBEDO.next_down()];
    }
    picture.input[40] = radiance([8.0; 3]);
    let got = agreed(cx, &picture)?;
    ensure(got[40].rgb[0] == 8.0 && got[40].rgb[2] == 8.0, || format!("{:?} of 8", got[40]))?;
    ensure((got[40].rgb[1] - 8.0 / 25.0).abs() < 1e-5, || format!("{:?} of 8 / 25", got[40]))
}

/// The least albedo is one that is divided by.
fn least_albedo_counts<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut picture = wall(2, 1, 2);
    picture.gbuffer[0].albedo = [LEAST_ALBEDO, 1.0, LEAST_ALBEDO];
    picture.gbuffer[1].albedo = [1.0, LEAST_ALBEDO, LEAST_ALBEDO];
    picture.input[1] = radiance([3.0; 3]);
    let got = agreed(cx, &picture)?;
    let want = [LEAST_ALBEDO, 1.0 / LEAST_ALBEDO, 1.0];
    for (value, want) in got[0].rgb.into_iter().zip(want) {
        ensure((value / want - 1.0).abs() < 1e-6, || format!("{:?}, want {want:?}", got[0]))?;
    }
    Ok(())
}

/// Beside what is not finite: joined neighbours aren't either, and all others have the bits that they have without.
fn what_is_not_finite_reaches_joined_neighbours_only<B: Backend>(cx: &Context<'_, B>) -> Check {
    for value in [f32::INFINITY, f32::NEG_INFINITY, f32::NAN] {
        for window in [1, 2, 5, 8, 32] {
            let mut picture = noisy_wall(&mut Random::new(cx.options.seed ^ 44), 23, 15, window);
            picture.diffuse = vec![1, 1];
            for at in 0..picture.gbuffer.len() {
                picture.gbuffer[at].material = u32::from(picture.place(at)[0] >= 12);
            }
            let sound = filtered(cx, &picture)?;
            let source = 7 * 23 + 11;
            picture.input[source].rgb[1] = value;
            let got = filtered(cx, &picture)?;
            reaches(&picture, [&got, &sound], source)
                .map_err(|f| f.within(&format!("{value} in window {window}")))?;
        }
    }
    Ok(())
}

/// Only the green of the source's window and material is other than finite.
fn reaches(picture: &Picture, [got, sound]: [&[RadianceTexel]; 2], source: usize) -> Check {
    let mut evidence = Evidence::new("spread", shape(picture));
    for (at, texel) in got.iter().enumerate() {
        let is_near = picture.window(at).iter().any(|(other, _)| *other == source);
        let is_joined = is_near && picture.gbuffer[at].material == picture.gbuffer[source].material;
        for c in 0..3 {
            let (value, was) = (texel.rgb[c], sound[at].rgb[c]);
            let holds =
                if is_joined && c == 1 { !value.is_finite() } else { value.to_bits() == was.to_bits() };
            evidence
                .holds(at, holds, || format!("rgb.{c}: got {value:e}, {was:e} without; joined: {is_joined}"));
        }
    }
    evidence.finish()
}

/// Pixels that show nothing, that are glossy, or black, keep what they have to themselves.
fn what_is_not_finite_and_copied_stays_where_it_is<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut picture = noisy_wall(&mut Random::new(cx.options.seed ^ 45), 23, 15, 6);
    picture.diffuse = vec![1, 0];
    for at in (0..picture.gbuffer.len()).step_by(4) {
        picture.input[at] = radiance([f32::NAN, f32::INFINITY, f32::NEG_INFINITY]);
        let texel = &mut picture.gbuffer[at];
        match at % 3 {
            0 => texel.triangle = NO_HIT,
            1 => texel.material = 1,
            _ => texel.albedo = [0.0; 3],
        }
    }
    let got = agreed(cx, &picture)?;
    let others = got.iter().enumerate().filter(|(at, _)| at % 4 != 0);
    let finite = others.filter(|(_, texel)| texel.rgb.iter().all(|value| value.is_finite())).count();
    let count = got.len() - got.len().div_ceil(4);
    ensure(finite == count, || format!("only {finite} of {count} pixels are finite"))
}

/// No light at all: zeros, whatever is shown.
fn dark_stays_dark<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut picture = patchwork(&mut Random::new(cx.options.seed ^ 46), 31, 23, 7);
    picture.input.fill(radiance([0.0; 3]));
    copied(cx, &picture)
}
