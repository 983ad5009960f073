//! Layered hit buffers against a reference that tests every pixel of every triangle in 64 and 128 bits.

use crate::{Check, Target, expect_same, numbers};
use bytemuck::Zeroable;
use glam::DVec3;
use libtest_mimic::Failed;
use twinlight_backend_gpu::kernels::rasterize_lhb::{ListSums, RasterizeLhbBlock, SOURCE};
use twinlight_backend_gpu::{DeviceOptions, GpuBackend, GpuDevice};
use twinlight_core::kernels::rasterize_lhb::{
    CAP_FAR, CAP_NEAR, LhbElement, PATH_AUTO, PATH_SPANS, RasterizeLhbParams,
};
use twinlight_core::lattice::{DEPTH_ORIGIN, LatticeMesh, View, subpixel_bits};
use twinlight_core::{Backend, Error};

pub const CHECKS: &[(&str, Check)] = &[
    ("lhb: soups of every size of triangle, on every path", soups),
    ("lhb: triangles as large as the view", giants),
    ("lhb: nothing, and triangles that cover nothing", nothing),
    ("lhb: caps keep the nearest and the farthest", caps),
    ("lhb: a million layers", layers),
    ("lhb: lists around the lengths that change how they are sorted", lengths),
    ("lhb: sums of layers don't wrap", sums),
    ("d3: layered hit buffers in batches, or beyond a binding", small_bindings),
];

type Lists = Vec<Vec<LhbElement>>;

fn area([a, b, c]: [[i64; 3]; 3]) -> i64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

fn project(view: &View, size: u32, vertex: [i16; 3]) -> [i64; 3] {
    let along = |row: [i32; 4]| (0..3).map(|c| i64::from(row[c]) * i64::from(vertex[c])).sum::<i64>();
    let origin = (i64::from(size) << (subpixel_bits(size) + 14)) + (1 << 14);
    [(along(view.right) + origin) >> 15, (along(view.down) + origin) >> 15, along(view.forward)]
}

/// The depth of the contract, less [`DEPTH_ORIGIN`], at column i and row j.
fn depth(p: [[i64; 3]; 3], half: i64, (i, j): (i64, i64)) -> i64 {
    let pixel = 2 * half;
    let first = |axis: usize| {
        let low = p.iter().map(|v| v[axis]).min().unwrap_or(0);
        ((low / pixel - 1).max(0)..).find(|i| i * pixel + half >= low).unwrap_or(0)
    };
    let (i0, j0) = (first(0), first(1));
    let n_x = (p[1][2] - p[0][2]) * (p[2][1] - p[0][1]) - (p[2][2] - p[0][2]) * (p[1][1] - p[0][1]);
    let n_y = (p[2][2] - p[0][2]) * (p[1][0] - p[0][0]) - (p[1][2] - p[0][2]) * (p[2][0] - p[0][0]);
    let a = i128::from(area(p));
    let r = |n: i128| (n + a / 2).div_euclid(a) as i64;
    let (x, y) = (i0 * pixel + half - p[0][0], j0 * pixel + half - p[0][1]);
    let there = i128::from(n_x) * i128::from(x) + i128::from(n_y) * i128::from(y);
    let step = |n: i64| r(i128::from(n) * i128::from(pixel));
    let z = p[0][2] + r(there) + (i - i0) * step(n_x) + (j - j0) * step(n_y);
    let depths = p.map(|v| v[2]);
    z.clamp(depths.into_iter().min().unwrap_or(z), depths.into_iter().max().unwrap_or(z))
}

fn covers(p: [[i64; 3]; 3], centre: [i64; 2]) -> bool {
    (0..3).all(|k| {
        let (a, b) = (p[k], p[(k + 1) % 3]);
        let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
        let e = dx * (centre[1] - a[1]) - dy * (centre[0] - a[0]);
        e > 0 || e == 0 && (dy < 0 || dy == 0 && dx > 0)
    })
}

fn reference(mesh: &LatticeMesh, views: &[View], size: u32) -> Lists {
    let n = i64::from(size);
    let half = 1 << (subpixel_bits(size) - 1);
    let mut lists = vec![Vec::new(); views.len() * (n * n) as usize];
    for (v, view) in views.iter().enumerate() {
        for (t, triangle) in mesh.triangles().iter().enumerate() {
            let mut p = triangle.map(|vertex| project(view, size, mesh.vertices()[vertex as usize]));
            let front = area(p) < 0;
            if front {
                p.swap(1, 2);
            }
            if area(p) == 0 {
                continue;
            }
            // A pixel more than the bounds on every side.
            let range = |axis: usize| {
                let [a, b, c] = p.map(|v| v[axis] / (2 * half));
                (a.min(b).min(c) - 1).max(0)..(a.max(b).max(c) + 2).min(n)
            };
            for (j, i) in range(1).flat_map(|j| range(0).map(move |i| (j, i))) {
                if covers(p, [(2 * i + 1) * half, (2 * j + 1) * half]) {
                    let depth = (depth(p, half, (i, j)) + i64::from(DEPTH_ORIGIN)) as u32;
                    let surface = 2 * t as u32 + u32::from(front);
                    lists[v * (n * n) as usize + (j * n + i) as usize].push(LhbElement { surface, depth });
                }
            }
        }
    }
    for list in &mut lists {
        list.sort_by_key(|e| (e.depth, e.triangle()));
    }
    lists
}

fn backend(target: &Target) -> Result<GpuBackend, Failed> {
    Ok(GpuBackend::new(target.device()?.clone()))
}

/// The lists, and what the cap left out.
fn lists(
    gpu: &GpuBackend,
    mesh: &LatticeMesh,
    views: &[View],
    params: RasterizeLhbParams,
) -> Result<(Lists, Vec<u32>), Failed> {
    let lhb = gpu.rasterize_lhb(&gpu.upload_mesh(mesh)?, views, &params)?;
    let (offsets, elements) = (gpu.download(&lhb.offsets)?, gpu.download(&lhb.elements)?);
    expect_same("offsets", &[offsets.len()], &[views.len() * (params.size * params.size) as usize + 1])?;
    expect_same("last offset", &[offsets[offsets.len() - 1] as usize], &[elements.len()])?;
    let lists = offsets.windows(2).map(|w| elements[w[0] as usize..w[1] as usize].to_vec()).collect();
    Ok((lists, gpu.download(&lhb.left_out)?))
}

fn expect_lists(
    gpu: &GpuBackend,
    mesh: &LatticeMesh,
    views: &[View],
    size: u32,
    paths: std::ops::RangeInclusive<u32>,
) -> Result<(), Failed> {
    let want = reference(mesh, views, size);
    for path in paths {
        let (got, left_out) =
            lists(gpu, mesh, views, RasterizeLhbParams { path, ..RasterizeLhbParams::new(size) })?;
        let lengths = |lists: &Lists| lists.iter().map(Vec::len).collect::<Vec<_>>();
        expect_same(&format!("lengths, size {size}, path {path}"), &lengths(&got), &lengths(&want))?;
        expect_same(&format!("elements, size {size}, path {path}"), &got.concat(), &want.concat())?;
        expect_same("left out", &left_out, &[])?;
    }
    Ok(())
}

/// Random triangles, the k-th `reach >> k % 8` wide.
pub fn soup(seed: u64, triangles: usize, reach: i16) -> LatticeMesh {
    let words = numbers(seed, 12 * triangles);
    let mut vertices = Vec::new();
    for (k, words) in words.chunks_exact(12).enumerate() {
        let width = i64::from(reach >> (k % 8)).max(1);
        for corner in 0..3 {
            vertices.push([0, 1, 2].map(|axis| {
                let centre = words[axis] as i64 % 18_000;
                let offset = words[3 + 3 * corner + axis] as i64 % width;
                (centre + offset).clamp(-18_900, 18_900) as i16
            }));
        }
    }
    let triangles = (0..triangles as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
    LatticeMesh::new(vertices, triangles).expect("in reach")
}

pub fn views(seed: u64, count: usize, size: u32) -> Vec<View> {
    let axes = [DVec3::new(1.0, 0.0, 0.0), DVec3::new(0.0, 0.0, -1.0)];
    let part = |n: u64| (n % 2001) as f64 / 1000.0 - 1.0;
    let random = numbers(seed, 3 * count);
    let random = random.chunks_exact(3).map(|n| DVec3::new(part(n[0]), part(n[1]), part(n[2]) + 1e-3));
    axes.into_iter().chain(random).take(count).map(|d| View::along(d, size).expect("a view")).collect()
}

fn soups(target: &Target) -> Result<(), Failed> {
    let gpu = backend(target)?;
    for (seed, size) in [(1, 1), (2, 2), (3, 5), (4, 16), (5, 37), (6, 64), (7, 100)] {
        expect_lists(&gpu, &soup(seed, 150, 18_000), &views(seed, 3, size), size, PATH_AUTO..=PATH_SPANS)?;
    }
    // Areas of a few units, where every rounding of a depth shows.
    for (seed, reach) in [(8, 40), (9, 120)] {
        expect_lists(&gpu, &soup(seed, 6000, reach), &views(seed, 2, 1024), 1024, PATH_AUTO..=PATH_AUTO)?;
    }
    Ok(())
}

/// Loops of llvmpipe end after 65535 rounds; a view of 1024² has a million pixels. The corners are as far away as corners
/// can be, so that every product is as large as it gets.
fn giants(target: &Target) -> Result<(), Failed> {
    let gpu = backend(target)?;
    let corners = vec![
        [-23_164, -23_164, 0],
        [23_164, -23_164, 0],
        [-23_164, 23_164, 0],
        [23_164, 23_164, 0],
        [0, 0, 32_760],
        [0, 0, -32_760],
        [32_760, 0, 0],
        [-32_759, 100, 0],
        [-32_759, 0, 0],
    ];
    let triangles = vec![[0, 1, 2], [1, 3, 2], [0, 4, 3], [5, 6, 1], [6, 7, 8], [0, 3, 3]];
    let mesh = LatticeMesh::new(corners, triangles).expect("in reach");
    // Seen from nearly above, the rounded steps of 1000 pixels leave the range of the vertices.
    for (size, direction) in [
        (1024, DVec3::new(0.0, 0.0, 1.0)),
        (1024, DVec3::new(0.3, -0.2, 0.9)),
        (1000, DVec3::new(1.2e-4, 0.7e-4, 1.0)),
    ] {
        let view = View::along(direction, size).expect("a view");
        expect_lists(&gpu, &mesh, &[view], size, PATH_AUTO..=PATH_SPANS)?;
    }
    Ok(())
}

fn nothing(target: &Target) -> Result<(), Failed> {
    let gpu = backend(target)?;
    let line =
        LatticeMesh::new(vec![[0, 0, 0], [900, 900, 900], [1800, 1800, 1800]], vec![[0, 1, 2], [1, 1, 1]])
            .expect("in reach");
    for path in PATH_AUTO..=PATH_SPANS {
        for (mesh, count) in [(&line, 3), (&line, 0), (&LatticeMesh::default(), 2)] {
            let views = views(9, count, 16);
            let params = RasterizeLhbParams { path, layer_cap: 1, ..RasterizeLhbParams::new(16) };
            let (got, left_out) = lists(&gpu, mesh, &views, params)?;
            expect_same("lists", &got, &vec![vec![]; 256 * count])?;
            expect_same("left out", &left_out, &vec![0; 256 * count])?;
        }
    }
    let views = views(9, 1, 8);
    let refused = gpu.rasterize_lhb(&gpu.upload_mesh(&line)?, &views, &RasterizeLhbParams::new(1025));
    expect_same("size 1025", &[matches!(refused, Err(Error::LimitExceeded { .. }))], &[true])
}

fn caps(target: &Target) -> Result<(), Failed> {
    let gpu = backend(target)?;
    let (mesh, views, size) = (soup(11, 200, 18_000), views(11, 2, 24), 24);
    let whole = reference(&mesh, &views, size);
    for layer_cap in [1, 2, 7, 1000] {
        for cap_side in [CAP_NEAR, CAP_FAR] {
            let params = RasterizeLhbParams { layer_cap, cap_side, ..RasterizeLhbParams::new(size) };
            let (got, left_out) = lists(&gpu, &mesh, &views, params)?;
            let keep = |list: &Vec<LhbElement>| {
                let kept = list.len().min(layer_cap as usize);
                let begin = if cap_side == CAP_FAR { list.len() - kept } else { 0 };
                list[begin..begin + kept].to_vec()
            };
            let want: Lists = whole.iter().map(keep).collect();
            expect_same(&format!("{layer_cap} on side {cap_side}"), &got, &want)?;
            let want: Vec<u32> =
                whole.iter().map(|list| list.len().saturating_sub(layer_cap as usize) as u32).collect();
            expect_same("left out", &left_out, &want)?;
        }
    }
    Ok(())
}

/// `count` triangles in front of each other that cover the one pixel of a view, in no order of depth.
pub fn stack(count: u32) -> LatticeMesh {
    let mut vertices = Vec::new();
    for z in -1000..1000 {
        vertices.extend([[-15_000, -12_000, z], [15_000, -12_000, z], [0, 20_000, z + z % 3]]);
    }
    let triangle = |t: u32| 3 * ((t.wrapping_mul(2_654_435_761) >> 5) % 2000);
    let triangles = (0..count).map(|t| [triangle(t), triangle(t) + 1, triangle(t) + 2]).collect();
    LatticeMesh::new(vertices, triangles).expect("in reach")
}

/// Hard case R8: one list of many rounds of merging, by a number of them that is even and one that isn't.
fn layers(target: &Target) -> Result<(), Failed> {
    let gpu = backend(target)?;
    let view = View::along(DVec3::new(0.0, 0.0, 1.0), 1).expect("a view");
    for count in [100_000, 1_000_000] {
        expect_lists(&gpu, &stack(count), &[view], 1, PATH_AUTO..=PATH_AUTO)?;
    }
    Ok(())
}

fn lengths(target: &Target) -> Result<(), Failed> {
    let gpu = backend(target)?;
    let view = View::along(DVec3::new(0.0, 0.0, 1.0), 1).expect("a view");
    for count in [1, 2, 31, 32, 33, 64, 65, 1023, 1024, 1025, 2048, 2049, 4097] {
        expect_lists(&gpu, &stack(count), &[view], 1, PATH_AUTO..=PATH_AUTO)?;
    }
    Ok(())
}

/// More layers than a test can draw: 2³² and more are told from few by the sums alone, because offsets wrap.
fn sums(target: &Target) -> Result<(), Failed> {
    let device = target.device()?;
    let mut counts = vec![u32::MAX >> 1; 5000];
    counts[4321] = u32::MAX;
    let params = RasterizeLhbBlock { list_count: counts.len() as u32, ..RasterizeLhbBlock::zeroed() };
    let (counts, sums) = (device.upload(&counts)?, device.zeroed::<ListSums>(2)?);
    let mut recorder = device.record("sum up layers");
    let buffers = [("counts", counts.binding()), ("list_sums", sums.binding())];
    recorder.dispatch("sum lists", &device.pipeline(&SOURCE, "sum_lists")?, &params, &buffers, 2)?;
    recorder.run()?;
    let sums = device.download(&sums)?;
    let total: u64 = sums.iter().map(|s| u64::from(s.elements_high) << 32 | u64::from(s.elements_low)).sum();
    expect_same("sum", &[total], &[4999 * 0x7fff_ffff + 0xffff_ffff])?;
    expect_same("longest", &[sums[0].longest, sums[1].longest], &[u32::MAX >> 1, u32::MAX])
}

/// Bindings of 16 KiB: pairs come in batches, lists and elements beyond are refused.
fn small_bindings(target: &Target) -> Result<(), Failed> {
    let binding = 1 << 14;
    let options = DeviceOptions { max_storage_binding_bytes: binding, ..target.options.clone() };
    let gpu = GpuBackend::new(GpuDevice::open(&options)?);
    let (mesh, size) = (soup(13, 600, 1500), 16);
    let views = views(13, 12, size);
    expect_lists(&gpu, &mesh, &views, size, PATH_AUTO..=PATH_SPANS)?;
    let limit_of = |mesh: &LatticeMesh, views: &[View], size| match gpu
        .upload_mesh(mesh)
        .and_then(|m| gpu.rasterize_lhb(&m, views, &RasterizeLhbParams::new(size)))
    {
        Err(Error::LimitExceeded { what, limit, .. }) if limit == binding => Ok(what),
        other => Err(format!("{other:?} for a limit of {binding}")),
    };
    let named = |what: String, name: &str| expect_same(&what, &[what.contains(name)], &[true]);
    named(limit_of(&mesh, &views, 128)?, "offsets")?;
    named(limit_of(&soup(1, 600, 18_000), &views, size)?, "elements")?;
    named(limit_of(&soup(1, 2000, 1), &views, size)?, "vertices")
}
