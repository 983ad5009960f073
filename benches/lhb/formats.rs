//! What elements take in each format, and the time to make it beside the build.

use super::clock::processor_seconds;
use super::{Arguments, spread};
use std::time::Instant;
use twinlight::cpu::CpuBackend;
use twinlight::kernels::pack_lhb::PackLhbParams;
use twinlight::kernels::rasterize_lhb::{CAP_NEAR, RasterizeLhbParams};
use twinlight::lattice::{Lattice, LatticeMesh, View};
use twinlight::scene::CompiledScene;
use twinlight::{Backend, Result};

/// Layers per pixel of Yu's layout.
const LAYERS: u32 = 16;

/// Seconds of the processor and by the wall.
type Lap = (f64, f64);

fn timed<T>(work: impl FnOnce() -> Result<T>) -> Result<(T, Lap)> {
    let (start, used) = (Instant::now(), processor_seconds());
    let made = work()?;
    Ok((made, (processor_seconds() - used, start.elapsed().as_secs_f64())))
}

/// Builds a view per line, packs it into lists and into layers, and reads both back, in turn.
pub fn time(backend: &CpuBackend, scene: &CompiledScene, arguments: &Arguments) -> Result<()> {
    let mesh = LatticeMesh::of_scene(&Lattice::of_scene(scene)?, scene)?;
    let resident = backend.upload_mesh(&mesh)?;
    let lines = arguments.directions.lines().iter();
    let views = lines.map(|&line| View::along(line, arguments.size)).collect::<Result<Vec<_>>>()?;
    let params = RasterizeLhbParams::new(arguments.size);
    let mut laps: [Vec<Lap>; 5] = Default::default();
    let (mut elements, mut lists, mut lost) = (0, 0, Vec::new());
    for round in 0..=arguments.rounds {
        let (lhb, build) = timed(|| backend.rasterize_lhb(&resident, &views, &params))?;
        let pack = |layers| timed(|| backend.pack_lhb(&lhb, &PackLhbParams { layers, cap_side: CAP_NEAR }));
        let (packed, pack_lists) = pack(0)?;
        let (_, unpack_lists) = timed(|| backend.unpack_lhb(&packed))?;
        let (layered, pack_layers) = pack(LAYERS)?;
        let (_, unpack_layers) = timed(|| backend.unpack_lhb(&layered))?;
        if round > 0 {
            let round = [build, pack_lists, unpack_lists, pack_layers, unpack_layers];
            laps.iter_mut().zip(round).for_each(|(laps, lap)| laps.push(lap));
        }
        (elements, lists) = (backend.len(&lhb.elements), backend.len(&layered.left_out));
        lost = backend.download(&layered.left_out)?;
    }
    println!(
        "  formats of {} views of {}²: {:.2} M elements",
        views.len(),
        arguments.size,
        elements as f64 / 1e6
    );
    let layers = LAYERS as usize;
    let per_element = (4 * layers * lists) as f64 / elements as f64;
    let full = 8 * elements + 4 * lists;
    for (format, each, bytes, of_format) in [
        ("full", 8.0, full, None),
        ("packed", 4.0, 4 * elements + 4 * lists, Some(1)),
        ("16 layers", per_element, 4 * (layers + 1) * lists, Some(3)),
    ] {
        let share = bytes as f64 / full as f64;
        println!(
            "    {format}: {each:.1} bytes an element, {:.1} MB in all, {share:.2} of full",
            bytes as f64 / 1e6
        );
        match of_format {
            None => println!("      built in {}", wall(&laps[0])),
            Some(step) => println!(
                "      packed in {}; read back in {}",
                row(&laps[step], &laps[0]),
                row(&laps[step + 1], &laps[0])
            ),
        }
    }
    let sum: u64 = lost.iter().map(|&n| u64::from(n)).sum();
    let short = lost.iter().filter(|&&n| n > 0).count();
    println!(
        "    16 layers lose {sum} elements, {:.3} % of them, in {short} of {lists} pixels",
        sum as f64 / elements as f64 * 100.0
    );
    Ok(())
}

/// Such as `12.0 ms, 3.1 % (2.9 to 3.3) of the build's processor time`.
fn row(laps: &[Lap], build: &[Lap]) -> String {
    let share = spread(laps.iter().zip(build).map(|(lap, build)| lap.0 / build.0 * 100.0).collect());
    format!(
        "{}, {:.1} % ({:.1} to {:.1}) of the build's processor time",
        wall(laps),
        share.0,
        share.1,
        share.2
    )
}

fn wall(laps: &[Lap]) -> String {
    let (median, least, most) = spread(laps.iter().map(|lap| lap.1 * 1e3).collect());
    format!("{median:.1} ms ({least:.1} to {most:.1})")
}
