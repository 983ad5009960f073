use super::super::{Curve, Influence, Interpolation, Joint, Node, Track};
use super::*;
use crate::scene::{Limits, Material, Mesh, compile};
use glam::{DMat3, DQuat, DVec3};
use std::f64::consts::FRAC_1_SQRT_2;

fn track() -> Track {
    Track {
        translation: Curve::constant(DVec3::ZERO),
        rotation: Curve::constant(DQuat::IDENTITY),
        scale: Curve::constant(DVec3::ONE),
    }
}

fn line<T: super::super::Keyed>(values: [T; 2]) -> Curve<T> {
    Curve::new(Interpolation::Linear, vec![0.0, 2.0], values.to_vec()).unwrap()
}

/// Turns about +Z by a quarter within two seconds.
fn turning() -> Local {
    // Sine and cosine of an eighth of a turn, as they stand here and not as a libm has them.
    let quarter = DQuat::from_xyzw(0.0, 0.0, FRAC_1_SQRT_2, FRAC_1_SQRT_2);
    let rotation = line([DQuat::IDENTITY, quarter]);
    Local::Keyed(Box::new(Track { rotation, ..track() }))
}

fn fixed(x: f64, y: f64) -> Local {
    Local::Fixed(Transform { linear: DMat3::IDENTITY, translation: DVec3::new(x, y, 0.0) })
}

fn node(parent: Option<u32>, local: Local) -> Node {
    Node { parent, local }
}

fn binding(instance: u32, nodes: &[u32]) -> Binding {
    Binding { instance, nodes: nodes.to_vec(), inner: Transform::IDENTITY }
}

/// Two triangles, each an instance of its own.
fn still() -> Scene {
    let mut scene = Scene::default();
    let material = scene.add_material(Material::default());
    for name in ["a", "b"] {
        let corners = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        scene.add_mesh(Mesh::new(name, corners, vec![[0, 1, 2]], material));
    }
    scene
}

fn near(found: DVec3, expected: [f64; 3]) {
    assert!((found - DVec3::from(expected)).length() < 1e-12, "{found} {expected:?}");
}

#[test]
fn what_stands_still_stays_bit_for_bit() {
    let scene = still();
    assert_eq!(scene.at(0.0).unwrap(), scene);
    assert!(!scene.moves(0) && !scene.moves(7));
    for bad in [f64::NAN, f64::INFINITY] {
        assert!(scene.at(bad).is_err());
    }
}

#[test]
fn nodes_turn_about_their_parents() {
    let mut scene = still();
    scene.motion = Motion {
        // A hub that turns at (3, 0), and on its rim a seat at (1, 0) from it.
        nodes: vec![node(None, fixed(3.0, 0.0)), node(Some(0), turning()), node(Some(1), fixed(1.0, 0.0))],
        bindings: vec![binding(1, &[2])],
        duration: 2.0,
        ..Motion::default()
    };
    let seat = |seconds: f64| scene.at(seconds).unwrap().instances[1].transform;
    assert_eq!(seat(0.0).translation, DVec3::new(4.0, 0.0, 0.0));
    near(seat(1.0).translation, [3.0 + FRAC_1_SQRT_2, FRAC_1_SQRT_2, 0.0]);
    near(seat(2.0).translation, [3.0, 1.0, 0.0]);
    near(seat(2.0).point([1.0, 0.0, 0.0]), [3.0, 2.0, 0.0]);
    assert_eq!((seat(9.0), seat(-1.0)), (seat(2.0), seat(0.0)));
    assert!(!scene.moves(0) && scene.moves(1) && scene.moving() == [false, true]);
    assert_eq!(scene.at(1.0).unwrap().instances[0], scene.instances[0]);
    assert!(scene.at(1.0).unwrap().motion.is_empty());
}

/// A scene that moves, in a placement that moves: outer transforms come first.
#[test]
fn chains_of_nodes_multiply_from_the_outside() {
    let mut scene = still();
    let shift = line([DVec3::ZERO, DVec3::new(0.0, 0.0, 8.0)]);
    let nodes = vec![
        node(None, turning()),
        node(None, Local::Keyed(Box::new(Track { translation: shift, ..track() }))),
        node(None, fixed(5.0, 0.0)),
    ];
    let inner = Transform::scale_translate(2.0, DVec3::ZERO);
    let binding = Binding { inner, ..binding(0, &[0, 1, 2]) };
    scene.motion = Motion { nodes, bindings: vec![binding], duration: 2.0, ..Motion::default() };
    let placed = scene.at(2.0).unwrap().instances[0].transform;
    // (1, 0, 0) → scaled (2, 0, 0) → moved (7, 0, 0) → moved (7, 0, 8) → turned (0, 7, 8).
    near(placed.point([1.0, 0.0, 0.0]), [0.0, 7.0, 8.0]);
}

/// A bar along +X from 0 to 2 whose outer half bends at (1, 0).
fn bar() -> Scene {
    let mut scene = Scene::default();
    let material = scene.add_material(Material::default());
    let positions = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [1.5, 0.0, 0.0]];
    let mut mesh = Mesh::new("bar", positions, vec![[0, 1, 2], [1, 2, 3]], material);
    mesh.normals = vec![[0.0, 1.0, 0.0]; 4];
    scene.add_mesh(mesh);
    let back = Transform { linear: DMat3::IDENTITY, translation: DVec3::new(-1.0, 0.0, 0.0) };
    let pair = |a: f32, b: f32| [Influence { joint: 0, weight: a }, Influence { joint: 1, weight: b }];
    let skin = Skin {
        mesh: 0,
        joints: vec![
            Joint { node: 0, inverse_bind: Transform::IDENTITY },
            Joint { node: 2, inverse_bind: back },
        ],
        per_vertex: 2,
        // The third has weights that don't add up to 1: what counts is their ratio.
        influences: [pair(1.0, 0.0), pair(0.5, 0.5), pair(0.0, 0.25), pair(0.25, 0.75)].concat(),
    };
    scene.motion = Motion {
        nodes: vec![
            node(None, Local::Fixed(Transform::IDENTITY)),
            node(Some(0), fixed(1.0, 0.0)),
            node(Some(1), turning()),
        ],
        skins: vec![skin],
        duration: 2.0,
        ..Motion::default()
    };
    scene
}

/// By hand: at two seconds the outer joint takes p to (1, 0) + R(p − (1, 0)), where R turns x to y and y to −x.
#[test]
fn skins_blend_their_joints() {
    let scene = bar();
    scene.validate(&Limits::default()).unwrap();
    let bent = scene.at(2.0).unwrap();
    let expected_positions = [
        [0.0, 0.0],
        // Half of itself, half of (1, 0), which is itself.
        [1.0, 0.0],
        [1.0, 1.0],
        // A quarter of (1.5, 0) and three quarters of (1, 0.5).
        [1.125, 0.375],
    ];
    // (0, 1) turned is (−1, 0); blended linear parts are turns times a factor, and the normal has length 1 again.
    let norm = 0.1_f64.sqrt();
    let expected_normals = [[0.0, 1.0], [-FRAC_1_SQRT_2, FRAC_1_SQRT_2], [-1.0, 0.0], [-3.0 * norm, norm]];
    for v in 0..4 {
        let close = |found: [f32; 3], [x, y]: [f64; 2]| {
            (glam::Vec3::from(found).as_dvec3() - DVec3::new(x, y, 0.0)).length() < 1e-7
        };
        assert!(close(bent.meshes[0].positions[v], expected_positions[v]), "{v}: {:?}", bent.meshes[0]);
        assert!(close(bent.meshes[0].normals[v], expected_normals[v]), "{v}: {:?}", bent.meshes[0]);
    }
    assert_eq!(bent.meshes[0].triangles, scene.meshes[0].triangles);
    let bind = scene.at(0.0).unwrap();
    assert_eq!(bind.meshes, scene.meshes, "where every joint undoes its inverse bind matrix");
    assert!(scene.moves(0));
}

/// The outer half stretched along X by 2: normals keep at right angles to the surface.
#[test]
fn normals_follow_the_inverse_transpose() {
    let mut scene = bar();
    scene.meshes[0].normals = vec![[1.0, 1.0, 0.0]; 4];
    let scale = Curve::constant(DVec3::new(2.0, 1.0, 1.0));
    scene.motion.nodes[2].local = Local::Keyed(Box::new(Track { scale, ..track() }));
    let [x, y, z] = scene.at(0.0).unwrap().meshes[0].normals[2].map(f64::from);
    near(DVec3::new(x, y, z) * 5.0_f64.sqrt() * 1e-6, [1e-6, 2e-6, 0.0]);
    assert!(!scene.moves(0), "a curve of one value does not move");
}

#[test]
fn posed_scenes_say_what_moves() {
    let mut scene = still();
    scene.instances[1].transform.translation.x = 4.0;
    let shift = line([DVec3::ZERO, DVec3::new(0.0, 0.0, 8.0)]);
    let nodes = vec![node(None, Local::Keyed(Box::new(Track { translation: shift, ..track() })))];
    scene.motion = Motion { nodes, bindings: vec![binding(0, &[0])], duration: 2.0, ..Motion::default() };
    let mut frames = [0.0, 1.0, 2.0].map(|seconds| scene.at(seconds).unwrap());
    for posed in &frames {
        assert_eq!((posed.moving(), posed.moves(0), posed.moves(1)), (vec![true, false], true, false));
        // Whoever poses a scene by other means than a motion says so.
        assert_eq!(posed.at(7.0).unwrap().moving(), [true, false]);
    }
    let compiled = |scene: &Scene| compile(scene, &Limits::default()).unwrap();
    let [first, ..] = frames.each_ref().map(compiled);
    assert_eq!((first.moving_from, first.parts().0[0].id, first.parts().1[0].id), (1, 1, 0));
    for posed in &frames {
        assert_eq!(compiled(posed).parts().0, first.parts().0);
    }
    frames[2].instances[0].moves = false;
    assert_eq!(compiled(&frames[2]).moving_from, 2);
}

/// Far from the origin, where the scene's own middle becomes it: that of what stays, whatever else goes where.
#[test]
fn what_stays_is_compiled_to_the_same_bits() {
    let mut scene = still();
    let place = DVec3::new(1e6, 2e6, -3e6);
    for (x, instance) in scene.instances.iter_mut().enumerate() {
        instance.transform.translation = place + DVec3::new(x as f64 * 0.3, 0.0, 0.0);
    }
    scene.instances[0].moves = true;
    let compiled = |scene: &Scene| compile(scene, &Limits::default()).unwrap();
    let first = compiled(&scene);
    for shift in [0.7, 40.0, -3e5] {
        scene.instances[0].transform.translation.y = place.y + shift;
        let frame = compiled(&scene);
        assert_eq!((frame.parts().0, frame.origin), (first.parts().0, first.origin), "{shift}");
    }
}

/// A lamp that moves and stands, this moment, where a wall of the room does: the wall is hidden as ever, and back the next.
#[test]
fn coinciding_with_what_stays_for_a_moment() {
    let mut scene = still();
    let lamp = scene.add_material(Material::emitter("lamp", [1.0; 3]));
    scene.instances[0].material = Some(lamp);
    scene.instances[0].moves = true;
    let ids = |scene: &Scene| {
        let compiled = compile(scene, &Limits::default()).unwrap();
        (compiled.moving_from, compiled.triangles.iter().map(|t| t.id).collect::<Vec<_>>())
    };
    assert_eq!(ids(&scene), (0, vec![0]));
    scene.instances[0].transform.translation.z = 0.5;
    assert_eq!(ids(&scene), (1, vec![1, 0]));
    scene.instances.swap(0, 1);
    scene.instances[1].transform.translation.z = 0.0;
    assert_eq!(ids(&scene), (0, vec![1]));
}

#[test]
fn hidden_by_scale_zero_and_still_counted() {
    let mut scene = still();
    let scale = Curve::new(Interpolation::Step, vec![0.0, 1.0], vec![DVec3::ZERO, DVec3::ONE]).unwrap();
    let nodes = vec![node(None, Local::Keyed(Box::new(Track { scale, ..track() })))];
    scene.motion = Motion { nodes, bindings: vec![binding(0, &[0])], duration: 1.0, ..Motion::default() };
    let ids = |seconds: f64| {
        let compiled = compile(&scene.at(seconds).unwrap(), &Limits::default()).unwrap();
        let mut ids: Vec<u32> = compiled.triangles.iter().map(|t| t.id).collect();
        ids.sort_unstable();
        ids
    };
    assert_eq!((ids(0.0), ids(1.0)), (vec![0, 1], vec![0, 1]));
}

#[test]
fn motions_that_do_not_fit_are_refused_by_their_place() {
    let refused = |change: fn(&mut Scene)| {
        let mut scene = bar();
        change(&mut scene);
        let message = scene.at(0.0).unwrap_err().to_string();
        assert_eq!(scene.validate(&Limits::default()).unwrap_err().to_string(), message);
        message
    };
    let message = refused(|s| s.motion.nodes[1].parent = Some(1));
    assert_eq!(message, "motion node 1: parent 1 does not come before it");
    let message = refused(|s| s.motion.bindings = vec![binding(1, &[0])]);
    assert_eq!(message, "motion binding 0: instance 1 of 1");
    let message = refused(|s| s.motion.bindings = vec![binding(0, &[3])]);
    assert_eq!(message, "motion binding 0: node 3 of 3");
    let message = refused(|s| s.motion.bindings = vec![binding(0, &[0]), binding(0, &[0])]);
    assert_eq!(message, "motion bindings: instances don't ascend");
    assert_eq!(refused(|s| s.motion.skins[0].mesh = 4), "skin 0: mesh 4 of 1");
    assert_eq!(refused(|s| s.motion.skins[0].joints[1].node = 9), "skin 0: node 9 of 3");
    let message = refused(|s| s.motion.skins[0].per_vertex = 0);
    assert_eq!(message, "skin 0: 8 influences, 0 for each of 4 positions");
    let message = refused(|s| s.motion.skins[0].influences[2].joint = 2);
    assert_eq!(message, "skin 0: vertex 1: joint 2 of 2");
    let message = refused(|s| s.motion.skins[0].influences[7].weight = f32::NAN);
    assert_eq!(message, "skin 0: vertex 3: weight NaN is negative or not a number");
    let message = refused(|s| s.motion.skins[0].influences[0].weight = 0.0);
    assert_eq!(message, "skin 0: vertex 0: no joint has a weight");
    assert!(refused(|s| s.motion.duration = f64::NAN).contains("duration NaN"));
}

/// FNV-1a over the bits of a bent and turned scene: the same on every platform, or a libm or a fused operation crept in.
#[test]
fn frames_have_the_same_bits_everywhere() {
    let mut scene = bar();
    scene.motion.bindings = vec![binding(0, &[2])];
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    for i in 0..=20 {
        let posed = scene.at(0.1 * f64::from(i)).unwrap();
        let t = posed.instances[0].transform;
        let floats = posed.meshes[0].positions.iter().chain(&posed.meshes[0].normals).flatten();
        let words = floats.map(|x| u64::from(x.to_bits())).chain(t.linear.to_cols_array().map(f64::to_bits));
        hash = words.fold(hash, |hash, word| (hash ^ word).wrapping_mul(0x100_0000_01b3));
    }
    assert_eq!(hash, 0xab33_8503_dff1_53f1, "{hash:#x}");
}
