//! Edge ladders, windows, random patchworks and rendered scenes, against the oracle.

use super::inputs::{noisy_wall, patchwork, rendered, textured, wall};
use super::{agreed, agrees, rounding};
use crate::compare::{Evidence, Shape};
use crate::kernels::property::hold;
use crate::trial::{Check, Context, Listing, ensure, list_trials};
use proptest::prelude::*;
use twinlight_core::Backend;
use twinlight_core::kernels::filter_indirect::{FilterIndirectParams, MAX_WINDOW};
use twinlight_fixtures::random::Random;
use twinlight_fixtures::scenes::builtin;

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "filter_indirect":
        g9_nothing_to_filter, one_pixel, a_window_of_one_copies, windows, picture_sizes, random_patchworks,
        rendered_scenes,
    );
}

/// No pixels in a row, no rows, neither.
fn g9_nothing_to_filter<B: Backend>(cx: &Context<'_, B>) -> Check {
    for (width, height) in [(0, 0), (0, 7), (7, 0), (u32::MAX, 0), (0, u32::MAX)] {
        let nothing = wall(0, 0, 3);
        let picture =
            super::Picture { params: FilterIndirectParams { width, height, ..nothing.params }, ..nothing };
        let got = agreed(cx, &picture).map_err(|f| f.within(&format!("{width} x {height}")))?;
        ensure(got.is_empty(), || format!("{} pixels of {width} x {height}", got.len()))?;
    }
    Ok(())
}

/// It is its only neighbour, whatever the window.
fn one_pixel<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 1);
    for window in 1..=MAX_WINDOW {
        let mut picture = noisy_wall(&mut random, 1, 1, window);
        textured(&mut random, &mut picture);
        copies(cx, &picture)?;
    }
    Ok(())
}

fn a_window_of_one_copies<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 2);
    let mut picture = noisy_wall(&mut random, 19, 13, 1);
    textured(&mut random, &mut picture);
    copies(cx, &picture)?;
    copies(cx, &patchwork(&mut random, 21, 17, 1))
}

fn copies<B: Backend>(cx: &Context<'_, B>, picture: &super::Picture) -> Check {
    let got = agreed(cx, picture)?;
    let mut evidence = Evidence::new("a copy", Shape::Line);
    for (at, (texel, input)) in got.iter().zip(&picture.input).enumerate() {
        for c in 0..3 {
            let (want, error) = (f64::from(input.rgb[c]), rounding(1) * f64::from(input.rgb[c]));
            evidence.interval(at, "rgb", texel.rgb[c], want - error, want + error, "of one term");
        }
    }
    evidence.finish()
}

/// Even and odd ones, and ones wider than the picture.
fn windows<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 3);
    let some = [1, 2, 3, 4, 5, 6, 7, 8, 15, 16, 17, MAX_WINDOW - 1, MAX_WINDOW];
    let all: Vec<u32> = if cx.full() { (1..=MAX_WINDOW).collect() } else { some.into() };
    for window in all {
        for (width, height) in [(29, 19), (7, 5), (3, 40)] {
            agrees(cx, &patchwork(&mut random, width, height, window))?;
        }
    }
    Ok(())
}

/// Rows, columns, primes, sizes around every workgroup size a backend is likely to use, and rows and columns of more pixels than
/// a device dispatches groups.
fn picture_sizes<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 4);
    let mut sizes =
        vec![(1, 67), (67, 1), (2, 2), (13, 7), (8, 8), (9, 7), (16, 16), (15, 17), (64, 4), (65, 3)];
    sizes.extend([(257, 2), (2, 257), (66_000, 1), (1, 66_000)]);
    if cx.full() {
        sizes.extend([(512, 512), (1_021, 509)]);
    }
    for (width, height) in sizes {
        agrees(cx, &patchwork(&mut random, width, height, 3))?;
    }
    Ok(())
}

fn random_patchworks<B: Backend>(cx: &Context<'_, B>) -> Check {
    let shape = (any::<u64>(), 1..40_u32, 1..30_u32);
    let limits = (1..=12_u32, 0.0..1.0_f32, 0.0..0.03_f32);
    hold(cx, (shape, limits), |((seed, width, height), (window, least_cosine, footprint))| {
        let mut picture = patchwork(&mut Random::new(seed), width, height, window);
        picture.params.least_cosine = least_cosine;
        picture.params.footprint = footprint;
        agrees(cx, &picture)
    })
}

fn rendered_scenes<B: Backend>(cx: &Context<'_, B>) -> Check {
    let (width, height) = if cx.full() { (61, 47) } else { (37, 25) };
    for name in ["cornell", "axis", "textured", "lights", "furnace"] {
        for window in [4, 9] {
            let Some(scene) = builtin(name) else { continue };
            let picture = rendered(&scene, width, height, window)?;
            let got = agreed(cx, &picture).map_err(|f| f.within(name))?;
            let changed = got.iter().zip(&picture.input).filter(|(a, b)| a != b).count();
            ensure(changed * 4 > got.len(), || format!("{name}: only {changed} pixels changed"))?;
        }
    }
    Ok(())
}
