//! Voxels: time to voxelize whole scenes, by the way triangles are worked on.
//!
//! `cargo bench -p twinlight --bench voxels -- [SCENE…] [--grid N,N…] [--rounds N] [--conservative]`
//!
//! In every round each way takes its turn: all triangles at once (triangle-parallel), all split over their cells (cell-parallel), and the
//! default, which splits those with many cells. `wall` is one triangle over half of the grid's middle plane.

mod scenes;

use scenes::snapped;
use std::time::Instant;
use twinlight::cpu::CpuBackend;
use twinlight::kernels::voxelize::{CONSERVATIVE, NO_CUTOFF, THIN, VoxelizeParams};
use twinlight::{Backend, Result};

struct Arguments {
    scenes: Vec<String>,
    grids: Vec<u32>,
    rounds: usize,
    separation: u32,
}

fn arguments() -> std::result::Result<Arguments, Box<dyn std::error::Error>> {
    let mut parsed =
        Arguments { scenes: Vec::new(), grids: vec![128, 256, 512], rounds: 9, separation: THIN };
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        let mut value = || words.next().ok_or_else(|| format!("{word} needs a value"));
        match word.as_str() {
            "--grid" => {
                parsed.grids = value()?.split(',').map(str::parse).collect::<std::result::Result<_, _>>()?
            }
            "--rounds" => parsed.rounds = value()?.parse::<usize>()?.max(1),
            "--conservative" => parsed.separation = CONSERVATIVE,
            "--bench" => {}
            _ => parsed.scenes.push(word),
        }
    }
    if parsed.scenes.is_empty() {
        parsed.scenes = ["wall", "builtin:room-70k", "builtin:room-1m"].map(String::from).to_vec();
    }
    Ok(parsed)
}

/// Median, least and greatest.
fn spread(mut values: Vec<f64>) -> (f64, f64, f64) {
    values.sort_by(f64::total_cmp);
    (values[values.len() / 2], values[0], values[values.len() - 1])
}

fn main() -> std::result::Result<(), Box<dyn std::error::Error>> {
    let arguments = arguments()?;
    let backend = CpuBackend::new();
    for name in &arguments.scenes {
        let scene = snapped(name)?;
        println!("{name}: {} triangles", scene.mesh.triangles().len());
        for &resolution in &arguments.grids {
            time(&backend, &scene, resolution, &arguments)?;
        }
    }
    Ok(())
}

/// Voxelizes in every way, in turn.
fn time(backend: &CpuBackend, scene: &scenes::Snapped, resolution: u32, arguments: &Arguments) -> Result<()> {
    let default = VoxelizeParams::thin().cutoff;
    let ways = [("triangles", NO_CUTOFF), ("cells", 0), ("default", default)];
    let grid = scene.grid(resolution)?;
    let resident = backend.upload_mesh(&scene.mesh)?;
    let mut times = [const { Vec::new() }; 3];
    let (mut active, mut large) = (0, 0);
    for round in 0..=arguments.rounds {
        for (times, (_, cutoff)) in times.iter_mut().zip(ways) {
            let params = VoxelizeParams { separation: arguments.separation, cutoff };
            let start = Instant::now();
            let voxels = backend.voxelize(&resident, &grid, &params)?;
            if round > 0 {
                times.push(start.elapsed().as_secs_f64() * 1e3);
            }
            (active, large) = (backend.len(&voxels.active), backend.len(&voxels.large));
        }
    }
    let [nx, ny, nz] = grid.dims;
    println!("  {nx}x{ny}x{nz}: {active} voxels, {large} large triangles");
    for ((name, _), times) in ways.iter().zip(&times) {
        let (median, least, most) = spread(times.clone());
        println!("    {name:9} {median:8.2} ms ({least:.2} to {most:.2})");
    }
    let better = times[0].iter().zip(&times[1]).map(|(a, b)| a.min(*b));
    let ratio = spread(times[2].iter().zip(better).map(|(own, better)| own / better).collect());
    println!(
        "    default beside the better of the others: {:.2} ({:.2} to {:.2})",
        ratio.0, ratio.1, ratio.2
    );
    Ok(())
}
