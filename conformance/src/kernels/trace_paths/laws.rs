//! Laws of `trace_paths`: what integer sums promise on any one backend, bit for bit.

use super::film::{wide, words};
use super::{params, traced};
use crate::compare::{Shape, exact};
use crate::scenes::compiled;
use crate::trial::{Check, Context, Failure, Listing, ensure, list_trials};
use bytemuck::Zeroable;
use twinlight_core::kernels::trace_paths::{FilmTexel, SAMPLER_SOBOL, TracePathsParams};
use twinlight_core::scene::{Camera, CompiledScene, Light, Material, NOTHING_HIDES, Scene};
use twinlight_core::{Backend, Error};
use twinlight_fixtures::meshes::quad;
use twinlight_fixtures::scenes;

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "trace_paths":
        any_split_gives_the_same_film, sums_carry_and_accumulate, repeated, seeds_and_samples_differ,
        direct_light_ignores_later_bounces, bounces_only_add, image_sizes, parameters_are_checked,
        g9_nothing_and_darkness, t5_no_rejected_sample, t7_camera_in_a_light,
        nothing_hides_a_light_where_the_scene_says_so,
    );
}

const SIZE: (u32, u32) = (13, 9);
const LINE: Shape = Shape::Image { width: 13 };

/// A scene with diffuse, glossy, mirror and glass surfaces.
fn mixed() -> (Scene, CompiledScene) {
    let mut scene = scenes::cornell();
    for (at, material) in scene.materials.iter_mut().enumerate().filter(|(_, m)| m.emission == [0.0; 3]) {
        if at % 2 == 1 {
            material.specular_f0 = [0.3, 0.2, 0.1];
            material.roughness = 0.4;
        }
    }
    let compiled = compiled(&scene);
    (scene, compiled)
}

fn sobol(scene: &Scene, compiled: &CompiledScene, samples: u32) -> Result<TracePathsParams, Failure> {
    let params = params(scene, compiled, SIZE, samples, None)?;
    Ok(TracePathsParams { sampler: SAMPLER_SOBOL, ..params })
}

/// Pixels, samples and passes in any cut and order: the same film.
fn any_split_gives_the_same_film<B: Backend>(cx: &Context<'_, B>) -> Check {
    let (scene, compiled) = mixed();
    let whole = sobol(&scene, &compiled, 7)?;
    let want = traced(cx.backend, &compiled, &whole)?;
    let resident = cx.backend.upload_scene(&compiled)?;
    any_split(cx, &whole, &want, |part, film| cx.backend.trace_paths(&resident, part, film))
}

/// Adds the parts of 117 pixels with 7 samples in several cuts, last parts first, and compares the film with `want`.
pub(crate) fn any_split<B: Backend>(
    cx: &Context<'_, B>,
    whole: &TracePathsParams,
    want: &[FilmTexel],
    add: impl Fn(&TracePathsParams, &mut B::Buffer<FilmTexel>) -> twinlight_core::Result<()>,
) -> Check {
    for (name, pixel_cuts, sample_cuts) in [
        ("samples", &[0, 117][..], &[0, 1, 4, 7][..]),
        ("pixels", &[0, 1, 64, 65, 100, 117], &[0, 7]),
        ("both", &[0, 40, 117], &[0, 5, 6, 7]),
    ] {
        let mut film = cx.backend.zeroed::<FilmTexel>(want.len())?;
        // Last parts first: order must not show.
        for s in sample_cuts.windows(2).rev() {
            for p in pixel_cuts.windows(2).rev() {
                let part = TracePathsParams {
                    pixel_begin: p[0],
                    pixel_count: p[1] - p[0],
                    sample_begin: s[0],
                    sample_count: s[1] - s[0],
                    ..*whole
                };
                add(&part, &mut film)?;
            }
        }
        exact(cx, name, &cx.backend.download(&film)?, want, LINE)?;
    }
    Ok(())
}

/// A film that already holds sums just below 2³², 2⁶³ and the largest count gets the new ones on top, with carry.
pub(crate) fn any_start<B: Backend>(
    cx: &Context<'_, B>,
    fresh: &[FilmTexel],
    add: impl Fn(&mut B::Buffer<FilmTexel>) -> twinlight_core::Result<()>,
) -> Check {
    for start in [0xffff_ffff_u64, 0x7fff_ffff_ffff_0000, 5] {
        let [direct, indirect] = [[words(start); 3]; 2];
        let held = FilmTexel { direct, indirect, luminance_squared: words(start), samples: 9, rejected: 0 };
        let mut film = cx.backend.upload(&vec![held; fresh.len()])?;
        add(&mut film)?;
        let plus = |w: [u32; 2]| words(wide(w) + start);
        let on_top = |t: &FilmTexel| FilmTexel {
            direct: t.direct.map(plus),
            indirect: t.indirect.map(plus),
            luminance_squared: plus(t.luminance_squared),
            samples: t.samples + 9,
            rejected: t.rejected,
        };
        let want: Vec<FilmTexel> = fresh.iter().map(on_top).collect();
        exact(cx, "film", &cx.backend.download(&film)?, &want, LINE)
            .map_err(|f| f.within(&format!("from {start:#x}")))?;
    }
    Ok(())
}

fn sums_carry_and_accumulate<B: Backend>(cx: &Context<'_, B>) -> Check {
    let (scene, compiled) = mixed();
    let params = sobol(&scene, &compiled, 3)?;
    let fresh = traced(cx.backend, &compiled, &params)?;
    let resident = cx.backend.upload_scene(&compiled)?;
    any_start(cx, &fresh, |film| cx.backend.trace_paths(&resident, &params, film))
}

fn repeated<B: Backend>(cx: &Context<'_, B>) -> Check {
    let (scene, compiled) = mixed();
    let params = sobol(&scene, &compiled, 5)?;
    let first = traced(cx.backend, &compiled, &params)?;
    exact(cx, "film of a second run", &traced(cx.backend, &compiled, &params)?, &first, LINE)
}

/// Other seeds and other samples are other paths.
fn seeds_and_samples_differ<B: Backend>(cx: &Context<'_, B>) -> Check {
    let (scene, compiled) = mixed();
    let one = sobol(&scene, &compiled, 2)?;
    let film = traced(cx.backend, &compiled, &one)?;
    for (name, other) in [
        ("seed", TracePathsParams { seed: one.seed + 1, ..one }),
        ("first sample", TracePathsParams { sample_begin: 2, ..one }),
        ("sampler", TracePathsParams { sampler: 1 - one.sampler, ..one }),
    ] {
        let other = traced(cx.backend, &compiled, &other)?;
        let same =
            film.iter().zip(&other).filter(|(a, b)| a.direct == b.direct && wide(a.direct[0]) > 0).count();
        ensure(same * 4 < film.len(), || format!("another {name}, but {same} pixels keep their light"))?;
    }
    Ok(())
}

/// What is scattered at most once does not depend on how paths go on.
fn direct_light_ignores_later_bounces<B: Backend>(cx: &Context<'_, B>) -> Check {
    let (scene, compiled) = mixed();
    let all = sobol(&scene, &compiled, 5)?;
    let one = TracePathsParams { max_bounces: 1, ..all };
    let direct =
        |film: Vec<FilmTexel>| -> Vec<u64> { film.iter().flat_map(|t| t.direct.map(wide)).collect() };
    let once = traced(cx.backend, &compiled, &one)?;
    let indirect = once.iter().flat_map(|t| t.indirect).filter(|w| wide(*w) > 0).count();
    ensure(indirect == 0, || format!("{indirect} indirect sums with one bounce"))?;
    exact(cx, "direct sums", &direct(traced(cx.backend, &compiled, &all)?), &direct(once), Shape::Line)
}

/// With the same numbers, a longer path is a shorter one and more: no sum falls.
fn bounces_only_add<B: Backend>(cx: &Context<'_, B>) -> Check {
    let (scene, compiled) = mixed();
    let all = TracePathsParams { roulette_begin: 8, ..sobol(&scene, &compiled, 4)? };
    let mut before = traced(cx.backend, &compiled, &TracePathsParams { max_bounces: 0, ..all })?;
    let seen = before.iter().filter(|t| wide(t.direct[0]) > 0).count();
    ensure(seen > 0 && seen < before.len() / 2, || format!("{seen} pixels see the lamp without a bounce"))?;
    for max_bounces in 1..6 {
        let after = traced(cx.backend, &compiled, &TracePathsParams { max_bounces, ..all })?;
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

fn image_sizes<B: Backend>(cx: &Context<'_, B>) -> Check {
    let (scene, compiled) = mixed();
    for size in [(1, 1), (1, 67), (67, 1), (64, 2), (65, 5)] {
        let params = params(&scene, &compiled, size, 2, Some(3))?;
        let film = traced(cx.backend, &compiled, &params)?;
        let wrong = film.iter().filter(|t| t.samples != 2 || t.rejected != 0).count();
        ensure(wrong == 0, || format!("{size:?}: {wrong} pixels without their two samples"))?;
    }
    Ok(())
}

fn parameters_are_checked<B: Backend>(cx: &Context<'_, B>) -> Check {
    let (scene, compiled) = mixed();
    let good = sobol(&scene, &compiled, 2)?;
    let resident = cx.backend.upload_scene(&compiled)?;
    for (name, bad, len) in [
        ("film too short", good, 116),
        ("film too long", good, 118),
        ("pixels beyond the image", TracePathsParams { pixel_begin: 1, ..good }, 117),
        ("pixel range overflows", TracePathsParams { pixel_begin: 2, pixel_count: u32::MAX, ..good }, 117),
        ("samples overflow", TracePathsParams { sample_begin: u32::MAX, ..good }, 117),
        ("unknown sampler", TracePathsParams { sampler: 2, ..good }, 117),
        ("endless paths", TracePathsParams { roulette_begin: u32::MAX, ..good }, 117),
    ] {
        let mut film = cx.backend.zeroed::<FilmTexel>(len)?;
        match cx.backend.trace_paths(&resident, &bad, &mut film) {
            Err(Error::InvalidInput { .. }) => {}
            Err(Error::Unsupported(what)) => return Err(Failure::Skip(what)),
            other => return Err(Failure::Mismatch(format!("{name}: {other:?}, want InvalidInput"))),
        }
        exact(cx, name, &cx.backend.download(&film)?, &vec![FilmTexel::zeroed(); len], Shape::Line)?;
    }
    Ok(())
}

/// No triangle, or no light: black, with every sample counted.
fn g9_nothing_and_darkness<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut dark = scenes::cornell();
    dark.lights.clear();
    dark.materials.iter_mut().for_each(|m| m.emission = [0.0; 3]);
    for (name, scene) in [("empty", scenes::empty()), ("dark", dark)] {
        let compiled = compiled(&scene);
        let params = params(&scene, &compiled, SIZE, 3, None)?;
        let black = FilmTexel { samples: 3, ..FilmTexel::zeroed() };
        exact(cx, name, &traced(cx.backend, &compiled, &params)?, &[black; 117], LINE)?;
    }
    Ok(())
}

/// No sample of any fixture is infinite, negative or NaN, and every film has light.
fn t5_no_rejected_sample<B: Backend>(cx: &Context<'_, B>) -> Check {
    let samples = if cx.full() { 32 } else { 4 };
    for name in ["cornell", "materials", "lights", "veach", "axis", "textured", "environment", "furnace"] {
        let Some(scene) = scenes::builtin(name) else { continue };
        let compiled = compiled(&scene);
        let film = traced(cx.backend, &compiled, &params(&scene, &compiled, SIZE, samples, None)?)?;
        let rejected: u32 = film.iter().map(|t| t.rejected).sum();
        let lit = film.iter().filter(|t| wide(t.direct[1]) + wide(t.indirect[1]) > 0).count();
        ensure(rejected == 0, || format!("{name}: {rejected} samples rejected"))?;
        ensure(lit > 0, || format!("{name}: black"))?;
    }
    Ok(())
}

/// A camera inside a sphere light, on an emissive wall, and a light that touches the floor: finite numbers.
fn t7_camera_in_a_light<B: Backend>(cx: &Context<'_, B>) -> Check {
    let base = scenes::furnace(0.5, 0.25);
    let sphere = |center: [f32; 3], radius: f32| {
        let mut scene = base.clone();
        scene.lights.push(Light::Sphere { center, radius, radiance: [1.0; 3] });
        scene
    };
    let mut on_wall = base.clone();
    if let Some(camera) = &mut on_wall.camera {
        camera.position = [1.0, 0.0, 0.0];
    }
    for (name, scene) in [
        ("in a sphere light", sphere([0.3, -0.2, 0.4], 0.25)),
        ("light touching a wall", sphere([0.0, -0.75, 0.0], 0.25)),
        ("on an emissive wall", on_wall),
    ] {
        let compiled = compiled(&scene);
        let film = traced(cx.backend, &compiled, &params(&scene, &compiled, SIZE, 16, Some(4))?)?;
        let rejected: u32 = film.iter().map(|t| t.rejected).sum();
        ensure(rejected == 0, || format!("{name}: {rejected} samples rejected"))?;
    }
    Ok(())
}

/// A floor under a point light, and a roof over it or none.
pub(crate) fn floor_and_roof(has_roof: bool) -> Scene {
    let mut scene = Scene { materials: vec![Material::diffuse("grey", [0.6; 3])], ..Scene::default() };
    scene.add_mesh(quad([-2.0, 0.0, 2.0], [2.0, 0.0, 2.0], [2.0, 0.0, -2.0], [-2.0, 0.0, -2.0]));
    if has_roof {
        scene.add_mesh(quad([-2.0, 1.0, 2.0], [2.0, 1.0, 2.0], [2.0, 1.0, -2.0], [-2.0, 1.0, -2.0]));
    }
    scene.lights.push(Light::Point { position: [0.3, 2.0, 0.2], intensity: [9.0, 6.0, 3.0] });
    // Under the roof.
    scene.camera = Some(Camera {
        position: [0.1, 0.8, 1.5],
        target: [0.0, 0.0, -0.5],
        up: [0.0, 1.0, 0.0],
        vfov_degrees: 40.0,
    });
    scene
}

/// With its shadow rays the roof's floor is dark; without them it is lit as if there were no roof.
fn nothing_hides_a_light_where_the_scene_says_so<B: Backend>(cx: &Context<'_, B>) -> Check {
    let films = |has_roof: bool, flags: u32| -> Result<Vec<FilmTexel>, Failure> {
        let scene = floor_and_roof(has_roof);
        let mut compiled = compiled(&scene);
        compiled.environment.flags = flags;
        let params = params(&scene, &compiled, SIZE, 4, Some(1))?;
        traced(cx.backend, &compiled, &params)
    };
    let (open, under_roof) = (films(false, 0)?, films(true, 0)?);
    let light = |film: &[FilmTexel]| film.iter().map(|texel| wide(texel.direct[0])).sum::<u64>();
    ensure(light(&under_roof) == 0 && light(&open) > 0, || {
        "the roof hides nothing: the trial has no power".into()
    })?;
    exact(cx, "as if there were no roof", &films(true, NOTHING_HIDES)?, &open, LINE)
}
