//! Whether surfaces see each other.

use super::{Subject, request};
use glam::DVec3;
use twinlight_core::scene::{Camera, Material, MaterialKind, Mesh, Scene};
use twinlight_fixtures::meshes::{cube, icosphere, inverted, placed, quad, torus, with_material};
use twinlight_methods::plan::{Decision, Effect, Method, Sight};

fn seen(meshes: Vec<Mesh>, eye: [f64; 3], kind: MaterialKind) -> Sight {
    let mut scene = Scene::default();
    let material = scene.add_material(Material { kind, ..Material::diffuse("grey", [0.5; 3]) });
    for mesh in meshes {
        scene.add_mesh(with_material(mesh, material));
    }
    scene.environment = Some(twinlight_fixtures::scenes::sky(8));
    scene.camera =
        Some(Camera { position: eye, target: [0.1, 0.2, 0.3], up: [0.0, 1.0, 0.0], vfov_degrees: 40.0 });
    Subject::of(&scene).plan(&request(Method::Reference)).facts.sight
}

fn from_afar(meshes: Vec<Mesh>) -> Sight {
    seen(meshes, [3.0, 4.0, 9.0], MaterialKind::Opaque)
}

fn floor() -> Mesh {
    quad([-2.0, -1.0, -2.0], [2.0, -1.0, -2.0], [2.0, -1.0, 2.0], [-2.0, -1.0, 2.0])
}

/// An odd place and an odd size: coordinates that are rounded, so that corners are not quite in the planes of their sides.
fn odd(mesh: Mesh) -> Mesh {
    placed(mesh, 0.377_219_3, DVec3::new(0.123_456_7, -0.765_432_1, 0.333_333_3))
}

#[test]
fn convex_bodies_and_planes_see_nothing() {
    let none = |sight| matches!(sight, Sight::None(_));
    assert!(none(from_afar(vec![cube()])));
    assert!(none(from_afar(vec![odd(cube())])));
    assert!(none(from_afar(vec![odd(icosphere(3))])));
    assert!(none(from_afar(vec![floor()])));
    let beside = quad([3.0, -1.0, -2.0], [5.0, -1.0, -2.0], [5.0, -1.0, 2.0], [3.0, -1.0, 2.0]);
    assert!(none(from_afar(vec![floor(), beside])), "two parts of one plane");
    assert!(none(from_afar(vec![])));
}

#[test]
fn everything_else_may() {
    let some = |sight| matches!(sight, Sight::Some(_));
    assert!(some(from_afar(vec![torus(12, 8, 0.3)])));
    assert!(some(from_afar(vec![cube(), placed(cube(), 1.0, DVec3::new(4.0, 0.0, 0.0))])));
    assert!(some(from_afar(vec![cube(), floor()])));
    assert!(some(from_afar(vec![inverted(cube())])), "inside out");
    assert!(some(seen(vec![cube()], [0.1, 0.1, 0.1], MaterialKind::Opaque)), "seen from inside");
    assert!(some(seen(vec![cube()], [3.0, 4.0, 9.0], MaterialKind::Dielectric { ior: 1.5 })), "glass");
    let mut open = cube();
    open.triangles.pop();
    assert!(some(from_afar(vec![open])), "a hole shows the inside");
}

/// What is behind every triangle doesn't matter; what rises above one by more than rays start above it does.
#[test]
fn a_dent_is_seen() {
    let mut dented = icosphere(3);
    dented.positions[7] = dented.positions[7].map(|c| c * 0.9);
    assert!(matches!(from_afar(vec![dented]), Sight::Some(_)));
}

#[test]
fn a_lone_body_is_planned_without_shadows_and_interreflection() {
    let mut scene = Scene::default();
    let material = scene.add_material(Material::diffuse("grey", [0.5; 3]));
    scene.add_mesh(with_material(odd(cube()), material));
    scene.environment = Some(twinlight_fixtures::scenes::sky(8));
    for method in super::methods() {
        let plan = Subject::of(&scene).plan(&request(method));
        assert_eq!(plan.decision(Effect::Shadows), Decision::Skipped);
        assert_eq!(plan.decision(Effect::Interreflection), Decision::Skipped);
        assert_eq!(plan.decision(Effect::DirectLight), Decision::Run);
        assert!(plan.edits.nothing_hides);
        assert_eq!((plan.bounces, plan.buffers.is_some(), plan.voxels.is_some()), (Some(1), false, false));
    }
}
