//! Lamps that lie on lamps: a ray meets one of them, so one of them shines.

use crate::{film, mean, settings};
use twinlight_core::scene::{Camera, Instance, Light, Limits, Material, Mesh, Scene, compile};
use twinlight_fixtures::meshes::quad;
use twinlight_fixtures::scenes::builtin;

/// Every instance of the Cornell box three times: the bits of the box.
#[test]
fn a_box_on_a_box_is_the_box() {
    let once = builtin("cornell").unwrap();
    let mut thrice = once.clone();
    for _ in 0..2 {
        thrice.instances.extend(once.instances.iter().cloned());
    }
    let settings = settings(24, 16);
    assert!(film(&thrice, &settings).radiance() == film(&once, &settings).radiance());
    let notices = compile(&thrice, &Limits::default()).unwrap().notices;
    assert!(notices.iter().any(|notice| notice.contains("left out")), "{notices:?}");
    assert!(compile(&once, &Limits::default()).unwrap().notices.is_empty());
}

/// A lamp between two floors, seen from the side so that both are in view.
fn two_floors(lamp: Material, lamps: &[Mesh]) -> Scene {
    let mut scene = Scene::default();
    // Material 0, which meshes have unless told otherwise.
    scene.add_material(Material::diffuse("floor", [0.8; 3]));
    let lamp = scene.add_material(lamp);
    for y in [-1.0, 1.0] {
        scene.add_mesh(quad([-2.0, y, 2.0], [2.0, y, 2.0], [2.0, y, -2.0], [-2.0, y, -2.0]));
    }
    for mesh in lamps {
        scene.add_mesh(mesh.clone());
        scene.instances.last_mut().unwrap().material = Some(lamp);
    }
    scene.camera =
        Some(Camera { position: [0.0, 0.0, 6.0], target: [0.0; 3], up: [0.0, 1.0, 0.0], vfov_degrees: 30.0 });
    scene
}

const LAMP: [[f32; 3]; 4] = [[-0.3, 0.1, 0.3], [0.3, 0.0, 0.3], [0.3, 0.0, -0.3], [-0.3, 0.1, -0.3]];

/// The same triangles, wound the other way.
fn turned(mesh: &Mesh) -> Mesh {
    let mut turned = mesh.clone();
    turned.triangles.iter_mut().for_each(|[a, b, _]| std::mem::swap(a, b));
    turned
}

#[test]
fn two_lamps_back_to_back_are_one_with_two_sides() {
    let [a, b, c, d] = LAMP;
    let front = quad(a, b, c, d);
    let back = turned(&front);
    let one_sided = Material::emitter("lamp", [5.0; 3]);
    let two_sided = Material { emits_both_sides: true, ..one_sided.clone() };
    let settings = settings(24, 16);
    let pair = film(&two_floors(one_sided.clone(), &[front.clone(), back]), &settings);
    let expected = film(&two_floors(two_sided, std::slice::from_ref(&front)), &settings);
    assert!(pair.radiance() == expected.radiance());
    let single = film(&two_floors(one_sided, &[front]), &settings);
    assert!(single.radiance() != expected.radiance(), "the other side lights nothing in view");
}

/// Rectangle lights have a material each: what they emit counts, not which it is.
#[test]
fn two_rectangles_back_to_back_are_one_with_two_sides() {
    let [corner, side, _, other] = LAMP;
    let edge = |to: [f32; 3]| [0, 1, 2].map(|axis| to[axis] - corner[axis]);
    let rectangle = |edge_u, edge_v, radiance| Light::Rectangle { corner, edge_u, edge_v, radiance };
    let lit_by = |lights: Vec<Light>| {
        let mut scene = two_floors(Material::default(), &[]);
        scene.lights = lights;
        scene
    };
    let settings = settings(24, 16);
    let (u, v) = (edge(side), edge(other));
    let pair = lit_by(vec![rectangle(u, v, [5.0; 3]), rectangle(v, u, [5.0; 3])]);
    let front = mean(&film(&lit_by(vec![rectangle(u, v, [5.0; 3])]), &settings)).0;
    let back = mean(&film(&lit_by(vec![rectangle(v, u, [5.0; 3])]), &settings)).0;
    let (both, error) = mean(&film(&pair, &settings));
    assert!(front > 0.0 && back > 0.0);
    // Each of the three has its own noise.
    assert!((both - (front + back)).abs() < 3.0 * 4.0 * error, "{both} for {front} + {back}, error {error}");
    let unlike = lit_by(vec![rectangle(u, v, [5.0; 3]), rectangle(v, u, [1.0, 0.0, 0.0])]);
    let notices = compile(&unlike, &Limits::default()).unwrap().notices;
    assert!(notices.iter().any(|notice| notice.contains("2 emit otherwise")), "{notices:?}");
}

/// Corners in another order would be met at a t that differs in its last bits, now before and now behind the others.
#[test]
fn corners_in_another_order_are_the_same_triangle() {
    let [a, b, c, d] = LAMP;
    let front = quad(a, b, c, d);
    let mut rotated = front.clone();
    rotated.triangles.iter_mut().for_each(|corners| corners.rotate_left(1));
    let lamp = Material::emitter("lamp", [5.0; 3]);
    let settings = settings(24, 16);
    let both = film(&two_floors(lamp.clone(), &[front.clone(), rotated]), &settings);
    assert!(both.radiance() == film(&two_floors(lamp, &[front]), &settings).radiance());
}

/// A wall that shares the lamp's corners is the lamp's other side.
#[test]
fn a_lamp_on_a_wall_stays_a_lamp() {
    let [a, b, c, d] = LAMP;
    let lamp = Material::emitter("lamp", [5.0; 3]);
    let front = quad(a, b, c, d);
    let alone = two_floors(lamp.clone(), std::slice::from_ref(&front));
    let mut walled = alone.clone();
    let wall = walled.add_mesh(turned(&front));
    let last = walled.instances.len() - 1;
    walled.instances.swap(last, 2);
    assert_eq!(walled.instances[2], Instance::new("quad", wall));
    let settings = settings(24, 16);
    assert!(film(&walled, &settings).radiance() == film(&alone, &settings).radiance());
}
