//! `voxelize` and `sum_voxels` against their CPU twins.

use crate::{Check, Target, expect_same, numbers};
use bytemuck::Zeroable;
use libtest_mimic::Failed;
use twinlight_backend_cpu::CpuBackend;
use twinlight_backend_gpu::{DeviceOptions, GpuBackend, GpuDevice};
use twinlight_core::kernels::sum_voxels::{NONE, VoxelSums, VoxelSurface};
use twinlight_core::kernels::voxelize::{
    CONSERVATIVE, NO_CUTOFF, THIN, VoxelBuffers, VoxelizeParams, Voxels,
};
use twinlight_core::lattice::{Lattice, LatticeMesh, VoxelGrid};
use twinlight_core::scene::{Limits, compile};
use twinlight_core::{Backend, Error, Result};
use twinlight_fixtures::scenes::builtin;

pub const CHECKS: &[(&str, Check)] = &[
    ("voxels of built-in scenes are those of the CPU twin", scenes),
    ("voxels of triangles of every size are those of the CPU twin", soups),
    ("voxels of triangles on faces and centres of voxels", aligned),
    ("voxels of grids whose mesh is beside them", beside),
    ("voxels of nothing, and of triangles without area", nothing),
    ("voxels of walls, at once and cell by cell", walls),
    ("sums of voxels of other origin", strangers),
    ("d3: voxels in parts, or beyond a binding", small_bindings),
];

/// Texels of the surfaces' textures.
const TEXELS: u32 = 4096;

const SEPARATIONS: [u32; 2] = [THIN, CONSERVATIVE];

/// [`Voxels`] on the host.
fn downloaded<B: Backend>(backend: &B, voxels: &Voxels<B>) -> Result<[(&'static str, Vec<u32>); 6]> {
    Ok([
        ("small", backend.download(&voxels.small)?),
        ("large", backend.download(&voxels.large)?),
        ("mask", backend.download(&voxels.mask)?),
        ("ranks", backend.download(&voxels.ranks)?),
        ("active", backend.download(&voxels.active)?),
        ("parents", backend.download(&voxels.parents)?),
    ])
}

/// Textured, tinted and shining, some of them beyond the texels.
fn surfaces(count: usize) -> Vec<VoxelSurface> {
    numbers(7, 16 * count)
        .chunks_exact(16)
        .map(|n| {
            let word = |i: usize| n[i] as u32;
            let within = |i: usize| [n[i], n[i] >> 32].map(|n| (n as u32 % 131_073) as i32 - 65_536);
            let light = |i: usize| [word(i) & 0x0fff_0fff, (n[i] >> 32) as u32 & 0x0fff];
            VoxelSurface {
                normals: [word(0), word(1), word(2)],
                texture: if n[3] % 4 == 0 { NONE } else { word(4) % TEXELS },
                texcoords: [within(5), within(6), within(7)],
                texture_size: (1 + word(8) % 40) | (1 + word(9) % 40) << 16,
                flags: word(10) % 2,
                tint: light(11),
                emission: if n[12] % 4 == 0 { light(13) } else { [0; 2] },
            }
        })
        .collect()
}

fn texels() -> Vec<u32> {
    numbers(8, TEXELS as usize).into_iter().map(|n| n as u32 >> 2).collect()
}

/// Both outputs of a backend.
type Outputs = ([(&'static str, Vec<u32>); 6], Vec<VoxelSums>);

fn outputs<B: Backend>(
    backend: &B,
    mesh: &LatticeMesh,
    grid: &VoxelGrid,
    params: &VoxelizeParams,
) -> Result<Outputs> {
    let count = mesh.triangles().len();
    let (surfaces, texels) = (backend.upload(&surfaces(count))?, backend.upload(&texels())?);
    let mesh = backend.upload_mesh(mesh)?;
    let voxels = backend.voxelize(&mesh, grid, params)?;
    let sums = backend.sum_voxels(&mesh, &voxels, &surfaces, &texels, params)?;
    Ok((downloaded(backend, &voxels)?, backend.download(&sums)?))
}

/// The same from both backends; the number of voxels.
fn expect_twins_on(
    gpu: &GpuBackend,
    mesh: &LatticeMesh,
    grid: &VoxelGrid,
    params: VoxelizeParams,
) -> std::result::Result<usize, Failed> {
    let (want, sums) = outputs(&CpuBackend::new(), mesh, grid, &params)?;
    let (got, got_sums) = outputs(gpu, mesh, grid, &params)?;
    for ((name, want), (_, got)) in want.iter().zip(&got) {
        expect_same(&format!("{name}, {grid:?}, {params:?}"), got, want)?;
    }
    expect_same(&format!("sums, {grid:?}, {params:?}"), &got_sums, &sums)?;
    Ok(sums.len())
}

fn expect_twins(
    target: &Target,
    mesh: &LatticeMesh,
    grid: &VoxelGrid,
    cutoffs: &[u32],
) -> std::result::Result<usize, Failed> {
    let gpu = backend(target)?;
    let mut most = 0;
    for separation in SEPARATIONS {
        for &cutoff in cutoffs {
            let params = VoxelizeParams { separation, cutoff };
            most = most.max(expect_twins_on(&gpu, mesh, grid, params)?);
        }
    }
    Ok(most)
}

fn backend(target: &Target) -> std::result::Result<GpuBackend, Failed> {
    Ok(GpuBackend::new(target.device()?.clone()))
}

fn expect_some(voxels: usize) -> std::result::Result<(), Failed> {
    if voxels == 0 { Err("no voxels were compared".into()) } else { Ok(()) }
}

/// Each triangle has corners of its own.
fn mesh_of(corners: Vec<[i16; 3]>) -> LatticeMesh {
    let triangles = (0..corners.len() as u32 / 3).map(|t| [0, 1, 2].map(|i| 3 * t + i)).collect();
    LatticeMesh::new(corners, triangles).expect("in reach")
}

/// The grid over the bounds of a mesh.
fn grid_over(mesh: &LatticeMesh, resolution: u32) -> VoxelGrid {
    let bound = |pick: fn(i16, i16) -> i16| {
        let bounds = |a: [i16; 3], b: &[i16; 3]| [0, 1, 2].map(|i| pick(a[i], b[i]));
        mesh.vertices().iter().fold(mesh.vertices()[0], bounds)
    };
    VoxelGrid::over(bound(i16::min), bound(i16::max), resolution).expect("a grid")
}

/// A grid whose coordinates are those of the lattice.
fn plain_grid(dims: [u32; 3], subvoxel_bits: u32) -> VoxelGrid {
    VoxelGrid { dims, scale: 1 << 14, offset: [0; 3], subvoxel_bits }
}

/// `count` triangles within `reach` of random points, which are multiples of `step` and not negative if `positive`.
fn soup(seed: u64, count: usize, reach: i64, step: i64, positive: bool) -> LatticeMesh {
    // A cube in the lattice's ball.
    const SIDE: i64 = 18_000;
    let least = if positive { 0 } else { -SIDE };
    let words = numbers(seed, 12 * count);
    let corners = words.chunks_exact(12).flat_map(|n| {
        let number = |i: usize, modulus: i64| (n[i] >> 1) as i64 % modulus;
        let centre = [0, 1, 2].map(|i| least + number(i, SIDE - least));
        let corner = move |k: usize| {
            [0, 1, 2].map(|i| {
                let free = centre[i] + (n[3 + 3 * k + i] >> 1) as i64 % (2 * reach + 1) - reach;
                (free.clamp(least, SIDE) / step * step) as i16
            })
        };
        [0, 1, 2].map(corner)
    });
    mesh_of(corners.collect())
}

fn scenes(target: &Target) -> std::result::Result<(), Failed> {
    for (name, resolution, cutoffs) in [
        ("cornell", 128, [0, 64, NO_CUTOFF].as_slice()),
        ("materials", 64, &[0, 64]),
        ("textured", 33, &[8]),
        ("room-70k", 128, &[64]),
    ] {
        let scene = compile(&builtin(name).ok_or("no such scene")?, &Limits::default())?;
        let mesh = LatticeMesh::of_scene(&Lattice::of_scene(&scene)?, &scene)?;
        expect_some(expect_twins(target, &mesh, &grid_over(&mesh, resolution), cutoffs)?)?;
    }
    Ok(())
}

fn soups(target: &Target) -> std::result::Result<(), Failed> {
    for (seed, count, reach, resolution, cutoffs) in [
        (1, 3000, 200, 128, [0, 64].as_slice()),
        (2, 300, 3000, 77, &[64, 100]),
        (3, 60, 18_000, 64, &[64, NO_CUTOFF]),
        (4, 5, 18_000, 250, &[64, NO_CUTOFF]),
        (5, 400, 20, 16, &[0, 64]),
    ] {
        let mesh = soup(seed, count, reach, 1, false);
        expect_some(expect_twins(target, &mesh, &grid_over(&mesh, resolution), cutoffs)?)?;
    }
    Ok(())
}

/// Ties: corners and edges on what decides.
fn aligned(target: &Target) -> std::result::Result<(), Failed> {
    for (seed, reach, step) in [(11, 2000, 256), (12, 600, 128), (13, 18_000, 512), (14, 300, 255)] {
        let mesh = soup(seed, 300, reach, step, true);
        let grid = plain_grid([128, 128, 128], 8);
        expect_some(expect_twins(target, &mesh, &grid, &[0, 64])?)?;
    }
    Ok(())
}

/// Grids that have only a part of the mesh, are flat or one voxel, or shrink the mesh to a point.
fn beside(target: &Target) -> std::result::Result<(), Failed> {
    let mesh = soup(21, 150, 9000, 1, false);
    for (dims, subvoxel_bits) in [
        ([64, 37, 1], 9),
        ([1, 1, 1], 15),
        ([1, 1, 1], 6),
        ([2, 1, 2], 14),
        ([3, 5, 7], 12),
        ([1, 200, 1], 7),
        ([17, 4, 33], 8),
    ] {
        for (scale, offset) in [
            (1 << 14, [0; 3]),
            (9000, [1 << 27, 1 << 28, -(1 << 26)]),
            (300, [1 << 20, 1 << 21, 1 << 22]),
            (0, [77; 3]),
        ] {
            let grid = VoxelGrid { dims, scale, offset, subvoxel_bits };
            expect_twins(target, &mesh, &grid, &[64])?;
        }
    }
    Ok(())
}

fn nothing(target: &Target) -> std::result::Result<(), Failed> {
    let none = LatticeMesh::default();
    let grid = plain_grid([20, 30, 40], 8);
    expect_same("voxels of nothing", &[expect_twins(target, &none, &grid, &[0, 64])?], &[0])?;
    let ends: [[i16; 3]; 7] = [
        [0, 0, 0],
        [5000, 0, 0],
        [0, 7000, 0],
        [0, 0, 9999],
        [5119, 7679, 10_239],
        [256, 512, 768],
        [1000, 1001, 1002],
    ];
    // Where the sum is odd, the middle is beside the line, and the triangle a sliver.
    let middle = |a: i16, b: i16| ((i32::from(a) + i32::from(b)) / 2) as i16;
    let pairs = ends.iter().flat_map(|&a| ends.iter().map(move |&b| (a, b)));
    let flat = mesh_of(pairs.flat_map(|(a, b)| [a, [0, 1, 2].map(|i| middle(a[i], b[i])), b]).collect());
    let gpu = backend(target)?;
    for cutoff in [0, 64, NO_CUTOFF] {
        let params = VoxelizeParams { separation: CONSERVATIVE, cutoff };
        expect_some(expect_twins_on(&gpu, &flat, &grid, params)?)?;
        expect_twins_on(&gpu, &flat, &grid, VoxelizeParams { separation: THIN, cutoff })?;
    }
    Ok(())
}

/// Rectangles through the whole of 512³ voxels, with more cells than a submission has, and segments along its axes and diagonals;
/// as large triangles, and as small ones of many items.
fn walls(target: &Target) -> std::result::Result<(), Failed> {
    // The corners of a cube of more lattice steps than 512 voxels have units.
    const L: i16 = -18_000;
    const H: i16 = 18_000;
    let grid = VoxelGrid::over([L; 3], [H; 3], 512)?;
    expect_same("voxels to a side", &grid.dims, &[512; 3])?;
    let segments = [[[L; 3], [H; 3]], [[L, H, L], [H, L, H]], [[L; 3], [H, L, L]], [[L; 3], [L, H, L]]];
    let rectangle = |z: i16| [[L, L, z], [H, L, z], [L, H, z], [L, H, z], [H, L, z], [H, H, z - 1]];
    let lines = segments.iter().flat_map(|&[a, b]| [a, b, a]);
    let stack = mesh_of(lines.clone().chain((-4..=4).flat_map(|i| rectangle(4000 * i))).collect());
    let gpu = backend(target)?;
    expect_some(expect_twins_on(&gpu, &stack, &grid, VoxelizeParams::thin())?)?;
    let one = mesh_of(lines.chain(rectangle(0)).collect());
    let params = VoxelizeParams { separation: CONSERVATIVE, cutoff: NO_CUTOFF };
    expect_some(expect_twins_on(&gpu, &one, &grid, params)?)
}

/// The sums of voxels whose buffers were changed.
fn changed_sums(
    gpu: &GpuBackend,
    change: impl FnOnce(&mut Vec<u32>, &mut Vec<u32>, &mut Vec<u32>),
) -> std::result::Result<[Vec<VoxelSums>; 2], Failed> {
    let mesh = soup(41, 200, 3000, 1, false);
    let (grid, params) = (grid_over(&mesh, 32), VoxelizeParams::thin());
    let count = mesh.triangles().len();
    let (surfaces, texels) = (gpu.upload(&surfaces(count))?, gpu.upload(&texels())?);
    let mesh = gpu.upload_mesh(&mesh)?;
    let voxels = gpu.voxelize(&mesh, &grid, &params)?;
    let sums = gpu.sum_voxels(&mesh, &voxels, &surfaces, &texels, &params)?;
    let [(_, mut small), _, (_, mut mask), (_, mut ranks), ..] = downloaded(gpu, &voxels)?;
    change(&mut small, &mut mask, &mut ranks);
    let changed = VoxelBuffers {
        small: gpu.upload(&small)?,
        mask: gpu.upload(&mask)?,
        ranks: gpu.upload(&ranks)?,
        ..voxels
    };
    let changed = gpu.sum_voxels(&mesh, &changed, &surfaces, &texels, &params)?;
    Ok([gpu.download(&sums)?, gpu.download(&changed)?])
}

fn strangers(target: &Target) -> std::result::Result<(), Failed> {
    let gpu = backend(target)?;
    let [sums, got] = changed_sums(&gpu, |small, _, _| small.extend([200, 201, u32::MAX, 1 << 31]))?;
    expect_some(sums.len())?;
    expect_same("with triangles that aren't there", &got, &sums)?;
    let zeroes = vec![VoxelSums::zeroed(); sums.len()];
    let [_, got] = changed_sums(&gpu, |_, mask, _| mask.fill(0))?;
    expect_same("with an empty mask", &got, &zeroes)?;
    let [_, got] = changed_sums(&gpu, |_, _, ranks| ranks.fill(u32::MAX - 64))?;
    expect_same("with ranks beyond the voxels", &got, &zeroes)?;
    let [_, got] = changed_sums(&gpu, |_, mask, ranks| {
        mask.fill(u32::MAX);
        ranks.fill(0);
    })?;
    let count: u32 = got.iter().map(|sums| sums.count).sum();
    // Large triangles are whole, and all of them are in the first voxels.
    expect_same("fragments", &[count], &[sums.iter().map(|sums| sums.count).sum()])?;
    expect_same("voxels behind those of the first word", &got[32..], &zeroes[32..])
}

/// Bindings of 16 KiB: 4096 codes, 341 sums, 512 triangles of a list.
fn small_bindings(target: &Target) -> std::result::Result<(), Failed> {
    let options = DeviceOptions { max_storage_binding_bytes: 16 << 10, ..target.options.clone() };
    let gpu = GpuBackend::new(GpuDevice::open(&options)?);
    let mesh = soup(51, 60, 12_000, 1, false);
    let params = VoxelizeParams { separation: CONSERVATIVE, cutoff: 64 };
    let voxels = expect_twins_on(&gpu, &mesh, &grid_over(&mesh, 28), params)?;
    if voxels <= 4096 {
        return Err(format!("{voxels} voxels fit one binding").into());
    }
    // Their surfaces would have no room.
    let many = soup(52, 600, 4000, 1, false);
    let grid = grid_over(&many, 16);
    let cpu = CpuBackend::new();
    for cutoff in [0, NO_CUTOFF] {
        let params = VoxelizeParams { separation: THIN, cutoff };
        let want = downloaded(&cpu, &cpu.voxelize(&cpu.upload_mesh(&many)?, &grid, &params)?)?;
        let got = downloaded(&gpu, &gpu.voxelize(&gpu.upload_mesh(&many)?, &grid, &params)?)?;
        for ((name, want), (_, got)) in want.iter().zip(&got) {
            expect_same(&format!("{name} of many"), got, want)?;
        }
    }
    match gpu.voxelize(&gpu.upload_mesh(&mesh)?, &grid_over(&mesh, 64), &VoxelizeParams::thin()) {
        Err(Error::LimitExceeded { .. }) => Ok(()),
        other => Err(format!("64³ voxels: {other:?}").into()),
    }
}
