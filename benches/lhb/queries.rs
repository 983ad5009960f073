//! Lookups beside traced rays.

use super::clock::processor_seconds;
use super::{QUERIES, spread};
use glam::Vec3;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;
use std::time::Instant;
use twinlight::cpu::{CpuBackend, CpuScene};
use twinlight::fixtures::random::Random;
use twinlight::kernels::query_lhb::LhbQuery;
use twinlight::kernels::rasterize_lhb::LhbElement;
use twinlight::kernels::trace::{Hit, Ray};
use twinlight::math::octahedral::nearest_direction;
use twinlight::math::vector::{basis, to_world};
use twinlight::methods::slhb::{Buffers, LookupSettings, build};
use twinlight::scene::CompiledScene;
use twinlight::transport::bsdf::cosine_hemisphere;
use twinlight::transport::lhb::lhb_query;
use twinlight::transport::light::FAR;
use twinlight::{Backend, Error, Result};

/// Times as many lookups as rays.
pub fn time(
    backend: &CpuBackend,
    scene: &CompiledScene,
    resident: &CpuScene,
    settings: &LookupSettings,
    rounds: usize,
    dump: Option<&Path>,
) -> Result<()> {
    let buffers = build(backend, scene, settings)?;
    let map = backend.download(&buffers.map)?;
    let mut work: Vec<(LhbQuery, Ray)> =
        bounces(scene).map(|(o, n, d, s)| query(&buffers, &map, o, n, d, s)).collect();
    work.sort_by_key(|(query, _)| query.ray);
    let (queries, rays): (Vec<_>, Vec<_>) = work.into_iter().unzip();
    if let Some(path) = dump {
        write(path, scene, &rays)
            .map_err(|error| Error::invalid(path.display().to_string(), error.to_string()))?;
    }
    let (queries, rays) = (backend.upload(&queries)?, backend.upload(&rays)?);
    let mut elements = backend.zeroed::<LhbElement>(QUERIES)?;
    let mut hits = backend.zeroed::<Hit>(QUERIES)?;
    let (mut looked_up, mut ratios, mut cores) = (Vec::new(), Vec::new(), Vec::new());
    let Buffers { mesh, lhb, views, .. } = &buffers;
    for round in 0..=rounds {
        let (start, used) = (Instant::now(), processor_seconds());
        backend.query_lhb(mesh, lhb, views, &queries, &mut elements)?;
        let (lookup, core) = (start.elapsed().as_secs_f64(), processor_seconds() - used);
        let used = processor_seconds();
        backend.trace_closest(resident, &rays, &mut hits)?;
        let traced = processor_seconds() - used;
        if round > 0 {
            looked_up.push(QUERIES as f64 / lookup / 1e6);
            cores.push(core / QUERIES as f64 * 1e9);
            ratios.push(traced / core);
        }
    }
    let (rate, least, most) = spread(looked_up);
    let (core, ratio) = (spread(cores), spread(ratios));
    println!(
        "  lookups: {rate:.1} M/s ({least:.1} to {most:.1}), {:.1} ns of a core ({:.1} to {:.1}), {:.1} times as fast as tracing \
         ({:.1} to {:.1}, processor time)",
        core.0, core.1, core.2, ratio.0, ratio.1, ratio.2
    );
    Ok(())
}

/// The numbers of triangles and rays as u64, the corners, the rays; everything little-endian where the machine is.
fn write(path: &Path, scene: &CompiledScene, rays: &[Ray]) -> std::io::Result<()> {
    let mut file = BufWriter::new(File::create(path)?);
    for count in [scene.triangles.len(), rays.len()] {
        file.write_all(&(count as u64).to_ne_bytes())?;
    }
    for triangle in &scene.triangles {
        for coordinate in [triangle.p0, triangle.p1, triangle.p2].as_flattened() {
            file.write_all(&coordinate.to_ne_bytes())?;
        }
    }
    for ray in rays {
        let words = [ray.origin[0], ray.origin[1], ray.origin[2], ray.t_min];
        let rest = [ray.direction[0], ray.direction[1], ray.direction[2], ray.t_max];
        for word in [words, rest].as_flattened() {
            file.write_all(&word.to_ne_bytes())?;
        }
    }
    file.flush()
}

/// A random point on a triangle, the normal, a direction away from it, and what it leaves.
fn bounces(scene: &CompiledScene) -> impl Iterator<Item = (Vec3, Vec3, Vec3, u32)> + '_ {
    let mut random = Random::new(1);
    (0..QUERIES).map(move |_| {
        let slot = random.index(scene.triangles.len());
        let triangle = &scene.triangles[slot];
        let [p0, p1, p2] = [triangle.p0, triangle.p1, triangle.p2].map(Vec3::from);
        let [mut u, mut v] = [random.unit() as f32, random.unit() as f32];
        if u + v > 1.0 {
            (u, v) = (1.0 - u, 1.0 - v);
        }
        let normal = Vec3::from(triangle.normal);
        let (tangent, bitangent) = basis(normal);
        let local = cosine_hemisphere(random.unit() as f32, random.unit() as f32);
        let direction = to_world(tangent, bitangent, normal, local);
        (p0 + (p1 - p0) * u + (p2 - p0) * v + normal * triangle.offset, normal, direction, slot as u32)
    })
}

fn query(
    buffers: &Buffers<CpuBackend>,
    map: &[u32],
    origin: Vec3,
    normal: Vec3,
    direction: Vec3,
    slot: u32,
) -> (LhbQuery, Ray) {
    let lookup = &buffers.lookup;
    let code = nearest_direction(map, lookup.map_resolution, direction);
    let view = &buffers.views[(code >> 1) as usize];
    let query = lhb_query(lookup, view, code, origin, normal, slot << 1 | 1);
    let ray = Ray { origin: origin.to_array(), t_min: 0.0, direction: direction.to_array(), t_max: FAR };
    (query, ray)
}
