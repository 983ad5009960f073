//! What plans decide about scenes whose needs are known.

use super::{Subject, methods, request};
use Decision::{Bounded, Lacking, Run, Skipped};
use twinlight_methods::plan::{Decision, Effect, Effects, Method};

fn decision(name: &str, method: Method, effect: Effect) -> Decision {
    Subject::builtin(name).plan(&request(method)).decision(effect)
}

#[test]
fn effects_follow_from_scenes() {
    let [reference, _, voxel] = methods();
    let cases = [
        ("cornell", Effect::GlossyReflection, Skipped),
        ("cornell", Effect::SoftShadows, Run),
        ("cornell", Effect::Motion, Skipped),
        ("materials", Effect::GlossyReflection, Run),
        ("materials", Effect::MirrorReflection, Run),
        ("materials", Effect::Refraction, Run),
        ("materials", Effect::Caustics, Run),
        ("environment", Effect::EnvironmentLight, Run),
        ("environment", Effect::Caustics, Run),
        ("textured", Effect::Textures, Run),
        ("empty", Effect::DirectLight, Skipped),
        ("empty", Effect::Shadows, Skipped),
    ];
    for (name, effect, wanted) in cases {
        assert_eq!(decision(name, reference.clone(), effect), wanted, "{name} {effect}");
    }
    assert_eq!(decision("materials", voxel.clone(), Effect::Refraction), Lacking);
    assert_eq!(decision("materials", voxel, Effect::Caustics), Lacking);
}

#[test]
fn bounces_follow_from_the_tolerance() {
    let subject = Subject::builtin("cornell");
    let mut fewer = 0;
    for tolerance in [10.0, 1.0, 0.1, 0.01, 0.001] {
        let mut request = request(Method::Reference);
        request.tolerance = tolerance;
        let plan = subject.plan(&request);
        assert_eq!(plan.decision(Effect::Interreflection), Bounded);
        assert!(plan.bound() <= tolerance);
        assert!(plan.bounces > Some(fewer), "{tolerance}: {:?}", plan.bounces);
        fewer = plan.bounces.unwrap();
        request.picture.bounces = Some(fewer - 1);
        assert_eq!(subject.plan(&request).bounces, Some(fewer - 1), "never more than asked for");
    }
    // Mirrors and glass reflect all of it: no number of bounces is sure to be enough.
    let mut request = request(Method::Reference);
    request.tolerance = 0.1;
    assert_eq!(Subject::builtin("materials").plan(&request).bounces, None);
}

#[test]
fn all_effects_run_whether_they_are_there_or_not() {
    for method in methods() {
        let mut request = request(method);
        request.effects = Effects::All;
        let plan = Subject::builtin("empty").plan(&request);
        assert!(
            plan.effects.iter().all(|d| matches!(d.decision, Run | Skipped | Bounded)),
            "{:?}",
            plan.effects
        );
        assert_eq!(plan.edits, Default::default());
        assert!(plan.steps.iter().any(|step| step.kernel == "trace_paths" || step.kernel == "walk_lhb"));
    }
}

#[test]
fn what_a_person_leaves_out_is_left_out() {
    let subject = Subject::builtin("materials");
    let radiance = |list: &str| {
        let mut request = request(Method::Reference);
        request.effects = list.parse().unwrap();
        subject.picture(&subject.plan(&request)).radiance()
    };
    let sum = |pixels: &[[f32; 3]]| pixels.iter().flatten().map(|&c| f64::from(c)).sum::<f64>();
    let everything = radiance("shadows,environment,interreflection,glossy,mirror,refraction,textures");
    assert_eq!(everything, radiance("auto"));
    for less in [
        "environment,interreflection,glossy,mirror,refraction,textures",
        "shadows,environment,glossy,mirror,refraction,textures",
        "shadows,environment,interreflection,mirror,refraction,textures",
        "shadows,environment,interreflection,glossy,refraction,textures",
        "shadows,environment,interreflection,glossy,mirror,textures",
    ] {
        assert_ne!(radiance(less), everything, "{less}");
    }
    assert!(sum(&radiance("shadows")) < sum(&radiance("none")), "shadows take light away");
}

#[test]
fn lists_of_effects_are_read() {
    assert_eq!("auto".parse::<Effects>().unwrap(), Effects::Auto);
    assert_eq!("none".parse::<Effects>().unwrap(), Effects::Only(Vec::new()));
    let list: Effects = "glossy,shadows".parse().unwrap();
    assert_eq!(list, Effects::Only(vec![Effect::GlossyReflection, Effect::Shadows]));
    for text in ["auto", "all", "none", "glossy,shadows"] {
        assert_eq!(text.parse::<Effects>().unwrap().to_string(), text);
    }
    for bad in ["", "emission", "glossy,", "Shadows", "all,glossy"] {
        let error = bad.parse::<Effects>().unwrap_err().to_string();
        assert!(error.contains("none of auto, all, none, shadows"), "{error}");
    }
}
