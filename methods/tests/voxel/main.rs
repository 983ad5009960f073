//! Voxel cone tracing as a whole.

use twinlight_backend_cpu::CpuBackend;
use twinlight_core::kernels::reduce_mips::{ISOTROPIC, MAX_RADIANCE};
use twinlight_core::scene::{Camera, CompiledScene, Light, Limits, Material, Scene, compile};
use twinlight_core::{Backend, Error};
use twinlight_fixtures::meshes::{quad, with_material};
use twinlight_fixtures::scenes::builtin;
use twinlight_methods::gbuffer;
use twinlight_methods::reference::{Control, Film, Settings, render};
use twinlight_methods::voxel::{Cones, Gathered, Storage, VoxelSettings, build, gather};

mod surfaces;

const SIZE: u32 = 32;

fn film(backend: &CpuBackend, scene: &CompiledScene, camera: &Camera, bounces: u32) -> Film {
    let resident = backend.upload_scene(scene).unwrap();
    let settings =
        Settings { width: SIZE, height: SIZE, samples: 64, bounces: Some(bounces), ..Settings::default() };
    render(backend, &resident, scene, camera, &settings, |_| Control::Continue).unwrap().film
}

fn gathered(
    backend: &CpuBackend,
    scene: &CompiledScene,
    camera: &Camera,
    settings: &VoxelSettings,
) -> Gathered {
    let resident = backend.upload_scene(scene).unwrap();
    let lit = build(backend, &resident, scene, settings).unwrap();
    let texels = gbuffer(backend, &resident, scene, camera, (SIZE, SIZE)).unwrap();
    let texels = backend.download(&texels).unwrap();
    gather(backend, scene, &lit, camera, &texels, &film(backend, scene, camera, 1), settings).unwrap()
}

fn total(light: &[[f32; 3]]) -> f64 {
    light.iter().flatten().map(|&radiance| f64::from(radiance)).sum()
}

fn compiled(scene: &Scene) -> (CompiledScene, Camera) {
    (compile(scene, &Limits::default()).unwrap(), Camera::of_scene(scene).unwrap())
}

fn settings() -> VoxelSettings {
    VoxelSettings { grid: 64, bounces: 2, ..VoxelSettings::default() }
}

/// Wrong weights, units or levels are off by a factor of π, of 4, of ten. What is measured is 1.04 to 1.29 of the reference: the bias of voxels, which is
/// no error of the code. The limits are a tenth above it and a fifth below.
#[test]
fn every_storage_has_the_light_of_the_reference() {
    let (scene, camera) = compiled(&builtin("cornell").unwrap());
    let backend = CpuBackend::new();
    let wanted = total(&film(&backend, &scene, &camera, 2).indirect());
    for (storage, _) in Storage::NAMES {
        for cones in [Cones::Six, Cones::Generic(16)] {
            let found = gathered(&backend, &scene, &camera, &VoxelSettings { storage, cones, ..settings() });
            let ratio = total(&found.indirect) / wanted;
            assert!((0.83..1.42).contains(&ratio), "{storage} {cones}: {ratio}");
        }
    }
}

#[test]
fn every_bounce_adds_light_and_one_is_direct_light_alone() {
    let (scene, camera) = compiled(&builtin("cornell").unwrap());
    let backend = CpuBackend::new();
    let mut before = -1.0;
    for bounces in 0..=4 {
        let found = gathered(&backend, &scene, &camera, &VoxelSettings { bounces, ..settings() });
        let light = total(&found.indirect);
        if bounces < 2 {
            assert_eq!(light, 0.0);
        } else {
            assert!(light > before, "{bounces} bounces: {light} after {before}");
        }
        before = light;
    }
}

#[test]
fn threads_do_not_show() {
    let (scene, camera) = compiled(&builtin("lights").unwrap());
    let pictures = [1, 3]
        .map(|threads| gathered(&CpuBackend::with_threads(threads).unwrap(), &scene, &camera, &settings()));
    assert_eq!(pictures[0], pictures[1]);
}

/// M6: what lies open under the sky of a lamp sees nothing of itself, at any grid.
#[test]
fn an_open_floor_gathers_nothing() {
    let mut scene = Scene::default();
    let white = scene.add_material(Material::diffuse("white", [0.8; 3]));
    let floor = quad([-1.0, 0.3, 1.0], [1.0, 0.3, 1.0], [1.0, 0.3, -1.0], [-1.0, 0.3, -1.0]);
    scene.add_mesh(with_material(floor, white));
    // Reflects nothing, and makes the grid higher than the floor is thick: cones of a flat one would begin outside.
    let black = scene.add_material(Material::diffuse("black", [0.0; 3]));
    let flag = quad([-1.0, 1.0, -1.0], [-0.8, 1.0, -1.0], [-0.8, 1.2, -1.0], [-1.0, 1.2, -1.0]);
    scene.add_mesh(with_material(flag, black));
    scene.lights = vec![Light::Point { position: [0.2, 2.0, 0.1], intensity: [9.0; 3] }];
    let (scene, camera) = compiled(&scene);
    for grid in [1, 16, 37, 64] {
        for (storage, _) in Storage::NAMES {
            let found =
                gathered(&CpuBackend::new(), &scene, &camera, &VoxelSettings { grid, storage, ..settings() });
            assert_eq!(total(&found.indirect), 0.0, "{storage} at {grid}");
        }
    }
}

/// Leaves that saturate lose light: the bound of what lights can do holds in scenes of every kind of light, and leaves most of its bits.
#[test]
fn integers_hold_what_lights_do() {
    for name in ["cornell", "lights", "environment"] {
        let (scene, _) = compiled(&builtin(name).unwrap());
        let backend = CpuBackend::new();
        let resident = backend.upload_scene(&scene).unwrap();
        let lit =
            build(&backend, &resident, &scene, &VoxelSettings { storage: Storage::Isotropic, ..settings() });
        let lit = lit.unwrap();
        assert_eq!(lit.call.storage, ISOTROPIC);
        let values = backend.download(&lit.values).unwrap();
        let leaves = values.chunks(4).take(lit.voxels() as usize);
        let most = leaves.flat_map(|leaf| leaf[..3].iter().copied()).max().unwrap_or(0);
        assert!(lit.saturated == 0 && most < MAX_RADIANCE && most > MAX_RADIANCE >> 12, "{name}: {most}");
    }
}

#[test]
fn bad_settings_are_errors() {
    let (scene, _) = compiled(&builtin("cornell").unwrap());
    let backend = CpuBackend::new();
    let resident = backend.upload_scene(&scene).unwrap();
    let refused = |grid| build(&backend, &resident, &scene, &VoxelSettings { grid, ..settings() }).err();
    assert!(matches!(refused(0), Some(Error::InvalidInput { .. })));
    assert!(matches!(refused(513), Some(Error::LimitExceeded { .. })));
    let endless = VoxelSettings { bounces: 65, ..settings() };
    let refused = build(&backend, &resident, &scene, &endless).err();
    assert!(matches!(refused, Some(Error::LimitExceeded { .. })));
    for text in ["", "7", "generic:3", "generic:257", "six"] {
        assert!(text.parse::<Cones>().is_err(), "{text}");
    }
    assert!("rgb".parse::<Storage>().is_err());
    for (storage, name) in Storage::NAMES {
        assert_eq!(name.parse::<Storage>().unwrap(), storage);
        assert_eq!(storage.to_string(), name);
    }
}
