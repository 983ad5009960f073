//! Layered hit buffers: triangle-views per second, what an element costs beside writing it to memory, lookups beside
//! traced rays, updates beside whole builds, and what elements take in each format.
//!
//! `cargo bench -p twinlight --bench lhb -- [SCENE…] [--directions N] [--size N] [--rounds N] [--path 0..4]
//! [--part builds|lookups|updates|formats] [--dump FILE]`
//!
//! Builds draw a view per direction, though opposite directions share one: that is the work that is compared. The floor is
//! filling as many bytes of the same vector from the same threads, in turn with the builds. Lookups are cosine-weighted rays
//! from random points of the scene's surfaces, in the order of their directions; the rays traced beside them are the same. Updates
//! and whole builds are in turn, of the same frames, a view per line: what stays is kept, and an object is moved. Formats are
//! made in turn with builds of a view per line. `--dump` writes
//! triangles and rays for `benchmarks/embree_rays.cpp`.

#[path = "../../backend-cpu/benches/trace/clock.rs"]
mod clock;
mod queries;

mod build;
mod formats;
mod update;

use std::path::PathBuf;
use twinlight::cpu::CpuBackend;
use twinlight::directions::DirectionSet;
use twinlight::methods::slhb::LookupSettings;
use twinlight::scene::{CompiledScene, Limits, compile};
use twinlight::{Backend, io};

/// Lookups and rays that are timed.
const QUERIES: usize = 1 << 22;

struct Arguments {
    scenes: Vec<String>,
    directions: DirectionSet,
    size: u32,
    rounds: usize,
    path: u32,
    part: Option<String>,
    dump: Option<PathBuf>,
}

impl Arguments {
    fn wants(&self, part: &str) -> bool {
        self.part.as_deref().is_none_or(|wanted| wanted == part)
    }
}

fn arguments() -> Result<Arguments, Box<dyn std::error::Error>> {
    let (scenes, directions) = (Vec::new(), "320".parse()?);
    let mut parsed = Arguments { scenes, directions, size: 128, rounds: 5, path: 0, part: None, dump: None };
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        let mut value = || words.next().ok_or_else(|| format!("{word} needs a value"));
        match word.as_str() {
            "--directions" => parsed.directions = value()?.parse()?,
            "--size" => parsed.size = value()?.parse()?,
            "--rounds" => parsed.rounds = value()?.parse::<usize>()?.max(1),
            "--path" => parsed.path = value()?.parse()?,
            "--part" => parsed.part = Some(value()?),
            "--dump" => parsed.dump = Some(value()?.into()),
            "--bench" => {}
            _ => parsed.scenes.push(word),
        }
    }
    if parsed.scenes.is_empty() {
        parsed.scenes = ["builtin:room-70k", "builtin:room-1m"].map(String::from).to_vec();
    }
    Ok(parsed)
}

/// Median, least and greatest.
fn spread(mut values: Vec<f64>) -> (f64, f64, f64) {
    values.sort_by(f64::total_cmp);
    (values[values.len() / 2], values[0], values[values.len() - 1])
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments = arguments()?;
    let backend = CpuBackend::new();
    for name in &arguments.scenes {
        let read = io::load(name, &io::LoadOptions::default())?;
        let scene = compile(&read, &Limits::default())?;
        println!("{name}: {} triangles, {} threads", scene.triangles.len(), backend.threads());
        if arguments.wants("builds") {
            build::time(&backend, &scene, &arguments)?;
        }
        if arguments.wants("lookups") {
            lookups(&backend, &scene, &arguments)?;
        }
        if arguments.wants("updates") {
            update::time(&backend, &read, &arguments)?;
        }
        if arguments.wants("formats") {
            formats::time(&backend, &scene, &arguments)?;
        }
    }
    Ok(())
}

fn lookups(backend: &CpuBackend, scene: &CompiledScene, arguments: &Arguments) -> twinlight::Result<()> {
    let settings = LookupSettings {
        directions: arguments.directions.clone(),
        size: arguments.size,
        ..LookupSettings::default()
    };
    let resident = backend.upload_scene(scene)?;
    let dump = arguments.dump.as_deref();
    queries::time(backend, scene, &resident, &settings, arguments.rounds, dump)
}
