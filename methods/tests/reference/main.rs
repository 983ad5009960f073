//! The reference path tracer against known answers, and its bits against every way of splitting the work.

mod coincident;
mod determinism;
mod known_answers;
mod metamorphic;
mod robustness;
mod walls;

use twinlight_backend_cpu::CpuBackend;
use twinlight_core::Backend;
use twinlight_core::scene::{Camera, Limits, Scene, compile};
use twinlight_methods::reference::{Control, Film, Sampler, Settings, render};

/// A square picture of independent samples, whose variance the film estimates rightly.
fn settings(size: u32, samples: u32) -> Settings {
    Settings { width: size, height: size, samples, sampler: Sampler::Independent, ..Settings::default() }
}

fn film_on(backend: &CpuBackend, scene: &Scene, settings: &Settings) -> Film {
    let compiled = compile(scene, &Limits::default()).unwrap();
    let resident = backend.upload_scene(&compiled).unwrap();
    let camera = Camera::of_scene(scene).unwrap();
    render(backend, &resident, &compiled, &camera, settings, |_| Control::Continue).unwrap().film
}

fn film(scene: &Scene, settings: &Settings) -> Film {
    film_on(&CpuBackend::new(), scene, settings)
}

/// Mean luminance over the picture and its standard error, pixels being independent.
fn mean(film: &Film) -> (f64, f64) {
    let radiance = film.radiance();
    let n = radiance.len() as f64;
    let luminance =
        |p: &[f32; 3]| 0.2126 * f64::from(p[0]) + 0.7152 * f64::from(p[1]) + 0.0722 * f64::from(p[2]);
    let sum: f64 = radiance.iter().map(luminance).sum();
    let variance: f64 = film.variance().iter().map(|&v| f64::from(v)).sum();
    (sum / n, (variance / (n * n)).sqrt())
}

/// The picture's mean is `expected` up to 4 standard errors (1 in 16 000 by chance, and the samples are fixed) and
/// `slack`, a relative error of the known answer itself.
fn assert_mean(name: &str, film: &Film, expected: f64, slack: f64) {
    let (mean, error) = mean(film);
    let allowed = 4.0 * error + slack * expected + 1e-6 * expected;
    assert!((mean - expected).abs() <= allowed, "{name}: {mean} for {expected}, allowed {allowed}");
    assert!(error <= 0.02 * expected.max(1e-9), "{name}: too noisy to tell, standard error {error}");
}
