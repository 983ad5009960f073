//! A frame in which an object moves, beside building everything.

use super::clock::processor_seconds;
use super::{Arguments, spread};
use glam::DVec3;
use std::time::Instant;
use twinlight::cpu::CpuBackend;
use twinlight::fixtures::meshes::displaced_sphere;
use twinlight::kernels::merge_lhb::MergeLhbParams;
use twinlight::kernels::rasterize_lhb::RasterizeLhbParams;
use twinlight::lattice::{Lattice, LatticeMesh, View};
use twinlight::methods::slhb::{Buffers, Kept, LookupSettings, build};
use twinlight::scene::{CompiledScene, Limits, Scene, Transform, compile};
use twinlight::{Backend, Result};

/// Cuts of an icosahedron's edge: 16,820 and 84,500 triangles.
const OBJECTS: [u32; 2] = [29, 65];

/// Radius of the object relative to the room's least extent, which makes it a fifth as wide.
const RADIUS: f64 = 0.1;

/// Where it is from frame to frame, relative to the middle of the room and half its extents.
const POSITIONS: [[f64; 3]; 5] =
    [[0.7, 0.1, 0.3], [-0.6, 0.7, 0.6], [0.0, -0.7, 0.75], [-0.75, 0.0, -0.6], [0.5, 0.8, -0.7]];

/// Seconds by the wall and of the processor, and the kernels' by the wall.
#[derive(Default)]
struct Times {
    wall: Vec<f64>,
    processor: Vec<f64>,
    kernels: Vec<f64>,
}

impl Times {
    fn take(&mut self, work: impl FnOnce() -> Result<Buffers<CpuBackend>>) -> Result<Buffers<CpuBackend>> {
        let (start, used) = (Instant::now(), processor_seconds());
        let buffers = work()?;
        self.wall.push(start.elapsed().as_secs_f64());
        self.processor.push(processor_seconds() - used);
        self.kernels.push(buffers.build_time.as_secs_f64());
        Ok(buffers)
    }
}

/// Times updates and whole builds in turn, with objects of each size at every position.
pub fn time(backend: &CpuBackend, room: &Scene, arguments: &Arguments) -> Result<()> {
    let settings = LookupSettings {
        directions: arguments.directions.clone(),
        size: arguments.size,
        ..LookupSettings::default()
    };
    for frequency in OBJECTS {
        let mut frames = Vec::new();
        let start = Instant::now();
        for position in POSITIONS {
            frames.push(compile(&with_object(room, frequency, position.into()), &Limits::default())?);
        }
        let compiling = start.elapsed().as_secs_f64() / frames.len() as f64;
        println!(
            "  update of {} triangles in {}: frames compiled in {:.0} ms each",
            frames[0].parts().1.len(),
            frames[0].parts().0.len(),
            compiling * 1e3
        );
        updates(backend, &frames, &settings, arguments.rounds)?;
    }
    Ok(())
}

fn with_object(room: &Scene, frequency: u32, position: DVec3) -> Scene {
    let mut scene = room.clone();
    let (low, high) = room.bounds().unwrap_or((DVec3::NEG_ONE, DVec3::ONE));
    let radius = RADIUS * (high - low).min_element();
    scene.add_mesh(displaced_sphere(frequency, DVec3::ZERO, radius, 0.18, 7));
    if let Some(object) = scene.instances.last_mut() {
        let reach = (high - low) * 0.5 - radius * 1.2;
        object.transform = Transform::scale_translate(1.0, (low + high) * 0.5 + position * reach);
        object.moves = true;
    }
    scene
}

fn updates(
    backend: &CpuBackend,
    frames: &[CompiledScene],
    settings: &LookupSettings,
    rounds: usize,
) -> Result<()> {
    let mut kept = Kept::new();
    kept.build(backend, &frames[0], settings)?;
    let (mut update, mut whole) = (Times::default(), Times::default());
    let (mut elements, mut added) = (0, 0);
    for frame in (0..rounds).flat_map(|_| frames) {
        let updated = update.take(|| kept.build(backend, frame, settings))?;
        elements = updated.elements(backend);
        added = elements - updated.kept_elements;
        let built = whole.take(|| build(backend, frame, settings))?;
        assert_eq!((built.elements(backend), built.kept_elements), (elements, 0));
    }
    let rows = [
        ("rasterize what moves and merge", &update.kernels, &whole.kernels, "rasterize everything"),
        ("with snapping and planes", &update.wall, &whole.wall, "with snapping and planes"),
        ("of the processor", &update.processor, &whole.processor, "of the processor"),
    ];
    println!("    {:.2} M elements, {:.2} M of them the object's", elements as f64 / 1e6, added as f64 / 1e6);
    for (what, update, whole, beside) in rows {
        let ratio = spread(update.iter().zip(whole).map(|(u, w)| u / w * 100.0).collect());
        let ms = |times: &[f64]| spread(times.iter().map(|t| t * 1e3).collect()).0;
        println!(
            "    {what}: {:.1} ms; {beside}: {:.1} ms; {:.1} % ({:.1} to {:.1})",
            ms(update),
            ms(whole),
            ratio.0,
            ratio.1,
            ratio.2
        );
    }
    steps(backend, frames, settings, rounds)
}

/// What an update is made of, by processor time.
fn steps(
    backend: &CpuBackend,
    frames: &[CompiledScene],
    settings: &LookupSettings,
    rounds: usize,
) -> Result<()> {
    let lattice = Lattice::of_scene(&frames[0])?;
    let (staying, _) = frames[0].parts();
    let lines = settings.directions.lines().iter();
    let views = lines.map(|&line| View::along(line, settings.size)).collect::<Result<Vec<_>>>()?;
    let params = RasterizeLhbParams::new(settings.size);
    let merging = MergeLhbParams {
        first_triangle: frames[0].moving_from,
        layer_cap: 0,
        cap_side: params.cap_side,
        padding: 0,
    };
    let first = LatticeMesh::of_triangles(&lattice, staying)?;
    let kept = backend.rasterize_lhb(&backend.upload_mesh(&first)?, &views, &params)?;
    let mut times: [Vec<f64>; 4] = Default::default();
    for frame in (0..rounds).flat_map(|_| frames) {
        let mut used = processor_seconds();
        let mut lap = |step: usize| {
            let now = processor_seconds();
            times[step].push((now - used) * 1e3);
            used = now;
        };
        let object = LatticeMesh::of_triangles(&lattice, frame.parts().1)?;
        let resident = backend.upload_mesh(&object)?;
        lap(0);
        let added = backend.rasterize_lhb(&resident, &views, &params)?;
        lap(1);
        backend.merge_lhb(&kept, &added, &merging)?;
        lap(2);
        backend.upload_mesh(&first.followed_by(&object)?)?;
        lap(3);
    }
    let [snap, rasterize, merge, join] = times.map(spread);
    println!(
        "    of which, of the processor: snap {:.1} ms ({:.1} to {:.1}), rasterize {:.1} ({:.1} to {:.1}), merge {:.1} ({:.1} to {:.1}), planes of the \
         whole {:.1} ({:.1} to {:.1})",
        snap.0,
        snap.1,
        snap.2,
        rasterize.0,
        rasterize.1,
        rasterize.2,
        merge.0,
        merge.1,
        merge.2,
        join.0,
        join.1,
        join.2
    );
    Ok(())
}
