//! Symmetries, and what is promised bit for bit.

use super::inputs::{noise, patchwork, textured, wall};
use super::{filtered, filtered_over, garbage, rounding, shape};
use crate::compare::{Evidence, exact};
use crate::kernels::strict_only;
use crate::oracle::filter_indirect::Picture;
use crate::trial::{Check, Context, Listing, ensure, list_trials};
use twinlight_core::Backend;
use twinlight_core::kernels::filter_indirect::{FilterIndirectParams, RadianceTexel};
use twinlight_fixtures::random::Random;

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "filter_indirect":
        mirrored_and_transposed, brighter_by_powers_of_two, channels_are_alike, far_pixels_do_not_matter,
        output_is_overwritten, inputs_stay,
    );
}

/// A picture whose pixel i is another's pixel `from[i]`.
fn permuted(picture: &Picture, params: FilterIndirectParams, from: &[usize]) -> Picture {
    Picture {
        params,
        gbuffer: from.iter().map(|at| picture.gbuffer[*at]).collect(),
        diffuse: picture.diffuse.clone(),
        input: from.iter().map(|at| picture.input[*at]).collect(),
    }
}

/// Windows look the same from all sides: what is mirrored, or has its rows for columns, is filtered so, but for the order of sums.
fn mirrored_and_transposed<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 51);
    for window in [2, 3, 6, 11] {
        let (width, height) = (29, 18);
        let picture = patchwork(&mut random, width, height, window);
        let got = filtered(cx, &picture)?;
        let (columns, rows) = (width as usize, height as usize);
        let count = columns * rows;
        let across = (0..count).map(|at| at / columns * columns + columns - 1 - at % columns).collect();
        let down = (0..count).map(|at| (rows - 1 - at / columns) * columns + at % columns).collect();
        let turned = (0..count).map(|at| at % rows * columns + at / rows).collect();
        let upright = picture.params;
        let lying = FilterIndirectParams { width: height, height: width, ..upright };
        let ways: [(&str, _, Vec<usize>); 3] =
            [("mirrored", upright, across), ("upside down", upright, down), ("transposed", lying, turned)];
        for (name, params, from) in ways {
            let other = permuted(&picture, params, &from);
            let want: Vec<RadianceTexel> = from.iter().map(|at| got[*at]).collect();
            alike(&other, &filtered(cx, &other)?, &want).map_err(|f| f.within(name))?;
        }
    }
    Ok(())
}

/// Equal but for rounding, in both.
fn alike(picture: &Picture, got: &[RadianceTexel], want: &[RadianceTexel]) -> Check {
    let mut evidence = Evidence::new("output", shape(picture));
    for (at, (got, want)) in got.iter().zip(want).enumerate() {
        for c in 0..3 {
            let want = f64::from(want.rgb[c]);
            let error = 2.0 * rounding(picture.window(at).len()) * want.abs();
            evidence.interval(at, "rgb", got.rgb[c], want - error, want + error, "the order of a sum");
        }
    }
    evidence.finish()
}

/// Twice the light is twice the result, bit for bit: powers of two don't round.
fn brighter_by_powers_of_two<B: Backend>(cx: &Context<'_, B>) -> Check {
    strict_only(cx)?;
    let picture = patchwork(&mut Random::new(cx.options.seed ^ 52), 31, 23, 6);
    let scaled = |texels: &[RadianceTexel], by: f32| -> Vec<RadianceTexel> {
        texels
            .iter()
            .map(|texel| RadianceTexel { rgb: texel.rgb.map(|value| value * by), ..*texel })
            .collect()
    };
    let dim = filtered(cx, &picture)?;
    for by in [2.0, 1_048_576.0, 1.0 / 65_536.0] {
        let bright = Picture { input: scaled(&picture.input, by), ..picture.clone() };
        exact(cx, "brighter", &filtered(cx, &bright)?, &scaled(&dim, by), shape(&picture))?;
    }
    Ok(())
}

/// What is true of red is true of green and blue.
fn channels_are_alike<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut picture = patchwork(&mut Random::new(cx.options.seed ^ 53), 31, 23, 5);
    let turned = |rgb: [f32; 3]| [rgb[2], rgb[0], rgb[1]];
    let mut want = filtered(cx, &picture)?;
    want.iter_mut().for_each(|texel| texel.rgb = turned(texel.rgb));
    picture.input.iter_mut().for_each(|texel| texel.rgb = turned(texel.rgb));
    picture.gbuffer.iter_mut().for_each(|texel| texel.albedo = turned(texel.albedo));
    exact(cx, "channels in turn", &filtered(cx, &picture)?, &want, shape(&picture))
}

/// Light and surfaces outside a pixel's window change nothing in it: a change in one column stays within its reach.
fn far_pixels_do_not_matter<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 54);
    for window in [1, 2, 3, 8, 9] {
        let mut picture = wall(41, 9, window);
        picture.input = noise(&mut random, 41 * 9);
        let before = filtered(cx, &picture)?;
        for at in (0..41 * 9).filter(|at| at % 41 == 20) {
            picture.input[at].rgb = picture.input[at].rgb.map(|value| value + 100.0);
        }
        let after = filtered(cx, &picture)?;
        let reach = i64::from(window) / 2;
        for at in 0..before.len() {
            let [x, y] = picture.place(at);
            let (within, same) = ((x - 20).abs() <= reach, before[at] == after[at]);
            ensure(within != same, || format!("window {window}, pixel ({x}, {y}): the same is {same}"))?;
        }
    }
    Ok(())
}

/// Whatever the output held: the same bits, and the same again.
fn output_is_overwritten<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut picture = patchwork(&mut Random::new(cx.options.seed ^ 55), 33, 19, 4);
    textured(&mut Random::new(5), &mut picture);
    let count = picture.input.len();
    let first = filtered_over(cx.backend, &picture, &garbage(count))?;
    for before in [picture.input.clone(), first.clone(), vec![super::inputs::radiance([0.0; 3]); count]] {
        let again = filtered_over(cx.backend, &picture, &before)?;
        exact(cx, "over other values", &again, &first, shape(&picture))?;
    }
    Ok(())
}

/// G-buffer, materials and input are read only.
fn inputs_stay<B: Backend>(cx: &Context<'_, B>) -> Check {
    let picture = patchwork(&mut Random::new(cx.options.seed ^ 56), 33, 19, 4);
    let backend = cx.backend;
    let gbuffer = backend.upload(&picture.gbuffer)?;
    let diffuse = backend.upload(&picture.diffuse)?;
    let input = backend.upload(&picture.input)?;
    let mut output = backend.upload(&garbage(picture.input.len()))?;
    for _ in 0..2 {
        backend.filter_indirect(&gbuffer, &diffuse, &input, &picture.params, &mut output)?;
    }
    exact(cx, "gbuffer", &backend.download(&gbuffer)?, &picture.gbuffer, shape(&picture))?;
    exact(cx, "diffuse", &backend.download(&diffuse)?, &picture.diffuse, shape(&picture))?;
    exact(cx, "input", &backend.download(&input)?, &picture.input, shape(&picture))?;
    let once = filtered(cx, &picture)?;
    exact(cx, "a second run", &backend.download(&output)?, &once, shape(&picture))
}
