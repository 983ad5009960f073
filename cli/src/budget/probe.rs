//! A short look at how fast this machine renders a scene, and how noisy it is.

use std::time::{Duration, Instant};
use twinlight::methods::post::metrics::pointwise::REL_MSE_EPSILON;
use twinlight::methods::reference::{Control, Progress, Sampler, Settings, render};
use twinlight::scene::{Camera, CompiledScene};
use twinlight::{Backend, Result};

/// What a look found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Probe {
    /// Seconds per sample of a pixel, of the reference tracer.
    pub per_sample: f64,
    /// relMSE of one sample per pixel, by the spread of samples.
    pub noise: f64,
    /// Share of the light that was scattered more than once.
    pub indirect: f64,
}

/// Pixels per row and column: enough for a mean, few enough for a look.
const SIZE: u32 = 64;

/// How long a look is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Effort {
    /// About so long.
    Time(Duration),
    /// So many samples per pixel: the same noise and the same share of indirect light every time.
    Samples(u32),
}

/// Renders for a while, with independent samples, whose spread says how noisy they are.
///
/// # Errors
/// What the backend refuses.
pub fn probe<B: Backend>(
    backend: &B,
    scene: &CompiledScene,
    camera: &Camera,
    bounces: Option<u32>,
    effort: Effort,
) -> Result<Probe> {
    let (samples, time) = match effort {
        Effort::Time(time) => (1 << 16, time),
        Effort::Samples(samples) => (samples, Duration::MAX),
    };
    let resident = backend.upload_scene(scene)?;
    let settings = Settings {
        width: SIZE,
        height: SIZE,
        samples,
        bounces,
        sampler: Sampler::Independent,
        pass: (time / 8).clamp(Duration::from_millis(2), Duration::from_millis(250)),
        ..Settings::default()
    };
    let start = Instant::now();
    // Two samples of a pixel have a spread.
    let observe = |progress: Progress| {
        if progress.samples >= 2 && start.elapsed() >= time { Control::Stop } else { Control::Continue }
    };
    let rendered = render(backend, &resident, scene, camera, &settings, observe)?;
    let film = &rendered.film;
    let samples: f64 = film.texels().iter().map(|texel| f64::from(texel.samples)).sum();
    let sum = |rgb: &[f32; 3]| rgb.iter().map(|&c| f64::from(c)).sum::<f64>();
    let light = |pixels: Vec<[f32; 3]>| pixels.iter().map(sum).sum::<f64>();
    let (all, indirect, variance) = (light(film.radiance()), light(film.indirect()), film.variance());
    let noise = variance.iter().zip(film.radiance()).zip(film.texels()).map(|((variance, rgb), texel)| {
        let luminance = 0.2126 * f64::from(rgb[0]) + 0.7152 * f64::from(rgb[1]) + 0.0722 * f64::from(rgb[2]);
        f64::from(*variance) * f64::from(texel.samples) / (luminance * luminance + REL_MSE_EPSILON)
    });
    Ok(Probe {
        per_sample: rendered.elapsed.as_secs_f64() / samples,
        noise: noise.sum::<f64>() / film.texels().len() as f64,
        indirect: if all > 0.0 { indirect / all } else { 0.0 },
    })
}
