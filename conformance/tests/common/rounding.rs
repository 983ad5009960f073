//! An adversary on the CPU: threads whose float operations all miss by up to a unit in the last place, to the same side. What exact
//! kernels decide does not move by a bit, because floats only guess there, and integers decide.

use glam::DVec3;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::hint::black_box;
use twinlight_backend_cpu::CpuBackend;
use twinlight_conformance::{Check, Failure};
use twinlight_core::Backend;
use twinlight_core::kernels::merge_lhb::MergeLhbParams;
use twinlight_core::kernels::pack_lhb::PackLhbParams;
use twinlight_core::kernels::query_lhb::LhbQuery;
use twinlight_core::kernels::rasterize_lhb::{LhbElement, RasterizeLhbParams};
use twinlight_core::lattice::{LatticeMesh, View};
use twinlight_fixtures::random::Random;

/// Flush-to-zero and denormals-are-zero, in MXCSR.
pub const FLUSH: u32 = 1 << 15 | 1 << 6;

/// Roundings that are not to the nearest, in MXCSR.
pub const ADVERSARIES: [(&str, u32); 3] =
    [("down", 1 << 13 | FLUSH), ("up", 2 << 13), ("towards zero", 3 << 13 | FLUSH)];

/// A pool of one thread with bits of MXCSR set, as a host may have set it up.
pub fn pool_with(bits: u32) -> Result<ThreadPool, Failure> {
    let set = move |_| {
        let mut state = 0_u32;
        // SAFETY: stores and loads this thread's MXCSR from and to a local; bits 15, 14, 13 and 6 only change how results are
        // rounded and how subnormals are treated.
        unsafe {
            std::arch::asm!("stmxcsr [{}]", in(reg) &mut state);
            state |= bits;
            std::arch::asm!("ldmxcsr [{}]", in(reg) &state);
        }
    };
    let pool = ThreadPoolBuilder::new().num_threads(1).start_handler(set).build();
    pool.map_err(|error| Failure::Mismatch(error.to_string()))
}

/// Some large triangles, and many of a few sub-pixels: the smaller its area, the oftener is a quotient just what is rounded to the
/// next integer.
fn triangles(random: &mut Random) -> twinlight_core::Result<LatticeMesh> {
    let mut vertices = Vec::new();
    for i in 0..9_000 {
        let reach = if i < 20 { 15_000 } else { 6 + i % 20 };
        let mut between = |reach: i16| random.index(2 * reach as usize + 1) as i16 - reach;
        let middle = [(); 3].map(|()| between(3_800));
        vertices.extend([(); 3].map(|()| middle.map(|c| c + between(reach))));
    }
    let numbers = (0..9_000).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    LatticeMesh::new(vertices, numbers)
}

/// Everything exact that is made of a mesh. Meshes, planes and views are made before: snapping to the lattice is where floats do
/// decide, once, on the host.
fn lists_and_hits(
    backend: &CpuBackend,
    mesh: &<CpuBackend as Backend>::Mesh,
    views: &[View],
    params: &RasterizeLhbParams,
    queries: &[LhbQuery],
) -> twinlight_core::Result<(Vec<u32>, Vec<LhbElement>)> {
    let lhb = backend.rasterize_lhb(mesh, views, params)?;
    let RasterizeLhbParams { layer_cap, cap_side, .. } = *params;
    let merge = MergeLhbParams { first_triangle: 9_000, layer_cap, cap_side, padding: 0 };
    let merged = backend.merge_lhb(&lhb, &lhb, &merge)?;
    let packed = backend.pack_lhb(&lhb, &PackLhbParams { layers: 4, cap_side })?;
    let back = backend.unpack_lhb(&packed)?;
    let mut hits = backend.zeroed(queries.len())?;
    backend.query_lhb(mesh, &lhb, views, &backend.upload(queries)?, &mut hits)?;
    let words = [&lhb.offsets, &merged.offsets, &merged.left_out, &packed.words, &packed.left_out];
    let elements = [&lhb.elements, &merged.elements, &back.elements, &hits];
    let offsets = words.map(|buffer| buffer.as_slice()).concat();
    let elements = elements.map(|buffer| buffer.as_slice()).concat();
    Ok((offsets, elements))
}

/// The same bits as in peace.
pub fn adversary_rounds(bits: u32) -> Check {
    let pool = pool_with(bits)?;
    let wrong = |what: String| Err(Failure::Mismatch(what));
    // The control: 1/3 to the nearest is below it, 1/10 above.
    let quotients = || [3.0, 10.0].map(|n: f64| black_box(1.0) / black_box(n));
    if pool.install(quotients) == quotients() {
        return wrong("the pool rounds to the nearest".into());
    }
    let backend = CpuBackend::new();
    for (seed, size, layer_cap) in [(1, 33, 3), (2, 128, 0), (3, 1_024, 2), (4, 1_023, 0)] {
        let mut random = Random::new(seed);
        let mesh = triangles(&mut random)?;
        let resident = backend.upload_mesh(&mesh)?;
        let directions = [DVec3::X, random.direction()];
        let views = directions.map(|d| View::along(d, size)).into_iter().collect::<Result<Vec<_>, _>>()?;
        let query = |corner: &[i16; 3]| LhbQuery {
            position: corner.map(i32::from),
            ray: random.index(4) as u32,
            offset: [0; 2],
            leaves: random.index(2 * 9_000) as u32,
            window: random.index(1 << 30) as u32,
        };
        let queries: Vec<LhbQuery> = mesh.vertices().iter().map(query).collect();
        let params = RasterizeLhbParams { layer_cap, ..RasterizeLhbParams::new(size) };
        let made = || lists_and_hits(&backend, &resident, &views, &params, &queries);
        let (want, got) = (made()?, pool.install(made)?);
        if want != got {
            let apart = want.1.iter().zip(&got.1).filter(|(a, b)| a != b).count();
            return wrong(format!("size {size}: {apart} of {} elements and hits differ", want.1.len()));
        }
    }
    Ok(())
}
