//! Plans are what runs: no kernel is called that they don't name, and those that they number as often as they say.

use super::{Subject, methods, names, request};
use std::collections::BTreeMap;
use twinlight_backend_cpu::CpuBackend;
use twinlight_core::scene::{Material, MaterialKind};
use twinlight_methods::Metered;
use twinlight_methods::plan::{Dispatches, Effects, Method, Plan};
use twinlight_methods::reference::Control;
use twinlight_methods::voxel::VoxelSettings;

/// Copies to and from the device are no kernels.
const TRANSFERS: [&str; 5] = ["upload", "zeroed", "download", "upload_scene", "upload_mesh"];

/// Calls of every kernel while a plan runs.
fn called(subject: &Subject, plan: &Plan) -> BTreeMap<&'static str, u64> {
    let cpu = CpuBackend::new();
    let metered = Metered::new(&cpu);
    plan.run(&metered, &subject.compiled, &subject.camera, |_| Control::Continue).unwrap();
    let calls = metered.calls().into_iter().filter(|calls| !TRANSFERS.contains(&calls.name));
    calls.map(|calls| (calls.name, calls.count)).collect()
}

/// The least and the most calls of every kernel that a plan names.
fn planned(plan: &Plan) -> BTreeMap<&'static str, (u64, u64)> {
    let mut planned: BTreeMap<&str, (u64, u64)> = BTreeMap::new();
    for step in &plan.steps {
        let (least, most) = match step.dispatches {
            Dispatches::Exactly(count) => (count, count),
            Dispatches::AtMost(count) => (0, count),
            Dispatches::Passes => (1, u64::MAX),
        };
        let sum = planned.entry(step.kernel).or_default();
        *sum = (sum.0 + least, sum.1.saturating_add(most));
    }
    planned
}

#[test]
fn what_is_called_is_what_is_planned() {
    for name in names() {
        let subject = Subject::builtin(name);
        for method in methods() {
            for (effects, bounces) in [
                (Effects::Auto, None),
                (Effects::Auto, Some(4)),
                (Effects::Auto, Some(1)),
                (Effects::Only(Vec::new()), None),
                (Effects::All, None),
            ] {
                let mut request = request(method.clone());
                request.picture.bounces = bounces;
                request.effects = effects;
                request.tolerance = 1.0 / 255.0;
                let plan = subject.plan(&request);
                let (called, planned) = (called(&subject, &plan), planned(&plan));
                for (kernel, count) in &called {
                    let Some((least, most)) = planned.get(kernel) else {
                        panic!("{name} {}: {kernel} is called, and not planned", request.method.name());
                    };
                    assert!(
                        least <= count && count <= most,
                        "{name}: {kernel} {count} times, for {least} to {most}"
                    );
                }
                let missing =
                    planned.iter().find(|(kernel, (least, _))| *least > 0 && !called.contains_key(*kernel));
                assert_eq!(missing, None, "{name} {}: planned and not called", request.method.name());
            }
        }
    }
}

#[test]
fn without_light_nothing_is_sampled() {
    let mut scene = twinlight_fixtures::scenes::builtin("cornell").unwrap();
    for material in &mut scene.materials {
        material.emission = [0.0; 3];
    }
    let subject = Subject::of(&scene);
    for method in methods() {
        let plan = subject.plan(&request(method));
        let called = called(&subject, &plan);
        assert_eq!(called.keys().copied().collect::<Vec<_>>(), ["shade_primary"]);
        let picture = subject.picture(&plan);
        assert!(picture.radiance().iter().flatten().all(|&c| c == 0.0));
        assert!(
            picture.rendered.film.texels().iter().all(|t| t.samples == 8),
            "as many samples as asked for, all known"
        );
    }
}

/// The last material that shines takes its cones along.
#[test]
fn nothing_shines_and_no_cones_look_for_it() {
    let mut scene = twinlight_fixtures::scenes::builtin("materials").unwrap();
    let voxel = || request(Method::Voxel(VoxelSettings { grid: 16, ..VoxelSettings::default() }));
    let shining =
        |plan: &Plan| plan.steps.iter().filter(|s| s.purpose == "what shining pixels reflect").count();
    let subject = Subject::of(&scene);
    let plan = subject.plan(&voxel());
    assert_eq!(shining(&plan), 1);
    let before = called(&subject, &plan)["trace_cones"];
    for material in &mut scene.materials {
        if material.kind != (MaterialKind::Dielectric { ior: 1.5 }) {
            *material =
                Material { emission: material.emission, ..Material::diffuse("plain", material.albedo) };
        }
    }
    let subject = Subject::of(&scene);
    let plan = subject.plan(&voxel());
    assert_eq!(shining(&plan), 0);
    assert_eq!(called(&subject, &plan)["trace_cones"], before - 1);
}
