//! Light samplers against their densities, and what they deliver against closed forms.

use crate::chi_squared;
use glam::{DMat3, DQuat, DVec3, Vec3};
use std::f64::consts::PI;
use twinlight_core::math::hash::to_unit;
use twinlight_core::math::sobol::{independent_pair, sobol_pair};
use twinlight_core::scene::{CompiledScene, Environment, Light, Limits, Material, Mesh, Scene, compile};
use twinlight_core::transport::SceneView;
use twinlight_core::transport::environment::{environment_from, sample_environment};
use twinlight_core::transport::intersect;
use twinlight_core::transport::light::{
    LightSample, sample_light, select_light, sphere_light_pdf, triangle_light_pdf,
};

fn compiled(scene: &Scene) -> CompiledScene {
    compile(scene, &Limits::default()).unwrap()
}

fn with_light(light: Light) -> CompiledScene {
    compiled(&Scene { lights: vec![light], ..Scene::default() })
}

fn draw(view: &SceneView<'_>, from: Vec3, i: u32) -> LightSample {
    let [choose, _] = independent_pair(7, i, 2);
    let [u, v] = independent_pair(7, i, 1).map(to_unit);
    sample_light(view, select_light(view, choose), from, u, v, independent_pair(7, i, 3))
}

/// Irradiance at `from` on a plane facing up, shadows aside, by the sampler.
fn irradiance(scene: &CompiledScene, from: Vec3, samples: u32) -> f64 {
    let view = SceneView::from(scene);
    let mut sum = 0.0;
    for i in 0..samples {
        let [choose, _] = sobol_pair(7, i, 2);
        let [u, v] = sobol_pair(7, i, 1).map(to_unit);
        let s = sample_light(&view, select_light(&view, choose), from, u, v, sobol_pair(7, i, 3));
        if s.pdf > 0.0 {
            sum += f64::from(s.emission.x) * f64::from(s.direction.z).max(0.0) / f64::from(s.pdf);
        }
    }
    sum / f64::from(samples)
}

/// A sphere of radiance L and radius r at height d over a plane: E = π L r²/d².
#[test]
fn sphere_light_irradiance() {
    for (distance, radius) in [(2.0_f32, 1.0_f32), (10.0, 1.0), (1.001, 1.0), (1000.0, 0.01)] {
        let scene = with_light(Light::Sphere { center: [0.0, 0.0, distance], radius, radiance: [3.0; 3] });
        let expected = PI * 3.0 * f64::from(radius * radius) / f64::from(distance * distance);
        let found = irradiance(&scene, Vec3::ZERO, 1 << 14);
        assert!((found / expected - 1.0).abs() < 2e-3, "d {distance} r {radius}: {found} for {expected}");
    }
}

/// Inside a sphere light there is nothing to sample, and nothing blows up (T7).
#[test]
fn t7_points_in_and_on_lights_are_finite() {
    let sphere = with_light(Light::Sphere { center: [0.0; 3], radius: 1.0, radiance: [1.0; 3] });
    let point = with_light(Light::Point { position: [0.0; 3], intensity: [1.0; 3] });
    let edges = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
    let rectangle = with_light(Light::Rectangle {
        corner: [0.0; 3],
        edge_u: edges.0,
        edge_v: edges.1,
        radiance: [1.0; 3],
    });
    for scene in [&sphere, &point, &rectangle] {
        let view = SceneView::from(scene);
        for from in [Vec3::ZERO, Vec3::X, Vec3::Z * 1e-30, Vec3::new(0.25, 0.25, 0.0)] {
            for i in 0..256 {
                let s = draw(&view, from, i);
                let value = s.emission * if s.pdf > 0.0 { 1.0 / s.pdf } else { 0.0 };
                assert!(value.is_finite() && s.direction.is_finite(), "{from}: {s:?}");
            }
        }
    }
}

/// Form factor of a parallel rectangle a by b at distance c over a point under its corner (Howell, B-4).
#[test]
fn rectangle_form_factor() {
    for (a, b, c) in [(1.0_f64, 1.0_f64, 1.0_f64), (2.0, 0.5, 1.0), (3.0, 3.0, 1.0)] {
        // Faces down: edge_u × edge_v = −z.
        let scene = with_light(Light::Rectangle {
            corner: [0.0, 0.0, c as f32],
            edge_u: [0.0, b as f32, 0.0],
            edge_v: [a as f32, 0.0, 0.0],
            radiance: [1.0; 3],
        });
        let (x, y) = (a / c, b / c);
        let term = |p: f64, q: f64| p / (1.0 + p * p).sqrt() * (q / (1.0 + p * p).sqrt()).atan();
        let factor = (term(x, y) + term(y, x)) / (2.0 * PI);
        let origin = DVec3::from(scene.origin).as_vec3();
        let found = irradiance(&scene, -origin, 1 << 18) / PI;
        assert!((found / factor - 1.0).abs() < 3e-3, "{a} {b} {c}: {found} for {factor}");
    }
}

#[test]
fn point_spot_and_directional_lights_are_their_formulas() {
    let from = Vec3::ZERO;
    let one = |light| {
        let scene = with_light(light);
        draw(&SceneView::from(&scene), from, 0)
    };
    let s = one(Light::Point { position: [0.0, 0.0, 2.0], intensity: [8.0; 3] });
    assert_eq!((s.emission.x, s.pdf, s.direction, s.delta), (2.0, 1.0, Vec3::Z, true));
    let spot = |angle: f64| {
        let position = [2.0 * angle.sin() as f32, 0.0, 2.0 * angle.cos() as f32];
        let light = Light::Spot {
            position,
            direction: [0.0, 0.0, -1.0],
            intensity: [4.0; 3],
            inner_angle: 0.3,
            outer_angle: 0.6,
        };
        f64::from(one(light).emission.x)
    };
    assert!((spot(0.0) - 1.0).abs() < 1e-6);
    assert!((spot(0.29) - 1.0).abs() < 1e-6);
    assert_eq!(spot(0.61), 0.0);
    let ramp = (0.45_f64.cos() - 0.6_f64.cos()) / (0.3_f64.cos() - 0.6_f64.cos());
    assert!((spot(0.45) - ramp * ramp).abs() < 1e-5);
    let s = one(Light::Directional { direction: [0.0, 0.0, -7.0], irradiance: [5.0; 3] });
    assert_eq!((s.emission.x, s.direction, s.infinite), (5.0, Vec3::Z, true));
}

/// T9 for sphere, triangle and environment lights.
#[test]
fn t9_light_sampling_follows_its_density() {
    let from = Vec3::new(0.3, -0.2, 0.1);
    let sphere = with_light(Light::Sphere { center: [0.5, 0.4, 1.2], radius: 0.9, radiance: [1.0; 3] });
    let view = SceneView::from(&sphere);
    let record = sphere.lights[0];
    let pdf = |d: Vec3| match intersect::sphere(from, d, Vec3::from(record.position), record.radius) {
        Some((near, _)) if near > 0.0 => f64::from(sphere_light_pdf(&record, from)),
        _ => 0.0,
    };
    chi_squared::check("sphere", 400_000, &|i| draw(&view, from, i).direction, &pdf);

    let mut scene = Scene::default();
    let glow = scene.add_material(Material { emits_both_sides: true, ..Material::emitter("glow", [1.0; 3]) });
    let corners = vec![[-2.0, -1.0, 1.0], [2.0, -1.5, 0.6], [0.2, 2.5, 1.5], [-2.0, 2.0, 0.8]];
    scene.add_mesh(Mesh::new("glow", corners, vec![[0, 1, 2], [2, 3, 0]], glow));
    let scene = compiled(&scene);
    let view = SceneView::from(&scene);
    let from = from - DVec3::from(scene.origin).as_vec3();
    let pdf = |d: Vec3| {
        let frame = intersect::ray_frame(from, d);
        let mut sum = 0.0;
        for t in &scene.triangles {
            if let Some(hit) = intersect::triangle(&frame, t, 0.0, 1e9) {
                let record = &scene.lights[t.light as usize];
                let cosine = Vec3::from(record.direction).dot(d).abs();
                sum += f64::from(triangle_light_pdf(record, hit.t, cosine));
            }
        }
        sum
    };
    chi_squared::check("triangles", 400_000, &|i| draw(&view, from, i).direction, &pdf);

    let scene = compiled(&Scene { environment: Some(sky()), ..Scene::default() });
    let view = SceneView::from(&scene);
    let pdf = |d: Vec3| f64::from(environment_from(&view, d).pdf);
    chi_squared::check("environment", 400_000, &|i| draw(&view, Vec3::ZERO, i).direction, &pdf);
}

/// A sky of few texels with large steps, rotated out of every axis.
fn sky() -> Environment {
    let (width, height) = (12_u32, 6_u32);
    let texel = |i: u32| [0.1 + (i * 7 % 11) as f32, 1.0, if i.is_multiple_of(5) { 9.0 } else { 0.0 }];
    Environment {
        width,
        height,
        texels: (0..width * height).map(texel).collect(),
        scale: 0.5,
        rotation: DMat3::from_quat(DQuat::from_axis_angle(DVec3::new(1.0, 2.0, 3.0).normalize(), 1.1)),
    }
}

/// What the sampler returns is what the lookup finds in that direction, texel edges aside.
#[test]
fn environment_sampling_and_lookup_agree() {
    let scene = compiled(&Scene { environment: Some(sky()), ..Scene::default() });
    let view = SceneView::from(&scene);
    let mut differ = 0;
    for i in 0..20_000 {
        let [u, v] = independent_pair(1, i, 0).map(to_unit);
        let (direction, value) = sample_environment(&view, independent_pair(1, i, 1), u, v);
        assert!((direction.length() - 1.0).abs() < 1e-5);
        differ += u32::from(environment_from(&view, direction) != value);
    }
    // A direction within rounding (about 1e-6 of a texel's width) of an edge may fall to the neighbour.
    assert!(differ <= 2, "{differ} of 20000");
}

/// A map lookup puts the picture where the contract says: row 0 up, column 0 at −z, columns towards +x.
#[test]
fn environment_is_the_right_way_round() {
    let mut map = Environment { rotation: DMat3::IDENTITY, ..sky() };
    map.texels = (0..72).map(|i| [(i % 12) as f32 + 1.0, (i / 12) as f32 + 1.0, 0.0]).collect();
    map.scale = 1.0;
    let scene = compiled(&Scene { environment: Some(map), ..Scene::default() });
    let view = SceneView::from(&scene);
    let at = |d: Vec3| environment_from(&view, d.normalize()).radiance;
    assert_eq!(at(Vec3::new(0.01, 1.0, -0.1)).y, 1.0, "up is row 0");
    assert_eq!(at(Vec3::new(0.01, -1.0, -0.1)).y, 6.0, "down is the last row");
    assert_eq!(at(Vec3::new(0.01, 0.1, -1.0)).x, 1.0, "-z is column 0");
    assert_eq!(at(Vec3::new(1.0, 0.1, -0.01)).x, 3.0, "+x is a quarter on");
    assert_eq!(at(Vec3::new(-0.01, 0.1, -1.0)).x, 12.0, "the last column meets the first");
}
