//! Nothing that is not finite, and nothing that hangs.

use crate::{film, settings};
use twinlight_backend_cpu::CpuBackend;
use twinlight_core::scene::{Camera, Light, Limits, Material, Mesh, Scene, compile};
use twinlight_core::{Backend, Error};
use twinlight_fixtures::scenes::{builtin, builtin_names, cornell};
use twinlight_methods::post::image::Image;
use twinlight_methods::post::metrics::{CompareSettings, Comparison};
use twinlight_methods::reference::{Control, Sampler, Settings, StopReason, render};

/// T5: every builtin scene renders without a rejected sample or a non-finite pixel.
#[test]
fn t5_builtin_scenes_are_finite() {
    for (name, _) in builtin_names().iter().filter(|(name, _)| *name != "room-1m") {
        let scene = builtin(name).unwrap();
        if scene.triangle_count() == 0 {
            continue;
        }
        let film = film(&scene, &settings(24, 8));
        assert_eq!(film.first_unusable(), None, "{name}");
        assert!(film.radiance().iter().flatten().all(|x| x.is_finite()), "{name}");
        assert!(film.radiance().iter().flatten().any(|&x| x > 0.0), "{name} is black");
    }
}

/// A room too small for its products of lengths is refused; one just large enough is what a room of ordinary size is.
#[test]
fn tiny_scenes_are_refused_or_right() {
    let scaled = |scale: f64| {
        let mut scene = builtin("furnace").unwrap();
        for instance in &mut scene.instances {
            instance.transform.linear *= scale;
            instance.transform.translation *= scale;
        }
        let camera = scene.camera.as_mut().unwrap();
        camera.position = camera.position.map(|x| x * scale);
        camera.target = camera.target.map(|x| x * scale);
        scene
    };
    let small = f64::exp2(-28.0);
    assert!(
        film(&scaled(small), &settings(8, 8)).radiance() == film(&scaled(1.0), &settings(8, 8)).radiance()
    );
    let error = compile(&scaled(small * 1e-3), &Limits::default()).unwrap_err().to_string();
    assert!(error.contains("units across"), "{error}");
}

/// Light below the film's quanta is named.
#[test]
fn dim_light_is_noticed() {
    let notices = |radiance: f32| {
        let mut scene = Scene::default();
        scene.add_material(Material::emitter("lamp", [radiance; 3]));
        scene.add_mesh(twinlight_fixtures::meshes::grid(1, 1));
        compile(&scene, &Limits::default()).unwrap().notices
    };
    assert!(notices(1e-11).is_empty());
    assert!(notices(1e-20).iter().any(|notice| notice.contains("scale lights up")), "{:?}", notices(1e-20));
}

/// G9: nothing to see gives a black picture.
#[test]
fn g9_empty_scene_is_black() {
    let camera =
        Camera { position: [0.0; 3], target: [0.0, 0.0, -1.0], up: [0.0, 1.0, 0.0], vfov_degrees: 40.0 };
    let film = film(&Scene { camera: Some(camera), ..Scene::default() }, &settings(4, 2));
    assert!(film.radiance().iter().flatten().all(|&x| x == 0.0));
}

/// G5, G6, G7: collinear triangles, slivers and duplicates, emissive ones too, neither shine nor poison.
#[test]
fn g5_g6_g7_degenerate_triangles() {
    let mut scene = cornell();
    let glow = scene.add_material(Material::emitter("glow", [50.0; 3]));
    let line = vec![[100.0, 100.0, 100.0], [200.0, 200.0, 200.0], [300.0, 300.0, 300.0]];
    let collinear = vec![[0, 1, 2], [0, 0, 1], [1, 1, 1]];
    let dark = film(&scene, &settings(16, 8));
    scene.add_mesh(Mesh::new("collinear", line, collinear, glow));
    assert!(film(&scene, &settings(16, 8)) == dark, "no area, no light");
    let sliver = vec![[100.0, 100.0, 100.0], [400.0, 100.0, 100.0], [250.0, 100.0003, 100.0]];
    scene.add_mesh(Mesh::new("sliver", sliver, vec![[0, 1, 2], [0, 1, 2]], glow));
    let film = film(&scene, &settings(16, 8));
    assert!(film.radiance().iter().flatten().all(|x| x.is_finite()));
}

/// T7: the camera inside a light, on a light, and a light that touches a wall.
#[test]
fn t7_touching_lights() {
    let mut scene = cornell();
    scene.lights.push(Light::Sphere { center: [278.0, 20.0, 200.0], radius: 20.0, radiance: [9.0; 3] });
    scene.lights.push(Light::Sphere { center: [278.0, 273.0, -800.0], radius: 5.0, radiance: [9.0; 3] });
    scene.lights.push(Light::Point { position: [0.0, 100.0, 100.0], intensity: [100.0; 3] });
    let film = film(&scene, &settings(16, 8));
    assert!(film.radiance().iter().flatten().all(|x| x.is_finite()));
}

/// D7: stopping at any report keeps a valid picture and returns at once.
#[test]
fn d7_cancel_keeps_what_is_done() {
    let scene = cornell();
    let compiled = compile(&scene, &Limits::default()).unwrap();
    let backend = CpuBackend::new();
    let resident = backend.upload_scene(&compiled).unwrap();
    let camera = Camera::of_scene(&scene).unwrap();
    for stop_at in [1, 2, 5] {
        let mut reports = 0;
        let mut last = 0.0;
        let asked = Settings { samples: 1_000_000, ..settings(64, 1) };
        let rendered = render(&backend, &resident, &compiled, &camera, &asked, |p| {
            assert!(p.fraction >= last && p.fraction <= 1.0);
            last = p.fraction;
            reports += 1;
            if reports == stop_at { Control::Stop } else { Control::Continue }
        })
        .unwrap();
        assert_eq!((rendered.stop, reports), (StopReason::Cancelled, stop_at));
        assert_eq!(rendered.film.first_unusable(), None);
    }
}

#[test]
fn bad_settings_are_refused() {
    let scene = cornell();
    let compiled = compile(&scene, &Limits::default()).unwrap();
    let backend = CpuBackend::new();
    let resident = backend.upload_scene(&compiled).unwrap();
    let camera = Camera::of_scene(&scene).unwrap();
    let bad = [
        Settings { width: 0, ..settings(8, 1) },
        Settings { height: 20_000, ..settings(8, 1) },
        Settings { samples: 0, ..settings(8, 1) },
        Settings { first_sample: u32::MAX, ..settings(8, 1) },
        Settings { roulette_begin: u32::MAX, ..settings(8, 1) },
    ];
    for settings in bad {
        let result = render(&backend, &resident, &compiled, &camera, &settings, |_| Control::Continue);
        assert!(matches!(result, Err(Error::InvalidInput { .. })), "{settings:?}");
    }
    let up = Camera { up: [0.0, 0.0, 1.0], ..camera };
    assert!(render(&backend, &resident, &compiled, &up, &settings(8, 1), |_| Control::Continue).is_err());
}

/// Sobol points have less error per sample than independent ones.
#[test]
fn sobol_beats_independent_samples() {
    let scene = cornell();
    let image = |settings: &Settings| {
        Image::new(settings.width, settings.height, film(&scene, settings).radiance()).unwrap()
    };
    let reference = image(&Settings { sampler: Sampler::Sobol, seed: 77, ..settings(32, 2048) });
    let error = |sampler| {
        let test = image(&Settings { sampler, ..settings(32, 64) });
        Comparison::new(&test, &reference, &CompareSettings::default()).unwrap().rel_mse
    };
    let (sobol, independent) = (error(Sampler::Sobol), error(Sampler::Independent));
    assert!(sobol < 0.9 * independent, "relMSE {sobol} against {independent}");
}
