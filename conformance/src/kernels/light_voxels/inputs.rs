//! Voxels and scenes that trials share.

use super::Case;
use crate::oracle::light_voxels::Voxel;
use crate::scenes::{compiled, scene_of};
use twinlight_core::kernels::light_voxels::LightVoxelsBlock;
use twinlight_core::kernels::sum_voxels::VoxelSums;
use twinlight_core::kernels::trace_cones::VoxelFrame;
use twinlight_core::math::morton::morton_code;
use twinlight_core::scene::{Light, Mesh, Scene};
use twinlight_fixtures::random::Random;

/// Eight voxels a side, each a quarter wide: from −1 to 1.
pub(super) fn block() -> LightVoxelsBlock {
    let frame = VoxelFrame { corner: [-1.0; 3], voxels_per_unit: 4.0 };
    LightVoxelsBlock { frame, seed: 5, samples: 3, scale: 20_000.0, emission_unit: 0.125 }
}

/// A voxel of albedo ¾, ½ and ¼.
pub(super) fn voxel(at: [u32; 3], normal: [i32; 3]) -> Voxel {
    let sums =
        VoxelSums { albedo: [6142, 4095, 2047], count: 2, normal, emission: [0; 3], ..VoxelSums::default() };
    Voxel { code: morton_code(at), sums, gathered: [0.0; 3] }
}

/// Voxels of all coordinates and normals, in the order of their codes; one in eight has no normal, one in sixteen no fragments.
pub(super) fn voxels(seed: u64, count: usize) -> Vec<Voxel> {
    let mut random = Random::new(seed);
    let mut voxels: Vec<Voxel> = (0..count).map(|_| some_voxel(&mut random)).collect();
    voxels.sort_by_key(|voxel| voxel.code);
    voxels
}

fn some_voxel(random: &mut Random) -> Voxel {
    let mut below = |n: u32| random.next_u32() % n;
    let at = [below(8), below(8), below(8)];
    let count = if below(16) == 0 { 0 } else { 1 + below(4) };
    let signed = |x: u32| x as i32 - 127;
    let normal = [signed(below(255)), signed(below(255)), signed(below(255))];
    let sums = VoxelSums {
        albedo: [below(4096) * count, below(4096) * count, below(4096) * count],
        count,
        normal: if below(8) == 0 { [0; 3] } else { normal.map(|x| x * count as i32) },
        emission: [below(64), 0, below(64)].map(|e| e * count),
        ..VoxelSums::default()
    };
    Voxel { code: morton_code(at), sums, gathered: [below(8) as f32 * 0.25, 0.0, below(3) as f32] }
}

/// Under one light.
pub(super) fn under(light: Light, voxels: Vec<Voxel>) -> Case {
    within(Vec::new(), vec![light], voxels)
}

/// Lights among meshes.
pub(super) fn within(meshes: Vec<Mesh>, lights: Vec<Light>, voxels: Vec<Voxel>) -> Case {
    let mut scene = Scene::default();
    if let Some(first) = meshes.first() {
        scene = scene_of(twinlight_fixtures::meshes::joined(&first.name, &meshes));
    }
    scene.lights = lights;
    of_scene(&scene, voxels)
}

/// Voxels in a scene of any kind.
pub(super) fn of_scene(scene: &Scene, voxels: Vec<Voxel>) -> Case {
    let scene = compiled(scene);
    let mut block = block();
    for (corner, origin) in block.frame.corner.iter_mut().zip(scene.origin) {
        *corner -= origin as f32;
    }
    Case { scene, block, voxels }
}

pub(super) fn point(position: [f32; 3]) -> Light {
    Light::Point { position, intensity: [8.0, 4.0, 2.0] }
}

pub(super) fn sun(direction: [f32; 3]) -> Light {
    Light::Directional { direction, irradiance: [3.0, 2.0, 1.0] }
}

pub(super) fn spot(position: [f32; 3], direction: [f32; 3]) -> Light {
    Light::Spot { position, direction, intensity: [9.0, 6.0, 3.0], inner_angle: 0.1, outer_angle: 0.8 }
}

/// One of each kind without extent.
pub(super) fn exact_lights() -> [(&'static str, Light); 3] {
    [
        ("point", point([0.3, 3.1, -0.2])),
        ("sun", sun([0.4, -1.0, 0.3])),
        ("spot", spot([0.9, 2.5, 0.4], [-0.4, -1.0, -0.1])),
    ]
}
