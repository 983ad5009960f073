//! The small files of the fixtures read back as the scenes they were written from.
#![cfg(feature = "io")]

use std::path::Path;
use twinlight::io::{LoadOptions, load};
use twinlight_core::scene::{Light, Scene};
use twinlight_fixtures::{meshes, scenes};

fn read(file: &str) -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/files").join(file);
    let path = path.to_str().expect("the repository's path is UTF-8");
    load(path, &LoadOptions::default()).unwrap_or_else(|e| panic!("{file}: {e}"))
}

/// World corners, albedo and emission of every triangle, by their bits and in an order of their own: readers may cut a
/// file into meshes as they like.
fn triangles(scene: &Scene) -> Vec<[u32; 15]> {
    let mut list = Vec::new();
    for instance in &scene.instances {
        let mesh = &scene.meshes[instance.mesh as usize];
        for (triangle, id) in mesh.triangles.iter().zip(&mesh.material_ids) {
            let material = &scene.materials[instance.material.unwrap_or(*id) as usize];
            let corners =
                triangle.map(|v| instance.transform.point(mesh.positions[v as usize]).as_vec3().to_array());
            let mut floats = corners.into_iter().flatten().chain(material.albedo).chain(material.emission);
            list.push(std::array::from_fn(|_| floats.next().unwrap_or_default().to_bits()));
        }
    }
    list.sort_unstable();
    list
}

#[test]
fn cornell_obj_is_the_builtin_cornell_box() {
    let (file, builtin) = (read("cornell-box/cornell-box.obj"), scenes::cornell());
    assert_eq!(triangles(&file), triangles(&builtin));
    let names = |scene: &Scene| {
        let mut names: Vec<String> = scene.materials.iter().map(|m| m.name.clone()).collect();
        names.sort_unstable();
        names
    };
    assert_eq!(names(&file), names(&builtin));
}

#[test]
fn textured_quad_has_the_checker() {
    let scene = read("textured-quad/textured-quad.obj");
    let checker = scenes::checker();
    assert_eq!(scene.triangle_count(), 2);
    assert_eq!((scene.textures.len(), scene.materials[0].albedo_texture), (1, Some(0)));
    assert_eq!(
        (scene.textures[0].width, scene.textures[0].height, &scene.textures[0].texels),
        (checker.width, checker.height, &checker.texels)
    );
    let mesh = &scene.meshes[0];
    let corner = mesh.positions.iter().position(|p| *p == [1.0, 2.0, 0.0]).expect("the third vertex");
    assert_eq!((mesh.texcoords[corner], mesh.normals[corner]), ([1.0, 1.0], [0.0, 0.0, 1.0]));
}

#[test]
fn both_plys_are_the_icosphere() {
    let ball = meshes::icosphere(2);
    for file in ["ball/ball-ascii.ply", "ball/ball-binary.ply"] {
        let scene = read(file);
        assert_eq!(scene.meshes.len(), 1, "{file}");
        assert_eq!(scene.meshes[0].positions, ball.positions, "{file}");
        assert_eq!(scene.meshes[0].triangles, ball.triangles, "{file}");
    }
}

#[test]
fn glb_has_its_nodes_in_place() {
    let scene = read("lamp/lamp.glb");
    assert_eq!(scene.triangle_count(), 14);
    let (low, high) = scene.bounds().expect("vertices");
    assert_eq!((low.to_array(), high.to_array()), ([-4.0, 0.0, -4.0], [4.0, 1.0, 4.0]));
    let camera = scene.camera.expect("a camera");
    assert_eq!(camera.position, [0.0, 1.0, 6.0]);
    // 0.7 radians.
    assert!((camera.vfov_degrees - 40.107_045_659_157_63).abs() < 1e-5, "{}", camera.vfov_degrees);
    let [Light::Point { position, intensity }] = scene.lights[..] else { panic!("{:?}", scene.lights) };
    // The stand's node moves the bulb's.
    assert_eq!((position, intensity), ([1.5, 2.5, 1.0], [40.0, 32.0, 24.0]));
    let brightest = scene.materials.iter().map(|m| m.emission[0]).fold(0.0, f32::max);
    assert_eq!(brightest, 3.0);
}

#[test]
fn cornell_toml_is_the_builtin_with_its_camera() {
    let (file, builtin) = (read("cornell-box/cornell-box.toml"), scenes::cornell());
    assert_eq!(triangles(&file), triangles(&builtin));
    assert_eq!(file.camera, builtin.camera);
}
