//! Surfaces that are joined, and surfaces that are not.

use super::inputs::{noise, noisy_wall, radiance, wall};
use super::{agreed, agrees, filtered, rounding, shape};
use crate::compare::Evidence;
use crate::oracle::filter_indirect::Picture;
use crate::trial::{Check, Context, Listing, ensure, list_trials};
use glam::{DMat3, DVec3};
use twinlight_core::Backend;
use twinlight_core::kernels::filter_indirect::FilterIndirectParams;
use twinlight_core::kernels::shade_primary::GBufferTexel;
use twinlight_core::kernels::trace::NO_HIT;
use twinlight_fixtures::random::Random;

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "filter_indirect":
        no_light_crosses, nothing_is_no_surface, a_floor_at_grazing_angles, a_slope_of_45_degrees_is_joined,
        narrow_limits, wide_limits, pixels_that_are_not_their_own_neighbours,
    );
}

/// Two surfaces in one picture.
type Difference = (&'static str, fn(&mut GBufferTexel));

const DIFFERENCES: [Difference; 7] = [
    ("material", |t| t.material = 1),
    ("normal", |t| t.shading_normal = [1.0, 0.0, 0.0]),
    ("opposite normal", |t| t.shading_normal = [0.0, 0.0, -1.0]),
    ("plane behind", |t| t.position[2] -= 50.0),
    ("plane before", |t| t.position[2] += 50.0),
    ("nothing", |t| t.triangle = NO_HIT),
    ("no entry", |t| t.material = 2),
];

/// One surface is dark and the other is not: the dark one stays so, exactly, and the other doesn't dim.
fn no_light_crosses<B: Backend>(cx: &Context<'_, B>) -> Check {
    let patterns: [fn([i64; 2]) -> bool; 4] =
        [|[x, _]| x >= 8, |[_, y]| y >= 6, |[x, y]| (x + y) % 2 == 0, |[x, y]| (x / 3 + y / 3) % 2 == 0];
    let windows: &[u32] = if cx.full() { &[2, 5, 8, 32] } else { &[5, 8] };
    for (name, differ) in DIFFERENCES {
        for is_other in patterns {
            for &window in windows {
                for other_is_lit in [false, true] {
                    let mut picture = wall(17, 13, window);
                    picture.diffuse = vec![1, 1];
                    for at in 0..picture.input.len() {
                        let other = is_other(picture.place(at));
                        if other {
                            differ(&mut picture.gbuffer[at]);
                        }
                        picture.input[at] = radiance([if other == other_is_lit { 3.0 } else { 0.0 }; 3]);
                    }
                    unmixed(cx, &picture).map_err(|f| f.within(name))?;
                }
            }
        }
    }
    Ok(())
}

/// Where there was no light there is none, and where it was the same all over, it still is.
fn unmixed<B: Backend>(cx: &Context<'_, B>, picture: &Picture) -> Check {
    let got = filtered(cx, picture)?;
    let mut evidence = Evidence::new(format!("window {}", picture.params.window), shape(picture));
    for (at, texel) in got.iter().enumerate() {
        let want = f64::from(picture.input[at].rgb[0]);
        let error = want * rounding(picture.window(at).len());
        for value in texel.rgb {
            evidence.interval(at, "rgb", value, want - error, want + error, "no other surface's light");
        }
    }
    evidence.finish()
}

/// What shows nothing has material 0 and may hold anything else: it is nobody's neighbour, and keeps its light.
fn nothing_is_no_surface<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut picture = noisy_wall(&mut Random::new(cx.options.seed ^ 21), 11, 9, 4);
    for at in (0..99).step_by(3) {
        picture.gbuffer[at].triangle = NO_HIT;
    }
    let got = agreed(cx, &picture)?;
    let copied = (0..99).step_by(3).all(|at| got[at] == picture.input[at]);
    ensure(copied, || "light of pixels that show nothing is changed".into())
}

/// A plane, tilted so that its floats round, up to the horizon: depths of neighbours differ tenfold, and all of them are joined.
fn a_floor_at_grazing_angles<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 22);
    for window in [3, 8, 32] {
        let mut picture = wall(23, 31, window);
        picture.params.footprint = 1.0 / 32.0;
        picture.input = noise(&mut random, picture.input.len());
        let turn = DMat3::from_axis_angle(DVec3::new(0.36, 0.48, 0.8), 0.7);
        for at in 0..picture.gbuffer.len() {
            let [x, y] = picture.place(at);
            // Half a pixel below the horizon and on.
            let depth = 32.0 / (y as f64 + 0.5);
            let position = turn * DVec3::new((x as f64 - 11.0) / 32.0 * depth, -1.0, -depth);
            let normal = (turn * DVec3::Y).as_vec3().to_array();
            let texel = &mut picture.gbuffer[at];
            (texel.position, texel.depth) = (position.as_vec3().to_array(), depth as f32);
            (texel.geometric_normal, texel.shading_normal) = (normal, normal);
        }
        let got = agreed(cx, &picture)?;
        all_joined(&picture, &got)?;
    }
    Ok(())
}

/// What rises by as much as it recedes is joined over the whole window, which the limit is made for.
fn a_slope_of_45_degrees_is_joined<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 23);
    for window in [2, 5, 16, 31] {
        let mut picture = noisy_wall(&mut random, 40, 9, window);
        // The wall's pixels are a unit apart, ⅛·8; its plane is known as one that faces the viewer.
        for at in 0..picture.gbuffer.len() {
            picture.gbuffer[at].position[2] -= picture.place(at)[0] as f32;
        }
        let got = agreed(cx, &picture)?;
        all_joined(&picture, &got)?;
    }
    Ok(())
}

/// White pixels hold the mean of their windows, whatever they show.
fn all_joined(picture: &Picture, got: &[super::RadianceTexel]) -> Check {
    let mut evidence = Evidence::new("the window's mean", shape(picture));
    for (at, texel) in got.iter().enumerate() {
        let window = picture.window(at);
        let weights: u32 = window.iter().map(|(_, quarters)| quarters).sum();
        for c in 0..3 {
            let light = |&(other, quarters): &(usize, u32)| {
                f64::from(quarters) * f64::from(picture.input[other].rgb[c])
            };
            let mean = window.iter().map(light).sum::<f64>() / f64::from(weights);
            let error = mean * rounding(window.len());
            evidence.interval(at, "rgb", texel.rgb[c], mean - error, mean + error, "all are joined");
        }
    }
    evidence.finish()
}

/// A footprint of 0: a flat wall is joined, and nothing off its plane. A cosine of 1: what faces the same way, as these normals are exact.
fn narrow_limits<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut picture = noisy_wall(&mut Random::new(cx.options.seed ^ 24), 15, 11, 5);
    picture.params.footprint = 0.0;
    let got = agreed(cx, &picture)?;
    all_joined(&picture, &got)?;
    let upright = FilterIndirectParams { least_cosine: 1.0, ..picture.params };
    all_joined(&picture, &filtered(cx, &Picture { params: upright, ..picture.clone() })?)?;
    for at in (0..picture.gbuffer.len()).step_by(2) {
        picture.gbuffer[at].position[2] += 1.0 / 1_024.0;
    }
    agrees(cx, &picture)
}

/// A pixel that meets no limit, even beside itself, counts in its own mean no more than others do, and keeps its light where there
/// are none.
fn pixels_that_are_not_their_own_neighbours<B: Backend>(cx: &Context<'_, B>) -> Check {
    let [p, q] =
        [0.5, 2.0].map(|x| GBufferTexel { shading_normal: [x, 0.0, 0.0], ..wall(1, 1, 2).gbuffer[0] });
    let behind = GBufferTexel { depth: -8.0, ..p };
    let picture = Picture {
        gbuffer: vec![p, q, p, p, behind, q],
        input: [0.5, 3.0, 7.0, 5.0, 0.5, 2.0].map(|light| radiance([light; 3])).into(),
        ..wall(6, 1, 2)
    };
    let got = filtered(cx, &picture)?;
    // q shares with such pixels beside it.
    let want = [3.0, (0.25 + 3.0 + 3.5) / 2.0, 3.0, 5.0, 0.5, (2.0 + 0.25) / 1.5];
    let same = got.iter().zip(want).all(|(texel, want)| texel.rgb == [want; 3]);
    ensure(same, || format!("{got:?}, want {want:?}"))
}

/// Limits that nothing exceeds: all of a material is joined, whichever way it faces.
fn wide_limits<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 25);
    let mut picture = noisy_wall(&mut random, 15, 11, 6);
    (picture.params.least_cosine, picture.params.footprint) = (-2.0, 1e6);
    for texel in &mut picture.gbuffer {
        texel.shading_normal = random.direction().as_vec3().to_array();
        texel.geometric_normal = random.direction().as_vec3().to_array();
        texel.position[2] += random.between(-9.0, 9.0) as f32;
    }
    let got = agreed(cx, &picture)?;
    all_joined(&picture, &got)
}
