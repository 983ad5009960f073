//! Changes of a scene that must change nothing, or by a known factor.

use crate::{film, settings};
use glam::{DMat3, DVec3};
use twinlight_core::scene::{Camera, Instance, Scene, Transform};
use twinlight_fixtures::scenes::{builtin, cornell, furnace};
use twinlight_methods::reference::{Film, Settings};

/// The scene scaled, then moved. Lights must be emissive meshes.
fn moved(mut scene: Scene, scale: f64, shift: DVec3) -> Scene {
    let map = Transform::scale_translate(scale, shift);
    for instance in &mut scene.instances {
        instance.transform = map.then_inner(&instance.transform);
    }
    let place = |p: [f64; 3]| (DVec3::from(p) * scale + shift).to_array();
    scene.camera = scene.camera.map(|c| Camera { position: place(c.position), target: place(c.target), ..c });
    scene
}

/// G11: a scene 2²⁰ grid steps away is compiled around its own middle and gives the same bits.
#[test]
fn g11_far_from_the_origin() {
    let near = film(&cornell(), &settings(16, 4));
    // The grid step of this scene is 2048.
    for shift in [DVec3::new(2048.0, 0.0, 0.0), DVec3::new(-2048.0, 4096.0, 8192.0) * 1_048_576.0] {
        assert!(film(&moved(cornell(), 1.0, shift), &settings(16, 4)) == near, "shift {shift}");
    }
}

/// G12: scaling by a power of two scales every intermediate exactly; radiance doesn't change.
#[test]
fn g12_powers_of_two() {
    let expected = film(&cornell(), &settings(16, 4));
    for exponent in [-20, -3, 1, 10, 20] {
        let scale = f64::from(exponent).exp2();
        assert!(film(&moved(cornell(), scale, DVec3::ZERO), &settings(16, 4)) == expected, "2^{exponent}");
    }
}

/// T6: no self-hits and no leaks at any scale: a closed furnace keeps its radiance in every pixel.
#[test]
fn t6_self_hits_at_every_scale() {
    for scale in [1e-3, 0.1, 1.0, 37.0, 1e3, 1e6] {
        for shift in [DVec3::ZERO, DVec3::new(3.0, -5.0, 2.0) * scale] {
            let bounces = Settings { bounces: Some(4), roulette_begin: 100, ..settings(24, 64) };
            let film = film(&moved(furnace(1.0, 1.0), scale, shift), &bounces);
            for (i, p) in film.radiance().iter().enumerate() {
                // Five terms of 1; a leak or self-hit darkens whole pixels. 64 samples of a room whose direct light
                // varies by a factor of about 2 have a standard error of about 0.1.
                assert!((p[0] - 5.0).abs() < 0.9, "scale {scale} shift {shift} pixel {i}: {}", p[0]);
            }
        }
    }
}

/// G13: a mirrored instance is turned back: the same room built by mirroring looks the same in the mirror.
#[test]
fn g13_mirrored_instance() {
    let mut mirrored = cornell();
    let flip =
        Transform { linear: DMat3::from_diagonal(DVec3::new(-1.0, 1.0, 1.0)), translation: DVec3::ZERO };
    for instance in &mut mirrored.instances {
        instance.transform = flip.then_inner(&instance.transform);
    }
    let mirror = |p: [f64; 3]| [-p[0], p[1], p[2]];
    mirrored.camera =
        mirrored.camera.map(|c| Camera { position: mirror(c.position), target: mirror(c.target), ..c });
    let totals = |film: Film| film.radiance().iter().map(|p| f64::from(p[1])).sum::<f64>();
    let (a, b) = (totals(film(&cornell(), &settings(24, 64))), totals(film(&mirrored, &settings(24, 64))));
    // Front faces only emit: a room turned inside out would be dark. 2 %: two independent pictures of 36 864 paths.
    assert!((a / b - 1.0).abs() < 0.02, "{a} {b}");
}

/// Splitting a mesh's placements into instances is the same as one mesh.
/// Other slots, another hierarchy, the same hits and lights.
#[test]
fn what_may_move_looks_the_same() {
    for name in ["axis", "materials", "veach"] {
        let mut scene = builtin(name).unwrap();
        let expected = film(&scene, &settings(24, 4));
        for part in 0..2 {
            scene.instances.iter_mut().enumerate().for_each(|(i, instance)| instance.moves = i % 2 == part);
            assert!(film(&scene, &settings(24, 4)) == expected, "{name}, part {part}");
        }
    }
}

#[test]
fn instances_are_copies() {
    let one = builtin("cornell").unwrap();
    let mut two = one.clone();
    let first: Vec<Instance> = two.instances.drain(..).collect();
    for (i, instance) in first.into_iter().enumerate() {
        let mesh = two.meshes[instance.mesh as usize].clone();
        two.meshes.push(mesh);
        let copy = (two.meshes.len() - 1) as u32;
        two.instances.push(Instance { mesh: copy, name: format!("copy {i}"), ..instance });
    }
    assert!(film(&one, &settings(8, 4)) == film(&two, &settings(8, 4)));
}
