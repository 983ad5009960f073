//! What building costs.

use super::clock::processor_seconds;
use super::{Arguments, spread};
use rayon::prelude::*;
use std::time::Instant;
use twinlight::cpu::CpuBackend;
use twinlight::kernels::rasterize_lhb::{LhbElement, RasterizeLhbParams};
use twinlight::lattice::{Lattice, LatticeMesh, View};
use twinlight::scene::CompiledScene;
use twinlight::{Backend, Result};

/// Builds a view per direction, and writes as many elements, in turn.
pub fn time(backend: &CpuBackend, scene: &CompiledScene, arguments: &Arguments) -> Result<()> {
    let mesh = LatticeMesh::of_scene(&Lattice::of_scene(scene)?, scene)?;
    let resident = backend.upload_mesh(&mesh)?;
    let directions = arguments.directions.directions().iter();
    let views = directions.map(|&d| View::along(d, arguments.size)).collect::<Result<Vec<_>>>()?;
    let params = RasterizeLhbParams { path: arguments.path, ..RasterizeLhbParams::new(arguments.size) };
    let work = mesh.triangles().len() as f64 * views.len() as f64;
    let (mut build, mut floor, mut cores) = (Vec::new(), Vec::new(), Vec::new());
    let mut elements = 0;
    for round in 0..=arguments.rounds {
        let (start, used) = (Instant::now(), processor_seconds());
        let lhb = backend.rasterize_lhb(&resident, &views, &params)?;
        let built = start.elapsed().as_secs_f64();
        let used = processor_seconds() - used;
        let mut copy = backend.download(&lhb.elements)?;
        elements = copy.len();
        let start = Instant::now();
        copy.par_chunks_mut(1 << 16).for_each(|part| part.fill(LhbElement { surface: 1, depth: 1 }));
        let filled = start.elapsed().as_secs_f64();
        assert_eq!(copy.last().map(|e| e.depth), (elements > 0).then_some(1));
        if round > 0 {
            build.push(built);
            cores.push(used / work * 1e9);
            floor.push(filled);
        }
    }
    let ratio = spread(build.iter().zip(&floor).map(|(b, f)| b / f).collect());
    let (time, least, most) = spread(build);
    let (core, core_least, core_most) = spread(cores);
    let (millions, size) = (elements as f64 / 1e6, arguments.size);
    let offsets = views.len() * size as usize * size as usize;
    println!(
        "  build of {} views of {size}²: {:.1} ms ({:.1} to {:.1}), {:.1} M triangle-views/s; {core:.2} ns of a core each \
         ({core_least:.2} to {core_most:.2})",
        views.len(),
        time * 1e3,
        least * 1e3,
        most * 1e3,
        work / time / 1e6,
    );
    println!(
        "  {millions:.2} M elements, {:.2} to a pixel, {:.0} M/s; {:.1} times writing them ({:.1} to {:.1}); 8 bytes each and \
         {:.1} MB of offsets, 16 fixed layers would take {:.1} times as much",
        elements as f64 / offsets as f64,
        millions / time,
        ratio.0,
        ratio.1,
        ratio.2,
        offsets as f64 * 4e-6,
        offsets as f64 * (16.0 * 8.0 + 4.0) / (elements as f64 * 8.0 + offsets as f64 * 4.0),
    );
    Ok(())
}
