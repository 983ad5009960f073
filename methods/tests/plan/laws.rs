//! A planned picture differs from the one with all effects by the plan's bound at most.

use super::{Subject, methods, names, request};
use proptest::prelude::*;
use twinlight_core::scene::{Light, Material, MaterialKind, Scene};
use twinlight_fixtures::meshes::{cube, icosphere, placed, quad, with_material};
use twinlight_methods::plan::{Decision, Edits, Effect, Effects, Method, Plan, Request};
use twinlight_methods::reference::Settings;

/// Why a plan's picture is not what it promises beside the one with all effects.
fn broken(subject: &Subject, plan: &Plan, slack: f64) -> Option<String> {
    let all = Request { effects: Effects::All, ..plan.request.clone() };
    let wanted = subject.picture(&subject.plan(&all)).radiance();
    let found = subject.picture(plan).radiance();
    let differs = |(i, (found, wanted)): (usize, (&[f32; 3], &[f32; 3]))| {
        (0..3).find_map(|c| {
            let difference = (f64::from(found[c]) - f64::from(wanted[c])).abs();
            let allowed = plan.bound() + slack * f64::from(wanted[c]);
            (difference > allowed)
                .then(|| format!("pixel {i}: {found:?} for {wanted:?}, bound {}", plan.bound()))
        })
    };
    found.iter().zip(&wanted).enumerate().find_map(differs)
}

/// Without a tolerance only what isn't there is left out, and no bit of the picture changes.
#[test]
fn what_is_not_there_is_not_missed() {
    for name in names() {
        let subject = Subject::builtin(name);
        for method in methods() {
            // A method that gathers a fixed number of bounces is asked for as many with all effects.
            let mut request = request(method);
            request.picture.bounces = Some(3);
            let plan = subject.plan(&request);
            assert_eq!(plan.bound(), 0.0, "{name} {}", request.method.name());
            assert_eq!(broken(&subject, &plan, 0.0), None, "{name} {}", request.method.name());
        }
    }
}

/// How much a plan's picture lacks on average over channels and pixels, beside the one with all effects, and the standard error of that.
fn lack(subject: &Subject, plan: &Plan) -> (f64, f64) {
    let all = Request { effects: Effects::All, ..plan.request.clone() };
    let wanted = subject.picture(&subject.plan(&all)).radiance();
    let found = subject.picture(plan).radiance();
    let mean_of = |rgb: [f32; 3]| rgb.into_iter().map(f64::from).sum::<f64>() / 3.0;
    let lacks: Vec<f64> = wanted.iter().zip(&found).map(|(w, f)| mean_of(*w) - mean_of(*f)).collect();
    let n = lacks.len() as f64;
    let mean = lacks.iter().sum::<f64>() / n;
    let variance = lacks.iter().map(|lack| (lack - mean) * (lack - mean)).sum::<f64>() / (n - 1.0);
    (mean, (variance / n).sqrt())
}

/// Light of the closed furnace falls by half with every bounce: what is left out is the bound itself, and with a bounce fewer twice as much. Pictures are
/// means of paths, whose spread from pixel to pixel says how far they may be from it: four standard errors are passed once in 30 000 runs, and seeds are fixed.
#[test]
fn a_bound_is_kept_where_it_is_tight() {
    let subject = Subject::builtin("furnace");
    for tolerance in [0.3, 0.03, 0.01] {
        let picture = Settings { samples: 128, ..request(Method::Reference).picture };
        let request = Request { tolerance, picture, ..request(Method::Reference) };
        let plan = subject.plan(&request);
        assert_eq!(plan.decision(Effect::Interreflection), Decision::Bounded);
        assert!(plan.bound() <= tolerance);
        let (lack, error) = lack(&subject, &plan);
        assert!((lack - plan.bound()).abs() <= 4.0 * error, "{lack} ± {error} for {}", plan.bound());
        let fewer = Plan { sampled_bounces: plan.sampled_bounces.map(|n| n - 1), ..plan };
        let (lack, error) = self::lack(&subject, &fewer);
        assert!(
            lack - 4.0 * error > fewer.bound(),
            "{lack} ± {error}: a bounce fewer is more than the bound"
        );
    }
}

/// The same random numbers make the same paths, which only end sooner.
#[test]
fn a_bound_is_kept_in_a_room() {
    let subject = Subject::builtin("cornell");
    for tolerance in [20.0, 2.0, 0.3] {
        let plan = subject.plan(&Request { tolerance, ..request(Method::Reference) });
        assert_eq!(plan.decision(Effect::Interreflection), Decision::Bounded);
        let (lack, _) = lack(&subject, &plan);
        assert!((0.0..=plan.bound()).contains(&lack), "{lack}, bound {}", plan.bound());
    }
}

/// The laws above would see a plan that leaves out what it must not.
#[test]
fn a_wrong_skip_is_caught() {
    let subject = Subject::builtin("materials");
    let sound = subject.plan(&request(Method::Reference));
    assert_eq!(broken(&subject, &sound, 0.0), None);
    let edits = [
        Edits { nothing_hides: true, ..Edits::default() },
        Edits { drop_glossy: true, ..Edits::default() },
        Edits { drop_mirrors: true, ..Edits::default() },
        Edits { drop_glass: true, ..Edits::default() },
    ];
    for edits in edits {
        assert!(broken(&subject, &Plan { edits, ..sound.clone() }, 0.0).is_some(), "{edits:?}");
    }
    let textured = Subject::builtin("textured");
    let plan = textured.plan(&request(Method::Reference));
    let edits = Edits { drop_textures: true, ..Edits::default() };
    assert!(broken(&textured, &Plan { edits, ..plan }, 0.0).is_some());
    let sky = Subject::builtin("environment");
    let plan = sky.plan(&request(Method::Reference));
    let edits = Edits { drop_environment: true, ..Edits::default() };
    assert!(broken(&sky, &Plan { edits, ..plan }, 0.0).is_some());
}

/// Few bodies of random kinds, places and lights: some see each other, some don't.
fn scenes() -> impl Strategy<Value = Scene> {
    let body = (0..3_u8, -2.0..2.0_f64, 0.2..1.2_f64, 0..4_u8);
    (prop::collection::vec(body, 1..4), 0..4_u8, any::<bool>()).prop_map(|(bodies, lights, sky)| {
        let mut scene = Scene::default();
        for (shape, x, scale, kind) in bodies {
            let material = scene.add_material(material(kind));
            let place = glam::DVec3::new(x, 0.3 * x, -x * x);
            let mesh = match shape {
                0 => placed(cube(), scale, place),
                1 => placed(icosphere(2), scale, place),
                _ => quad([-2.0, -1.0, -2.0], [2.0, -1.0, -2.0], [2.0, -1.0, 2.0], [-2.0, -1.0, 2.0]),
            };
            scene.add_mesh(with_material(mesh, material));
        }
        for i in 0..lights {
            let position = [f32::from(i) * 2.0 - 3.0, 4.0, 2.0];
            scene.lights.push(Light::Point { position, intensity: [5.0; 3] });
        }
        if sky {
            scene.environment = Some(twinlight_fixtures::scenes::sky(8));
        }
        scene.camera = Some(twinlight_core::scene::Camera {
            position: [0.5, 3.0, 9.0],
            target: [0.0; 3],
            up: [0.0, 1.0, 0.0],
            vfov_degrees: 40.0,
        });
        scene
    })
}

fn material(kind: u8) -> Material {
    let diffuse = Material::diffuse("diffuse", [0.7, 0.4, 0.2]);
    match kind {
        0 | 1 => diffuse,
        2 => Material { specular_f0: [0.04; 3], roughness: 0.3, ..diffuse },
        _ => Material { specular_f0: [0.9; 3], kind: MaterialKind::Mirror, ..diffuse },
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, ..ProptestConfig::default() })]

    #[test]
    fn random_scenes_lack_nothing(scene in scenes()) {
        let subject = Subject::of(&scene);
        for method in methods() {
            let mut request = request(method);
            request.picture.bounces = Some(3);
            let plan = subject.plan(&request);
            prop_assert_eq!(plan.bound(), 0.0);
            prop_assert_eq!(broken(&subject, &plan, 0.0), None);
            prop_assert_eq!(subject.plan(&request), plan, "a plan is a function of its arguments");
        }
    }
}
