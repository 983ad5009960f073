//! What stays is kept: same bits as building everything, in any order of frames.

use super::{lookups, settings};
use glam::{DQuat, DVec3};
use twinlight_backend_cpu::CpuBackend;
use twinlight_core::Backend;
use twinlight_core::kernels::rasterize_lhb::LhbElement;
use twinlight_core::kernels::walk_lhb::WalkLhbBlock;
use twinlight_core::scene::motion::{Binding, Curve, Interpolation, Local, Node, Track};
use twinlight_core::scene::{
    Camera, CompiledScene, Limits, Material, Mesh, Motion, Scene, Transform, compile,
};
use twinlight_fixtures::meshes::{icosphere, placed, with_material};
use twinlight_fixtures::scenes::builtin;
use twinlight_methods::reference::Control;
use twinlight_methods::slhb::{Buffers, Elements, Kept, LookupSettings, build, render};

/// The Cornell box with a ball that crosses it within four seconds, turning, and is out of the box from the third on.
fn box_and_ball() -> Scene {
    let mut scene = builtin("cornell").unwrap();
    let material = scene.add_material(Material::diffuse("ball", [0.4, 0.6, 0.8]));
    let ball = with_material(placed(icosphere(8), 70.0, DVec3::ZERO), material);
    scene.add_mesh(ball);
    // Not the last: what moves is compiled last, wherever it is in the scene.
    let instance = scene.instances.len() - 2;
    scene.instances.swap(instance, instance + 1);
    let line = |values: Vec<DVec3>| Curve::new(Interpolation::Linear, vec![0.0, 2.0, 4.0], values).unwrap();
    let turns = vec![DQuat::IDENTITY, DQuat::from_xyzw(0.6, 0.0, 0.0, 0.8)];
    let track = Track {
        translation: line(vec![
            DVec3::new(120.0, 400.0, 200.0),
            DVec3::new(420.0, 420.0, 250.0),
            DVec3::new(4000.0, 300.0, 250.0),
        ]),
        rotation: Curve::new(Interpolation::Linear, vec![0.0, 2.0], turns).unwrap(),
        scale: Curve::constant(DVec3::ONE),
    };
    scene.motion = Motion {
        nodes: vec![Node { parent: None, local: Local::Keyed(Box::new(track)) }],
        bindings: vec![Binding { instance: instance as u32, nodes: vec![0], inner: Transform::IDENTITY }],
        duration: 4.0,
        ..Motion::default()
    };
    scene
}

fn compiled(scene: &Scene) -> CompiledScene {
    compile(scene, &Limits::default()).unwrap()
}

fn frame(scene: &Scene, seconds: f64) -> CompiledScene {
    compiled(&scene.at(seconds).unwrap())
}

type Bits = (Vec<u32>, Vec<LhbElement>, Vec<u32>, WalkLhbBlock);

fn bits(backend: &CpuBackend, buffers: &Buffers<CpuBackend>) -> Bits {
    let lhb = &buffers.lhb;
    let words = |buffer| backend.download::<u32>(buffer).unwrap();
    (words(&lhb.offsets), backend.download(&lhb.elements).unwrap(), words(&lhb.left_out), buffers.lookup)
}

/// Builds with what is kept, compares with building everything, and says how many elements were kept.
fn check(
    backend: &CpuBackend,
    kept: &mut Kept<CpuBackend>,
    scene: &CompiledScene,
    settings: &LookupSettings,
) -> usize {
    let (found, expected) =
        (kept.build(backend, scene, settings).unwrap(), build(backend, scene, settings).unwrap());
    assert!(bits(backend, &found) == bits(backend, &expected));
    assert_eq!(expected.kept_elements, 0);
    found.kept_elements
}

#[test]
fn frames_have_the_bits_of_whole_builds_in_any_order() {
    let (backend, scene) = (CpuBackend::with_threads(2).unwrap(), box_and_ball());
    let uncapped = lookups("icosahedron:80", 40);
    for settings in [
        LookupSettings { layers: Some(2), ..uncapped.clone() },
        LookupSettings { elements: Elements::Layers(3), ..uncapped.clone() },
        uncapped,
    ] {
        for order in [[0.0, 0.5, 1.0, 1.5], [1.5, 0.0, 1.0, 0.5]] {
            let mut kept = Kept::new();
            let counts = order.map(|at| check(&backend, &mut kept, &frame(&scene, at), &settings));
            assert_eq!(counts[0], 0);
            assert!(counts[1] > 1000 && counts[1] == counts[2] && counts[2] == counts[3], "{counts:?}");
        }
    }
}

/// The numbers of elements that were built say that something moved at all.
#[test]
fn what_moves_is_in_the_buffers() {
    let (backend, scene, settings) = (CpuBackend::new(), box_and_ball(), lookups("icosahedron:20", 32));
    let mut kept = Kept::new();
    let first = kept.build(&backend, &frame(&scene, 0.0), &settings).unwrap();
    let second = kept.build(&backend, &frame(&scene, 1.0), &settings).unwrap();
    let added = second.elements(&backend) - second.kept_elements;
    assert!(added > 100 && added < second.kept_elements, "{added} of {}", second.elements(&backend));
    assert!(bits(&backend, &first) != bits(&backend, &second));
}

#[test]
fn other_settings_are_built_anew() {
    let (backend, scene) = (CpuBackend::new(), frame(&box_and_ball(), 1.0));
    let first = lookups("icosahedron:20", 32);
    let mut kept = Kept::new();
    check(&backend, &mut kept, &scene, &first);
    for other in [
        lookups("icosahedron:80", 32),
        lookups("icosahedron:20", 40),
        LookupSettings { layers: Some(3), ..first.clone() },
        LookupSettings { cone: false, ..first.clone() },
        LookupSettings { elements: Elements::Packed, ..first.clone() },
        first.clone(),
    ] {
        assert_eq!(check(&backend, &mut kept, &scene, &other), 0);
        assert!(check(&backend, &mut kept, &scene, &other) > 0);
    }
}

#[test]
fn what_changes_without_moving_is_built_anew() {
    let (backend, mut scene, settings) = (CpuBackend::new(), box_and_ball(), lookups("icosahedron:20", 32));
    let mut kept = Kept::new();
    check(&backend, &mut kept, &frame(&scene, 0.0), &settings);
    let wall = &mut scene.meshes[0].positions[0];
    wall[0] -= 5.0;
    assert_eq!(check(&backend, &mut kept, &frame(&scene, 0.0), &settings), 0);
    assert!(check(&backend, &mut kept, &frame(&scene, 1.0), &settings) > 0);
    let other = compiled(&builtin("materials").unwrap());
    assert_eq!(check(&backend, &mut kept, &other, &settings), 0);
    assert_eq!(check(&backend, &mut kept, &frame(&scene, 1.0), &settings), 0);
}

/// Out of the ball around the box the lattice is another, for those frames only: what is kept is used when the ball is back.
#[test]
fn what_leaves_is_built_whole_and_comes_back() {
    let (backend, scene, settings) = (CpuBackend::new(), box_and_ball(), lookups("icosahedron:20", 32));
    let mut kept = Kept::new();
    let seconds = [3.0, 0.0, 4.0, 3.5, 1.0, 3.0];
    let counts = seconds.map(|at| check(&backend, &mut kept, &frame(&scene, at), &settings));
    assert_eq!([counts[0], counts[1], counts[2], counts[3], counts[5]], [0; 5]);
    assert!(counts[4] > 0);
    let step = |at| build(&backend, &frame(&scene, at), &settings).unwrap().lookup.unit_per_step;
    assert!(step(0.0) == step(1.0) && step(3.0) > step(1.0) && step(4.0) > step(3.0));
}

#[test]
fn scenes_of_one_part() {
    let (backend, settings) = (CpuBackend::new(), lookups("icosahedron:20", 32));
    let mut kept = Kept::new();
    let mut scene = builtin("cornell").unwrap();
    assert_eq!(check(&backend, &mut kept, &compiled(&scene), &settings), 0);
    assert!(check(&backend, &mut kept, &compiled(&scene), &settings) > 0);
    scene.instances.iter_mut().for_each(|instance| instance.moves = true);
    let scene = compiled(&scene);
    assert_eq!(scene.moving_from, 0);
    for _ in 0..2 {
        assert_eq!(check(&backend, &mut kept, &scene, &settings), 0);
    }
    for _ in 0..2 {
        assert_eq!(check(&backend, &mut kept, &compiled(&Scene::default()), &settings), 0);
    }
}

/// Triangles are those of the scene's slots: paths see the same.
#[test]
fn pictures_are_the_same() {
    let (backend, scene, lookups) = (CpuBackend::new(), box_and_ball(), lookups("icosahedron:80", 48));
    let camera = Camera::of_scene(&scene).unwrap();
    let mut kept = Kept::new();
    for seconds in [0.0, 1.0, 1.7] {
        let scene = frame(&scene, seconds);
        let resident = backend.upload_scene(&scene).unwrap();
        let film = |buffers: &Buffers<CpuBackend>| {
            let settings = settings(24, 4, 4);
            let done =
                render(&backend, &resident, &scene, buffers, &camera, &settings, |_| Control::Continue);
            done.unwrap().film
        };
        let whole = build(&backend, &scene, &lookups).unwrap();
        assert!(film(&kept.build(&backend, &scene, &lookups).unwrap()) == film(&whole), "{seconds}");
    }
}

#[test]
fn errors_are_those_of_a_whole_build() {
    let (backend, scene) = (CpuBackend::new(), frame(&box_and_ball(), 0.0));
    let mut kept = Kept::new();
    for size in [0, 2000] {
        let settings = lookups("icosahedron:20", size);
        let expected = build(&backend, &scene, &settings).err().unwrap().to_string();
        assert_eq!(kept.build(&backend, &scene, &settings).err().unwrap().to_string(), expected);
    }
    assert_eq!(check(&backend, &mut kept, &scene, &lookups("icosahedron:20", 16)), 0);
}

/// What is the same mesh in both parts, as leaves of one tree are, lies in the same places: equal depths, lower triangle first.
#[test]
fn equal_depths_keep_the_order_of_slots() {
    let (backend, settings) = (CpuBackend::new(), lookups("icosahedron:20", 32));
    let mut scene = Scene::default();
    let material = scene.add_material(Material::default());
    for name in ["moving", "staying"] {
        let mesh = with_material(icosphere(3), material);
        scene.add_mesh(Mesh { name: name.into(), ..mesh });
    }
    scene.instances[0].moves = true;
    let mut kept = Kept::new();
    check(&backend, &mut kept, &compiled(&scene), &settings);
    let kept_elements = check(&backend, &mut kept, &compiled(&scene), &settings);
    let all = build(&backend, &compiled(&scene), &settings).unwrap().elements(&backend);
    assert_eq!(2 * kept_elements, all);
}
