//! Layered hit buffers: triangle-views per second, and what an element costs beside writing it to memory.
//!
//! `cargo bench -p twinlight --bench lhb -- [SCENE…] [--views N] [--size N] [--rounds N] [--path 0..4]`
//!
//! The floor is filling as many bytes of the same vector from the same threads, in turn with the builds.

#[path = "../backend-cpu/benches/trace/clock.rs"]
mod clock;

use clock::processor_seconds;
use rayon::prelude::*;
use std::time::Instant;
use twinlight::kernels::rasterize_lhb::{LhbElement, RasterizeLhbParams};
use twinlight::lattice::{Lattice, LatticeMesh, View};
use twinlight::{Backend, cpu::CpuBackend, io};

struct Arguments {
    scenes: Vec<String>,
    views: u32,
    size: u32,
    rounds: usize,
    path: u32,
}

fn arguments() -> Arguments {
    let mut parsed = Arguments { scenes: Vec::new(), views: 320, size: 128, rounds: 5, path: 0 };
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        let mut number = |default: u32| words.next().and_then(|w| w.parse().ok()).unwrap_or(default);
        match word.as_str() {
            "--views" => parsed.views = number(parsed.views).max(1),
            "--size" => parsed.size = number(parsed.size).max(1),
            "--rounds" => parsed.rounds = number(5).max(1) as usize,
            "--path" => parsed.path = number(0),
            "--bench" => {}
            _ => parsed.scenes.push(word),
        }
    }
    if parsed.scenes.is_empty() {
        parsed.scenes = ["builtin:room-70k", "builtin:room-1m"].map(String::from).to_vec();
    }
    parsed
}

/// Median, least and greatest.
fn spread(mut values: Vec<f64>) -> (f64, f64, f64) {
    values.sort_by(f64::total_cmp);
    (values[values.len() / 2], values[0], values[values.len() - 1])
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments = arguments();
    let backend = CpuBackend::new();
    for name in &arguments.scenes {
        let scene = io::load(name, &io::LoadOptions::default())?;
        let compiled = twinlight::scene::compile(&scene, &twinlight::scene::Limits::default())?;
        let lattice = Lattice::of_scene(&compiled)?;
        let mesh = LatticeMesh::of_scene(&lattice, &compiled)?;
        let resident = backend.upload_mesh(&mesh)?;
        let views = directions(arguments.views)
            .map(|d| View::along(d, arguments.size))
            .collect::<Result<Vec<_>, _>>()?;
        let params = RasterizeLhbParams { path: arguments.path, ..RasterizeLhbParams::new(arguments.size) };
        let work = mesh.triangles().len() as f64 * f64::from(arguments.views);
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
                cores.push(used);
                floor.push(filled);
            }
        }
        let ratio = spread(build.iter().zip(&floor).map(|(b, f)| b / f).collect());
        let (time, least, most) = spread(build);
        println!(
            "{name}: {} triangles, {} vertices, {} views of {}²",
            mesh.triangles().len(),
            mesh.vertices().len(),
            arguments.views,
            arguments.size
        );
        println!(
            "  build {:.1} ms ({:.1} to {:.1}), {:.1} M triangle-views/s, {:.1} M elements ({:.1} M/s), {:.2} to a pixel",
            time * 1e3,
            least * 1e3,
            most * 1e3,
            work / time / 1e6,
            elements as f64 / 1e6,
            elements as f64 / time / 1e6,
            elements as f64 / f64::from(arguments.views * arguments.size * arguments.size),
        );
        let (cores, least, most) = spread(cores.iter().map(|c| c / work * 1e9).collect());
        println!("  a triangle-view takes {cores:.2} ns of a core ({least:.2} to {most:.2})");
        println!("  beside writing the elements: {:.1} ({:.1} to {:.1})", ratio.0, ratio.1, ratio.2);
    }
    Ok(())
}

/// Evenly spread directions: a spiral.
fn directions(count: u32) -> impl Iterator<Item = glam::DVec3> {
    let turn = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    (0..count).map(move |i| {
        let y = 1.0 - (f64::from(i) + 0.5) * 2.0 / f64::from(count);
        let radius = (1.0 - y * y).sqrt();
        let angle = turn * f64::from(i);
        glam::DVec3::new(radius * angle.cos(), y, radius * angle.sin())
    })
}
