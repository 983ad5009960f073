// kernel family: trace_paths
// contract core/src/kernels/trace_paths.rs
// cpu backend-cpu/src/kernels/trace_paths.rs
// gpu backend-gpu/src/kernels/trace_paths.wgsl
// oracle conformance/src/oracle/trace_paths.rs
//! Cases and laws of `trace_paths`: pictures whose radiance is known, and the film's integers, which are exact.

pub(super) mod film;
pub(super) mod laws;

use crate::kernels::pictures_wanted;
use crate::oracle::trace_paths::{self as oracle, Known};
use crate::scenes::compiled;
use crate::trial::{Check, Context, Failure, Listing, ensure, list_trials};
use film::Mean;
use twinlight_core::Backend;
use twinlight_core::kernels::trace_paths::{
    FilmTexel, SAMPLER_INDEPENDENT, SAMPLER_SOBOL, TracePathsParams, UNLIMITED_BOUNCES,
};
use twinlight_core::scene::{Camera, CompiledScene, Scene};

/// Lists the trials.
pub fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "trace_paths":
        t1_closed_furnace, t2_sphere_room, punctual_lights, area_lights, environments, mirrors_and_glass,
        t4_glossy_under_an_even_sky,
    );
    laws::list(list);
}

/// Parameters for a whole picture, or the reason there are none.
pub(crate) fn params(
    scene: &Scene,
    compiled: &CompiledScene,
    size: (u32, u32),
    samples: u32,
    bounces: Option<u32>,
) -> Result<TracePathsParams, Failure> {
    let camera = Camera::of_scene(scene)
        .ok_or_else(|| Failure::Mismatch("a scene of the suite has no camera and no bounds".into()))?;
    Ok(TracePathsParams {
        camera: camera.record(size.0, size.1, compiled.origin)?,
        width: size.0,
        height: size.1,
        pixel_begin: 0,
        pixel_count: size.0 * size.1,
        sample_begin: 0,
        sample_count: samples,
        seed: 1,
        max_bounces: bounces.unwrap_or(UNLIMITED_BOUNCES),
        roulette_begin: 4,
        sampler: SAMPLER_INDEPENDENT,
        film_exponent: compiled.film_exponent,
        moment_exponent: compiled.moment_exponent,
    })
}

/// A fresh film with the samples of `params`.
pub(crate) fn traced<B: Backend>(
    backend: &B,
    compiled: &CompiledScene,
    params: &TracePathsParams,
) -> Result<Vec<FilmTexel>, Failure> {
    let resident = backend.upload_scene(compiled)?;
    let mut film = backend.zeroed::<FilmTexel>((params.width * params.height) as usize)?;
    backend.trace_paths(&resident, params, &mut film)?;
    Ok(backend.download(&film)?)
}

/// Standard errors by which a mean may miss: with fixed seeds this is decided once, and 4.5 leaves 7·10⁻⁶ to chance.
const SIGMAS: f64 = 4.5;

/// Largest relative standard error of a picture's mean at which a bias of 2 % still shows.
const POWER: f64 = 0.004;

fn known<B: Backend>(cx: &Context<'_, B>, cases: &[Known]) -> Check {
    pictures_wanted(cx)?;
    for case in cases {
        check(cx, case).map_err(|f| f.within(&case.name))?;
    }
    Ok(())
}

/// The mean over the picture against the known radiance, with independent samples, whose spread is known, and with
/// Sobol points, whose error is no larger.
fn check<B: Backend>(cx: &Context<'_, B>, case: &Known) -> Check {
    let compiled = compiled(&case.scene);
    let (size, samples) = if cx.full() { ((32, 32), 256) } else { ((16, 16), 256) };
    let mut params = params(&case.scene, &compiled, size, samples, case.bounces)?;
    params.seed = params.seed.wrapping_add(cx.options.seed as u32);
    let mean = Mean::of(&traced(cx.backend, &compiled, &params)?, &params)?;
    let error = mean.standard_error();
    ensure(error <= POWER, || {
        format!("relative standard error {error} hides biases; the check has no power")
    })?;
    let mut means = vec![("independent", mean)];
    // Sobol points on every scene double the time; their bits are compared between backends at every effort.
    if cx.full() {
        params.sampler = SAMPLER_SOBOL;
        means.push(("Sobol", Mean::of(&traced(cx.backend, &compiled, &params)?, &params)?));
    }
    for (name, mean) in means {
        for channel in 0..3 {
            let (got, want) = (mean.radiance[channel], case.radiance[channel]);
            let allowed = want * (SIGMAS * error + case.slack);
            ensure((got - want).abs() <= allowed, || {
                format!(
                    "{name} samples, channel {channel}: got {got:.6}, want {want:.6} ± {allowed:.6} ({:+.2} %)",
                    (got / want - 1.0) * 100.0
                )
            })?;
        }
    }
    Ok(())
}

/// Closed furnaces of albedo 0, 0.5, 0.9 and 1: radiance Lₑ·Σ ρᵏ to the bounce cap.
fn t1_closed_furnace<B: Backend>(cx: &Context<'_, B>) -> Check {
    known(cx, &oracle::furnaces())
}

/// pbrt's sphere: a lamp in a diffuse sphere. Every adapter shows it at every effort: one answer that no backend gave.
fn t2_sphere_room<B: Backend>(cx: &Context<'_, B>) -> Check {
    check(cx, &oracle::sphere_room())
}

fn punctual_lights<B: Backend>(cx: &Context<'_, B>) -> Check {
    known(cx, &oracle::punctual_lights())
}

/// Rectangle-to-point form factor, for the light and for the emissive mesh, and the sphere's irradiance.
fn area_lights<B: Backend>(cx: &Context<'_, B>) -> Check {
    known(cx, &oracle::area_lights())
}

fn environments<B: Backend>(cx: &Context<'_, B>) -> Check {
    known(cx, &oracle::environments())
}

fn mirrors_and_glass<B: Backend>(cx: &Context<'_, B>) -> Check {
    known(cx, &oracle::specular())
}

/// The GGX lobe's albedo by quadrature, from nearly smooth to rough.
fn t4_glossy_under_an_even_sky<B: Backend>(cx: &Context<'_, B>) -> Check {
    known(cx, &oracle::glossy())
}
