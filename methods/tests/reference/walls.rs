//! Walls let nothing through: closed rooms of needles, smooth normals, blockers close to lights.

use crate::{assert_mean, film, mean, settings};
use glam::{DMat3, DVec3};
use twinlight_core::scene::{Camera, Environment, Light, Material, Mesh, Scene};
use twinlight_fixtures::meshes::quad;
use twinlight_methods::reference::Settings;

/// A closed cylinder of radius 1 around its axis, in general position, and a camera in it. Its sides are `segments`
/// pairs of triangles as long as the cylinder.
fn cylinder(segments: u32, length: f64, smooth: bool) -> (Mesh, Camera) {
    let turn = DMat3::from_euler(glam::EulerRot::XYZ, 0.3, 0.8, 0.5);
    let place = |p: DVec3| (turn * p).as_vec3().to_array();
    let around = |i: u32| {
        let (s, c) = (std::f64::consts::TAU * f64::from(i % segments) / f64::from(segments)).sin_cos();
        DVec3::new(c, s, 0.0)
    };
    let mut mesh = Mesh { name: "cylinder".into(), ..Mesh::default() };
    for i in 0..segments {
        for end in [-0.5, 0.5] {
            mesh.positions.push(place(around(i) + DVec3::Z * (end * length)));
            if smooth {
                mesh.normals.push(place(around(i)));
            }
        }
    }
    let (low, high) = (2 * segments, 2 * segments + 1);
    for (end, inward) in [(-0.5, 1.0), (0.5, -1.0)] {
        mesh.positions.push(place(DVec3::Z * (end * length)));
        if smooth {
            mesh.normals.push(place(DVec3::Z * -inward));
        }
    }
    for i in 0..segments {
        let (a, b) = (2 * i, 2 * ((i + 1) % segments));
        mesh.triangles.extend([[a, b, b + 1], [a, b + 1, a + 1], [low, b, a], [high, a + 1, b + 1]]);
    }
    mesh.material_ids = vec![0; mesh.triangles.len()];
    let at = |z: f64| (turn * DVec3::new(0.1, 0.2, z)).to_array();
    let camera = Camera {
        position: at(-0.3 * length),
        target: at(0.3 * length),
        up: [0.0, 1.0, 0.0],
        vfov_degrees: 120.0,
    };
    (mesh, camera)
}

/// T1, T6: a closed furnace of needles is one too. Rays that met the needle they left, or missed its
/// neighbour, would end up outside.
#[test]
fn t6_furnaces_of_needles() {
    for (segments, length) in [(128, 20.0), (512, 100.0), (2048, 20.0)] {
        let (mesh, camera) = cylinder(segments, length, false);
        let mut scene = Scene { camera: Some(camera), ..Scene::default() };
        scene.add_material(Material {
            emission: [0.1; 3],
            emits_both_sides: true,
            ..Material::diffuse("wall", [0.9; 3])
        });
        scene.add_mesh(mesh);
        let film = film(&scene, &settings(16, 256));
        assert_mean(&format!("{segments} segments, length {length}"), &film, 1.0, 0.0);
    }
}

/// No light of the sky gets into a sealed room, however its normals are bent.
#[test]
fn t6_sealed_rooms_are_dark() {
    for (segments, length, smooth) in [(512, 20.0, false), (8, 2.0, true), (512, 20.0, true)] {
        let (mesh, camera) = cylinder(segments, length, smooth);
        let sky = Environment::constant([1.0; 3]);
        let mut scene = Scene { camera: Some(camera), environment: Some(sky), ..Scene::default() };
        scene.add_material(Material::diffuse("wall", [0.9; 3]));
        scene.add_mesh(mesh);
        let (mean, _) = mean(&film(&scene, &settings(16, 256)));
        assert_eq!(mean, 0.0, "{segments} segments, length {length}, smooth {smooth}");
    }
}

/// The floor under a lamp, seen from below the lamp; `extra` is added.
fn floor(extra: impl FnOnce(&mut Scene)) -> Scene {
    let mut scene = Scene::default();
    scene.add_material(Material::diffuse("floor", [0.8; 3]));
    scene.add_mesh(quad([-1.0, 0.0, 1.0], [1.0, 0.0, 1.0], [1.0, 0.0, -1.0], [-1.0, 0.0, -1.0]));
    scene.camera = Some(Camera {
        position: [0.0, 0.5, 0.0],
        target: [0.0; 3],
        up: [0.0, 0.0, -1.0],
        vfov_degrees: 20.0,
    });
    extra(&mut scene);
    scene
}

const DIRECT: Settings = Settings {
    width: 16,
    height: 16,
    samples: 64,
    first_sample: 0,
    bounces: Some(1),
    seed: 0,
    sampler: twinlight_methods::reference::Sampler::Independent,
    roulette_begin: 4,
    time: None,
    pass: std::time::Duration::from_millis(250),
};

/// A shadow ray looks all the way to the light.
#[test]
fn a_plate_just_below_a_light_blocks_it() {
    let plate = |y: f32| quad([-1.0, y, 1.0], [1.0, y, 1.0], [1.0, y, -1.0], [-1.0, y, -1.0]);
    let lights = [
        Light::Point { position: [0.0, 2.0, 0.0], intensity: [5.0; 3] },
        Light::Sphere { center: [0.0, 2.1, 0.0], radius: 0.1, radiance: [50.0; 3] },
        Light::Rectangle {
            corner: [-0.1, 2.0, -0.1],
            edge_u: [0.2, 0.0, 0.0],
            edge_v: [0.0, 0.0, 0.2],
            radiance: [50.0; 3],
        },
    ];
    for light in lights {
        let open = film(&floor(|scene| scene.lights.push(light)), &DIRECT);
        assert!(mean(&open).0 > 0.05, "{light:?} lights the floor");
        let blocked = floor(|scene| {
            scene.lights.push(light);
            scene.add_mesh(plate(1.999));
        });
        assert_eq!(mean(&film(&blocked, &DIRECT)).0, 0.0, "{light:?} behind a plate");
    }
}

/// A sphere light hides another.
#[test]
fn a_sphere_in_front_of_a_sphere() {
    let near = Light::Sphere { center: [0.0, 2.0, 0.0], radius: 1.0, radiance: [0.5; 3] };
    let far = Light::Sphere { center: [0.0, 5.0, 0.0], radius: 0.1, radiance: [1e4; 3] };
    let alone = film(&floor(|scene| scene.lights.push(near)), &DIRECT);
    let both = film(&floor(|scene| scene.lights.extend([near, far])), &DIRECT);
    let ((alone, a), (both, b)) = (mean(&alone), mean(&both));
    assert!(
        (alone - both).abs() < 4.0 * (a + b),
        "{alone} ± {a} without, {both} ± {b} with the hidden sphere"
    );
}
