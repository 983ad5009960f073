//! Scenes that come without a camera or light can be seen all the same.

use crate::read;
use twinlight::io::{LoadOptions, complete};
use twinlight_core::scene::{Camera, Light, Scene, compile};

fn triangle() -> Scene {
    read("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", &[], &LoadOptions::default()).unwrap()
}

#[test]
fn a_bare_mesh_gets_a_camera_and_a_light_with_notices() {
    let mut scene = triangle();
    complete(&mut scene);
    let camera = scene.camera.unwrap();
    let [Light::Rectangle { corner, edge_u, edge_v, .. }] = scene.lights[..] else {
        panic!("{:?}", scene.lights)
    };
    let [corner, u, v] = [corner, edge_u, edge_v].map(glam::Vec3::from);
    let axis = (glam::DVec3::from(camera.target) - glam::DVec3::from(camera.position)).as_vec3();
    let eye = glam::DVec3::from(camera.position).as_vec3();
    assert!(u.cross(v).dot(axis) > 0.0, "the light faces what the camera sees");
    // The plane of the eye up to f32 rounding of coordinates about as large as the scene.
    assert!(
        (corner - eye).dot(axis.normalize()).abs() < 1e-5,
        "the light lies in the plane of the eye, out of view"
    );
    assert!(corner.distance(eye) < u.length() && u.dot(glam::DVec3::from(camera.up).as_vec3()) > 0.0);
    assert_eq!(scene.notices.len(), 2, "{:?}", scene.notices);
    compile(&scene, &LoadOptions::default().limits).unwrap();
    let before = scene.clone();
    complete(&mut scene);
    assert_eq!(scene, before, "nothing is missing any more");
}

#[test]
fn a_room_keeps_its_camera_and_is_lit_inside() {
    let mut scene = twinlight::io::builtin::load("cornell").unwrap();
    let camera = Camera {
        position: [278.0, 273.0, 100.0],
        target: [278.0, 273.0, 101.0],
        up: [0.0, 1.0, 0.0],
        vfov_degrees: 60.0,
    };
    scene.camera = Some(camera);
    scene.lights.clear();
    scene.materials.iter_mut().for_each(|m| m.emission = [0.0; 3]);
    complete(&mut scene);
    assert_eq!(scene.camera, Some(camera));
    let [Light::Rectangle { corner, edge_u, edge_v, .. }] = scene.lights[..] else {
        panic!("{:?}", scene.lights)
    };
    let [corner, u, v] = [corner, edge_u, edge_v].map(glam::Vec3::from);
    let (lo, hi) = scene.bounds().unwrap();
    let middle = (corner + (u + v) * 0.5).as_dvec3();
    assert!(middle.cmpgt(lo).all() && middle.cmplt(hi).all(), "{middle}");
}

/// A white surface at the target reflects about radiance 1, however far away the camera is.
#[test]
fn an_added_light_is_as_bright_from_afar() {
    for (distance, to_target) in [(2.0, 2.0), (30.0, 30.0), (3e6, 3e6), (3000.0, 1.0), (3000.0, 1e9)] {
        let mut scene = triangle();
        let eye = [0.0, 0.0, distance];
        let target = [0.0, 0.0, distance - to_target];
        scene.camera = Some(Camera { position: eye, target, up: [0.0, 1.0, 0.0], vfov_degrees: 40.0 });
        complete(&mut scene);
        let [Light::Rectangle { edge_u, edge_v, radiance, .. }] = scene.lights[..] else {
            panic!("{:?}", scene.lights)
        };
        let area = f64::from(glam::Vec3::from(edge_u).cross(edge_v.into()).length());
        let reflected = f64::from(radiance[0]) * area / (std::f64::consts::PI * distance * distance);
        // A target beyond the scene may be as far behind its front as the scene is large.
        assert!((0.99..1.01 + 4.0 / distance).contains(&reflected), "{distance}, {to_target}: {reflected}");
    }
}

#[test]
fn nothing_to_see_is_no_failure() {
    let mut scene = Scene::default();
    complete(&mut scene);
    assert!(scene.camera.is_some() && scene.lights.is_empty());
    let mut lit = triangle();
    lit.lights.push(Light::Point { position: [0.0; 3], intensity: [1.0; 3] });
    complete(&mut lit);
    assert_eq!(lit.lights.len(), 1);
}

#[test]
fn a_scene_of_one_point_gets_a_light_with_an_area() {
    let mut scene = read("a.obj", "v 7 7 7\nf 1 1 1\n", &[], &LoadOptions::default()).unwrap();
    complete(&mut scene);
    scene.validate(&LoadOptions::default().limits).unwrap();
    assert_eq!(scene.lights.len(), 1);
}

#[test]
fn vertices_that_are_no_numbers_do_not_move_the_camera() {
    let mut scene = triangle();
    complete(&mut scene);
    let expected = scene.camera;
    let mut broken = triangle();
    broken.meshes[0].positions.extend([[f32::NAN; 3], [f32::INFINITY, 0.0, 0.0], [3e38, 0.0, 0.0]]);
    complete(&mut broken);
    assert_eq!(broken.camera, expected);
}

/// A cube around the origin whose quads face inwards, without those named: 0 and 1 are the sides at -X and +X.
fn room(missing: &[usize]) -> Scene {
    let corners: String = (0..8)
        .map(|i| [i & 1, i >> 1 & 1, i >> 2 & 1].map(|bit| bit * 2 - 1))
        .map(|[x, y, z]| format!("v {x} {y} {z}\n"))
        .collect();
    let sides = ["1 3 7 5", "2 6 8 4", "1 5 6 2", "3 4 8 7", "1 2 4 3", "5 7 8 6"];
    let present = sides.iter().enumerate().filter(|(side, _)| !missing.contains(side));
    let faces: String = present.map(|(_, corners)| format!("f {corners}\n")).collect();
    read("room.obj", &(corners + &faces), &[], &LoadOptions::default()).unwrap()
}

fn eye(mut scene: Scene) -> glam::DVec3 {
    complete(&mut scene);
    scene.camera.unwrap().position.into()
}

#[test]
fn nobody_looks_from_below() {
    for ground in ["f 1 2 3 4", "f 4 3 2 1"] {
        let corners = "v -1 0 1\nv 1 0 1\nv 1 0 -1\nv -1 0 -1\n";
        let scene =
            read("ground.obj", &format!("{corners}{ground}\n"), &[], &LoadOptions::default()).unwrap();
        assert!(eye(scene).y > 0.5, "{ground}");
    }
    assert!(eye(room(&[2])).y > 0.5);
}

#[test]
fn the_largest_scene_has_a_camera() {
    let corners = "v -5e11 0 0\nv 5e11 0 0\nv 0 5e11 0\nf 1 2 3\n";
    let mut scene = read("large.obj", corners, &[], &LoadOptions::default()).unwrap();
    complete(&mut scene);
    scene.camera.unwrap().record(16, 16, [0.0; 3]).unwrap();
}

#[test]
fn an_open_room_is_seen_from_its_open_side() {
    // From below, at 2, nobody looks.
    for side in [0, 1, 3, 4, 5] {
        let sign = [-1.0, 1.0][side % 2];
        // The sides are at ±1: the eye is beyond the open one, and of it sees more than of any other.
        let beyond = |eye: glam::DVec3| {
            let out = sign * eye[side / 2];
            out > 1.5 && out >= eye.abs().max_element() * (1.0 - 1e-12)
        };
        let scene = room(&[side]);
        assert!(beyond(eye(scene.clone())), "side {side}: {}", eye(scene));
        // What is in front stays in front.
        let mut mirrored = room(&[side]);
        mirrored.instances[0].transform.linear *= -1.0;
        // Mirrored, the open side of 3 is below.
        assert!(side == 3 || beyond(-eye(mirrored)), "side {side}, mirrored");
        let mut scene = room(&[side]);
        complete(&mut scene);
        scene.camera.unwrap().record(16, 16, [0.0; 3]).expect("up is not along the axis");
        assert_eq!(scene.notices[0], "no camera in the scene: one that frames it is used");
    }
}

#[test]
fn what_is_open_on_no_side_or_on_both_is_seen_from_the_front() {
    let scene = room(&[]);
    let front = Camera::framing(scene.bounds().unwrap()).position;
    assert_eq!(eye(scene).to_array(), front);
    assert_eq!(eye(room(&[0, 1])).to_array(), front);
    assert_eq!(eye(room(&[5])).to_array(), front, "the front is open");
}
