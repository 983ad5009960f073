//! glTF: animations and skins.
#![cfg(feature = "io")]

#[path = "common/gltf.rs"]
mod build;

use build::{Builder, SQUARE, floats, square};
use serde_json::{Value, json};
use twinlight::io::resolve::MemoryFiles;
use twinlight::io::{LoadOptions, gltf};
use twinlight_core::Result;
use twinlight_core::scene::{Scene, Transform, compile};

fn parse(bytes: &[u8], animation: Option<&str>) -> Result<Scene> {
    let options = LoadOptions { animation: animation.map(str::to_owned), ..LoadOptions::default() };
    let scene = gltf::parse(bytes, "t.gltf", &MemoryFiles::default(), &options)?;
    scene.validate(&options.limits)?;
    Ok(scene)
}

fn read(builder: &Builder) -> Scene {
    parse(&builder.glb(), None).unwrap()
}

fn refusal(builder: &Builder) -> String {
    parse(&builder.gltf(), None).unwrap_err().to_string()
}

fn fixture(animation: Option<&str>) -> Result<Scene> {
    let files = twinlight_fixtures::files::all();
    let (_, bytes) = files.iter().find(|(path, _)| *path == "bending/bending.glb").unwrap();
    parse(bytes, animation)
}

fn near(found: [f64; 3], expected: [f64; 3]) {
    let close = found.iter().zip(expected).all(|(f, e)| (f - e).abs() < 1e-6);
    assert!(close, "{found:?} {expected:?}");
}

fn corner(scene: &Scene, vertex: usize) -> [f64; 3] {
    scene.instances[0].transform.point(scene.meshes[0].positions[vertex]).to_array()
}

#[test]
fn the_bar_bends_and_the_cube_glides() {
    let scene = fixture(None).unwrap();
    assert_eq!(scene.motion.duration, 2.0);
    assert_eq!(scene.notices, ["1 animations not played: Wave"]);
    assert_eq!(scene.moving(), [true, true, false]);
    // As it is in the file, and at its first keyframe: the bar's node moves it nowhere, the joints decide.
    for scene in [&scene, &scene.at(0.0).unwrap()] {
        near(corner(scene, 8), [0.125, 2.0, 0.125]);
        near(scene.instances[1].transform.translation.to_array(), [2.0, 0.3, 0.0]);
    }
    // The upper joint is a quarter turn about +Z at (0, 1): x becomes y, and y − 1 becomes −x.
    let bent = scene.at(1.0).unwrap();
    near(corner(&bent, 0), [0.125, 0.0, 0.125]);
    near(corner(&bent, 8), [-1.0, 1.125, 0.125]);
    // Half and half.
    near(corner(&bent, 4), [0.0625, 1.0625, 0.125]);
    let half = std::f64::consts::FRAC_1_SQRT_2;
    near(bent.meshes[0].normals[8].map(f64::from), [0.0, half, half]);
    // Half-way along the spline, 2 seconds long: half the way, and an eighth of the first slope's 2.
    let cube = &bent.instances[1].transform;
    near(cube.translation.to_array(), [2.0, 0.3 + 0.25, -1.0]);
    near((cube.linear * glam::DVec3::ONE).to_array(), [0.15; 3]);
    near((scene.at(0.999).unwrap().instances[1].transform.linear * glam::DVec3::ONE).to_array(), [0.3; 3]);
    assert_eq!(bent.instances[2], scene.instances[2]);
    assert_eq!(scene.at(2.0).unwrap(), scene.at(5.0).unwrap());
    let ids = |seconds| {
        let mut triangles =
            compile(&scene.at(seconds).unwrap(), &LoadOptions::default().limits).unwrap().triangles;
        triangles.sort_by_key(|t| t.id);
        triangles.iter().map(|t| (t.id, t.material)).collect::<Vec<_>>()
    };
    assert_eq!(ids(0.0), ids(1.3));
}

#[test]
fn animations_are_chosen_by_name_or_number() {
    for choice in ["Wave", "1"] {
        let scene = fixture(Some(choice)).unwrap();
        assert_eq!((scene.motion.duration, scene.moving()), (1.0, vec![true, false, false]), "{choice}");
        // About +X: y − 1 becomes z.
        near(corner(&scene.at(1.0).unwrap(), 8), [0.125, 0.875, 1.0]);
    }
    let message = fixture(Some("Bent")).unwrap_err().to_string();
    let expected =
        "t.gltf: animations: no animation is called 'Bent' (did you mean 'Bend'?); there are 2: Bend, Wave";
    assert_eq!(message, expected);
    assert!(fixture(Some("2")).is_err());
    assert!(
        parse(&square().gltf(), Some("any")).is_ok(),
        "a file that stands still has nothing to choose from"
    );
}

/// The unit square, skinned to nodes 1 and 2, with so many influences and an animation of node 2 by `path`.
struct Skinned {
    builder: Builder,
}

impl Skinned {
    fn new(joints: &[[u8; 4]], weights: &[[f32; 4]]) -> Self {
        let mut b = square();
        let joints = b.accessor("VEC4", 5121, joints.len(), joints.as_flattened());
        let weights = b.accessor("VEC4", 5126, weights.len(), &floats(weights.as_flattened()));
        let attributes = &mut b.json["meshes"][0]["primitives"][0]["attributes"];
        (attributes["JOINTS_0"], attributes["WEIGHTS_0"]) = (json!(joints), json!(weights));
        b.json["nodes"] = json!([{"mesh": 0, "skin": 0}, {"translation": [0, 0, 5]}, {}]);
        b.json["scenes"] = json!([{"nodes": [0, 1, 2]}]);
        b.json["skins"] = json!([{"joints": [1, 2]}]);
        Self { builder: b }
    }

    /// Keyframes of node 2.
    fn animated(mut self, path: &str, times: &[f32], kind: &str, values: &[f32], count: usize) -> Self {
        let b = &mut self.builder;
        let input = b.accessor("SCALAR", 5126, times.len(), &floats(times));
        let output = b.accessor(kind, 5126, count, &floats(values));
        b.json["animations"] = json!([{"channels": [{"sampler": 0, "target": {"node": 2, "path": path}}],
            "samplers": [{"input": input, "output": output}]}]);
        self
    }

    fn moving() -> Self {
        Self::plain().animated("translation", &[0.0, 1.0], "VEC3", &[0.0, 0.0, 0.0, 3.0, 0.0, 0.0], 2)
    }

    fn plain() -> Self {
        Self::new(&[[0, 1, 0, 0]; 4], &[[0.5, 0.5, 0.0, 0.0]; 4])
    }

    fn with(mut self, pointer: &str, value: Value) -> Self {
        *self.builder.json.pointer_mut(pointer).unwrap_or_else(|| panic!("no {pointer}")) = value;
        self
    }
}

#[test]
fn a_skin_without_animation_is_bent_as_its_joints_stand() {
    let scene = read(&Skinned::plain().builder);
    assert!(scene.motion.is_empty() && scene.notices.is_empty());
    assert_eq!(scene.meshes[0].positions, SQUARE.map(|[x, y, z]| [x, y, z + 2.5]));
    // A constant animation is a pose.
    let constant = Skinned::plain().animated("translation", &[0.0], "VEC3", &[0.0, 0.0, 1.0], 1);
    let scene = read(&constant.builder);
    assert!(scene.motion.is_empty());
    assert_eq!(scene.meshes[0].positions, SQUARE.map(|[x, y, z]| [x, y, z + 3.0]));
}

#[test]
fn skins_that_can_not_bend_stay_in_their_bind_pose_with_a_notice() {
    let outside = Skinned::plain().with("/scenes/0/nodes", json!([0, 1]));
    let mut bare = Skinned::plain();
    let attributes = bare.builder.json.pointer_mut("/meshes/0/primitives/0/attributes").unwrap();
    attributes.as_object_mut().unwrap().remove("WEIGHTS_0");
    for (case, why) in [(outside, "their joints are not in the scene"), (bare, "they have no weights")] {
        let scene = read(&case.builder);
        assert_eq!(scene.meshes[0].positions, SQUARE);
        assert_eq!(scene.instances[0].transform, Transform::IDENTITY);
        let expected = format!("1 skinned meshes shown in their bind pose: {why}: meshes[0].primitives[0]");
        assert_eq!(scene.notices, [expected]);
    }
}

#[test]
fn weights_count_by_their_ratio() {
    let uneven = Skinned::new(&[[0, 1, 9, 9]; 4], &[[0.3, 0.1, 0.0, 0.0]; 4]);
    let scene = read(&uneven.builder);
    assert!((scene.meshes[0].positions[0][2] - 3.75).abs() < 1e-6);
    let expected = "4 vertices with weights that don't add up to 1 scaled: meshes[0].primitives[0], …";
    assert_eq!(scene.notices, [expected]);
    let none = Skinned::new(&[[1, 1, 1, 1]; 4], &[[0.0; 4]; 4]);
    let scene = read(&none.builder);
    assert_eq!(scene.meshes[0].positions[0], [0.0, 0.0, 5.0]);
    let expected = "4 vertices without weights follow the first joint: meshes[0].primitives[0], …";
    assert_eq!(scene.notices, [expected]);
}

/// One mesh of the file, at a node without a skin and at two with different ones.
#[test]
fn a_mesh_is_another_one_with_each_skin() {
    let nodes =
        json!([{"mesh": 0}, {"mesh": 0, "skin": 0}, {"translation": [0, 0, 5]}, {"mesh": 0, "skin": 1}, {}]);
    let case = Skinned::plain().with("/nodes", nodes).with("/scenes/0/nodes", json!([0, 1, 2, 3, 4]));
    let scene = read(&case.with("/skins", json!([{"joints": [2, 4]}, {"joints": [2, 2]}])).builder);
    let heights: Vec<f32> =
        scene.instances.iter().map(|i| scene.meshes[i.mesh as usize].positions[0][2]).collect();
    assert_eq!(heights, [0.0, 2.5, 5.0]);
}

#[test]
fn more_than_four_influences() {
    let mut case = Skinned::new(&[[0; 4]; 4], &[[0.25, 0.0, 0.0, 0.0]; 4]);
    let b = &mut case.builder;
    let joints = b.accessor("VEC4", 5121, 4, [[1; 4]; 4].as_flattened());
    let weights = b.accessor("VEC4", 5126, 4, &floats([[0.75, 0.0, 0.0, 0.0]; 4].as_flattened()));
    let attributes = &mut b.json["meshes"][0]["primitives"][0]["attributes"];
    (attributes["JOINTS_1"], attributes["WEIGHTS_1"]) = (json!(joints), json!(weights));
    assert_eq!(read(b).meshes[0].positions[0], [0.0, 0.0, 1.25]);
}

#[test]
fn what_is_hidden_at_rest_can_appear() {
    let mut b = square();
    b.json["nodes"] = json!([{"mesh": 0, "scale": [0, 0, 0]}]);
    assert_eq!(read(&b).instances.len(), 0);
    let input = b.accessor("SCALAR", 5126, 2, &floats(&[0.0, 1.0]));
    let output = b.vec3(&[[0.0; 3], [2.0; 3]]);
    b.json["animations"] = json!([{"channels": [{"sampler": 0, "target": {"node": 0, "path": "scale"}}],
        "samplers": [{"input": input, "output": output}]}]);
    let scene = read(&b);
    near(corner(&scene.at(0.0).unwrap(), 2), [0.0; 3]);
    near(corner(&scene.at(1.0).unwrap(), 2), [2.0, 2.0, 0.0]);
    compile(&scene.at(0.0).unwrap(), &LoadOptions::default().limits).unwrap();
}

#[test]
fn what_of_an_animation_is_ignored_is_said() {
    let scene =
        read(&Skinned::moving().with("/animations/0/channels/0/target/path", json!("weights")).builder);
    assert_eq!(scene.notices, ["1 animated morph weights ignored: nodes[2]"]);
    let scene =
        read(&Skinned::moving().with("/animations/0/channels/0/target/path", json!("pointer")).builder);
    assert_eq!(scene.notices, ["1 animated properties that are not known ignored: nodes[2]"]);
    let mut case = Skinned::moving();
    case.builder.json["nodes"].as_array_mut().unwrap().push(json!({}));
    let scene = read(&case.with("/animations/0/channels/0/target/node", json!(3)).builder);
    assert_eq!(scene.notices, ["1 animated nodes outside the scene ignored: nodes[3]"]);
    let mut case = Skinned::moving();
    case.builder.json["cameras"] =
        json!([{"type": "perspective", "perspective": {"yfov": 1.0, "znear": 0.1}}]);
    case.builder.json["nodes"][2]["camera"] = json!(0);
    let scene = read(&case.builder);
    assert_eq!(scene.notices, ["1 cameras and lights on animated nodes stay where they rest: nodes[2]"]);
}

#[test]
fn hostile_animations_are_refused_with_their_place() {
    let keys = |times: &[f32], values: &[f32]| {
        refusal(&Skinned::plain().animated("translation", times, "VEC3", values, values.len() / 3).builder)
    };
    let sampler = "t.gltf: animations[0].samplers[0]: keyframes: ";
    let cases = [
        (keys(&[], &[]), "there are none"),
        (keys(&[0.0, f32::NAN], &[0.0; 6]), "time NaN of keyframe 1 is negative or not a number"),
        (keys(&[-1.0, 0.0], &[0.0; 6]), "time -1 of keyframe 0 is negative or not a number"),
        (keys(&[1.0, 1.0], &[0.0; 6]), "times don't increase: 1 s, then 1 s at keyframe 1"),
        (keys(&[0.0, 1.0], &[0.0; 9]), "3 values for 2 times, 1 each"),
        (
            keys(&[0.0, 1.0], &[0.0, 0.0, 0.0, f32::NAN, 0.0, 0.0]),
            "value of keyframe 1 is not finite or has no direction",
        ),
        (
            refusal(&Skinned::plain().animated("rotation", &[0.0], "VEC4", &[0.0; 4], 1).builder),
            "value of keyframe 0 is not finite or has no direction",
        ),
        (
            refusal(
                &Skinned::moving()
                    .with(
                        "/animations/0/samplers/0",
                        json!({"input": 4, "output": 5,
                "interpolation": "CUBICSPLINE"}),
                    )
                    .builder,
            ),
            "2 values for 2 times, 3 each",
        ),
    ];
    for (message, expected) in cases {
        assert_eq!(message, format!("{sampler}{expected}"));
    }
    let changed = |pointer: &str, value: Value| refusal(&Skinned::moving().with(pointer, value).builder);
    let channel = "animations[0].channels[0]";
    let cases = [
        ("/animations/0/channels/0/sampler", json!(7), format!("{channel}: refers to sampler 7 of 1")),
        (
            "/animations/0/channels/0/target/node",
            json!(9),
            format!("{channel}.target: refers to node 9 of 3"),
        ),
        (
            "/nodes/2",
            json!({"matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}),
            format!("{channel}.target: moves nodes[2], whose transform is a matrix"),
        ),
        (
            "/animations/0/samplers/0/input",
            json!(99),
            "animations[0].samplers[0].input: refers to accessor 99 of 6".into(),
        ),
        ("/animations/0/samplers/0/input", json!(5), "accessors[5]: has elements of type".into()),
        (
            "/accessors/4/count",
            json!(u64::MAX),
            "accessors[4]: 18446744073709551615 elements of 4 bytes".into(),
        ),
        (
            "/animations/0/samplers/0",
            json!({"input": 4, "output": 5, "interpolation": "MAGIC"}),
            "animations[0].samplers[0]: has no valid interpolation".into(),
        ),
    ];
    for (pointer, value, expected) in cases {
        let message = changed(pointer, value);
        assert!(message.starts_with(&format!("t.gltf: {expected}")), "{message}");
    }
    let mut twice = Skinned::moving();
    let channels = twice.builder.json.pointer_mut("/animations/0/channels").unwrap().as_array_mut().unwrap();
    channels.push(channels[0].clone());
    let expected = "animations[0].channels[1]: another channel moves the same property of the same node";
    assert_eq!(refusal(&twice.builder), format!("t.gltf: {expected}"));
}

#[test]
fn hostile_skins_are_refused_with_their_place() {
    let primitive = "meshes[0].primitives[0]";
    let weights =
        |joints: [u8; 4], weights: [f32; 4]| refusal(&Skinned::new(&[joints; 4], &[weights; 4]).builder);
    let mut binds = Skinned::plain();
    let accessor = binds.builder.accessor("MAT4", 5126, 1, &floats(&[1.0; 16]));
    binds.builder.json["skins"][0]["inverseBindMatrices"] = json!(accessor);
    let cases = [
        (weights([2, 0, 0, 0], [1.0, 0.0, 0.0, 0.0]), format!("{primitive}: joint 2 of 2 at vertex 0")),
        (
            weights([0; 4], [f32::NAN; 4]),
            format!("{primitive}: weight NaN of vertex 0 is negative or not a number"),
        ),
        (
            weights([0; 4], [-1.0; 4]),
            format!("{primitive}: weight -1 of vertex 0 is negative or not a number"),
        ),
        (
            refusal(&Skinned::new(&[[0; 4]; 3], &[[1.0; 4]; 4]).builder),
            format!("{primitive}.attributes.JOINTS_0: 3 elements for 4 positions"),
        ),
        (
            refusal(&Skinned::plain().with("/skins/0/joints", json!([1, 8])).builder),
            "skins[0].joints[1]: refers to node 8 of 3".into(),
        ),
        (
            refusal(&Skinned::plain().with("/nodes/0/skin", json!(3)).builder),
            format!("{primitive}: refers to skin 3 of 1"),
        ),
        (
            refusal(&Skinned::plain().with("/accessors/2/componentType", json!(5126)).builder),
            "accessors[2]: joints of type F32, not unsigned bytes or shorts".into(),
        ),
        (
            refusal(&binds.builder),
            "skins[0].inverseBindMatrices[0]: matrix is not affine or not finite".into(),
        ),
    ];
    for (message, expected) in cases {
        assert_eq!(message, format!("t.gltf: {expected}"));
    }
    let mut few = Skinned::plain();
    let identity: Vec<f32> = (0..16).map(|i| if i % 5 == 0 { 1.0 } else { 0.0 }).collect();
    let accessor = few.builder.accessor("MAT4", 5126, 1, &floats(&identity));
    few.builder.json["skins"][0]["inverseBindMatrices"] = json!(accessor);
    assert_eq!(refusal(&few.builder), "t.gltf: skins[0]: 1 inverse bind matrices for 2 joints");
}
