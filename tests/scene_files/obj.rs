//! What OBJ and MTL statements mean.

use crate::read;
use twinlight::io::LoadOptions;
use twinlight_core::scene::{Material, MaterialKind, Scene};

fn scene(text: &str, mtl: &str) -> Scene {
    read("a.obj", text, &[("a.mtl", mtl)], &LoadOptions::default()).unwrap()
}

fn material(keys: &str) -> Material {
    let mtl = format!("newmtl m\n{keys}");
    scene("mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n", &mtl).materials.remove(0)
}

#[test]
fn faces_of_every_form_become_triangles() {
    let vertices = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 1\n";
    let faces = [
        ("f 1 2 3", 1),
        ("f 1 2 3 4", 2),
        ("f -4 -3 -2", 1),
        ("f 1/1 2/2 3/3", 1),
        ("f 1//1 2//1 3//1", 1),
        ("f 1/1/1 2/2/1 3/3/1 # comment", 1),
        ("f 1/ 2/ 3/", 1),
        ("f 1 2 \\\n 3", 1),
        ("f 1 2", 0),
        ("l 1 2 3", 0),
        ("p 1", 0),
    ];
    for (face, triangles) in faces {
        assert_eq!(scene(&format!("{vertices}{face}\r\n"), "").triangle_count(), triangles, "{face}");
    }
    let all: String = faces.iter().map(|(face, _)| format!("{face}\n")).collect();
    assert_eq!(scene(&format!("\u{feff}{vertices}{all}"), "").triangle_count(), 9);
}

#[test]
fn attributes_stay_with_their_corners() {
    // Faces with and without attributes share vertices and a group: a single-index mesh must not mix them up.
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0.25 0.5\nvt 0.5 0.25\nvt 1 1\nvn 0 0 2\n\
                g part\nf 1 2 3\nf 1/3 2/2 4/1\nf 1//1 2//1 3//1\nf 1/1 2 3\n";
    let scene = scene(text, "");
    assert_eq!(scene.triangle_count(), 4);
    for mesh in &scene.meshes {
        assert_eq!(mesh.name, "part");
        assert!(mesh.texcoords.is_empty() || mesh.texcoords.len() == mesh.positions.len());
        assert!(mesh.normals.is_empty() || mesh.normals.len() == mesh.positions.len());
    }
    let textured = scene.meshes.iter().find(|m| !m.texcoords.is_empty()).unwrap();
    let corner = |position: [f32; 3]| {
        let i = textured.positions.iter().position(|&p| p == position).unwrap();
        textured.texcoords[i]
    };
    assert_eq!(corner([0.0, 0.0, 0.0]), [1.0, 1.0]);
    assert_eq!(corner([1.0, 0.0, 0.0]), [0.5, 0.25]);
    assert_eq!(corner([0.0, 0.0, 1.0]), [0.25, 0.5]);
    assert!(
        scene.notices.iter().any(|n| n.contains("1 faces whose corners don't all have")),
        "{:?}",
        scene.notices
    );
}

#[test]
fn extra_numbers_of_a_vertex() {
    let text = "v 2 4 6 2\nv 1 0 0 0.1 0.2 0.3\nv 0 3 0 1 0.1 0.2 0.3\nf 1 2 3\n";
    let scene = scene(text, "");
    assert_eq!(scene.meshes[0].positions, [[1.0, 2.0, 3.0], [1.0, 0.0, 0.0], [0.0, 3.0, 0.0]]);
    assert!(scene.notices.iter().any(|n| n.contains("2 vertex colours ignored")));
}

#[test]
fn materials_go_to_their_faces() {
    let text = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nusemtl red  wood\nf 1 2 3\nf 2 3 1\nusemtl gone\nf 3 2 1\n";
    let scene = scene(text, "newmtl red  wood\r\nKd 1 0 0\r\n");
    let mut ids: Vec<u32> = scene.meshes.iter().flat_map(|m| m.material_ids.clone()).collect();
    let name = |id: u32| scene.materials[id as usize].name.as_str();
    assert_eq!(
        ids.iter().map(|&id| name(id)).collect::<Vec<_>>(),
        ["default", "red  wood", "red  wood", "default"]
    );
    ids.dedup();
    assert_eq!(ids.len(), 3);
    assert!(scene.notices.iter().any(|n| n.contains("a.obj:9:8: no material library defines 'gone'")));
}

#[test]
fn the_last_of_two_keys_wins_and_indentation_is_nothing() {
    assert_eq!(material("\tKd 0.1 0.2 0.3\n   Kd 1 1 1\n").albedo, [1.0; 3]);
    assert_eq!(material("Kd 0.5\n").albedo, [0.5; 3]);
}

#[test]
fn phong_exponents_become_roughness() {
    let plastic = material("Kd 0.5 0.5 0.5\nKs 0.2 0.2 0.2\nNs 198\nillum 2\n");
    assert_eq!(plastic.kind, MaterialKind::Opaque);
    assert_eq!(plastic.specular_f0, [0.2; 3]);
    // α = √(2/200) = 0.1, and roughness its root; f32 rounds each step.
    assert!((plastic.roughness - 0.1_f32.sqrt()).abs() < 1e-6, "{}", plastic.roughness);
    assert_eq!(material("Ks 0.2 0.2 0.2\nNs 198\nPr 0.3\n").roughness, 0.3);
    assert_eq!(material("Kd 0.5 0.5 0.5\nKs 0.2 0.2 0.2\nillum 1\n").specular_f0, [0.0; 3]);
}

#[test]
fn metals_take_their_colour_from_where_it_is() {
    let gold = material("Kd 1 0.8 0.2\nPm 1\nPr 0.2\n");
    assert_eq!((gold.albedo, gold.specular_f0), ([0.0; 3], [1.0, 0.8, 0.2]));
    let converted = material("Kd 0 0 0\nKs 0.9 0.6 0.4\nPm 1\nPr 0.2\nillum 3\n");
    assert_eq!((converted.albedo, converted.specular_f0), ([0.0; 3], [0.9, 0.6, 0.4]));
    assert_eq!(converted.kind, MaterialKind::Opaque);
    let half = material("Kd 0.8 0.8 0.8\nPm 0.5\n");
    assert_eq!(half.albedo, [0.4; 3]);
    assert!((half.specular_f0[0] - 0.42).abs() < 1e-6);
}

#[test]
fn mirrors_and_glass() {
    let mirror = material("Kd 0.01 0.01 0.01\nKs 0.95 0.95 0.95\nNs 1000\nillum 5\n");
    assert_eq!((mirror.kind, mirror.specular_f0, mirror.albedo), (MaterialKind::Mirror, [0.95; 3], [0.0; 3]));
    assert_eq!(material("Kd 0 0 0\nKs 1 1 1\nillum 3\n").kind, MaterialKind::Mirror);
    let tiles = material("Kd 0.4 0.3 0.3\nKs 0.1 0.1 0.1\nillum 3\nPr 0\n");
    assert_eq!((tiles.kind, tiles.roughness), (MaterialKind::Opaque, 0.0));
    assert_eq!(material("Kd 0 0 0\nKs 1 1 1\nNs 40\nillum 3\n").kind, MaterialKind::Opaque);
    let glass = |ior| MaterialKind::Dielectric { ior };
    assert_eq!(material("Ks 0.3 0.3 0.3\nNs 200\nNi 1.33\nillum 7\n").kind, glass(1.33));
    assert_eq!(material("Kd 1 1 1\nillum 4\n").kind, glass(1.5));
    assert_eq!(material("d 0.5\nNi 1.5\nillum 2\n").kind, glass(1.5));
    assert_eq!(material("Tr 0.5\nNi 1.5\nillum 2\n").kind, glass(1.5));
    assert_eq!(
        material("d 1\nTr 1\nNi 1.5\nillum 2\n").kind,
        MaterialKind::Opaque,
        "Tr 1 beside d 1 is an old exporter's slip"
    );
    assert_eq!(material("d 0.5\nNi 1\nillum 2\n").kind, MaterialKind::Opaque);
}

#[test]
fn no_channel_reflects_more_than_it_receives() {
    for keys in [
        "Kd 0.9 0.1 1\nKs 0.2 0.2 0.7\n",
        "Kd 3e38 1 1\nKs 3e38 0.04 1e-45\n",
        "Kd 1 1 1\nKs 0.333 0.1 0.7\n",
    ] {
        let m = material(&format!("{keys}Ns 40\nillum 2\n"));
        for i in 0..3 {
            let sum = f64::from(m.albedo[i]) + f64::from(m.specular_f0[i]);
            assert!(sum <= 1.0 && sum > 0.999_999 || keys.starts_with("Kd 0.9") && i == 1, "{keys}: {sum}");
        }
    }
    let scene = scene("mtllib a.mtl\n", "newmtl a\nKd 1 1 1\nKs 1 1 1\nnewmtl b\nKd 1 1 1\nKs 0.1 0.1 0.1\n");
    assert_eq!(scene.notices.iter().filter(|n| n.contains("2 materials reflect more")).count(), 1);
}

#[test]
fn emission_leaves_the_front() {
    let scene = scene(
        "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n",
        "newmtl m\nKd 0 0 0\nKe 17 12 4\n",
    );
    assert_eq!(scene.materials[0].emission, [17.0, 12.0, 4.0]);
    assert!(!scene.materials[0].emits_both_sides && scene.has_light());
}

#[test]
fn lenient_reading_leaves_numbers_to_the_compiler() {
    let mut options = LoadOptions::default();
    options.limits.lenient = true;
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv nan 0 0\nf 1 2 3\nf 1 2 4\n";
    let scene = read("a.obj", text, &[], &options).unwrap();
    let compiled = twinlight_core::scene::compile(&scene, &options.limits).unwrap();
    assert_eq!(compiled.triangles.len(), 1);
    assert!(compiled.notices.iter().any(|n| n.starts_with("1 triangles")), "{:?}", compiled.notices);
}
