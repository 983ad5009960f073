//! D3: buffers larger than a binding are worked on in chunks, with the same bits.

use crate::{Check, Target, expect_same};
use libtest_mimic::Failed;
use twinlight_backend_gpu::{DeviceOptions, GpuBackend, GpuDevice};
use twinlight_core::kernels::shade_primary::{GBufferTexel, ShadePrimaryParams};
use twinlight_core::kernels::trace::Hit;
use twinlight_core::kernels::trace_paths::{FilmTexel, SAMPLER_SOBOL, TracePathsParams};
use twinlight_core::scene::{Limits, compile};
use twinlight_core::{Backend, Error};
use twinlight_fixtures::inputs;
use twinlight_fixtures::scenes::builtin;

pub const CHECKS: &[(&str, Check)] = &[
    ("d3: a scan larger than a binding", scan),
    ("d3: more rays than a binding holds", rays),
    ("d3: pictures larger than a binding", pictures),
    ("d3: a sort larger than a binding is refused", sort),
];

/// Bytes of a binding.
const BINDING: u64 = 1 << 20;
/// Two megabytes of film and of G-buffer, which end within a chunk.
const WIDTH: u32 = 211;
const HEIGHT: u32 = 157;

/// A backend whose bindings are small, and one with those of the adapter.
fn backends(target: &Target) -> Result<[GpuBackend; 2], Failed> {
    let options = DeviceOptions { max_storage_binding_bytes: BINDING, ..target.options.clone() };
    Ok([GpuBackend::new(GpuDevice::open(&options)?), GpuBackend::new(target.device()?.clone())])
}

fn scan(target: &Target) -> Result<(), Failed> {
    let [small, _] = backends(target)?;
    for len in [(1 << 18) - 1, 1 << 18, (1 << 18) + 1, 600_001] {
        let counts: Vec<u32> = (0..len).map(|i: u32| i.wrapping_mul(2_654_435_761) >> 20).collect();
        let mut offsets = small.zeroed::<u32>(counts.len())?;
        let total = small.scan(&small.upload(&counts)?, &mut offsets)?;
        let mut sum = 0_u32;
        let mut want = Vec::with_capacity(counts.len());
        for count in &counts {
            want.push(sum);
            sum = sum.wrapping_add(*count);
        }
        expect_same(&format!("scan of {len}"), &small.download(&offsets)?, &want)?;
        expect_same(&format!("total of {len}"), &[total], &[sum])?;
    }
    Ok(())
}

fn rays(target: &Target) -> Result<(), Failed> {
    let scene = compile(&builtin("cornell").ok_or("no such scene")?, &Limits::default())?;
    let rays = inputs::incoherent_rays(scene.bounds, 70_001, 1);
    let mut results = Vec::new();
    for backend in backends(target)? {
        let resident = backend.upload_scene(&scene)?;
        let uploaded = backend.upload(&rays)?;
        let mut hits = backend.zeroed::<Hit>(rays.len())?;
        let mut blocked = backend.zeroed::<u32>(rays.len())?;
        backend.trace_closest(&resident, &uploaded, &mut hits)?;
        backend.trace_any(&resident, &uploaded, &mut blocked)?;
        results.push((backend.download(&hits)?, backend.download(&blocked)?));
    }
    expect_same("hits", &results[0].0, &results[1].0)?;
    expect_same("any hits", &results[0].1, &results[1].1)
}

fn pictures(target: &Target) -> Result<(), Failed> {
    let scene = builtin("cornell").ok_or("no such scene")?;
    let compiled = compile(&scene, &Limits::default())?;
    let camera = scene.camera.as_ref().ok_or("no camera")?.record(WIDTH, HEIGHT, compiled.origin)?;
    let shade = ShadePrimaryParams { camera, width: WIDTH, height: HEIGHT, padding: [0; 2] };
    let paths = TracePathsParams {
        camera,
        width: WIDTH,
        height: HEIGHT,
        pixel_begin: 77,
        pixel_count: WIDTH * HEIGHT - 100,
        sample_begin: 0,
        sample_count: 2,
        seed: 7,
        max_bounces: 2,
        roulette_begin: 3,
        sampler: SAMPLER_SOBOL,
        film_exponent: compiled.film_exponent,
        moment_exponent: compiled.moment_exponent,
    };
    let mut results = Vec::new();
    for backend in backends(target)? {
        let resident = backend.upload_scene(&compiled)?;
        let mut gbuffer = backend.zeroed::<GBufferTexel>((WIDTH * HEIGHT) as usize)?;
        let mut film = backend.zeroed::<FilmTexel>((WIDTH * HEIGHT) as usize)?;
        backend.shade_primary(&resident, &shade, &mut gbuffer)?;
        backend.trace_paths(&resident, &paths, &mut film)?;
        results.push((backend.download(&gbuffer)?, backend.download(&film)?));
    }
    expect_same("G-buffer", &results[0].0, &results[1].0)?;
    expect_same("film", &results[0].1, &results[1].1)?;
    let sampled = |texel: &&FilmTexel| texel.samples > 0;
    expect_same("pixels", &[results[0].1.iter().filter(sampled).count()], &[paths.pixel_count as usize])
}

/// Scatters go anywhere, so that no run of elements is enough for them: the limit stays one, and is named.
fn sort(target: &Target) -> Result<(), Failed> {
    let [small, _] = backends(target)?;
    let sort_of = |len: usize| {
        let mut keys = small.zeroed::<u32>(len)?;
        small.sort_u32(&mut keys, &mut small.zeroed::<u32>(len)?)
    };
    sort_of(1 << 18)?;
    match sort_of((1 << 18) + 1) {
        Err(Error::LimitExceeded { limit: BINDING, .. }) => Ok(()),
        other => Err(format!("{other:?}").into()),
    }
}
