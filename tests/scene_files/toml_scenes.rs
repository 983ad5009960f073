//! What the tables of a TOML scene file mean.

use crate::{files, read};
use twinlight::io::LoadOptions;
use twinlight::io::resolve::MemoryFiles;
use twinlight::io::toml_scene::{self, RenderSettings};
use twinlight_core::Result;
use twinlight_core::scene::{Light, MaterialKind, Scene};

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

fn scene(text: &str) -> Scene {
    read("s.toml", text, &[("m.obj", TRIANGLE), ("sub/n.obj", TRIANGLE)], &LoadOptions::default()).unwrap()
}

#[test]
fn render_settings_come_beside_the_scene() {
    let text = "\"$schema\" = 'scene.schema.json'\n[render]\nsize = [640, 480]\nspp = 256\nbounces = 4\nseed = 9\nmethod = 'reference'\n";
    let (scene, settings) = toml_scene::parse_with_settings(
        text.as_bytes(),
        "s.toml",
        &MemoryFiles::default(),
        &LoadOptions::default(),
    )
    .unwrap();
    let method = Some("reference".to_owned());
    let expected =
        RenderSettings { size: Some([640, 480]), spp: Some(256), bounces: Some(4), seed: Some(9), method };
    assert_eq!((scene, settings), (Scene::default(), expected));
}

#[test]
fn placements_scale_then_rotate_then_move() {
    let scene = scene(
        "[[mesh]]\nname = 'm'\npath = 'm.obj'\n[[instance]]\nmesh = 'm'\nscale = 2\n\
         rotate = { axis = [0, 0, 3], angle = 90 }\ntranslate = [10, 0, 0]\n\
         [[instance]]\nmesh = 'm'\neuler = [90, 0, 90]\nscale = [1, 2, 3]\n\
         [[instance]]\nmesh = 'm'\nmatrix = [[1, 0, 0, 4], [0, 1, 0, 5], [0, 0, 1, 6]]\n",
    );
    let image =
        |i: usize, p| scene.instances[i].transform.point(p).to_array().map(|x| (x * 1e6).round() / 1e6);
    assert_eq!(image(0, [1.0, 0.0, 0.0]), [10.0, 2.0, 0.0]);
    // About X first: y goes to z; then about Z: z stays.
    assert_eq!(image(1, [0.0, 1.0, 0.0]), [0.0, 0.0, 2.0]);
    assert_eq!(image(1, [1.0, 0.0, 0.0]), [0.0, 1.0, 0.0]);
    assert_eq!(image(2, [1.0, 0.0, 0.0]), [5.0, 5.0, 6.0]);
    assert_eq!((scene.meshes.len(), scene.instances.len()), (1, 3));
}

#[test]
fn meshes_without_an_instance_are_placed_once() {
    let scene =
        scene("[[mesh]]\npath = 'm.obj'\n[[mesh]]\npath = 'sub/n.obj'\n[[instance]]\nmesh = 'm.obj'\n");
    assert_eq!(scene.instances.iter().map(|i| i.mesh).collect::<Vec<_>>(), [0, 1]);
}

#[test]
fn materials_replace_those_of_the_file() {
    let scene = scene(
        "[[material]]\nname = 'red'\nalbedo = [1, 0, 0]\n[[material]]\nname = 'glass'\nkind = 'dielectric'\n\
         [[material]]\nname = 'chrome'\nkind = 'mirror'\nspecular = 0.5\n\
         [[mesh]]\npath = 'm.obj'\nmaterial = 'red'\n[[instance]]\nmesh = 'm.obj'\n[[instance]]\nmesh = 'm.obj'\nmaterial = 'glass'\n",
    );
    let of = |i: usize| &scene.materials[scene.instances[i].material.unwrap() as usize];
    assert_eq!((of(0).albedo, of(0).roughness), ([1.0, 0.0, 0.0], 1.0));
    assert_eq!(of(1).kind, MaterialKind::Dielectric { ior: 1.5 });
    assert_eq!((scene.materials[2].kind, scene.materials[2].specular_f0), (MaterialKind::Mirror, [0.5; 3]));
    scene.validate(&LoadOptions::default().limits).unwrap();
}

#[test]
fn lights_of_every_type() {
    let scene = scene(
        "[[light]]\ntype = 'point'\nposition = [1, 2, 3]\nintensity = [1, 2, 3]\n\
         [[light]]\ntype = 'spot'\nposition = [0, 0, 0]\ndirection = [0, -1, 0]\nintensity = 5\nouter_angle = 90\n\
         [[light]]\ntype = 'directional'\ndirection = [0, -1, 0]\nirradiance = 2.5\n\
         [[light]]\ntype = 'rectangle'\ncorner = [0, 0, 0]\nedge_u = [1, 0, 0]\nedge_v = [0, 1, 0]\nradiance = 1\n\
         [[light]]\ntype = 'sphere'\ncenter = [0, 0, 0]\nradius = 0.5\nradiance = 7\n\
         [environment]\nradiance = [0.1, 0.2, 0.3]\nscale = 2\n",
    );
    assert_eq!(scene.lights[0], Light::Point { position: [1.0, 2.0, 3.0], intensity: [1.0, 2.0, 3.0] });
    assert!(
        matches!(scene.lights[1], Light::Spot { outer_angle, inner_angle: 0.0, .. } if outer_angle > 1.57)
    );
    assert_eq!(scene.lights[2], Light::Directional { direction: [0.0, -1.0, 0.0], irradiance: [2.5; 3] });
    assert_eq!(scene.lights.len(), 5);
    let environment = scene.environment.unwrap();
    assert_eq!((environment.texels[0], environment.scale), ([0.1, 0.2, 0.3], 2.0));
}

#[test]
fn scene_files_nest_with_their_lights_and_cameras() {
    let inner = "[camera]\nposition = [0, 0, 5]\ntarget = [0, 0, 0]\n[environment]\nradiance = 1\n\
                 [[mesh]]\npath = '../m.obj'\n[[light]]\ntype = 'sphere'\ncenter = [1, 0, 0]\nradius = 0.5\nradiance = 7\n";
    let outer = "[[mesh]]\nname = 'inner'\npath = 'sub/inner.toml'\n[[instance]]\nmesh = 'inner'\nscale = 2\ntranslate = [0, 1, 0]\n";
    let others = [("m.obj", TRIANGLE), ("sub/inner.toml", inner)];
    let scene = read("s.toml", outer, &others, &LoadOptions::default()).unwrap();
    assert_eq!(scene.lights, [Light::Sphere { center: [2.0, 1.0, 0.0], radius: 1.0, radiance: [7.0; 3] }]);
    assert_eq!(scene.camera.unwrap().position, [0.0, 1.0, 10.0]);
    assert_eq!(scene.instances[0].transform.point([1.0, 0.0, 0.0]).to_array(), [2.0, 1.0, 0.0]);
    assert!(
        scene.environment.is_none() && scene.notices.iter().any(|n| n.contains("environment of 'inner'"))
    );
    let uneven = outer.replace("scale = 2", "scale = [1, 2, 1]");
    let message = read("s.toml", &uneven, &others, &LoadOptions::default()).unwrap_err().to_string();
    assert!(message.contains("can't be scaled unevenly"), "{message}");
}

#[test]
fn builtin_scenes_are_meshes_too() {
    let scene = scene("[[mesh]]\nname = 'box'\npath = 'builtin:cornell'\n");
    let builtin = twinlight::io::builtin::load("cornell").unwrap();
    assert_eq!(scene.triangle_count(), builtin.triangle_count());
    assert_eq!((scene.camera, scene.lights), (builtin.camera, builtin.lights));
}

fn nested(levels: usize, last: &str) -> Result<Scene> {
    let mut texts: Vec<(String, String)> =
        (0..levels).map(|i| (format!("{i}.toml"), format!("[[mesh]]\npath = '{}.toml'\n", i + 1))).collect();
    texts.push((format!("{levels}.toml"), last.to_owned()));
    let borrowed: Vec<(&str, &str)> = texts.iter().map(|(p, t)| (p.as_str(), t.as_str())).collect();
    toml_scene::parse(texts[0].1.as_bytes(), "0.toml", &files(&borrowed), &LoadOptions::default())
}

#[test]
fn nesting_ends() {
    assert!(nested(7, "").is_ok());
    let deep = nested(8, "").unwrap_err().to_string();
    assert!(deep.ends_with("scene files inside each other: needs 9, the limit is 8"), "{deep}");
    let cycle = nested(3, "[[mesh]]\npath = '1.toml'\n").unwrap_err().to_string();
    assert_eq!(cycle, "3.toml:2:8: '1.toml' includes itself");
}

#[test]
fn few_lines_cannot_ask_for_billions() {
    let ten = |file: usize| -> String {
        (0..10).map(|i| format!("[[mesh]]\nname = '{i}'\npath = '{}.toml'\n", file + 1)).collect()
    };
    let mut texts: Vec<(String, String)> = (0..7).map(|i| (format!("{i}.toml"), ten(i))).collect();
    texts.push(("7.toml".into(), String::new()));
    let borrowed: Vec<(&str, &str)> = texts.iter().map(|(p, t)| (p.as_str(), t.as_str())).collect();
    let options = LoadOptions::default();
    let message =
        toml_scene::parse(texts[0].1.as_bytes(), "0.toml", &files(&borrowed), &options).unwrap_err();
    assert!(message.to_string().starts_with("mesh files of the scene: needs 4097"), "{message}");

    let many = |file: usize| -> String {
        let instances = "[[instance]]\nmesh = 'm'\n".repeat(100);
        format!(
            "[[mesh]]\nname = 'm'\npath = '{}'\n{instances}",
            if file == 4 { "m.obj".into() } else { format!("{}.toml", file + 1) }
        )
    };
    let mut texts: Vec<(String, String)> = (0..5).map(|i| (format!("{i}.toml"), many(i))).collect();
    texts.push(("m.obj".into(), TRIANGLE.into()));
    let borrowed: Vec<(&str, &str)> = texts.iter().map(|(p, t)| (p.as_str(), t.as_str())).collect();
    let message =
        toml_scene::parse(texts[0].1.as_bytes(), "0.toml", &files(&borrowed), &options).unwrap_err();
    assert!(message.to_string().starts_with("instances of the scene: needs"), "{message}");
}

#[test]
fn the_committed_schema_is_current() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/fixtures/scene.schema.json");
    if std::env::var_os("TWINLIGHT_BLESS").is_some() {
        std::fs::write(path, toml_scene::json_schema()).unwrap();
    }
    let committed = std::fs::read_to_string(path).unwrap();
    assert!(
        committed == toml_scene::json_schema(),
        "{path} is out of date: run this test with TWINLIGHT_BLESS=1"
    );
    for key in ["camera", "mesh", "instance", "material", "light", "environment", "render", "albedo_texture"]
    {
        assert!(committed.contains(&format!("\"{key}\"")), "{key}");
    }
}
