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
    ("d3: a sort larger than a binding", sort),
    ("d3: a scene larger than a binding is refused", scene),
    ("d3: a binding too small for a chunk is refused", tiny_binding),
];

/// Bytes of a binding: chunks of 2¹⁸ words.
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

/// Keys of few values, so that the order of equal ones counts, and of many.
fn sort(target: &Target) -> Result<(), Failed> {
    let [small, _] = backends(target)?;
    let random = |i: u32| i.wrapping_mul(2_654_435_761).rotate_left(11) ^ i;
    for (len, values) in [(1 << 18, 50), ((1 << 18) + 1, 50), (700_001, 3), (700_001, u32::MAX)] {
        let keys: Vec<u32> = (0..len).map(|i| random(i) % values).collect();
        let mut buffer = small.upload(&keys)?;
        let mut payload = small.upload(&(0..len).collect::<Vec<u32>>())?;
        small.sort_u32(&mut buffer, &mut payload)?;
        expect_sorted(
            &format!("{len} of {values}"),
            &keys,
            &small.download(&buffer)?,
            &small.download(&payload)?,
        )?;
    }
    // The low word decides only where the high one doesn't.
    let keys: Vec<u64> =
        (0..300_001).map(|i| u64::from(random(i) % 5) << 32 | u64::from(random(!i) % 7)).collect();
    let mut buffer = small.upload(&keys)?;
    let mut payload = small.upload(&(0..keys.len() as u32).collect::<Vec<u32>>())?;
    small.sort_u64(&mut buffer, &mut payload)?;
    expect_sorted("64 bits", &keys, &small.download(&buffer)?, &small.download(&payload)?)
}

/// What the standard library's stable sort gives, payloads being the keys' places.
fn expect_sorted<K: Ord + Copy + std::fmt::Debug>(
    what: &str,
    input: &[K],
    keys: &[K],
    payload: &[u32],
) -> Result<(), Failed> {
    let mut places: Vec<u32> = (0..input.len() as u32).collect();
    places.sort_by_key(|&place| input[place as usize]);
    expect_same(&format!("payload of {what}"), payload, &places)?;
    let sorted: Vec<K> = places.iter().map(|&place| input[place as usize]).collect();
    expect_same(&format!("keys of {what}"), keys, &sorted)
}

/// Traversal goes anywhere in a scene, so that no run of its records is enough: the limit stays one, and is named.
fn scene(target: &Target) -> Result<(), Failed> {
    let options = DeviceOptions { max_storage_binding_bytes: 1 << 10, ..target.options.clone() };
    let backend = GpuBackend::new(GpuDevice::open(&options)?);
    let scene = compile(&builtin("cornell").ok_or("no such scene")?, &Limits::default())?;
    expect_limit(1 << 10, backend.upload_scene(&scene))
}

fn tiny_binding(target: &Target) -> Result<(), Failed> {
    let options = DeviceOptions { max_storage_binding_bytes: 128, ..target.options.clone() };
    let backend = GpuBackend::new(GpuDevice::open(&options)?);
    let mut keys = backend.zeroed::<u32>(100)?;
    expect_limit(128, backend.sort_u32(&mut keys, &mut backend.zeroed::<u32>(100)?))
}

fn expect_limit<T: std::fmt::Debug>(expected: u64, result: twinlight_core::Result<T>) -> Result<(), Failed> {
    match result {
        Err(Error::LimitExceeded { limit, .. }) if limit == expected => Ok(()),
        other => Err(format!("{other:?} for a limit of {expected}").into()),
    }
}
