//! The oracle against closed forms.

use super::*;
use crate::scenes::compiled;
use twinlight_core::kernels::trace_cones::VoxelFrame;
use twinlight_core::scene::{Environment, Light, Scene};

/// A voxel of width 1 around the origin, albedo 1 and ½ and ¼, normal +y.
fn voxel() -> Voxel {
    let sums = VoxelSums {
        albedo: [4095 * 2, 4095, 4095 / 2 + 1],
        count: 2,
        normal: [0, 200, 0],
        ..VoxelSums::default()
    };
    Voxel { code: 0, sums, gathered: [0.0; 3] }
}

fn block() -> LightVoxelsBlock {
    let frame = VoxelFrame { corner: [-0.5; 3], voxels_per_unit: 1.0 };
    LightVoxelsBlock { frame, seed: 1, samples: 1, scale: 1e4, emission_unit: 1.0 }
}

fn under(lights: Vec<Light>, environment: Option<Environment>) -> CompiledScene {
    compiled(&Scene { lights, environment, ..Scene::default() })
}

fn near(got: &Expected, red: f64) {
    let allowed = 5.0 * got.error.x + 1e-6 * red;
    assert!((got.value.x - red).abs() <= allowed, "{got:?}, want {red} ± {allowed}");
    assert!(got.error.x < 0.01 * red, "{got:?}");
    assert!((got.value.y - got.value.x / 2.0).abs() < 1e-9 * red, "{got:?}");
}

#[test]
fn a_point_light_falls_off_by_its_square() {
    let scene = under(vec![Light::Point { position: [3.0, 4.0, 0.0], intensity: [50.0; 3] }], None);
    // 50/25 · 4/5, /π
    near(&expected(&scene, &block(), &voxel()), 1e4 * 1.6 / PI);
}

#[test]
fn light_from_below_counts_and_no_normal_halves() {
    let scene = under(vec![Light::Directional { direction: [0.0, 3.0, 0.0], irradiance: [2.0; 3] }], None);
    near(&expected(&scene, &block(), &voxel()), 1e4 * 2.0 / PI);
    let mut lost = voxel();
    lost.sums.normal = [0; 3];
    near(&expected(&scene, &block(), &lost), 1e4 / PI);
}

#[test]
fn a_sphere_gives_pi_times_its_squared_sine() {
    let scene = under(vec![Light::Sphere { center: [0.0, 4.0, 0.0], radius: 1.0, radiance: [3.0; 3] }], None);
    near(&expected(&scene, &block(), &voxel()), 1e4 * 3.0 / 16.0);
}

#[test]
fn an_even_sky_comes_from_both_sides() {
    let scene = under(Vec::new(), Some(Environment::constant([0.5; 3])));
    // π·L per side.
    near(&expected(&scene, &block(), &voxel()), 1e4 * 2.0 * 0.5);
}

#[test]
fn a_rectangle_has_lamberts_form_factor() {
    let rectangle = Light::Rectangle {
        corner: [-1.0, 2.0, -1.0],
        edge_u: [2.0, 0.0, 0.0],
        edge_v: [0.0, 0.0, 2.0],
        radiance: [5.0; 3],
    };
    let x = 0.5 / 1.25_f64.sqrt();
    let factor = 4.0 * (x * x.atan() + x * x.atan()) / (2.0 * PI);
    near(&expected(&under(vec![rectangle], None), &block(), &voxel()), 1e4 * 5.0 * factor);
}

#[test]
fn spheres_and_triangles_are_in_between() {
    let far = Light::Point { position: [0.0, 40.0, 0.0], intensity: [1e4; 3] };
    // A sphere without light of its own is none.
    let ball = Light::Sphere { center: [0.0, 20.0, 0.0], radius: 0.5, radiance: [1e-9; 3] };
    let dark = expected(&under(vec![far, ball], None), &block(), &voxel());
    assert!(dark.value.max_element() < 1e-3, "{dark:?}");
    let roof = crate::scenes::scene_of(twinlight_fixtures::meshes::quad(
        [-1.0, 9.0, -1.0],
        [1.0, 9.0, -1.0],
        [1.0, 9.0, 1.0],
        [-1.0, 9.0, 1.0],
    ));
    let dark = expected(&compiled(&Scene { lights: vec![far], ..roof }), &block(), &voxel());
    assert_eq!(dark.value, DVec3::ZERO);
    let lit = expected(&under(vec![far], None), &block(), &voxel());
    near(&lit, 1e4 * 6.25 / PI);
}

#[test]
fn what_is_gathered_and_emitted_adds_up() {
    let mut voxel = voxel();
    voxel.gathered = [PI as f32, 0.0, 1e9];
    voxel.sums.emission = [0, 3, 0];
    let got = leaf(&under(Vec::new(), None), &LightVoxelsBlock { scale: 100.0, ..block() }, &voxel);
    assert_eq!(got, VoxelLight { rgb: [100, 150, MAX_RADIANCE], opacity: OPAQUE });
    voxel.sums.count = 0;
    assert_eq!(leaf(&under(Vec::new(), None), &block(), &voxel), VoxelLight::default());
}
