//! `walk_lhb` against its CPU twin: bit for bit in strict mode.

use crate::transport::{FILMS, Pair, expect_twin_films};
use crate::{Check, Target, expect_same};
use libtest_mimic::Failed;
use twinlight_backend_cpu::CpuBackend;
use twinlight_backend_gpu::{DeviceOptions, GpuBackend, GpuDevice};
use twinlight_core::directions::DirectionSet;
use twinlight_core::kernels::rasterize_lhb::LhbBuffers;
use twinlight_core::kernels::trace_paths::{FilmTexel, TracePathsParams, UNLIMITED_BOUNCES};
use twinlight_core::kernels::walk_lhb::{CONE, WalkLhbParams};
use twinlight_core::lattice::{Lattice, LatticeMesh};
use twinlight_core::{Backend, Error};
use twinlight_methods::slhb::{Buffers, LookupSettings, Shadows, build};

pub const CHECKS: &[(&str, Check)] = &[
    ("walks are those of the CPU twin", walks),
    ("walks that look shadows up are those of the CPU twin", shadows),
    ("d3: walks in batches", batches),
    ("walks in what doesn't belong together are refused", strangers),
];

fn lookups(cone: bool, trace_misses: bool) -> Result<LookupSettings, Failed> {
    let directions = DirectionSet::octahedron(2)?;
    Ok(LookupSettings { directions, size: 40, cone, trace_misses, ..LookupSettings::default() })
}

/// On `backend`, with lists that the CPU rasterizes: they are the same, and come sooner.
fn film<B: Backend>(
    backend: &B,
    pair: &Pair,
    lookups: &LookupSettings,
    call: TracePathsParams,
) -> twinlight_core::Result<Vec<FilmTexel>> {
    let (cpu, scene) = (CpuBackend::new(), &pair.compiled);
    let resident = backend.upload_scene(scene)?;
    let Buffers { lhb, views, map, lookup, .. } = build(&cpu, scene, lookups)?;
    let mesh = backend.upload_mesh(&LatticeMesh::of_scene(&Lattice::of_scene(scene)?, scene)?)?;
    let lhb = LhbBuffers {
        size: lhb.size,
        view_count: lhb.view_count,
        offsets: backend.upload(&cpu.download(&lhb.offsets)?)?,
        elements: backend.upload(&cpu.download(&lhb.elements)?)?,
        left_out: backend.zeroed(0)?,
    };
    let map = backend.upload(&cpu.download(&map)?)?;
    let mut film = backend.zeroed((call.width * call.height) as usize)?;
    backend.walk_lhb(&resident, &mesh, &lhb, &views, &map, &WalkLhbParams { call, lookup }, &mut film)?;
    backend.download(&film)
}

fn walks(target: &Target) -> Result<(), Failed> {
    let gpu = GpuBackend::new(target.device()?.clone());
    for (name, bounces, cone, trace_misses) in [
        ("cornell", 3, false, false),
        ("cornell", UNLIMITED_BOUNCES, true, true),
        ("materials", 5, true, false),
        ("lights", 2, true, true),
        ("textured", 4, true, true),
        ("environment", 3, true, true),
        ("axis", 0, true, true),
    ] {
        expect_twins(target, &gpu, &Pair::new(name)?, &lookups(cone, trace_misses)?, bounces)?;
    }
    Ok(())
}

/// With shadow rays looked up, at once or from the second vertex on, until roulette ends paths or a bounce does.
fn shadows(target: &Target) -> Result<(), Failed> {
    let gpu = GpuBackend::new(target.device()?.clone());
    for (name, bounces, cone, shadows) in [
        ("cornell", UNLIMITED_BOUNCES, true, Shadows::Lookups),
        ("materials", 3, true, Shadows::IndirectLookups),
        ("lights", 2, true, Shadows::Lookups),
        ("environment", 1, false, Shadows::Lookups),
    ] {
        let lookups = LookupSettings { shadows, ..lookups(cone, true)? };
        expect_twins(target, &gpu, &Pair::new(name)?, &lookups, bounces)?;
    }
    Ok(())
}

fn expect_twins(
    target: &Target,
    gpu: &GpuBackend,
    pair: &Pair,
    lookups: &LookupSettings,
    bounces: u32,
) -> Result<(), Failed> {
    let call = pair.paths(bounces)?;
    let want = film(&CpuBackend::new(), pair, lookups, call)?;
    let got = film(gpu, pair, lookups, call)?;
    expect_twin_films(target, pair, &call, &FILMS, [&got, &want])
}

/// Bindings of 64 KiB hold 448 paths, and 960 texels from any of them on.
fn batches(target: &Target) -> Result<(), Failed> {
    let options = DeviceOptions { max_storage_binding_bytes: 1 << 16, ..target.options.clone() };
    let small = GpuBackend::new(GpuDevice::open(&options)?);
    let gpu = GpuBackend::new(target.device()?.clone());
    let pair = Pair::new("cornell")?;
    let lookups =
        LookupSettings { size: 8, directions: DirectionSet::octahedron(1)?, ..lookups(true, true)? };
    for sample_count in [1, 5, 600] {
        let call = TracePathsParams { sample_count, pixel_count: 1200 / sample_count, ..pair.paths(2)? };
        let call = TracePathsParams { width: 48, height: 32, ..call };
        let want = film(&gpu, &pair, &lookups, call)?;
        expect_same("film", &film(&small, &pair, &lookups, call)?, &want)?;
    }
    Ok(())
}

fn strangers(target: &Target) -> Result<(), Failed> {
    let gpu = GpuBackend::new(target.device()?.clone());
    let pair = Pair::new("cornell")?;
    let scene = gpu.upload_scene(&pair.compiled)?;
    let Buffers { mesh, lhb, views, map, lookup, .. } = build(&gpu, &pair.compiled, &lookups(true, false)?)?;
    let params = WalkLhbParams { call: pair.paths(1)?, lookup };
    let mut film = gpu.zeroed((params.call.width * params.call.height) as usize)?;
    let mut other_size = params;
    other_size.lookup.size = 39;
    let other_mesh = gpu.upload_mesh(&LatticeMesh::default())?;
    let results = [
        gpu.walk_lhb(&scene, &mesh, &lhb, &views, &map, &other_size, &mut film),
        gpu.walk_lhb(&scene, &other_mesh, &lhb, &views, &map, &params, &mut film),
        gpu.walk_lhb(&scene, &mesh, &lhb, &views[1..], &map, &params, &mut film),
        gpu.walk_lhb(&scene, &mesh, &lhb, &views, &map, &params, &mut gpu.zeroed(3)?),
    ];
    for result in results {
        if !matches!(result, Err(Error::InvalidInput { .. })) {
            return Err(format!("{result:?}").into());
        }
    }
    expect_same("the cone", &[lookup.flags], &[CONE])
}
