//! From a scene to lit voxels on all levels.

use super::light::Lighting;
use super::{MAX_BOUNCES, VoxelSettings, bright, surfaces};
use std::time::{Duration, Instant};
use twinlight_core::kernels::light_voxels::LightVoxelsBlock;
use twinlight_core::kernels::reduce_mips::{MAX_RADIANCE, ReduceMipsParams, VoxelLevels, VoxelLight};
use twinlight_core::kernels::trace_cones::{TraceConesBlock, VoxelFrame};
use twinlight_core::kernels::voxelize::VoxelizeParams;
use twinlight_core::lattice::{Lattice, LatticeMesh, VoxelGrid};
use twinlight_core::scene::CompiledScene;
use twinlight_core::{Backend, Error, Result};

/// Lit voxels of a scene, on a device.
pub struct Lit<B: Backend> {
    /// Occupancy of all levels.
    pub levels: VoxelLevels<B>,
    /// What their voxels store.
    pub values: B::Buffer<u32>,
    /// For the kernel `trace_cones`.
    pub call: TraceConesBlock,
    /// Width of a voxel, world units.
    pub voxel: f32,
    /// Time to voxelize and to sum up surfaces.
    pub voxelize_time: Duration,
    /// Time to light voxels.
    pub light_time: Duration,
    /// Voxels of the finest level that are as bright as integers hold, or brighter: light is missing.
    pub saturated: usize,
    /// Time to reduce them to coarser levels.
    pub reduce_time: Duration,
}

impl<B: Backend> Lit<B> {
    /// Active voxels of the finest level.
    pub fn voxels(&self) -> u32 {
        self.levels.starts[1]
    }

    /// Stores the light of voxels on all levels.
    fn store(&mut self, backend: &B, leaves: &[VoxelLight]) -> Result<()> {
        let start = Instant::now();
        self.saturated = leaves.iter().filter(|leaf| leaf.rgb.contains(&MAX_RADIANCE)).count();
        let params = ReduceMipsParams { storage: self.call.storage };
        self.values = backend.reduce_mips(&self.levels, &backend.upload(leaves)?, &params)?;
        self.reduce_time += start.elapsed();
        Ok(())
    }

    /// Bytes of levels and values.
    pub fn bytes(&self, backend: &B) -> u64 {
        let words = [&self.levels.mask, &self.levels.ranks, &self.levels.active, &self.values];
        4 * words.iter().map(|buffer| backend.len(buffer) as u64).sum::<u64>()
    }
}

/// Voxelizes a scene (resident on `backend` as `resident`), lights its voxels and reduces them.
///
/// # Errors
/// [`twinlight_core::Error::InvalidInput`] and [`twinlight_core::Error::LimitExceeded`] for a grid out of range; what the backend refuses.
pub fn build<B: Backend>(
    backend: &B,
    resident: &B::Scene,
    scene: &CompiledScene,
    settings: &VoxelSettings,
) -> Result<Lit<B>> {
    if settings.bounces > MAX_BOUNCES {
        return Err(Error::limit("bounces of voxels", settings.bounces.into(), MAX_BOUNCES.into()));
    }
    let lattice = Lattice::of_scene(scene)?;
    let mesh = LatticeMesh::of_scene(&lattice, scene)?;
    let (low, high) = mesh.bounds();
    let grid = VoxelGrid::over(low, high, settings.grid)?;
    let (frame, voxel) = frame(&lattice, &grid);
    let start = Instant::now();
    let params = VoxelizeParams::thin();
    let on_device = backend.upload_mesh(&mesh)?;
    let voxels = backend.voxelize(&on_device, &grid, &params)?;
    let surfaces = surfaces(scene, voxel);
    let texels = backend.upload(&surfaces.texels)?;
    let sums =
        backend.sum_voxels(&on_device, &voxels, &backend.upload(&surfaces.surfaces)?, &texels, &params)?;
    let levels = backend.voxel_levels(&voxels)?;
    let voxelize_time = start.elapsed();

    let unit = bright::brightest(scene) / MAX_RADIANCE as f32;
    let lights = LightVoxelsBlock {
        frame,
        seed: settings.seed,
        samples: settings.light_samples,
        scale: 1.0 / unit,
        // Lamps are sampled: their emission would count twice.
        emission_unit: 0.0,
    };
    let call = TraceConesBlock { frame, unit, reach: f32::MAX, storage: settings.storage.code(), flags: 0 };
    let mut lit = Lit {
        values: backend.zeroed(0)?,
        levels,
        call,
        voxel,
        voxelize_time,
        light_time: Duration::ZERO,
        saturated: 0,
        reduce_time: Duration::ZERO,
    };
    let lighting = Lighting { backend, resident, active: &voxels.active, sums: &sums, block: lights };
    if settings.bounces > 1 {
        let start = Instant::now();
        let direct = lighting.direct()?;
        lit.light_time += start.elapsed();
        lit.store(backend, &direct)?;
        for _ in 2..settings.bounces {
            let start = Instant::now();
            let leaves = lighting.scattered(&lit, &direct)?;
            lit.light_time += start.elapsed();
            lit.store(backend, &leaves)?;
        }
    }
    Ok(lit)
}

/// Where a grid over a lattice is in the world, and how wide its voxels are.
fn frame(lattice: &Lattice, grid: &VoxelGrid) -> (VoxelFrame, f32) {
    let place =
        |point: [f64; 3]| glam::DVec3::from(grid.lattice_point(point)) * lattice.step() + lattice.centre();
    let width = f64::from(1_u32 << grid.subvoxel_bits);
    let corner = place([0.0; 3]);
    let voxel = (place([width, 0.0, 0.0]) - corner).x;
    let frame = VoxelFrame { corner: corner.as_vec3().to_array(), voxels_per_unit: (1.0 / voxel) as f32 };
    (frame, voxel as f32)
}
