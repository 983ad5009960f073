//! Energy, reciprocity, limits and sampling of the opaque material; the dielectric's Fresnel terms.

use crate::chi_squared;
use bytemuck::Zeroable;
use glam::{DVec3, Vec3};
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};
use twinlight_core::math::hash::to_unit;
use twinlight_core::math::sobol::{independent_pair, sobol_pair};
use twinlight_core::scene::{Limits, Material, MaterialRecord, Mesh, Scene, compile};
use twinlight_core::transport::bsdf::{evaluate, sample_dielectric, sample_mirror, sample_opaque};

fn record(f0: f32, roughness: f32) -> MaterialRecord {
    let mut scene = Scene::default();
    let material = Material { specular_f0: [f0; 3], roughness, ..Material::default() };
    let id = scene.add_material(material);
    scene.add_mesh(Mesh::new("t", vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], vec![[0, 1, 2]], id));
    compile(&scene, &Limits::default()).unwrap().materials[0]
}

fn direction(cosine: f32, turns: f64) -> Vec3 {
    let z = f64::from(cosine);
    let r = (1.0 - z * z).max(0.0).sqrt();
    DVec3::new(r * (TAU * turns).cos(), r * (TAU * turns).sin(), z).as_vec3()
}

/// Share of light scattered from `wo`, by the material's own sampler: the mean of its weights.
fn directional_albedo(m: &MaterialRecord, albedo: f32, wo: Vec3, samples: u32) -> f64 {
    let mut sum = 0.0;
    for i in 0..samples {
        let [a, b] = sobol_pair(5, i, 0).map(to_unit);
        let [lobe, _] = sobol_pair(5, i, 1).map(to_unit);
        let s = sample_opaque(m, Vec3::splat(albedo), wo, lobe, a, b);
        sum += f64::from(s.weight.x);
    }
    sum / f64::from(samples)
}

/// T8: no more light leaves than arrives, for white surfaces of every roughness and reflectance, at every angle.
#[test]
fn t8_energy_is_conserved() {
    for f0 in [0.0, 0.02, 0.04, 0.2, 0.5, 0.9, 1.0] {
        for roughness in [0.0, 0.05, 0.1, 0.2, 0.4, 0.6, 0.8, 1.0] {
            let m = record(f0, roughness);
            for cosine in [1.0, 0.9, 0.7, 0.5, 0.3, 0.2, 0.1, 0.05, 0.01] {
                let share = directional_albedo(&m, 1.0, direction(cosine, 0.1), 4096);
                // 0.2 %: the sampling error of 4096 Sobol points with weights of at most a few units.
                assert!(share <= 1.002, "f0 {f0} roughness {roughness} cosine {cosine}: {share}");
            }
        }
    }
}

#[test]
fn without_reflectance_the_material_is_lambertian() {
    let m = record(0.0, 0.3);
    for cosine in [1.0_f32, 0.5, 0.01] {
        let v = evaluate(&m, Vec3::splat(0.5), direction(cosine, 0.3), direction(0.5, 0.9));
        assert_eq!(v.f_cos, Vec3::splat(0.5 * (0.5 * std::f32::consts::FRAC_1_PI)));
    }
    let share = directional_albedo(&m, 0.5, direction(0.4, 0.0), 64);
    assert!((share - 0.5).abs() < 1e-6, "{share}");
}

/// T4: roughness 0, 1e-4, … 1: finite everywhere, and no jump between neighbours.
#[test]
fn t4_roughness_sweep_is_finite_and_continuous() {
    for cosine in [1.0, 0.6, 0.2, 0.01] {
        let mut last: Option<f64> = None;
        for step in 0..=200 {
            let roughness = if step == 1 { 1e-4 } else { step as f32 / 200.0 };
            let share = directional_albedo(&record(0.9, roughness), 0.0, direction(cosine, 0.2), 2048);
            assert!(share.is_finite() && share >= 0.0, "roughness {roughness}");
            // Steps of 0.005 in roughness; the steepest change of the albedo over roughness is below 6.
            if let Some(last) = last {
                assert!((share - last).abs() < 0.03, "roughness {roughness}: {last} then {share}");
            }
            last = Some(share);
        }
    }
}

/// T3: weights stay finite and bounded as the viewer or the light goes to the horizon.
#[test]
fn t3_grazing_angles_have_finite_weights() {
    for f0 in [0.0, 0.04, 1.0] {
        for roughness in [0.0, 0.1, 1.0] {
            let m = record(f0, roughness);
            for k in 0..100 {
                let cosine = f32::powi_by_hand(0.8, k);
                for i in 0..64 {
                    let [a, b] = sobol_pair(9, i, 0).map(to_unit);
                    let [lobe, _] = sobol_pair(9, i, 1).map(to_unit);
                    let s = sample_opaque(&m, Vec3::ONE, direction(cosine, 0.0), lobe, a, b);
                    assert!(s.weight.is_finite() && s.pdf.is_finite(), "f0 {f0} {roughness} {cosine}");
                    // D·G/pdf is at most 4(n·o + …)/k² with k ≥ 1/8, times the lobe probability's inverse.
                    assert!(s.weight.max_element() < 600.0, "{} at {cosine}", s.weight);
                }
            }
        }
    }
}

trait PowiByHand {
    fn powi_by_hand(base: f32, exponent: u32) -> f32;
}

impl PowiByHand for f32 {
    fn powi_by_hand(base: f32, exponent: u32) -> f32 {
        (0..exponent).fold(1.0, |p, _| p * base)
    }
}

proptest! {
    /// T8: f(o, i) = f(i, o).
    #[test]
    fn t8_reciprocity(
        f0 in 0.0_f32..1.0, roughness in 0.0_f32..1.0, albedo in 0.0_f32..1.0,
        (co, to) in (0.01_f32..1.0, 0.0_f64..1.0), (ci, ti) in (0.01_f32..1.0, 0.0_f64..1.0),
    ) {
        let m = record(f0, roughness);
        let (o, i) = (direction(co, to), direction(ci, ti));
        let there = evaluate(&m, Vec3::splat(albedo), o, i).f_cos.x / i.z;
        let back = evaluate(&m, Vec3::splat(albedo), i, o).f_cos.x / o.z;
        // Half vectors of the two orders differ by rounding; near the peak of a sharp lobe D amplifies it by 1/α².
        let slack = 1e-5 + 1e-6 / (m.alpha * m.alpha);
        prop_assert!((there - back).abs() <= slack * there.max(back), "{there} {back}");
    }
}

/// T9: directions are distributed as the density says.
#[test]
fn t9_opaque_sampling_follows_its_density() {
    for (f0, roughness, albedo) in
        [(0.0, 1.0, 0.8), (0.04, 0.5, 0.6), (0.9, 0.35, 0.0), (0.5, 0.7, 0.5), (1.0, 1.0, 0.0)]
    {
        let m = record(f0, roughness);
        for cosine in [0.95, 0.5, 0.15] {
            let wo = direction(cosine, 0.37);
            let sample = |i: u32| {
                let [a, b] = independent_pair(3, i, 0).map(to_unit);
                let [lobe, _] = independent_pair(3, i, 1).map(to_unit);
                sample_opaque(&m, Vec3::splat(albedo), wo, lobe, a, b).direction
            };
            let pdf = |d: Vec3| f64::from(evaluate(&m, Vec3::splat(albedo), wo, d).pdf);
            let name = format!("f0 {f0} roughness {roughness} albedo {albedo} cosine {cosine}");
            chi_squared::check(&name, 400_000, &sample, &pdf);
        }
    }
}

#[test]
fn sampled_weights_are_value_over_density() {
    let m = record(0.3, 0.4);
    let wo = direction(0.6, 0.1);
    for i in 0..1000 {
        let [a, b] = sobol_pair(1, i, 0).map(to_unit);
        let s = sample_opaque(&m, Vec3::splat(0.5), wo, to_unit(sobol_pair(1, i, 1)[0]), a, b);
        if s.direction != Vec3::ZERO {
            let v = evaluate(&m, Vec3::splat(0.5), wo, s.direction);
            assert_eq!((s.pdf, s.weight), (v.pdf, v.f_cos * (1.0 / v.pdf)));
        }
    }
}

#[test]
fn mirrors_mirror() {
    let m = MaterialRecord { specular_f0: [0.9, 0.8, 0.7], ..MaterialRecord::zeroed() };
    let s = sample_mirror(&m, Vec3::new(0.6, 0.0, 0.8));
    assert_eq!((s.direction, s.weight, s.pdf), (Vec3::new(-0.6, 0.0, 0.8), Vec3::new(0.9, 0.8, 0.7), 0.0));
}

/// Fresnel's formulas at known points: normal incidence, Brewster's angle, total reflection; Snell's law.
#[test]
fn dielectrics_follow_fresnel_and_snell() {
    let ior = 1.5_f32;
    let m = MaterialRecord { ior, ..MaterialRecord::zeroed() };
    let reflectance = |wo: Vec3, front: bool| {
        let below = |c: f32| sample_dielectric(&m, front, wo, c).direction.z > 0.0;
        let (mut low, mut high) = (0.0_f32, 1.0_f32);
        for _ in 0..30 {
            let middle = (low + high) * 0.5;
            if below(middle) { low = middle } else { high = middle }
        }
        f64::from(low)
    };
    assert!((reflectance(Vec3::Z, true) - 0.04).abs() < 1e-6);
    assert!((reflectance(Vec3::Z, false) - 0.04).abs() < 1e-6);
    let brewster = (f64::from(ior)).atan();
    let wo = DVec3::new(brewster.sin(), 0.0, brewster.cos()).as_vec3();
    let refracted = (brewster.sin() / f64::from(ior)).asin();
    let s_only = ((brewster - refracted).sin() / (brewster + refracted).sin()).powi(2) * 0.5;
    assert!((reflectance(wo, true) - s_only).abs() < 1e-6);
    assert!(reflectance(direction(0.5, 0.0), false) > 0.999, "beyond the critical angle");
    let down = sample_dielectric(&m, true, wo, 0.999_999);
    assert!((f64::from(-down.direction.x) - refracted.sin()).abs() < 1e-6, "Snell's law");
    assert!((down.weight.x - 1.0 / (ior * ior)).abs() < 1e-6, "radiance is compressed");
}

/// The white furnace of a Lambertian hemisphere integrates to its albedo by quadrature, too.
#[test]
fn density_of_cosine_sampling_is_normalised() {
    let m = record(0.0, 1.0);
    let mut sum = 0.0;
    let n = 2000;
    for i in 0..n {
        let z = (i as f32 + 0.5) / n as f32;
        sum += f64::from(evaluate(&m, Vec3::ONE, Vec3::Z, direction(z, 0.2)).pdf) * 2.0 * PI / f64::from(n);
    }
    assert!((sum - 1.0).abs() < 1e-5, "{sum}");
}
