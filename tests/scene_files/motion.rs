//! What moves in TOML scene files.

use crate::{files, read, read_bytes};
use twinlight::io::resolve::MemoryFiles;
use twinlight::io::{LoadOptions, complete};
use twinlight_core::scene::Scene;

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

fn scene(instances: &str) -> Scene {
    let text = format!("[[mesh]]\nname = 'm'\npath = 'm.obj'\n{instances}");
    let scene = read("s.toml", &text, &[("m.obj", TRIANGLE)], &LoadOptions::default()).unwrap();
    scene.validate(&LoadOptions::default().limits).unwrap();
    scene
}

fn image(scene: &Scene, instance: usize, seconds: f64, p: [f32; 3]) -> [f64; 3] {
    let posed = scene.at(seconds).unwrap();
    posed.instances[instance].transform.point(p).to_array().map(|x| (x * 1e9).round() / 1e9)
}

#[test]
fn keyframes_move_what_they_name_and_leave_the_rest() {
    let scene = scene(
        "[[instance]]\nmesh = 'm'\n[[instance]]\nmesh = 'm'\nscale = 2\nrotate = { axis = [0, 0, 1], angle = 90 }\n\
         [[instance.motion]]\ntime = 1\ntranslate = [10, 0, 0]\n[[instance.motion]]\ntime = 3\ntranslate = [20, 0, 4]\n",
    );
    assert_eq!((scene.motion.duration, scene.moving()), (3.0, vec![false, true]));
    for (seconds, expected) in [(0.0, [10.0, 2.0, 0.0]), (2.0, [15.0, 2.0, 2.0]), (9.0, [20.0, 2.0, 4.0])] {
        assert_eq!(image(&scene, 1, seconds, [1.0, 0.0, 0.0]), expected, "{seconds}");
    }
    assert_eq!(scene.at(2.0).unwrap().instances[0], scene.instances[0]);
    assert_eq!(scene.instances[1].transform, scene.at(0.0).unwrap().instances[1].transform);
}

/// Two and a half turns are two and a half turns, and 360 degrees do not stand still.
#[test]
fn rotations_about_one_axis_turn_through_their_angles() {
    let scene = scene(
        "[[instance]]\nmesh = 'm'\n[[instance.motion]]\ntime = 0\nrotate = { axis = [0, 0, 2], angle = 0 }\n\
         [[instance.motion]]\ntime = 10\nrotate = { axis = [0, 0, 1], angle = 900 }\n\
         [[instance.motion]]\ntime = 12\nrotate = { axis = [0, 0, 1], angle = 810 }\n",
    );
    let cases =
        [(1.0, [0.0, 1.0, 0.0]), (2.0, [-1.0, 0.0, 0.0]), (4.0, [1.0, 0.0, 0.0]), (12.0, [0.0, 1.0, 0.0])];
    for (seconds, expected) in cases {
        assert_eq!(image(&scene, 0, seconds, [1.0, 0.0, 0.0]), expected, "{seconds}");
    }
}

#[test]
fn scenes_that_move_can_be_placed_and_moved() {
    let inner = "[[mesh]]\nname = 'm'\npath = 'm.obj'\n[[instance]]\nmesh = 'm'\n[[instance.motion]]\ntime = 0\n\
                 translate = [0, 0, 0]\n[[instance.motion]]\ntime = 1\ntranslate = [1, 0, 0]\n[[instance]]\nmesh = 'm'\n";
    let outer = "[[mesh]]\nname = 'in'\npath = 'in.toml'\n[[instance]]\nmesh = 'in'\nscale = 3\n\
                 [[instance]]\nmesh = 'in'\n[[instance.motion]]\ntime = 0\ntranslate = [0, 5, 0]\n\
                 [[instance.motion]]\ntime = 2\ntranslate = [0, 7, 0]\n[[instance]]\nmesh = 'in'\n";
    let scene =
        read("s.toml", outer, &[("m.obj", TRIANGLE), ("in.toml", inner)], &LoadOptions::default()).unwrap();
    assert_eq!((scene.motion.duration, scene.moving()), (2.0, vec![true, false, true, true, true, false]));
    let origins: Vec<[f64; 3]> = (0..6).map(|i| image(&scene, i, 1.0, [0.0; 3])).collect();
    let expected = [[3.0, 0.0, 0.0], [0.0; 3], [1.0, 6.0, 0.0], [0.0, 6.0, 0.0], [1.0, 0.0, 0.0], [0.0; 3]];
    assert_eq!(origins, expected);
}

fn bending(animation: &str) -> MemoryFiles {
    let all = twinlight_fixtures::files::all();
    let glb = all.into_iter().find(|(path, _)| *path == "bending/bending.glb").unwrap().1;
    let text = format!(
        "[[mesh]]\nname = 'still'\npath = 'm.obj'\n[[mesh]]\nname = 'b'\npath = 'b.glb'\n{animation}\n\
         [[mesh]]\nname = 'c'\npath = 'b.glb'\nanimation = 'Wave'\n\
         [[instance]]\nmesh = 'b'\ntranslate = [0, 0, 10]\n[[instance]]\nmesh = 'b'\n[[instance.motion]]\ntime = 0\n\
         translate = [0, 0, 0]\n[[instance.motion]]\ntime = 4\ntranslate = [0, 0, -4]\n"
    );
    let texts = [("s.toml", text.into_bytes()), ("m.obj", TRIANGLE.into()), ("b.glb", glb)];
    MemoryFiles::new(texts.map(|(path, bytes)| (path.to_owned(), bytes)))
}

fn read_bending(animation: &str, options: &LoadOptions) -> twinlight_core::Result<Scene> {
    use twinlight::io::resolve::Files;
    let files = bending(animation);
    read_bytes("s.toml", &files.read("s.toml").unwrap(), &files, options)
}

/// A skin bends in its own file's space, wherever that is placed, and nodes move within a placement.
#[test]
fn skinned_files_can_be_placed_and_moved() {
    let options = LoadOptions::default();
    let scene = read_bending("", &options).unwrap();
    scene.validate(&options.limits).unwrap();
    // b twice; then, each placed once, m.obj and c, which plays another animation.
    let c = [false, true, false, false];
    assert_eq!(scene.moving(), [&[true, true, false, true, true, true][..], &c].concat());
    let posed = scene.at(1.0).unwrap();
    let corner = |instance: usize, vertex: usize| {
        let instance = &posed.instances[instance];
        let p = instance.transform.point(posed.meshes[instance.mesh as usize].positions[vertex]);
        p.to_array().map(|x| (x * 1e6).round() / 1e6)
    };
    assert_eq!(corner(0, 8), [-1.0, 1.125, 10.125]);
    assert_eq!(corner(3, 8), [-1.0, 1.125, -0.875]);
    assert_eq!(corner(7, 8), [0.125, 0.875, 1.0]);
    let cube =
        |i: usize| posed.instances[i].transform.translation.to_array().map(|x| (x * 1e6).round() / 1e6);
    assert_eq!((cube(1), cube(4)), ([2.0, 0.55, 9.0], [2.0, 0.55, -2.0]));
    let notice = "lights and cameras of 'b' stay where its motion begins";
    assert!(scene.notices.iter().any(|n| n == notice), "{:?}", scene.notices);
}

#[test]
fn a_mesh_says_which_animation_it_plays() {
    let options = LoadOptions { animation: Some("Bend".into()), ..LoadOptions::default() };
    for (own, options, moves) in [
        ("animation = 'Wave'", LoadOptions::default(), false),
        ("animation = 'Wave'", options.clone(), false),
        ("", options, true),
    ] {
        assert_eq!(read_bending(own, &options).unwrap().moves(1), moves, "{own}");
    }
    let message = read_bending("animation = 'Walk'", &LoadOptions::default()).unwrap_err().to_string();
    assert!(message.contains("no animation is called 'Walk'"), "{message}");
}

#[test]
fn errors_point_at_the_keyframe() {
    let refused = |keys: &str| {
        let text = format!("[[mesh]]\npath = 'm.obj'\n[[instance]]\nmesh = 'm.obj'\n{keys}");
        read("s.toml", &text, &[("m.obj", TRIANGLE)], &LoadOptions::default()).unwrap_err().to_string()
    };
    let key = "[[instance.motion]]\n";
    let cases = [
        (
            format!("{key}time = 1\nscale = 1\n{key}time = 1\nscale = 1\n"),
            "s.toml:8:1: times of keyframes must increase: 1, then 1",
        ),
        (format!("{key}time = 1\n"), "s.toml:5:1: a keyframe needs translate, rotate or scale"),
        (format!("{key}scale = 1\n"), "s.toml:5:1: missing field 'time'"),
        (format!("{key}time = 1\nmove = 1\n"), "s.toml:7:1: unknown field 'move'"),
        (format!("{key}time = -1\nscale = 1\n"), "s.toml:5:1: time -1 of keyframe 0 is negative"),
        (
            format!("matrix = [[1, 0, 0, 4], [0, 1, 0, 5], [0, 0, 1, 6]]\n{key}time = 1\nscale = 1\n"),
            "s.toml:6:1: a placement by a matrix",
        ),
    ];
    for (keys, expected) in cases {
        let message = refused(&keys);
        assert!(message.starts_with(expected), "{message}");
    }
    let text = "[[mesh]]\npath = 'm.obj'\nanimation = 'walk'\n";
    let message = twinlight::io::toml_scene::parse(
        text.as_bytes(),
        "s.toml",
        &files(&[("m.obj", TRIANGLE)]),
        &LoadOptions::default(),
    );
    let expected = "s.toml:3:13: 'm.obj' has no animation that could be played";
    assert_eq!(message.unwrap_err().to_string(), expected);
}

/// What moves far is in the picture at the beginning and at the end.
#[test]
fn an_added_camera_frames_the_whole_motion() {
    let mut scene = scene(
        "[[instance]]\nmesh = 'm'\n[[instance.motion]]\ntime = 0\ntranslate = [0, 0, 0]\n\
         [[instance.motion]]\ntime = 1\ntranslate = [100, 0, 0]\n",
    );
    complete(&mut scene);
    let camera = scene.camera.unwrap();
    assert!((camera.target[0] - 50.5).abs() < 1e-9, "{camera:?}");
    assert_eq!(scene.lights.len(), 1);
    assert!(!scene.motion.is_empty());
}
