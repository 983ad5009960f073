//! Laws of `walk_lhb`: what it shares with `trace_paths`, and what integer sums promise on any one backend, bit for bit.

use super::{Prepared, walked};
use crate::compare::{Shape, exact};
use crate::kernels::strict_only;
use crate::kernels::trace_paths::film::wide;
use crate::kernels::trace_paths::laws::{any_split, any_start};
use crate::kernels::trace_paths::{params, traced};
use crate::oracle::trace_paths as known;
use crate::scenes::compiled;
use crate::trial::{Check, Context, Failure, Listing, ensure, list_trials};
use twinlight_core::Backend;
use twinlight_core::kernels::trace_paths::{FilmTexel, SAMPLER_SOBOL, TracePathsParams};
use twinlight_core::kernels::walk_lhb::{WalkLhbBlock, WalkLhbParams};
use twinlight_core::scene::{CompiledScene, Light, Scene};
use twinlight_fixtures::scenes;

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "walk_lhb":
        emission_is_the_reference, alone_it_is_the_reference, any_split_gives_the_same_film,
        sums_carry_and_accumulate, repeated, seeds_and_samples_differ, direct_light_ignores_later_bounces,
        bounces_only_add, patterns_repeat,
    );
}

pub(super) const SIZE: (u32, u32) = (13, 9);
pub(super) const LINE: Shape = Shape::Image { width: 13 };

/// The Cornell box with some glossy walls, and seven samples of it.
pub(super) fn mixed<B: Backend>(
    cx: &Context<'_, B>,
) -> Result<(CompiledScene, TracePathsParams, Prepared<B>), Failure> {
    let mut scene = scenes::cornell();
    for (at, material) in scene.materials.iter_mut().enumerate().filter(|(_, m)| m.emission == [0.0; 3]) {
        if at % 2 == 1 {
            material.specular_f0 = [0.3, 0.2, 0.1];
            material.roughness = 0.4;
        }
    }
    let compiled = compiled(&scene);
    let call = TracePathsParams { sampler: SAMPLER_SOBOL, ..params(&scene, &compiled, SIZE, 7, None)? };
    let prepared = Prepared::new(cx.backend, &compiled, "icosahedron:80", 24)?;
    Ok((compiled, call, prepared))
}

/// Without a bounce nothing is scattered: the film of `trace_paths`.
fn emission_is_the_reference<B: Backend>(cx: &Context<'_, B>) -> Check {
    strict_only(cx)?;
    for name in ["cornell", "furnace", "materials", "lights", "environment"] {
        let Some(scene) = scenes::builtin(name) else { continue };
        let compiled = compiled(&scene);
        let call = params(&scene, &compiled, SIZE, 5, Some(0))?;
        let prepared = Prepared::new(cx.backend, &compiled, "octahedron:8", 8)?;
        let want = traced(cx.backend, &compiled, &call)?;
        exact(cx, name, &walked(cx.backend, &prepared, &call)?, &want, LINE)?;
    }
    Ok(())
}

/// Where a scattered ray meets nothing, traced or looked up, and no triangle emits, the films are the same: floors under lights that
/// are points, spheres and skies, mirrors and glass, with any number of bounces.
fn alone_it_is_the_reference<B: Backend>(cx: &Context<'_, B>) -> Check {
    strict_only(cx)?;
    let mut cases = known::punctual_lights();
    cases.extend(known::area_lights().into_iter().filter(|case| case.name == "sphere light"));
    cases.extend(known::environments());
    cases.extend(known::glossy());
    cases.extend(known::specular());
    for case in cases {
        let compiled = compiled(&case.scene);
        for (sampler, bounces) in [(SAMPLER_SOBOL, case.bounces), (1, Some(1))] {
            let call = TracePathsParams { sampler, ..params(&case.scene, &compiled, SIZE, 6, bounces)? };
            let prepared = Prepared::new(cx.backend, &compiled, "icosahedron:80", 32)?;
            let want = traced(cx.backend, &compiled, &call)?;
            exact(cx, &case.name, &walked(cx.backend, &prepared, &call)?, &want, LINE)?;
        }
    }
    Ok(())
}

/// Pixels, samples and passes in any cut and order: the same film.
fn any_split_gives_the_same_film<B: Backend>(cx: &Context<'_, B>) -> Check {
    let (_, whole, prepared) = mixed(cx)?;
    let want = walked(cx.backend, &prepared, &whole)?;
    any_split(cx, &whole, &want, |part, film| prepared.walk(cx.backend, part, film))
}

fn sums_carry_and_accumulate<B: Backend>(cx: &Context<'_, B>) -> Check {
    let (_, call, prepared) = mixed(cx)?;
    any_start(cx, &walked(cx.backend, &prepared, &call)?, |film| prepared.walk(cx.backend, &call, film))
}

fn repeated<B: Backend>(cx: &Context<'_, B>) -> Check {
    let (_, call, prepared) = mixed(cx)?;
    let first = walked(cx.backend, &prepared, &call)?;
    exact(cx, "film of a second run", &walked(cx.backend, &prepared, &call)?, &first, LINE)
}

/// Other seeds and other samples are other paths, and another exponent is another scale.
fn seeds_and_samples_differ<B: Backend>(cx: &Context<'_, B>) -> Check {
    let (_, call, prepared) = mixed(cx)?;
    let one = TracePathsParams { sample_count: 2, ..call };
    let film = walked(cx.backend, &prepared, &one)?;
    for (name, other) in [
        ("seed", TracePathsParams { seed: one.seed + 1, ..one }),
        ("first sample", TracePathsParams { sample_begin: 2, ..one }),
        ("sampler", TracePathsParams { sampler: 1 - one.sampler, ..one }),
        ("exponent", TracePathsParams { film_exponent: one.film_exponent - 3, ..one }),
    ] {
        let other = walked(cx.backend, &prepared, &other)?;
        let same =
            film.iter().zip(&other).filter(|(a, b)| a.direct == b.direct && wide(a.direct[0]) > 0).count();
        ensure(same * 4 < film.len(), || format!("another {name}, but {same} pixels keep their light"))?;
    }
    Ok(())
}

/// What is scattered at most once does not depend on how paths go on.
fn direct_light_ignores_later_bounces<B: Backend>(cx: &Context<'_, B>) -> Check {
    let (_, all, prepared) = mixed(cx)?;
    let one = TracePathsParams { max_bounces: 1, ..all };
    let direct = |film: &[FilmTexel]| film.iter().flat_map(|t| t.direct.map(wide)).collect::<Vec<u64>>();
    let once = walked(cx.backend, &prepared, &one)?;
    let indirect = once.iter().flat_map(|t| t.indirect).filter(|w| wide(*w) > 0).count();
    ensure(indirect == 0, || format!("{indirect} indirect sums with one bounce"))?;
    let whole = walked(cx.backend, &prepared, &all)?;
    exact(cx, "direct sums", &direct(&whole), &direct(&once), Shape::Line)
}

/// With the same numbers, a longer path is a shorter one and more: no sum falls.
fn bounces_only_add<B: Backend>(cx: &Context<'_, B>) -> Check {
    let (_, call, prepared) = mixed(cx)?;
    let all = TracePathsParams { roulette_begin: 8, ..call };
    let mut before = walked(cx.backend, &prepared, &TracePathsParams { max_bounces: 0, ..all })?;
    for max_bounces in 1..6 {
        let after = walked(cx.backend, &prepared, &TracePathsParams { max_bounces, ..all })?;
        let total = |t: &FilmTexel, c: usize| wide(t.direct[c]) + wide(t.indirect[c]);
        let fallen =
            before.iter().zip(&after).filter(|(b, a)| (0..3).any(|c| total(a, c) < total(b, c))).count();
        ensure(fallen == 0, || format!("{fallen} pixels lose light by bounce {max_bounces}"))?;
        let light = |film: &[FilmTexel]| film.iter().map(|t| total(t, 1)).sum::<u64>();
        ensure(light(&after) > light(&before), || format!("bounce {max_bounces} brings no light"))?;
        before = after;
    }
    Ok(())
}

/// The Cornell box by the light of a point.
fn point_lit(glossy: bool) -> Scene {
    let mut scene = scenes::cornell();
    for material in &mut scene.materials {
        material.emission = [0.0; 3];
        (material.specular_f0, material.roughness) = ([if glossy { 0.2 } else { 0.0 }; 3], 0.4);
    }
    scene.lights.push(Light::Point { position: [0.1, 0.6, 0.2], intensity: [0.5; 3] });
    scene
}

/// Interleaved: the first tile has the film of its pixels' own numbers, others have sampled lights by their own and the rest by
/// other numbers, and where nothing is diffuse nothing changes.
fn patterns_repeat<B: Backend>(cx: &Context<'_, B>) -> Check {
    let (width, tile) = (SIZE.0 as usize, 4);
    for glossy in [false, true] {
        let scene = point_lit(glossy);
        let compiled = compiled(&scene);
        let call = params(&scene, &compiled, SIZE, 7, Some(3))?;
        let prepared = Prepared::new(cx.backend, &compiled, "icosahedron:80", 24)?;
        let own = walked(cx.backend, &prepared, &call)?;
        let lookup = WalkLhbBlock { interleave: tile as u32, ..prepared.buffers.lookup };
        let mut film = cx.backend.zeroed::<FilmTexel>(own.len())?;
        prepared.walk_as(cx.backend, &WalkLhbParams { call, lookup }, &mut film)?;
        let film = cx.backend.download(&film)?;
        if glossy {
            exact(cx, "film without diffuse surfaces", &film, &own, LINE)?;
            continue;
        }
        let direct = |film: &[FilmTexel]| film.iter().flat_map(|t| t.direct.map(wide)).collect::<Vec<u64>>();
        exact(cx, "direct sums", &direct(&film), &direct(&own), Shape::Line)?;
        let is_first = |i: usize| i % width < tile && i / width < tile;
        let kept =
            |inside: bool| (0..own.len()).filter(|&i| is_first(i) == inside && film[i] == own[i]).count();
        ensure(kept(true) == tile * tile, || {
            format!("{} pixels of the first tile keep their light", kept(true))
        })?;
        // Where nothing is met, numbers decide nothing.
        ensure(kept(false) * 4 < own.len(), || format!("{} other pixels keep their light", kept(false)))?;
    }
    Ok(())
}
