//! Voxels that `voxelize` and `sum_voxels` made of a room, on the CPU: what is judged is the light on them.

use super::{Case, Checked};
use crate::oracle::light_voxels::Voxel;
use crate::scenes::compiled;
use crate::trial::{Check, Context, Listing, ensure, list_trials};
use glam::DVec3;
use twinlight_backend_cpu::CpuBackend;
use twinlight_core::Backend;
use twinlight_core::kernels::light_voxels::LightVoxelsBlock;
use twinlight_core::kernels::sum_voxels::VoxelSums;
use twinlight_core::kernels::trace_cones::VoxelFrame;
use twinlight_core::kernels::voxelize::VoxelizeParams;
use twinlight_core::lattice::{Lattice, LatticeMesh, VoxelGrid};
use twinlight_core::scene::{CompiledScene, Light};
use twinlight_fixtures::scenes;
use twinlight_methods::voxel::surfaces;

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "light_voxels": cornell_under_a_bulb);
}

/// Voxels along the longest side of the room.
const RESOLUTION: u32 = 16;

/// The Cornell box with its own light, or with another instead.
pub(super) fn cornell(light: Option<Light>) -> Checked<Case> {
    let mut scene = scenes::cornell();
    if let Some(light) = light {
        scene.materials.iter_mut().for_each(|material| material.emission = [0.0; 3]);
        scene.lights = vec![light];
    }
    let scene = compiled(&scene);
    let lattice = Lattice::of_scene(&scene)?;
    let grid = grid_over(&lattice, &scene)?;
    let (frame, width) = frame(&lattice, &grid);
    let (active, sums) = sums_of(&scene, &lattice, &grid, width)?;
    let voxels = active.into_iter().zip(sums);
    let voxels = voxels.map(|(code, sums)| Voxel { code, sums, gathered: [0.0; 3] }).collect();
    let block = LightVoxelsBlock { frame, seed: 3, samples: 2, scale: 20_000.0, emission_unit: 0.0 };
    Ok(Case { scene, block, voxels })
}

fn grid_over(lattice: &Lattice, scene: &CompiledScene) -> Checked<VoxelGrid> {
    let mesh = LatticeMesh::of_scene(lattice, scene)?;
    let ends = |pick: fn(i16, i16) -> i16, start| {
        mesh.vertices().iter().fold([start; 3], |ends: [i16; 3], v| {
            [pick(ends[0], v[0]), pick(ends[1], v[1]), pick(ends[2], v[2])]
        })
    };
    Ok(VoxelGrid::over(ends(i16::min, i16::MAX), ends(i16::max, i16::MIN), RESOLUTION)?)
}

/// Where the grid is, and how wide its voxels are.
fn frame(lattice: &Lattice, grid: &VoxelGrid) -> (VoxelFrame, f32) {
    let place = |point| DVec3::from(grid.lattice_point(point)) * lattice.step() + lattice.centre();
    let corner = place([0.0; 3]);
    let width = (place([f64::from(1_u32 << grid.subvoxel_bits), 0.0, 0.0]) - corner).x;
    let frame = VoxelFrame { corner: corner.as_vec3().to_array(), voxels_per_unit: (1.0 / width) as f32 };
    (frame, width as f32)
}

fn sums_of(
    scene: &CompiledScene,
    lattice: &Lattice,
    grid: &VoxelGrid,
    width: f32,
) -> Checked<(Vec<u32>, Vec<VoxelSums>)> {
    let cpu = CpuBackend::new();
    let mesh = cpu.upload_mesh(&LatticeMesh::of_scene(lattice, scene)?)?;
    let params = VoxelizeParams::thin();
    let voxels = cpu.voxelize(&mesh, grid, &params)?;
    let surfaces = surfaces(scene, width);
    let texels = cpu.upload(&surfaces.texels)?;
    let sums = cpu.sum_voxels(&mesh, &voxels, &cpu.upload(&surfaces.surfaces)?, &texels, &params)?;
    Ok((cpu.download(&voxels.active)?, cpu.download(&sums)?))
}

/// A lamp in the room: every voxel of it by the oracle.
fn cornell_under_a_bulb<B: Backend>(cx: &Context<'_, B>) -> Check {
    let bulb = Light::Point { position: [271.3, 411.7, 203.9], intensity: [9e4, 8e4, 7e4] };
    let case = cornell(Some(bulb))?;
    let leaves = case.agreed(cx)?;
    let lit = leaves.iter().filter(|leaf| leaf.rgb != [0; 3]).count();
    ensure(lit > leaves.len() / 2 && lit < leaves.len(), || format!("{lit} of {} are lit", leaves.len()))
}
