//! `trace`, `shade_primary` and `trace_paths` against their CPU twins: bit for bit in strict mode.

use crate::{Check, Target};
use bytemuck::{Pod, Zeroable};
use libtest_mimic::Failed;
use twinlight_backend_cpu::CpuBackend;
use twinlight_backend_gpu::{GpuBackend, Mode};
use twinlight_core::kernels::shade_primary::{GBufferTexel, ShadePrimaryParams};
use twinlight_core::kernels::trace::{Hit, Ray};
use twinlight_core::kernels::trace_paths::{FilmTexel, SAMPLER_SOBOL, TracePathsParams, UNLIMITED_BOUNCES};
use twinlight_core::math::fixed::to_f64;
use twinlight_core::scene::{CompiledScene, Limits, Scene, compile};
use twinlight_core::{Backend, Error};
use twinlight_fixtures::inputs;
use twinlight_fixtures::scenes::builtin;

pub const CHECKS: &[(&str, Check)] = &[
    ("hits are those of the CPU twin", hits),
    ("G-buffers are those of the CPU twin", gbuffers),
    ("films are those of the CPU twin", films),
    ("long paths rest between dispatches", long_paths),
    ("nothing is met in an empty scene", empty_scene),
    ("wrong sizes are refused", wrong_sizes),
];

/// Every kind of material and light, textures, an environment, nothing at all.
const SCENES: [&str; 7] = ["cornell", "materials", "lights", "veach", "axis", "textured", "environment"];
const WIDTH: u32 = 24;
const HEIGHT: u32 = 16;

/// Share of the elements that must have the same bits in portable mode. Statistics are conformance's job, this only
/// tells a broken kernel from a rounding one: no hit and no G-buffer texel was seen to differ on llvmpipe.
const PORTABLE_HITS: f64 = 0.9;

/// How well a film must agree in portable mode, where drivers round as they like while the random numbers are the same.
pub struct Tolerance {
    /// Greatest relative difference of a texel's light that counts as rounding.
    light: f64,
    /// Share of the texels that must differ by rounding only; in the others a path may have branched otherwise.
    share: f64,
}

/// A handful of vertices: of 3800 texels on llvmpipe, the worst was seen to differ by 9.5e-6, 99 % by less than 6e-7.
pub const FILMS: Tolerance = Tolerance { light: 1.0 / 65536.0, share: 0.99 };

/// 80 vertices and more, at each of which a position's error is carried on to the next wall and grows: on llvmpipe half
/// of the texels were seen to differ by 8e-5, 5 % by 2e-3, 1 % by 1.1e-2.
const LONG_PATHS: Tolerance = Tolerance { light: 1.0 / 64.0, share: 0.95 };

pub struct Pair {
    name: &'static str,
    scene: Scene,
    pub compiled: CompiledScene,
}

impl Pair {
    pub fn new(name: &'static str) -> Result<Self, Failed> {
        let scene = builtin(name).ok_or("no such scene")?;
        let compiled = compile(&scene, &Limits::default())?;
        Ok(Self { name, scene, compiled })
    }

    fn camera(&self) -> Result<twinlight_core::kernels::trace_paths::CameraRecord, Failed> {
        let camera = self.scene.camera.as_ref().ok_or("no camera")?;
        Ok(camera.record(WIDTH, HEIGHT, self.compiled.origin)?)
    }

    pub fn paths(&self, max_bounces: u32) -> Result<TracePathsParams, Failed> {
        Ok(TracePathsParams {
            camera: self.camera()?,
            width: WIDTH,
            height: HEIGHT,
            pixel_begin: 5,
            pixel_count: WIDTH * HEIGHT - 5,
            sample_begin: 3,
            sample_count: 3,
            seed: 7,
            max_bounces,
            roulette_begin: 3,
            sampler: SAMPLER_SOBOL,
            film_exponent: self.compiled.film_exponent,
            moment_exponent: self.compiled.moment_exponent,
        })
    }
}

fn hits(target: &Target) -> Result<(), Failed> {
    let gpu = GpuBackend::new(target.device()?.clone());
    for name in ["cornell", "materials", "axis"] {
        let pair = Pair::new(name)?;
        let mut rays = inputs::incoherent_rays(pair.compiled.bounds, 3000, 1);
        rays.extend(inputs::axis_rays(pair.compiled.bounds, 4));
        rays.push(Ray { origin: [0.0; 3], t_min: 0.0, direction: [0.0; 3], t_max: f32::INFINITY });
        let (cpu_hits, cpu_blocked) = trace(&CpuBackend::new(), &pair.compiled, &rays)?;
        let (gpu_hits, gpu_blocked) = trace(&gpu, &pair.compiled, &rays)?;
        let met = cpu_hits.iter().filter(|hit| hit.triangle != u32::MAX).count();
        if met < rays.len() / 10 {
            return Err(format!("{name}: only {met} of {} rays meet anything", rays.len()).into());
        }
        expect_twins(target, &format!("{name} hits"), &gpu_hits, &cpu_hits, PORTABLE_HITS)?;
        expect_twins(target, &format!("{name} any"), &gpu_blocked, &cpu_blocked, PORTABLE_HITS)?;
    }
    Ok(())
}

fn trace<B: Backend>(
    backend: &B,
    scene: &CompiledScene,
    rays: &[Ray],
) -> twinlight_core::Result<(Vec<Hit>, Vec<u32>)> {
    let scene = backend.upload_scene(scene)?;
    let rays_buffer = backend.upload(rays)?;
    let mut hits = backend.zeroed::<Hit>(rays.len())?;
    let mut blocked = backend.zeroed::<u32>(rays.len())?;
    backend.trace_closest(&scene, &rays_buffer, &mut hits)?;
    backend.trace_any(&scene, &rays_buffer, &mut blocked)?;
    Ok((backend.download(&hits)?, backend.download(&blocked)?))
}

fn gbuffers(target: &Target) -> Result<(), Failed> {
    let gpu = GpuBackend::new(target.device()?.clone());
    for name in SCENES {
        let pair = Pair::new(name)?;
        let params =
            ShadePrimaryParams { camera: pair.camera()?, width: WIDTH, height: HEIGHT, padding: [0; 2] };
        let want = shade(&CpuBackend::new(), &pair.compiled, &params)?;
        let got = shade(&gpu, &pair.compiled, &params)?;
        expect_twins(target, &format!("{name} G-buffer"), &got, &want, PORTABLE_HITS)?;
    }
    Ok(())
}

fn shade<B: Backend>(
    backend: &B,
    scene: &CompiledScene,
    params: &ShadePrimaryParams,
) -> twinlight_core::Result<Vec<GBufferTexel>> {
    let scene = backend.upload_scene(scene)?;
    let mut gbuffer = backend.zeroed((params.width * params.height) as usize)?;
    backend.shade_primary(&scene, params, &mut gbuffer)?;
    backend.download(&gbuffer)
}

fn films(target: &Target) -> Result<(), Failed> {
    for name in SCENES {
        let pair = Pair::new(name)?;
        compare_films(target, &pair, &pair.paths(UNLIMITED_BOUNCES)?, &FILMS)?;
    }
    let pair = Pair::new("cornell")?;
    for bounces in [0, 1, 2] {
        compare_films(target, &pair, &pair.paths(bounces)?, &FILMS)?;
    }
    Ok(())
}

/// Between walls of albedo 0.95 and no roulette before vertex 200, paths take more dispatches than one submission has.
fn long_paths(target: &Target) -> Result<(), Failed> {
    let scene = twinlight_fixtures::scenes::furnace(0.95, 1.0);
    let compiled = compile(&scene, &Limits::default())?;
    let pair = Pair { name: "furnace", scene, compiled };
    for max_bounces in [90, UNLIMITED_BOUNCES] {
        let params = TracePathsParams { roulette_begin: 80, ..pair.paths(max_bounces)? };
        compare_films(target, &pair, &params, &LONG_PATHS)?;
    }
    Ok(())
}

fn compare_films(
    target: &Target,
    pair: &Pair,
    params: &TracePathsParams,
    portable: &Tolerance,
) -> Result<(), Failed> {
    let gpu = GpuBackend::new(target.device()?.clone());
    let want = film(&CpuBackend::new(), &pair.compiled, params)?;
    let got = film(&gpu, &pair.compiled, params)?;
    expect_twin_films(target, pair, params, portable, [&got, &want])
}

/// `got` is `want`: bit for bit in strict mode.
pub fn expect_twin_films(
    target: &Target,
    pair: &Pair,
    params: &TracePathsParams,
    portable: &Tolerance,
    [got, want]: [&[FilmTexel]; 2],
) -> Result<(), Failed> {
    let begin = params.pixel_begin as usize;
    let samples_done = |texel: &FilmTexel| texel.samples == params.sample_count && texel.rejected == 0;
    if !got[begin..].iter().all(samples_done)
        || got[..begin].iter().any(|texel| *texel != FilmTexel::zeroed())
    {
        return Err(format!("{}: samples missing, rejected or astray", pair.name).into());
    }
    let what = format!("{} film, {} bounces", pair.name, params.max_bounces);
    if target.device()?.mode() == Mode::Strict {
        return expect_twins(target, &what, got, want, 1.0);
    }
    let texels = || got[begin..].iter().zip(&want[begin..]);
    let differs = |(got, want): &(&FilmTexel, &FilmTexel)| {
        let (got, want) = (light(got, params), light(want, params));
        (got - want).abs() > portable.light * got.max(want)
    };
    let differing = texels().filter(differs).count();
    if differing as f64 <= (1.0 - portable.share) * texels().count() as f64 {
        return Ok(());
    }
    let first = texels().find(differs);
    let (limit, all) = (portable.light, texels().count());
    Err(format!("{what}: {differing} of {all} texels differ by more than {limit:.1e}: {first:?}").into())
}

/// All light of a texel.
fn light(texel: &FilmTexel, params: &TracePathsParams) -> f64 {
    texel.direct.iter().chain(&texel.indirect).map(|&w| to_f64(w, params.film_exponent)).sum()
}

fn film<B: Backend>(
    backend: &B,
    scene: &CompiledScene,
    params: &TracePathsParams,
) -> twinlight_core::Result<Vec<FilmTexel>> {
    let scene = backend.upload_scene(scene)?;
    let mut film = backend.zeroed((params.width * params.height) as usize)?;
    backend.trace_paths(&scene, params, &mut film)?;
    backend.download(&film)
}

fn empty_scene(target: &Target) -> Result<(), Failed> {
    let compiled = compile(&Scene::default(), &Limits::default())?;
    let gpu = GpuBackend::new(target.device()?.clone());
    let rays = [Ray { origin: [0.0; 3], t_min: 0.0, direction: [0.0, 0.6, 0.8], t_max: 4.0 }; 3];
    let want = trace(&CpuBackend::new(), &compiled, &rays)?;
    let got = trace(&gpu, &compiled, &rays)?;
    if got == want { Ok(()) } else { Err(format!("{got:?}").into()) }
}

fn wrong_sizes(target: &Target) -> Result<(), Failed> {
    let gpu = GpuBackend::new(target.device()?.clone());
    let pair = Pair::new("cornell")?;
    let scene = gpu.upload_scene(&pair.compiled)?;
    let params = ShadePrimaryParams { camera: pair.camera()?, width: WIDTH, height: HEIGHT, padding: [0; 2] };
    let rays = gpu.zeroed(4)?;
    let results = [
        gpu.trace_closest(&scene, &rays, &mut gpu.zeroed(5)?),
        gpu.trace_any(&scene, &rays, &mut gpu.zeroed(3)?),
        gpu.shade_primary(&scene, &params, &mut gpu.zeroed(7)?),
        gpu.trace_paths(&scene, &pair.paths(1)?, &mut gpu.zeroed(7)?),
    ];
    for result in results {
        if !matches!(result, Err(Error::InvalidInput { .. })) {
            return Err(format!("{result:?}").into());
        }
    }
    Ok(())
}

/// Equal bytes in strict mode; in portable mode at least `portable` of the elements.
fn expect_twins<T: Pod + std::fmt::Debug>(
    target: &Target,
    what: &str,
    got: &[T],
    want: &[T],
    portable: f64,
) -> Result<(), Failed> {
    let bytes = |element: &T| bytemuck::bytes_of(element).to_vec();
    let differing = got.iter().zip(want).filter(|(got, want)| bytes(got) != bytes(want)).count();
    let share = if target.device()?.mode() == Mode::Strict { 1.0 } else { portable };
    if (want.len() - differing) as f64 >= share * want.len() as f64 {
        return Ok(());
    }
    let at = got.iter().zip(want).position(|(got, want)| bytes(got) != bytes(want)).unwrap_or(0);
    Err(format!(
        "{what}: {differing} of {} differ; {at} is {:?}, expected {:?}",
        want.len(),
        got[at],
        want[at]
    )
    .into())
}
