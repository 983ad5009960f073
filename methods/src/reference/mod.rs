//! The reference path tracer: unbiased, what every other method is judged by.
//!
//! [`render`] runs the kernel `trace_paths` in passes short enough to report progress and to stop between, on any
//! [`Backend`]. Sums are integers, so neither the passes nor their order show in the picture.

mod film;
mod schedule;
mod settings;

pub use film::Film;
pub use settings::{Sampler, Settings};

use schedule::Schedule;
use std::time::{Duration, Instant};
use twinlight_core::kernels::trace_paths::{FilmTexel, TracePathsParams};
use twinlight_core::scene::{Camera, CompiledScene};
use twinlight_core::{Backend, Error, Result};

/// How far a render is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Progress {
    /// Share of the samples asked for that are done, in [0, 1]; never falls.
    pub fraction: f64,
    /// Whole samples per pixel that are done everywhere.
    pub samples: u32,
    /// Since the start.
    pub elapsed: Duration,
}

/// What the caller says to a progress report.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Control {
    /// Go on.
    Continue,
    /// Stop after this pass; the samples so far make a valid picture.
    Stop,
}

/// Why a render ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StopReason {
    /// Every sample was taken.
    Samples,
    /// The time limit came first.
    Time,
    /// The caller said [`Control::Stop`].
    Cancelled,
}

/// A finished or stopped render.
#[derive(Debug, Clone)]
pub struct Rendered {
    /// The sums.
    pub film: Film,
    /// Why it ended.
    pub stop: StopReason,
    /// Time in the kernel, passes and waiting included.
    pub elapsed: Duration,
}

/// Renders `scene` (resident on `backend` as `resident`) from `camera`. `observe` is called after every pass, at most a
/// few times per second of work.
///
/// # Errors
/// What [`Settings`], the camera and the backend refuse; [`Error::InvalidInput`] when samples had to be rejected (not
/// finite, negative or too bright for the film), which no valid scene causes.
///
/// ```
/// use twinlight_backend_cpu::CpuBackend;
/// use twinlight_core::{Backend, scene};
/// use twinlight_methods::reference::{Control, Settings, render};
///
/// # fn main() -> twinlight_core::Result<()> {
/// let mut room = scene::Scene::default();
/// let wall = room.add_material(scene::Material { emission: [1.0; 3], ..Default::default() });
/// let corners = vec![[-9.0, -9.0, -1.0], [9.0, -9.0, -1.0], [0.0, 9.0, -1.0]];
/// room.add_mesh(scene::Mesh::new("wall", corners, vec![[0, 1, 2]], wall));
/// let camera =
///     scene::Camera { position: [0.0; 3], target: [0.0, 0.0, -1.0], up: [0.0, 1.0, 0.0], vfov_degrees: 40.0 };
///
/// let compiled = scene::compile(&room, &scene::Limits::default())?;
/// let backend = CpuBackend::new();
/// let resident = backend.upload_scene(&compiled)?;
/// let settings = Settings { width: 8, height: 8, samples: 4, ..Settings::default() };
/// let rendered = render(&backend, &resident, &compiled, &camera, &settings, |_| Control::Continue)?;
/// assert_eq!(rendered.film.radiance()[0], [1.0; 3]);
/// # Ok(())
/// # }
/// ```
pub fn render<B: Backend>(
    backend: &B,
    resident: &B::Scene,
    scene: &CompiledScene,
    camera: &Camera,
    settings: &Settings,
    observe: impl FnMut(Progress) -> Control,
) -> Result<Rendered> {
    let kernel = |params: &TracePathsParams, film: &mut _| backend.trace_paths(resident, params, film);
    accumulate(backend, scene, camera, settings, kernel, observe)
}

/// Runs a kernel that adds samples to a film, in passes.
pub(crate) fn accumulate<B: Backend>(
    backend: &B,
    scene: &CompiledScene,
    camera: &Camera,
    settings: &Settings,
    kernel: impl Fn(&TracePathsParams, &mut B::Buffer<FilmTexel>) -> Result<()>,
    mut observe: impl FnMut(Progress) -> Control,
) -> Result<Rendered> {
    let mut params = settings.params(camera, scene)?;
    let pixels = settings.width * settings.height;
    params.check(pixels as usize)?;
    let start = Instant::now();
    let mut sums = backend.zeroed::<FilmTexel>(pixels as usize)?;
    let mut schedule = Schedule::new(pixels, settings.samples, settings.pass);
    let mut stop = StopReason::Samples;
    while let Some(pass) = schedule.next() {
        params.pixel_begin = pass.pixel_begin;
        params.pixel_count = pass.pixel_count;
        params.sample_begin = settings.first_sample + pass.sample_begin;
        params.sample_count = pass.sample_count;
        let before = Instant::now();
        kernel(&params, &mut sums)?;
        schedule.took(&pass, before.elapsed());
        let elapsed = start.elapsed();
        let progress = Progress { fraction: schedule.fraction(), samples: schedule.whole_samples(), elapsed };
        if observe(progress) == Control::Stop && !schedule.is_done() {
            stop = StopReason::Cancelled;
            break;
        }
        // At least one sample everywhere: a picture with holes is no picture.
        if settings.time.is_some_and(|limit| elapsed >= limit)
            && schedule.whole_samples() > 0
            && !schedule.is_done()
        {
            stop = StopReason::Time;
            break;
        }
    }
    let film = Film::new(settings.width, settings.height, &params, backend.download(&sums)?)?;
    check_rejected(&film, &params)?;
    Ok(Rendered { film, stop, elapsed: start.elapsed() })
}

fn check_rejected(film: &Film, params: &TracePathsParams) -> Result<()> {
    match film.first_unusable() {
        Some(pixel) => {
            let place = format!("pixel ({}, {})", pixel % params.width, pixel / params.width);
            Err(Error::invalid(
                place,
                "samples are not finite, negative or too bright for the film's fixed point",
            ))
        }
        None => Ok(()),
    }
}
