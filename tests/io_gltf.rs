//! glTF: geometry, transforms, materials, lights, cameras.
#![cfg(feature = "io")]

#[path = "common/gltf.rs"]
mod build;

use build::{Builder, SQUARE, floats, square};
use serde_json::json;
use twinlight::io::resolve::MemoryFiles;
use twinlight::io::{LoadOptions, gltf, image::png};
use twinlight_core::Result;
use twinlight_core::scene::{Light, Material, MaterialKind, Scene, Wrap};

fn parse(bytes: &[u8]) -> Result<Scene> {
    gltf::parse(bytes, "test.gltf", &MemoryFiles::default(), &LoadOptions::default())
}

fn read(builder: &Builder) -> Scene {
    let scene = parse(&builder.gltf()).unwrap();
    scene.validate(&LoadOptions::default().limits).unwrap();
    scene
}

#[test]
fn every_kind_of_index_gives_the_same_triangles() {
    let expected = vec![[0, 1, 2], [0, 2, 3]];
    for component in [5121_u32, 5123, 5125] {
        let mut b = Builder::new();
        let positions = b.vec3(&SQUARE);
        let size = [1, 2, 4][(component as usize - 5121) / 2];
        let bytes: Vec<u8> =
            [0_u32, 1, 2, 0, 2, 3].iter().flat_map(|i| i.to_le_bytes()[..size].to_vec()).collect();
        let indices = b.accessor("SCALAR", component, 6, &bytes);
        b.primitive(json!({"attributes": {"POSITION": positions}, "indices": indices}));
        let scene = read(&b);
        assert_eq!(scene.meshes[0].triangles, expected, "{component}");
        assert_eq!(scene.meshes[0].positions, SQUARE);
    }
    let mut b = Builder::new();
    let positions = b.vec3(&[0, 1, 2, 0, 2, 3].map(|i: usize| SQUARE[i]));
    b.primitive(json!({"attributes": {"POSITION": positions}}));
    assert_eq!(read(&b).meshes[0].triangles, [[0, 1, 2], [3, 4, 5]]);
}

#[test]
fn strips_and_fans_keep_the_winding() {
    let with_mode = |mode: u32, order: &[u16]| {
        let mut b = Builder::new();
        let positions = b.vec3(&SQUARE);
        let indices = b.indices16(order);
        b.primitive(json!({"attributes": {"POSITION": positions}, "indices": indices, "mode": mode}));
        read(&b)
    };
    // All three describe the square seen from +z.
    let normal_z = |scene: &Scene| -> Vec<f32> {
        let mesh = &scene.meshes[0];
        let corner = |t: &[u32; 3], i: usize| glam::Vec3::from(mesh.positions[t[i] as usize]);
        let z = |t| (corner(t, 1) - corner(t, 0)).cross(corner(t, 2) - corner(t, 0)).z;
        mesh.triangles.iter().map(z).collect()
    };
    for (mode, order) in [(4, &[0, 1, 2, 0, 2, 3][..]), (5, &[0, 1, 3, 2]), (6, &[0, 1, 2, 3])] {
        let scene = with_mode(mode, order);
        assert_eq!(normal_z(&scene), [1.0, 1.0], "mode {mode}");
    }
    assert_eq!(with_mode(5, &[0, 1]).triangle_count(), 0);
    for mode in 0..4 {
        let scene = with_mode(mode, &[0, 1, 2, 3]);
        assert_eq!(scene.triangle_count(), 0);
        assert_eq!(scene.notices, ["1 primitives of points or lines ignored: meshes[0].primitives[0]"]);
    }
}

#[test]
fn glb_and_text_give_the_same_scene() {
    let builder = square();
    assert_eq!(parse(&builder.glb()).unwrap(), parse(&builder.gltf()).unwrap());
}

#[test]
fn transforms_multiply_from_root_to_leaf() {
    let mut b = square();
    let half = std::f32::consts::FRAC_1_SQRT_2;
    b.json["nodes"] = json!([
        {"translation": [10, 0, 0], "rotation": [0, 0, half, half], "children": [1, 2]},
        {"scale": [2, 3, 4], "translation": [0, 1, 0], "mesh": 0},
        {"matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 5,6,7,1], "mesh": 0, "name": "second"},
    ]);
    let scene = read(&b);
    let image = |i: usize, p: [f32; 3]| scene.instances[i].transform.point(p).as_vec3();
    // (1, 1, 0) → scaled (2, 3, 0) → moved (2, 4, 0) → turned by 90° (−4, 2, 0) → moved (6, 2, 0).
    assert!(image(0, [1.0, 1.0, 0.0]).abs_diff_eq(glam::Vec3::new(6.0, 2.0, 0.0), 1e-5));
    // (0, 0, 0) → (5, 6, 7) → (−6, 5, 7) → (4, 5, 7).
    assert!(image(1, [0.0, 0.0, 0.0]).abs_diff_eq(glam::Vec3::new(4.0, 5.0, 7.0), 1e-5));
    assert_eq!(scene.instances[1].name, "second");
    assert_eq!((scene.meshes.len(), scene.triangle_count()), (1, 4));

    b.json["nodes"][1]["scale"] = json!([1, 0, 1]);
    let scene = read(&b);
    assert_eq!(scene.instances.len(), 1);
    assert!(scene.notices[0].contains("flattened to nothing"), "{:?}", scene.notices);
}

#[test]
fn strided_sparse_and_quantised_accessors() {
    let mut b = Builder::new();
    // Position and normal interleaved, 28 bytes apart, with 4 bytes of junk behind each.
    let rows: Vec<f32> = SQUARE.iter().flat_map(|p| [p[0], p[1], p[2], 0.0, 0.0, 1.0, 9.0]).collect();
    let view = b.view(&floats(&rows));
    b.json["bufferViews"][view]["byteStride"] = json!(28);
    let accessor = |offset: usize| json!({"bufferView": view, "byteOffset": offset, "componentType": 5126, "count": 4, "type": "VEC3"});
    let (positions, normals) = (b.push("accessors", accessor(0)), b.push("accessors", accessor(12)));
    // Two of the positions replaced.
    let indices = b.view(&[1, 3]);
    let values = b.view(&floats(&[7.0, 8.0, 9.0, 1.0, 2.0, 3.0]));
    b.json["accessors"][positions]["sparse"] = json!({"count": 2,
        "indices": {"bufferView": indices, "componentType": 5121}, "values": {"bufferView": values}});
    // Normalised bytes: 255 is 1.
    let texcoords = b.accessor("VEC2", 5121, 4, &[0, 0, 255, 0, 255, 255, 0, 51]);
    b.json["accessors"][texcoords]["normalized"] = json!(true);
    let picture = b.view(&png::encode(1, 1, &[[1, 2, 3]]).unwrap());
    b.json["images"] = json!([{"bufferView": picture, "mimeType": "image/png"}]);
    b.json["textures"] = json!([{"source": 0}]);
    b.json["materials"] = json!([{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}]);
    b.primitive(json!({"attributes": {"POSITION": positions, "NORMAL": normals, "TEXCOORD_0": texcoords},
        "mode": 6, "material": 0}));
    let scene = read(&b);
    let mesh = &scene.meshes[0];
    assert_eq!(mesh.positions, [SQUARE[0], [7.0, 8.0, 9.0], SQUARE[2], [1.0, 2.0, 3.0]]);
    assert_eq!(mesh.normals, [[0.0, 0.0, 1.0]; 4]);
    // glTF's v runs down from the top, the scene's up from the bottom.
    assert_eq!(mesh.texcoords, [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.8]]);
    assert_eq!(scene.textures[0].texels, [[1, 2, 3, 255]]);

    // Without a view, what sparse does not name is zero.
    b.json["accessors"][positions].as_object_mut().unwrap().remove("bufferView");
    assert_eq!(read(&b).meshes[0].positions, [[0.0; 3], [7.0, 8.0, 9.0], [0.0; 3], [1.0, 2.0, 3.0]]);
}

fn material(json: serde_json::Value) -> Material {
    let mut b = square();
    b.json["materials"] = json!([json]);
    b.json["meshes"][0]["primitives"][0]["material"] = json!(0);
    read(&b).materials[0].clone()
}

fn near(a: [f32; 3], b: [f32; 3]) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-6)
}

#[test]
fn metallic_rough_materials() {
    let plain = material(json!({"name": "paint", "doubleSided": true, "pbrMetallicRoughness":
        {"baseColorFactor": [0.5, 0.25, 1.0, 0.3], "metallicFactor": 0.0, "roughnessFactor": 0.75}}));
    assert_eq!((plain.name.as_str(), plain.roughness, plain.kind), ("paint", 0.75, MaterialKind::Opaque));
    assert!(near(plain.albedo, [0.5, 0.25, 1.0]) && near(plain.specular_f0, [0.04; 3]), "{plain:?}");
    assert!(plain.emits_both_sides);

    let half = material(json!({"pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 1.0, 1.0],
        "metallicFactor": 0.5}}));
    assert!(near(half.albedo, [0.25, 0.125, 0.5]) && near(half.specular_f0, [0.27, 0.145, 0.52]), "{half:?}");

    let metal = material(json!({"pbrMetallicRoughness": {"roughnessFactor": 0.0}}));
    assert!(near(metal.albedo, [0.0; 3]) && near(metal.specular_f0, [1.0; 3]));
    assert_eq!(metal.kind, MaterialKind::Mirror);

    let lamp = material(json!({"emissiveFactor": [1.0, 0.5, 0.0],
        "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 20.0}}}));
    assert_eq!(lamp.emission, [20.0, 10.0, 0.0]);

    let glass = material(json!({"pbrMetallicRoughness": {"metallicFactor": 0.0}, "extensions": {
        "KHR_materials_transmission": {"transmissionFactor": 1.0}, "KHR_materials_ior": {"ior": 1.33}}}));
    assert_eq!(glass.kind, MaterialKind::Dielectric { ior: 1.33 });

    // ((2 − 1)/(2 + 1))² = 1/9, tinted, halved.
    let varnish = material(json!({"pbrMetallicRoughness": {"metallicFactor": 0.0}, "extensions": {
        "KHR_materials_ior": {"ior": 2.0},
        "KHR_materials_specular": {"specularFactor": 0.5, "specularColorFactor": [1.0, 0.5, 90.0]}}}));
    assert!(near(varnish.specular_f0, [1.0 / 18.0, 1.0 / 36.0, 0.5]), "{varnish:?}");
}

#[test]
fn textures_without_a_place_are_averaged() {
    let mut b = square();
    // Roughness 51/255 = 0.2 and 153/255 = 0.6, metalness 0 and 1.
    let surface = b.view(&png::encode(2, 1, &[[0, 51, 0], [0, 153, 255]]).unwrap());
    let color = b.view(&png::encode(2, 1, &[[255, 0, 0], [0, 0, 0]]).unwrap());
    b.json["images"] = json!([{"bufferView": surface, "mimeType": "image/png"},
        {"bufferView": color, "mimeType": "image/png"}]);
    b.json["samplers"] = json!([{"wrapS": 33071, "wrapT": 33071}]);
    b.json["textures"] = json!([{"source": 0}, {"source": 1, "sampler": 0}]);
    b.json["materials"] = json!([{"emissiveFactor": [4, 4, 4], "emissiveTexture": {"index": 1},
        "pbrMetallicRoughness": {"metallicRoughnessTexture": {"index": 0}, "baseColorTexture": {"index": 1}}}]);
    b.json["meshes"][0]["primitives"][0]["material"] = json!(0);
    let scene = read(&b);
    let m = &scene.materials[0];
    assert!((m.roughness - 0.4).abs() < 1e-6, "{m:?}");
    assert!(near(m.albedo, [0.5; 3]), "{m:?}");
    assert!(near(m.specular_f0, [0.27, 0.02, 0.02]), "{m:?}");
    assert!(near(m.emission, [2.0, 0.0, 0.0]), "{m:?}");
    assert_eq!((m.albedo_texture, scene.textures.len(), scene.textures[0].wrap), (Some(0), 1, Wrap::Clamp));
    assert_eq!(scene.notices.len(), 2, "{:?}", scene.notices);
}

#[test]
fn lights_and_cameras_stand_where_their_nodes_do() {
    let mut b = square();
    let half = std::f32::consts::FRAC_1_SQRT_2;
    b.json["extensions"] = json!({"KHR_lights_punctual": {"lights": [
        {"type": "point", "color": [1.0, 0.5, 0.0], "intensity": 10.0},
        {"type": "spot", "spot": {"innerConeAngle": 0.25, "outerConeAngle": 0.5}},
        {"type": "directional", "intensity": 3.0}]}});
    b.json["cameras"] = json!([
        {"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 1, "zfar": 9, "znear": 0}},
        {"type": "perspective", "perspective": {"yfov": std::f32::consts::FRAC_PI_3, "znear": 0.1}},
        {"type": "perspective", "perspective": {"yfov": 1.0, "znear": 0.1}}]);
    let light = |i: usize| json!({"KHR_lights_punctual": {"light": i}});
    b.json["nodes"] = json!([
        {"translation": [1, 2, 3], "rotation": [0, half, 0, half], "children": [1, 2, 3, 4, 5, 6]},
        {"extensions": light(0)}, {"extensions": light(1)}, {"extensions": light(2)},
        {"camera": 0}, {"camera": 1, "translation": [0, 0, 1]}, {"camera": 2}]);
    let scene = read(&b);
    let direction_near = |d: [f32; 3]| near(d, [-1.0, 0.0, 0.0]);
    let position = [1.0, 2.0, 3.0];
    assert_eq!(scene.lights.len(), 3);
    assert_eq!(scene.lights[0], Light::Point { position, intensity: [10.0, 5.0, 0.0] });
    assert!(
        matches!(scene.lights[1], Light::Spot { position: p, direction, inner_angle: 0.25, outer_angle: 0.5,
        intensity } if p == position && direction_near(direction) && intensity == [1.0; 3])
    );
    assert!(matches!(scene.lights[2], Light::Directional { direction, irradiance }
        if direction_near(direction) && irradiance == [3.0; 3]));
    let camera = scene.camera.unwrap();
    // The node's +z is the world's +x after the quarter turn about y.
    let [eye, target] = [camera.position, camera.target].map(|v| v.map(|x| x as f32));
    assert!(near(eye, [2.0, 2.0, 3.0]) && near(target, [1.0, 2.0, 3.0]), "{camera:?}");
    assert!((camera.vfov_degrees - 60.0).abs() < 1e-5 && (camera.up[1] - 1.0).abs() < 1e-9);
}

#[test]
fn a_file_without_scenes_shows_all_top_nodes() {
    let mut b = square();
    b.json.as_object_mut().unwrap().remove("scene");
    b.json["scenes"] = json!([]);
    b.json["nodes"] = json!([{"mesh": 0, "children": [2]}, {"mesh": 0}, {"mesh": 0}]);
    assert_eq!(read(&b).instances.len(), 3);
}
