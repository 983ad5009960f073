//! How light spreads: weights of single pixels and of interleaved patterns.

use super::inputs::{radiance, textured, wall};
use super::{agreed, filtered, rounding, shape};
use crate::compare::Evidence;
use crate::oracle::filter_indirect::Picture;
use crate::trial::{Check, Context, Listing, ensure, list_trials};
use twinlight_core::Backend;
use twinlight_core::kernels::filter_indirect::{MAX_WINDOW, RadianceTexel};
use twinlight_core::kernels::shade_primary::GBufferTexel;
use twinlight_fixtures::random::Random;

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "filter_indirect":
        a_bright_pixel_fills_its_window, patterns_weigh_the_same, even_light_stays_even, textures_stay_sharp,
    );
}

/// Weight of a distance along one axis.
fn weight(distance: i64, window: u32) -> f64 {
    match i64::from(window) - 2 * distance.abs() {
        0 => 0.5,
        1.. => 1.0,
        _ => 0.0,
    }
}

/// One bright pixel, in the middle, at a border and in a corner: every pixel gets its weight's share of it, and those outside the
/// window nothing at all.
fn a_bright_pixel_fills_its_window<B: Backend>(cx: &Context<'_, B>) -> Check {
    for window in [1, 2, 3, 4, 5, 8, 15, 16, MAX_WINDOW] {
        let side = window + 3;
        let middle = i64::from(side / 2);
        // Wide windows are dear on software adapters, and borders are the same to them.
        let places = [[middle, middle], [0, middle], [middle, i64::from(side) - 1], [0, 0]];
        for &bright in if window > 8 { &places[..1] } else { &places[..] } {
            let mut picture = wall(side, side, window);
            let at = picture.pixel(bright[0], bright[1]);
            picture.input[at.unwrap_or_default()] = radiance([1.0, 3.0, 0.7]);
            let got = filtered(cx, &picture)?;
            shares(&picture, &got, bright).map_err(|f| f.within(&format!("window {window}, {bright:?}")))?;
        }
    }
    Ok(())
}

fn shares(picture: &Picture, got: &[RadianceTexel], bright: [i64; 2]) -> Check {
    let (window, side) = (picture.params.window, i64::from(picture.params.width));
    // Of a row's weights around x those within the picture.
    let inside = |x: i64| (0..side).map(|other| weight(other - x, window)).sum::<f64>();
    let mut evidence = Evidence::new("share", shape(picture));
    for (at, texel) in got.iter().enumerate() {
        let [x, y] = picture.place(at);
        let share = weight(x - bright[0], window) * weight(y - bright[1], window) / (inside(x) * inside(y));
        for (value, light) in texel.rgb.into_iter().zip([1.0, 3.0, f64::from(0.7_f32)]) {
            let want = share * light;
            // All terms but one are 0, and adding them is exact.
            let error = want * rounding(1);
            evidence.interval(at, "rgb", value, want - error, want + error, "its weight's share");
        }
    }
    evidence.finish()
}

/// Light that repeats every n × n pixels has the same mean in every window that lies in the picture: each pattern weighs as much as
/// any other, wherever the window begins.
fn patterns_weigh_the_same<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 31);
    for window in [2, 3, 4, 5, 6, 7, 8, 13, 16, MAX_WINDOW] {
        let n = i64::from(window);
        let side = window + 6;
        let mut picture = wall(side, side, window);
        let tiles: Vec<[f32; 3]> = (0..n * n)
            .map(|pattern| {
                // One pattern alone, and all of them in unlike light.
                let alone = if pattern == n * n / 3 { 64.0 } else { 0.0 };
                [alone, random.between(0.1, 2.0) as f32, random.between(0.0, 9.0) as f32]
            })
            .collect();
        for at in 0..picture.input.len() {
            let [x, y] = picture.place(at);
            picture.input[at] = radiance(tiles[(y % n * n + x % n) as usize]);
        }
        let got = filtered(cx, &picture)?;
        let inner = (n / 2)..(i64::from(side) - n / 2);
        let mut evidence = Evidence::new(format!("{n} x {n} patterns"), shape(&picture));
        for (at, texel) in got.iter().enumerate().filter(|(at, _)| {
            let [x, y] = picture.place(*at);
            inner.contains(&x) && inner.contains(&y)
        }) {
            for c in 0..3 {
                let mean = tiles.iter().map(|tile| f64::from(tile[c])).sum::<f64>() / (n * n) as f64;
                let error = mean * rounding(picture.window(at).len());
                evidence.interval(at, "rgb", texel.rgb[c], mean - error, mean + error, "the patterns' mean");
            }
        }
        evidence.finish()?;
    }
    Ok(())
}

/// The same light everywhere on white stays.
fn even_light_stays_even<B: Backend>(cx: &Context<'_, B>) -> Check {
    for window in [2, 3, 8, MAX_WINDOW] {
        let mut picture = wall(29, 23, window);
        picture.input.fill(radiance([0.1, 1.0, 700.0]));
        let got = agreed(cx, &picture)?;
        let want: Vec<[f64; 3]> = picture.input.iter().map(|texel| texel.rgb.map(f64::from)).collect();
        stays(&picture, &got, &want)?;
    }
    Ok(())
}

/// The same irradiance on a texture, pixel for pixel or with an edge, is the texture.
fn textures_stay_sharp<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 32);
    for window in [2, 3, 8, MAX_WINDOW] {
        for has_edge in [false, true] {
            let mut picture = wall(29, 23, window);
            textured(&mut random, &mut picture);
            for at in 0..picture.gbuffer.len() {
                let dark = if picture.place(at)[0] < 14 { 1.0 / 512.0 } else { 0.9 };
                let texel = &mut picture.gbuffer[at];
                texel.albedo = if has_edge { [dark; 3] } else { texel.albedo };
                picture.input[at] = radiance(texel.albedo.map(|albedo| albedo * 5.0));
            }
            let got = agreed(cx, &picture)?;
            let exact = |texel: &GBufferTexel| texel.albedo.map(|albedo| f64::from(albedo) * 5.0);
            let want: Vec<[f64; 3]> = picture.gbuffer.iter().map(exact).collect();
            stays(&picture, &got, &want)?;
            let edge = f64::from(got[14].rgb[0]) / f64::from(got[13].rgb[0]);
            ensure(!has_edge || edge > 400.0, || format!("an edge of 460 : 1 is one of {edge} : 1"))?;
        }
    }
    Ok(())
}

fn stays(picture: &Picture, got: &[RadianceTexel], want: &[[f64; 3]]) -> Check {
    let mut evidence = Evidence::new(format!("window {}", picture.params.window), shape(picture));
    for (at, (texel, want)) in got.iter().zip(want).enumerate() {
        for (value, want) in texel.rgb.into_iter().zip(want) {
            // One rounding more: of the input.
            let error = want * rounding(picture.window(at).len() + 1);
            evidence.interval(at, "rgb", value, want - error, want + error, "even irradiance");
        }
    }
    evidence.finish()
}
