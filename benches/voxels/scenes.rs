//! What is voxelized.

use twinlight::lattice::{Lattice, LatticeMesh, VoxelGrid};
use twinlight::scene::{Limits, compile};
use twinlight::{Result, io};

/// A snapped mesh and its bounds.
pub struct Snapped {
    pub mesh: LatticeMesh,
    low: [i16; 3],
    high: [i16; 3],
}

impl Snapped {
    fn new(mesh: LatticeMesh) -> Self {
        let (low, high) = mesh.bounds();
        Self { mesh, low, high }
    }

    /// The grid over all of it.
    pub fn grid(&self, resolution: u32) -> Result<VoxelGrid> {
        VoxelGrid::over(self.low, self.high, resolution)
    }
}

/// A scene by its name, or `wall`.
pub fn snapped(name: &str) -> std::result::Result<Snapped, Box<dyn std::error::Error>> {
    if name == "wall" {
        return Ok(Snapped { low: [-18_000; 3], high: [18_000; 3], mesh: wall()? });
    }
    let scene = io::load(name, &io::LoadOptions::default())?;
    let compiled = compile(&scene, &Limits::default())?;
    Ok(Snapped::new(LatticeMesh::of_scene(&Lattice::of_scene(&compiled)?, &compiled)?))
}

/// A triangle over half of the middle of a cube.
fn wall() -> Result<LatticeMesh> {
    let corner = |x: i16, y: i16| [x, y, 100];
    let vertices = vec![corner(-18_000, -18_000), corner(18_000, -18_000), corner(-18_000, 18_000)];
    LatticeMesh::new(vertices, vec![[0, 1, 2]])
}
