//! Physics with known answers.

use crate::{assert_mean, film, settings};
use twinlight_core::scene::{Camera, Environment, Light, Material, MaterialKind, Mesh, Scene};
use twinlight_fixtures::meshes::{icosphere, with_material, with_smooth_normals};
use twinlight_fixtures::scenes::{furnace, furnace_radiance, sphere_room, sphere_room_radiance};
use twinlight_methods::reference::Settings;

/// T1: in a closed room of albedo ρ that emits Lₑ everywhere, L = Lₑ·Σ ρᵏ up to the bounce cap.
#[test]
fn t1_closed_furnace() {
    for albedo in [0.0, 0.5, 0.9, 1.0] {
        for bounces in [0, 1, 2, 5, 12] {
            let settings = Settings { bounces: Some(bounces), roulette_begin: 100, ..settings(16, 256) };
            let film = film(&furnace(albedo, 0.7), &settings);
            let expected = furnace_radiance(f64::from(albedo), f64::from(0.7_f32), Some(bounces));
            assert_mean(&format!("albedo {albedo}, {bounces} bounces"), &film, expected, 0.0);
        }
    }
}

/// T1 without a cap: roulette changes no expectation.
#[test]
fn t1_furnace_to_roulette() {
    for (albedo, roulette_begin) in [(0.0, 1), (0.5, 1), (0.5, 4), (0.9, 2), (0.95, 4)] {
        let settings = Settings { bounces: None, roulette_begin, ..settings(16, 1024) };
        let film = film(&furnace(albedo, 0.7), &settings);
        let expected = furnace_radiance(f64::from(albedo), f64::from(0.7_f32), None);
        assert_mean(&format!("albedo {albedo} roulette from {roulette_begin}"), &film, expected, 0.0);
    }
}

/// T2: a diffuse sphere around a lamp.
#[test]
fn t2_sphere_room() {
    for (albedo, lamp, radiance) in [(0.5, 0.25, 17.0), (0.8, 0.1, 30.0), (0.3, 0.45, 2.0)] {
        let film = film(&sphere_room(albedo, lamp, radiance), &settings(24, 512));
        let expected = sphere_room_radiance(f64::from(albedo), f64::from(lamp), f64::from(radiance));
        // 0.1 %: the facets, as the fixture derives.
        assert_mean(&format!("albedo {albedo} lamp {lamp}"), &film, expected, 1e-3);
    }
}

/// A convex object of any lossless material under an even sky can't be told from the sky.
#[test]
fn white_furnace_of_every_material() {
    let base = Material::diffuse("white", [1.0; 3]);
    let materials = [
        ("diffuse", base.clone()),
        ("mirror", Material { kind: MaterialKind::Mirror, specular_f0: [1.0; 3], ..base.clone() }),
        ("glass", Material { kind: MaterialKind::Dielectric { ior: 1.5 }, ..base.clone() }),
        ("diamond", Material { kind: MaterialKind::Dielectric { ior: 2.4 }, ..base }),
    ];
    for (name, material) in materials {
        let mut scene = Scene { environment: Some(Environment::constant([1.0; 3])), ..Scene::default() };
        let id = scene.add_material(material);
        scene.add_mesh(with_smooth_normals(with_material(icosphere(12), id)));
        scene.camera = Some(Camera {
            position: [0.0, 0.5, 3.0],
            target: [0.0; 3],
            up: [0.0, 1.0, 0.0],
            vfov_degrees: 36.0,
        });
        // Interpolated normals send grazing reflections into the facets: up to the facet angle's share is lost.
        assert_mean(name, &film(&scene, &settings(16, 256)), 1.0, 4e-3);
    }
}

/// A diffuse plane under an even sky of radiance L, and under the sun: L_o = ρL and ρE cosθ/π.
#[test]
fn plane_under_sky_and_sun() {
    let plane = |scene: &mut Scene| {
        let id = scene.add_material(Material::diffuse("ground", [0.6, 0.6, 0.6]));
        let corners = vec![[-1e3, 0.0, -1e3], [1e3, 0.0, -1e3], [1e3, 0.0, 1e3], [-1e3, 0.0, 1e3]];
        scene.add_mesh(Mesh::new("ground", corners, vec![[0, 2, 1], [0, 3, 2]], id));
        scene.camera = Some(Camera {
            position: [0.0, 5.0, 0.0],
            target: [1.0, 0.0, 0.0],
            up: [0.0, 1.0, 0.0],
            vfov_degrees: 30.0,
        });
    };
    let mut sky = Scene { environment: Some(Environment::constant([2.0; 3])), ..Scene::default() };
    plane(&mut sky);
    assert_mean("sky", &film(&sky, &settings(16, 256)), 1.2, 0.0);
    let sun = Light::Directional { direction: [1.0, -1.0, 0.0], irradiance: [3.0; 3] };
    let mut sunny = Scene { lights: vec![sun], ..Scene::default() };
    plane(&mut sunny);
    let expected = f64::from(0.6_f32) * 3.0 * 0.5_f64.sqrt() / std::f64::consts::PI;
    assert_mean("sun", &film(&sunny, &settings(16, 4)), expected, 0.0);
}

/// Bounces split as they should: with one, everything is direct; the caps nest.
#[test]
fn bounce_caps_nest() {
    let scene = furnace(0.5, 1.0);
    let one = film(&scene, &Settings { bounces: Some(1), ..settings(8, 16) });
    assert!(one.indirect().iter().flatten().all(|&x| x == 0.0));
    let three = film(&scene, &Settings { bounces: Some(3), ..settings(8, 16) });
    assert_eq!(one.direct(), three.direct(), "the first bounce doesn't depend on the cap");
    assert!(three.indirect().iter().flatten().all(|&x| x > 0.0));
}
