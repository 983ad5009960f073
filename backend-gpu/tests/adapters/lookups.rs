//! `query_lhb` against its CPU twin.

use crate::lhb::{soup, stack, views};
use crate::{Check, Target, expect_same, numbers};
use glam::DVec3;
use libtest_mimic::Failed;
use twinlight_backend_cpu::CpuBackend;
use twinlight_backend_gpu::{DeviceOptions, GpuBackend, GpuDevice};
use twinlight_core::kernels::query_lhb::{LhbQuery, NO_ELEMENT};
use twinlight_core::kernels::rasterize_lhb::{Lhb, LhbBuffers, LhbElement, RasterizeLhbParams};
use twinlight_core::lattice::{LatticeMesh, View};
use twinlight_core::{Backend, Error, Result};

pub const CHECKS: &[(&str, Check)] = &[
    ("lookups are those of the CPU twin", lookups),
    ("lookups in a hundred thousand layers", layers),
    ("lookups in buffers of other origin stay within them", foreign),
    ("lookups of wrong sizes are refused", wrong_sizes),
    ("d3: more lookups than a binding holds", small_bindings),
];

fn gpu(target: &Target) -> std::result::Result<GpuBackend, Failed> {
    Ok(GpuBackend::new(target.device()?.clone()))
}

/// From the lattice's centre.
fn query_along(ray: u32) -> LhbQuery {
    LhbQuery { position: [0; 3], ray, offset: [0; 2], leaves: 0, window: 1 << 16 }
}

/// Queries from vertices and from beside them, of views that there are and one that isn't.
fn queries(seed: u64, count: usize, mesh: &LatticeMesh, view_count: usize) -> Vec<LhbQuery> {
    let words = numbers(seed, 16 * count);
    let signed = |word: u64, reach: i64| (word as i64 % reach) as i32;
    let query = |n: &[u64]| {
        let corner = mesh.vertices()[n[0] as usize % mesh.vertices().len()].map(i32::from);
        // Half of them on a vertex, where the window decides, the others up to half the lattice away.
        let aside = if n[1].is_multiple_of(2) { 4 } else { 16_000 };
        let beside = |axis: usize| (corner[axis] + signed(n[2 + axis], aside)).clamp(-32_760, 32_760);
        LhbQuery {
            position: [beside(0), beside(1), beside(2)],
            ray: (n[5] % (2 * view_count as u64 + 1)) as u32,
            offset: [signed(n[6], 1 << (n[7] % 16)), signed(n[8], 1 << (n[9] % 16))],
            leaves: (n[10] % (2 * mesh.triangles().len() as u64)) as u32,
            window: (n[11] % (1 << (n[12] % 31))) as u32,
        }
    };
    words.chunks_exact(16).map(query).collect()
}

fn answers<B: Backend>(
    backend: &B,
    mesh: &LatticeMesh,
    views: &[View],
    params: &RasterizeLhbParams,
    queries: &[LhbQuery],
) -> Result<Vec<LhbElement>> {
    let mesh = backend.upload_mesh(mesh)?;
    let lhb = backend.rasterize_lhb(&mesh, views, params)?;
    answers_of(backend, &mesh, &lhb, views, queries)
}

fn answers_of<B: Backend>(
    backend: &B,
    mesh: &B::Mesh,
    lhb: &Lhb<B>,
    views: &[View],
    queries: &[LhbQuery],
) -> Result<Vec<LhbElement>> {
    let mut hits = backend.zeroed(queries.len())?;
    backend.query_lhb(mesh, lhb, views, &backend.upload(queries)?, &mut hits)?;
    backend.download(&hits)
}

fn lookups(target: &Target) -> std::result::Result<(), Failed> {
    let gpu = gpu(target)?;
    for (seed, size, triangles) in [(21, 1, 200), (22, 9, 1), (23, 24, 300), (24, 64, 900)] {
        let (mesh, views) = (soup(seed, triangles, 18_000), views(seed, 4, size));
        let queries = queries(seed, 20_000, &mesh, views.len());
        let params = RasterizeLhbParams::new(size);
        let want = answers(&CpuBackend::new(), &mesh, &views, &params, &queries)?;
        let got = answers(&gpu, &mesh, &views, &params, &queries)?;
        expect_same(&format!("size {size}, {triangles} triangles"), &got, &want)?;
        let met = want.iter().filter(|hit| hit.surface != NO_ELEMENT).count();
        if triangles > 1 && !(2000..=19_000).contains(&met) {
            return Err(format!("{met} of 20000 lookups meet anything").into());
        }
    }
    let view = View::along(DVec3::Z, 4)?;
    let params = RasterizeLhbParams::new(4);
    let got = answers(&gpu, &LatticeMesh::default(), &[view], &params, &[query_along(0)])?;
    expect_same("nothing", &got, &[LhbElement { surface: NO_ELEMENT, depth: 0 }])
}

/// Loops of llvmpipe end after 65535 rounds.
fn layers(target: &Target) -> std::result::Result<(), Failed> {
    let view = View::along(DVec3::Z, 1)?;
    let mesh = stack(100_000);
    let queries: Vec<_> = (-1100..1100)
        .flat_map(|z| [0, 1].map(|ray| LhbQuery { position: [0, 0, z], ..query_along(ray) }))
        .collect();
    let params = RasterizeLhbParams::new(1);
    let want = answers(&CpuBackend::new(), &mesh, &[view], &params, &queries)?;
    expect_same("layers", &answers(&gpu(target)?, &mesh, &[view], &params, &queries)?, &want)
}

/// Offsets below `most` in no order, elements of triangles that there aren't, in increasing depth.
fn foreign_buffers<B: Backend>(backend: &B, most: u64) -> Result<Lhb<B>> {
    let offsets: Vec<u32> = numbers(31, 2 * 81 + 1).iter().map(|&n| (n % most) as u32).collect();
    let element = |i: u32| LhbElement { surface: i.wrapping_mul(0x9e37_79b9) >> (i % 32), depth: i << 23 };
    let elements: Vec<_> = (0..80).map(element).collect();
    Ok(LhbBuffers {
        size: 9,
        view_count: 2,
        offsets: backend.upload(&offsets)?,
        elements: backend.upload(&elements)?,
        left_out: backend.zeroed(0)?,
    })
}

fn foreign(target: &Target) -> std::result::Result<(), Failed> {
    let (gpu, cpu) = (gpu(target)?, CpuBackend::new());
    let (mesh, views) = (soup(31, 7, 18_000), views(31, 2, 9));
    let queries = queries(31, 5000, &mesh, 3);
    let resident = gpu.upload_mesh(&mesh)?;
    let want = answers_of(&cpu, &cpu.upload_mesh(&mesh)?, &foreign_buffers(&cpu, 81)?, &views, &queries)?;
    let got = answers_of(&gpu, &resident, &foreign_buffers(&gpu, 81)?, &views, &queries)?;
    expect_same("any order", &got, &want)?;
    // Of lists that end beyond all elements nothing is read.
    let got = answers_of(&gpu, &resident, &foreign_buffers(&gpu, 1 << 32)?, &views, &queries)?;
    expect_same("out of range", &got, &vec![LhbElement { surface: NO_ELEMENT, depth: 0 }; queries.len()])
}

fn wrong_sizes(target: &Target) -> std::result::Result<(), Failed> {
    let gpu = gpu(target)?;
    let (mesh, views) = (gpu.upload_mesh(&soup(32, 7, 18_000))?, views(32, 3, 9));
    let lhb = gpu.rasterize_lhb(&mesh, &views, &RasterizeLhbParams::new(9))?;
    let queries = gpu.upload(&[query_along(0); 5])?;
    let short = LhbBuffers {
        size: 9,
        view_count: 3,
        offsets: gpu.zeroed(3 * 81)?,
        elements: gpu.zeroed(0)?,
        left_out: gpu.zeroed(0)?,
    };
    let results = [
        gpu.query_lhb(&mesh, &lhb, &views, &queries, &mut gpu.zeroed(4)?),
        gpu.query_lhb(&mesh, &lhb, &views[1..], &queries, &mut gpu.zeroed(5)?),
        gpu.query_lhb(&mesh, &short, &views, &queries, &mut gpu.zeroed(5)?),
    ];
    for result in results {
        if !matches!(result, Err(Error::InvalidInput { .. })) {
            return Err(format!("{result:?}").into());
        }
    }
    Ok(())
}

/// Bindings of 16 KiB: 512 queries.
fn small_bindings(target: &Target) -> std::result::Result<(), Failed> {
    let options = DeviceOptions { max_storage_binding_bytes: 1 << 14, ..target.options.clone() };
    let small = GpuBackend::new(GpuDevice::open(&options)?);
    let (mesh, views) = (soup(33, 300, 1500), views(33, 3, 16));
    let params = RasterizeLhbParams::new(16);
    for count in [511, 512, 513, 3000] {
        let queries = queries(33, count, &mesh, views.len());
        let want = answers(&CpuBackend::new(), &mesh, &views, &params, &queries)?;
        let got = answers(&small, &mesh, &views, &params, &queries)?;
        expect_same(&format!("{count} lookups"), &got, &want)?;
    }
    Ok(())
}
