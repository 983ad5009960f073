//! The parity law on well-known scans and on modelled rooms, whose border is closed by fans: on every line through a closed mesh there are as many fronts as backs, however
//! many triangles share a pixel.
//!
//! The files are too large to live here: the test runs where `TWINLIGHT_SCENES` names the folder that holds them, and
//! says so where it doesn't.
#![cfg(all(feature = "io", feature = "cpu"))]

use glam::DVec3;
use std::path::Path;
use std::time::Instant;
use twinlight::cpu::CpuBackend;
use twinlight::io::{LoadOptions, load};
use twinlight::kernels::rasterize_lhb::{LhbElement, RasterizeLhbParams};
use twinlight::lattice::{Lattice, LatticeMesh, View};
use twinlight::{Backend, Result};
use twinlight_core::scene::{Limits, compile};
use twinlight_fixtures::meshes::fans_over_border;
use twinlight_fixtures::random::Random;

/// File, and whether its holes are large enough to be looked through from somewhere.
const MESHES: [(&str, bool); 6] = [
    ("bunny/stanford-bunny.obj", true),
    ("dragon-100k/dragon.obj", false),
    ("buddha-100k/buddha.obj", false),
    ("dragon-871k/dragon_vrip.ply", false),
    ("sponza-dabrovic/sponza.obj", true),
    ("conference/conference.obj", true),
];

/// What the lists of a mesh say.
#[derive(Debug, Default)]
struct Lines {
    elements: usize,
    met: usize,
    deepest: usize,
    /// Lines with more fronts than backs, or fewer.
    unbalanced: usize,
}

#[test]
fn r13_as_many_fronts_as_backs() {
    let Some(folder) = std::env::var_os("TWINLIGHT_SCENES") else {
        println!("SKIPPED: TWINLIGHT_SCENES does not name the folder of the public scenes");
        return;
    };
    for (file, has_holes) in MESHES {
        let open = lattice_mesh(&Path::new(&folder).join(file)).unwrap_or_else(|e| panic!("{file}: {e}"));
        let fans = fans_over_border(open.triangles());
        let all = open.triangles().iter().chain(&fans).copied().collect();
        let closed = LatticeMesh::new(open.vertices().to_vec(), all).unwrap();
        println!("{file}: {} triangles, {} close its holes", open.triangles().len(), fans.len());
        let (mut seen_open, mut seen) = (Lines::default(), Lines::default());
        for (size, count) in [(128, 24), (1_024, 2)] {
            for (mesh, lines) in [(&open, &mut seen_open), (&closed, &mut seen)] {
                let start = Instant::now();
                look(mesh, size, count, lines).unwrap_or_else(|e| panic!("{file}: {e}"));
                println!("    {count} views of {size}²: {:.2} s", start.elapsed().as_secs_f64());
            }
        }
        println!("    open {seen_open:?}\n    closed {seen:?}");
        assert_eq!(seen.unbalanced, 0, "{file}");
        assert!(seen.met > 100_000, "{file}: only {} lines meet it", seen.met);
        // The control: what the fans are for shows without them.
        assert_eq!(seen_open.unbalanced > 0, has_holes && !fans.is_empty(), "{file}");
    }
}

fn lattice_mesh(path: &Path) -> std::result::Result<LatticeMesh, Box<dyn std::error::Error>> {
    let scene = load(&path.to_string_lossy(), &LoadOptions::default())?;
    let compiled = compile(&scene, &Limits::default())?;
    Ok(LatticeMesh::of_scene(&Lattice::of_scene(&compiled)?, &compiled)?)
}

/// From the axes, where scans are gridded, and from anywhere.
fn look(mesh: &LatticeMesh, size: u32, count: usize, lines: &mut Lines) -> Result<()> {
    let backend = CpuBackend::new();
    let resident = backend.upload_mesh(mesh)?;
    let mut random = Random::new(u64::from(size));
    let axes = [DVec3::Y, DVec3::X, DVec3::Z].into_iter().take(count / 2);
    let others = std::iter::repeat_with(|| random.direction());
    for direction in axes.chain(others).take(count) {
        let view = View::along(direction, size)?;
        let lhb = backend.rasterize_lhb(&resident, &[view], &RasterizeLhbParams::new(size))?;
        let (offsets, elements) = (lhb.offsets.as_slice(), lhb.elements.as_slice());
        lines.elements += elements.len();
        for list in offsets.windows(2).map(|w| &elements[w[0] as usize..w[1] as usize]) {
            lines.met += usize::from(!list.is_empty());
            lines.deepest = lines.deepest.max(list.len());
            let fronts = list.iter().filter(|e: &&LhbElement| e.is_front()).count();
            lines.unbalanced += usize::from(2 * fronts != list.len());
        }
    }
    Ok(())
}
