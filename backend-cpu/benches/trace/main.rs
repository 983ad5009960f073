//! Rays per second of the eight-wide hierarchy, beside obvhs's own compressed eight-wide one of the same triangles.
//!
//! `cargo bench -p twinlight-backend-cpu --bench trace -- [SCENE…] [--rounds N] [--threads N] [--dump FILE]`
//!
//! All contenders trace the same rays in turn, slice by slice, timed in processor time: what else the machine does hits
//! all alike.
//! With `--dump`, the triangles and the rays are also written, for tracers of other languages: three little-endian u32
//! (triangles, closest rays, any-hit rays), then 9 f32 per triangle in id order, then 8 f32 per ray (origin, t_min,
//! direction, t_max); and to FILE.hits 4 words per closest ray: t, u, v as f32 bits, id.

mod clock;
mod contender;
mod rays;
mod report;

use clock::processor_seconds;
use contender::{Contender, contenders};
use rays::{Rays, bounce_rays};
use report::{Timing, print_header, print_row};
use std::time::Instant;
use twinlight_backend_cpu::bvh8::WideBvh;
use twinlight_core::bvh;
use twinlight_core::kernels::trace::Ray;
use twinlight_core::scene::{CompiledScene, Limits, compile};

/// Rays timed at a time: some milliseconds.
const SLICE: usize = 1 << 15;

struct Arguments {
    scenes: Vec<String>,
    rounds: usize,
    threads: usize,
    dump: Option<String>,
}

fn arguments() -> Arguments {
    let mut parsed = Arguments { scenes: Vec::new(), rounds: 40, threads: 2, dump: None };
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        let mut number = |default: usize| words.next().and_then(|w| w.parse().ok()).unwrap_or(default);
        match word.as_str() {
            "--rounds" => parsed.rounds = number(parsed.rounds).max(1),
            "--threads" => parsed.threads = number(parsed.threads).max(1),
            "--dump" => parsed.dump = words.next(),
            "--bench" => {}
            _ => parsed.scenes.push(word),
        }
    }
    if parsed.scenes.is_empty() {
        parsed.scenes = ["room-70k", "room-1m"].map(String::from).to_vec();
    }
    parsed
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments = arguments();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(arguments.threads).build()?;
    for name in &arguments.scenes {
        let source =
            twinlight_fixtures::scenes::builtin(name).ok_or_else(|| format!("no builtin scene {name}"))?;
        let scene = compile(&source, &Limits::default())?;
        let wide = WideBvh::new(&scene);
        let rays = bounce_rays(&source, &scene, &wide)?;
        describe(name, &scene, &wide, &rays);
        if let Some(file) = &arguments.dump {
            rays::dump(file, &scene, &wide, &rays)?;
        }
        let list = contenders(&scene, &wide);
        pool.install(|| {
            for (kind, set, any) in [
                ("closest", &rays.bounce, false),
                ("closest, camera", &rays.camera, false),
                ("any", &rays.shadow, true),
            ] {
                print_header(kind, arguments.threads, arguments.rounds);
                for (contender, timing) in list.iter().zip(race(&list, set, any, arguments.rounds)) {
                    print_row(contender.name, &timing);
                }
            }
        });
    }
    Ok(())
}

/// Sizes, build times, and how much work a ray is.
fn describe(name: &str, scene: &CompiledScene, wide: &WideBvh, rays: &Rays) {
    let triangles: Vec<[[f32; 3]; 3]> = scene.triangles.iter().map(|t| [t.p0, t.p1, t.p2]).collect();
    let mut times = [f64::INFINITY; 2];
    for _ in 0..3 {
        let start = Instant::now();
        std::hint::black_box(bvh::build(&triangles));
        times[0] = times[0].min(start.elapsed().as_secs_f64());
        let start = Instant::now();
        std::hint::black_box(WideBvh::new(scene));
        times[1] = times[1].min(start.elapsed().as_secs_f64());
    }
    let (nodes, packs, bytes) = wide.size();
    println!(
        "\n{name}: {} triangles, {nodes} nodes, {packs} packs, {:.1} MB",
        triangles.len(),
        bytes as f64 / 1e6
    );
    let (filled, children) = wide.fill();
    println!("  {filled:.2} triangles per pack, {children:.2} children per node");
    println!("  built in {:.0} ms (binary) + {:.0} ms (wide)", times[0] * 1e3, times[1] * 1e3);
    let mut sums = [0_u64; 2];
    for ray in &rays.bounce {
        let visits = wide.count_visits(ray.origin.into(), ray.direction.into(), ray.t_min, ray.t_max);
        sums[0] += visits.nodes;
        sums[1] += visits.packs;
    }
    let per_ray = sums.map(|sum| sum as f64 / rays.bounce.len() as f64);
    println!("  a closest hit visits {:.1} nodes and {:.1} packs", per_ray[0], per_ray[1]);
}

/// Every contender's times for the slices of `rays`, in turn.
fn race(list: &[Contender<'_>], rays: &[Ray], any: bool, rounds: usize) -> Vec<Timing> {
    let mut timings: Vec<Timing> = list.iter().map(|_| Timing::default()).collect();
    let threads = rayon::current_num_threads() as f64;
    let slices: Vec<&[Ray]> = rays.chunks_exact(SLICE).collect();
    for round in 0..=rounds {
        let slice = slices[round % slices.len()];
        for (contender, timing) in list.iter().zip(&mut timings) {
            let start = processor_seconds();
            let hits = if any { (contender.any)(slice) } else { (contender.closest)(slice) };
            let seconds = (processor_seconds() - start) / threads;
            // The first round warms caches up.
            if round > 0 {
                timing.add(slice.len(), hits, seconds);
            }
        }
    }
    timings
}
