//! glTF files that must be refused, or read with a notice: each by the text a person gets.
#![cfg(feature = "io")]

#[path = "common/gltf.rs"]
mod build;

use build::{Builder, square};
use serde_json::{Value, json};
use twinlight::io::resolve::{MemoryFiles, Resolver};
use twinlight::io::{LoadOptions, gltf};
use twinlight_core::scene::Limits;
use twinlight_core::{Error, Result, scene::Scene};

fn parse_with(bytes: &[u8], options: &LoadOptions) -> Result<Scene> {
    let files = MemoryFiles::new([("ok.bin".to_owned(), vec![0; 100])]);
    gltf::parse(bytes, "t.gltf", &files, options)
}

fn refusal(builder: &Builder) -> String {
    parse_with(&builder.gltf(), &LoadOptions::default()).unwrap_err().to_string()
}

/// The refusal of the square with the value at a JSON pointer replaced.
fn changed(pointer: &str, value: Value) -> String {
    let mut b = square();
    *b.json.pointer_mut(pointer).unwrap_or_else(|| panic!("no {pointer}")) = value;
    refusal(&b)
}

#[test]
fn numbers_near_the_largest_are_refused_with_their_place() {
    let most = u64::MAX;
    let cases = [
        ("/accessors/0/count", json!(most), "accessors[0]: 18446744073709551615 elements of 12 bytes"),
        ("/accessors/0/count", json!(1_u64 << 61), "accessors[0]: 2305843009213693952 elements"),
        (
            "/accessors/0/count",
            json!(5),
            "accessors[0]: 5 elements of 12 bytes, stride 12, from byte 0 of a view of 48",
        ),
        (
            "/bufferViews/0/byteOffset",
            json!(most),
            "bufferViews[0]: 48 bytes from 18446744073709551615 of a buffer of 60",
        ),
        ("/bufferViews/0/byteLength", json!(most), "bufferViews[0]: 18446744073709551615 bytes from 0"),
        ("/bufferViews/0/buffer", json!(7), "bufferViews[0]: refers to buffer 7 of 1"),
        ("/accessors/0/bufferView", json!(9), "accessors[0]: refers to buffer view 9 of 2"),
        ("/accessors/0/componentType", json!(5124), "accessors[0]: has no valid component type"),
        ("/accessors/0/type", json!("VEC2"), "accessors[0]: has elements of type"),
        ("/accessors/1/componentType", json!(5126), "accessors[1]: vertex indices of type F32"),
        (
            "/accessors/1/count",
            json!(5),
            "meshes[0].primitives[0]: 5 corners are no whole number of triangles",
        ),
        ("/accessors/0/count", json!(3), "meshes[0].primitives[0].indices: vertex 3 of 3"),
        (
            "/meshes/0/primitives/0/attributes/POSITION",
            json!(88),
            "attributes.POSITION: refers to accessor 88 of 2",
        ),
        ("/meshes/0/primitives/0/indices", json!(88), "primitives[0].indices: refers to accessor 88 of 2"),
        ("/nodes/0/mesh", json!(3), "nodes[0]: refers to mesh 3 of 1"),
        ("/scene", json!(3), "scene: refers to scene 3 of 1"),
        ("/scenes/0/nodes/0", json!(3), "scene: refers to node 3 of 1"),
    ];
    for (pointer, value, expected) in cases {
        let message = changed(pointer, value.clone());
        assert!(
            message.starts_with("t.gltf: ") && message.contains(expected),
            "{pointer} = {value}: {message}"
        );
    }
    for (key, value, expected) in [
        ("byteOffset", json!(most), "from byte 18446744073709551615 of a view of 48"),
        ("byteOffset", json!(most - 47), "elements of 12 bytes"),
    ] {
        let mut b = square();
        b.json["accessors"][0][key] = value;
        let message = refusal(&b);
        assert!(message.contains(expected), "{message}");
    }
    for stride in [0_u64, 8, most] {
        let mut b = square();
        b.json["bufferViews"][0]["byteStride"] = json!(stride);
        let message = refusal(&b);
        assert!(message.contains("stride"), "{stride}: {message}");
    }
}

#[test]
fn cameras_beyond_the_limit_of_coordinates_are_refused() {
    let mut b = square();
    b.json["cameras"] = json!([{"type": "perspective", "perspective": {"yfov": 1.0, "znear": 0.1}}]);
    b.json["nodes"] =
        json!([{"mesh": 0, "children": [1]}, {"camera": 0, "translation": [0, -4398046511104_i64, 0]}]);
    let expected = "t.gltf: cameras[0]: its node places it at coordinate -4398046511104.0, ";
    assert!(refusal(&b).starts_with(expected), "{}", refusal(&b));
}

#[test]
fn sparse_elements_are_checked_like_others() {
    let sparse = |change: &dyn Fn(&mut Value)| {
        let mut b = square();
        let (indices, values) = (b.view(&[1, 9]), b.view(&[0; 24]));
        b.json["accessors"][0]["sparse"] = json!({"count": 2,
            "indices": {"bufferView": indices, "componentType": 5121}, "values": {"bufferView": values}});
        change(&mut b.json["accessors"][0]);
        refusal(&b)
    };
    assert!(sparse(&|_| {}).contains("accessors[0].sparse: index 9 of 4 elements"));
    assert!(
        sparse(&|a| a["sparse"]["count"] = json!(u64::MAX))
            .contains("accessors[0].sparse: 18446744073709551615")
    );
    assert!(
        sparse(&|a| a["sparse"]["count"] = json!(3)).contains("accessors[0].sparse: 3 elements of 1 bytes")
    );
    assert!(
        sparse(&|a| a["sparse"]["values"]["byteOffset"] = json!(1))
            .contains("accessors[0].sparse: 2 elements")
    );
    let message = sparse(&|a| {
        a.as_object_mut().unwrap().remove("bufferView");
        a["count"] = json!(1_u64 << 40);
    });
    assert!(message.contains("accessors[0]: elements without data: needs 1099511627776"), "{message}");
}

#[test]
fn nodes_that_are_no_tree_are_refused_and_deep_trees_are_not() {
    let nodes = |nodes: Value| {
        let mut b = square();
        b.json["nodes"] = nodes;
        refusal(&b)
    };
    let twice = "t.gltf: nodes[1]: is reached twice: nodes don't form a tree";
    assert_eq!(nodes(json!([{"children": [1]}, {"children": [1]}])), twice);
    assert_eq!(nodes(json!([{"children": [1, 1]}, {}])), twice);
    assert!(nodes(json!([{"children": [0]}])).contains("nodes[0]: is reached twice"));
    assert!(nodes(json!([{"rotation": [0, 0, 0, 0]}])).contains("nodes[0]: rotation"));
    assert!(
        nodes(json!([{"matrix": [1,0,0,1, 0,1,0,0, 0,0,1,0, 0,0,0,1]}]))
            .contains("nodes[0]: matrix is not affine")
    );

    let mut b = square();
    let mut deep: Vec<Value> = (1..100_000).map(|i| json!({"children": [i]})).collect();
    deep.push(json!({"mesh": 0}));
    b.json["nodes"] = json!(deep);
    assert_eq!(parse_with(&b.gltf(), &LoadOptions::default()).unwrap().triangle_count(), 2);
}

#[test]
fn a_small_file_cannot_describe_a_scene_beyond_the_limits() {
    let mut b = square();
    let nodes: Vec<Value> = (0..1000).map(|_| json!({"mesh": 0})).collect();
    b.json["scenes"][0]["nodes"] = json!((0..1000).collect::<Vec<_>>());
    b.json["nodes"] = json!(nodes);
    let with = |limits: Limits| parse_with(&b.gltf(), &LoadOptions { limits, ..LoadOptions::default() });
    assert_eq!(with(Limits::default()).unwrap().triangle_count(), 2000);
    let error = with(Limits { max_triangles: 1999, ..Limits::default() }).unwrap_err();
    assert!(matches!(error, Error::LimitExceeded { needed: 2000, limit: 1999, .. }), "{error}");

    let copies: Vec<Value> =
        (0..1000).map(|_| json!({"attributes": {"POSITION": 0}, "indices": 1})).collect();
    let mut b = square();
    b.json["meshes"][0]["primitives"] = json!(copies);
    // The JSON is estimated at 3.2 MB; what it describes takes 1000 × (48 + 24 + 32 bytes + an instance) more.
    let tight = Limits { max_bytes: 4_000_000, ..Limits::default() };
    assert!(parse_with(&b.gltf(), &LoadOptions { limits: tight, ..LoadOptions::default() }).is_ok());
    let tight = Limits { max_bytes: 100_000, ..Limits::default() };
    let error = parse_with(&b.gltf(), &LoadOptions { limits: tight, ..LoadOptions::default() }).unwrap_err();
    assert!(matches!(&error, Error::LimitExceeded { what, .. } if what.contains("parsed JSON")), "{error}");
}

#[test]
fn files_come_from_the_scene_folder_only() {
    let uri = |uri: &str| {
        let mut b = square();
        b.json["buffers"] = json!([{"byteLength": 60, "uri": uri}]);
        let text = b.json.to_string();
        parse_with(text.as_bytes(), &LoadOptions::default())
            .map(|s| s.triangle_count())
            .map_err(|e| e.to_string())
    };
    assert_eq!(uri("ok.bin"), Ok(2));
    assert_eq!(uri("%6Fk.bin"), Ok(2));
    for (bad, expected) in [
        ("../ok.bin", "../ok.bin"),
        ("/etc/passwd", "/etc/passwd"),
        ("file:///etc/passwd", "file:///etc/passwd"),
        ("https://example.org/a.bin", "https://example.org/a.bin"),
        ("%FF", "%FF"),
        ("%2e%2e/ok.bin", "../ok.bin"),
        ("none.bin", "file 'none.bin' can't be read"),
        ("data:application/octet-stream;base64,AAAA", "buffers[0]: claims 60 bytes, has 3"),
        ("data:application/octet-stream;base64,A*AA", "character 2 of the base64"),
        ("data:application/octet-stream,AAAA", "is not base64"),
        ("data:no comma", "without a comma"),
    ] {
        let message = uri(bad).unwrap_err();
        assert!(message.contains(expected), "{bad}: {message}");
        assert!(message.trim_start_matches("unsupported: ").starts_with("t.gltf: buffers[0]: "), "{message}");
        assert_eq!(message.matches("t.gltf").count(), 1, "{message}");
    }
    // The same on a real folder, which has a neighbour.
    let folder = std::env::temp_dir().join(format!("twinlight-gltf-{}", std::process::id()));
    std::fs::create_dir_all(folder.join("scene")).unwrap();
    std::fs::write(folder.join("secret.bin"), [0; 100]).unwrap();
    let options = LoadOptions::default();
    let files = Resolver::new(&folder.join("scene/t.gltf"), &options).unwrap();
    let mut b = square();
    b.json["buffers"] = json!([{"byteLength": 60, "uri": "../secret.bin"}]);
    let error = gltf::parse(b.json.to_string().as_bytes(), "t.gltf", &files, &options).unwrap_err();
    std::fs::remove_dir_all(&folder).unwrap();
    assert!(error.to_string().contains("outside the scene's folder"), "{error}");
}

#[test]
fn required_extensions_are_named_and_others_noted() {
    let mut b = square();
    b.json["extensionsUsed"] = json!(["KHR_draco_mesh_compression", "KHR_lights_punctual"]);
    let scene = parse_with(&b.gltf(), &LoadOptions::default()).unwrap();
    assert_eq!(scene.notices, ["1 extensions ignored: KHR_draco_mesh_compression"]);
    let strict = LoadOptions { strict: true, ..LoadOptions::default() };
    assert!(matches!(parse_with(&b.gltf(), &strict), Err(Error::Unsupported(_))));
    b.json["extensionsRequired"] = json!(["KHR_texture_transform", "KHR_draco_mesh_compression"]);
    let error = parse_with(&b.gltf(), &LoadOptions::default()).unwrap_err();
    assert!(
        matches!(&error, Error::Unsupported(what) if what.contains("KHR_draco_mesh_compression")),
        "{error}"
    );
}

#[test]
fn unreadable_pictures_are_noted_or_refused() {
    let mut b = square();
    b.json["images"] = json!([{"uri": "ok.bin"}]);
    b.json["textures"] = json!([{"source": 0}]);
    b.json["materials"] =
        json!([{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicFactor": 0.0}}]);
    let strict = LoadOptions { strict: true, ..LoadOptions::default() };
    for uri in ["ok.bin", "missing.png", "data:image/png;base64,iVBORw0KGgo="] {
        b.json["images"][0]["uri"] = json!(uri);
        let scene = parse_with(&b.gltf(), &LoadOptions::default()).unwrap();
        assert_eq!((scene.textures.len(), scene.materials[0].albedo_texture), (0, None));
        assert!(scene.notices[0].contains("textures left out"), "{:?}", scene.notices);
        assert!(scene.notices[0].contains("t.gltf: "), "{:?}", scene.notices);
        assert!(parse_with(&b.gltf(), &strict).is_err(), "{uri}");
    }
    // Not a missing picture, but an attempt.
    b.json["images"][0]["uri"] = json!("../../secret.png");
    assert!(refusal(&b).starts_with("t.gltf: images[0]: reference '../../secret.png'"), "{}", refusal(&b));
    b.json["textures"] = json!([{}]);
    assert!(refusal(&b).contains("refers to image 4294967295 of 1"));
}

#[test]
fn broken_containers_are_refused() {
    let message = |bytes: &[u8]| parse_with(bytes, &LoadOptions::default()).unwrap_err().to_string();
    assert!(
        message(b"{\n  \"asset\": nonsense}").starts_with("t.gltf:2:"),
        "{}",
        message(b"{\n \"asset\": x}")
    );
    assert!(message(b"").starts_with("t.gltf:1:0: JSON"));
    assert!(message(b"{}").contains("asset"));
    assert!(message(br#"{"asset": {"version": "1.0"}}"#).contains("glTF version '1.0'"));
    let glb = square().glb();
    for length in 0..glb.len() {
        assert!(
            parse_with(&glb[..length], &LoadOptions::default()).is_err(),
            "{length} bytes of the GLB pass"
        );
    }
    let patched = |at: usize, word: u32| {
        let mut glb = square().glb();
        glb[at..at + 4].copy_from_slice(&word.to_le_bytes());
        message(&glb)
    };
    assert!(patched(4, 3).contains("GLB version 3"));
    assert!(patched(8, u32::MAX).contains("claims 4294967295 bytes"));
    assert!(patched(8, 5).contains("no JSON chunk"));
    assert!(patched(12, u32::MAX).contains("chunk at byte 12 claims 4294967295 bytes"));
    assert!(patched(16, 0).contains("no JSON chunk"));
}
