//! The render in batches of whole samples, whose films are added up on the host: what is finished survives a lost
//! device. Sums are integers, so the batches don't show in the picture.

use super::job::Job;
use std::time::{Duration, Instant};
use twinlight::methods::reference::{Control, Film, Progress, Rendered, Settings, StopReason};
use twinlight::{Error, Result};

/// What a lost device may cost: batches grow until they take this long.
const BATCH: Duration = Duration::from_secs(10);

/// Why sampling ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stop {
    /// Every sample was taken.
    Samples,
    /// The time limit came first.
    Time,
    /// A signal.
    Signal(i32),
    /// The device went away.
    DeviceLost,
}

impl Stop {
    /// For the sidecar and the EXR header.
    pub fn name(self) -> &'static str {
        match self {
            Self::Samples => "samples",
            Self::Time => "time",
            Self::Signal(_) => "interrupted",
            Self::DeviceLost => "device lost",
        }
    }
}

/// What was sampled.
pub struct Taken {
    /// The sums.
    pub film: Film,
    /// Why it ended.
    pub stop: Stop,
    /// Since the start.
    pub elapsed: Duration,
    /// The error of a device that went away after the first batch.
    pub lost: Option<Error>,
}

impl Taken {
    /// Least and most samples of a pixel.
    pub fn samples(&self) -> (u32, u32) {
        let counts = || self.film.texels().iter().map(|t| t.samples);
        (counts().min().unwrap_or(0), counts().max().unwrap_or(0))
    }

    /// Camera paths per second of sampling.
    pub fn paths_per_second(&self) -> f64 {
        let paths: u64 = self.film.texels().iter().map(|t| u64::from(t.samples)).sum();
        paths as f64 / self.elapsed.as_secs_f64().max(1e-9)
    }
}

/// Takes the samples of a job, which `sampled` makes. `interrupted` is asked, and `observe` told, after every pass.
///
/// # Errors
/// Those of `sampled`; a device lost in the first batch.
pub fn take(
    job: &Job,
    sampled: impl Fn(&Settings, &mut dyn FnMut(Progress) -> Control) -> Result<Rendered>,
    interrupted: impl Fn() -> Option<i32>,
    mut observe: impl FnMut(Progress),
) -> Result<Taken> {
    let start = Instant::now();
    let mut sum: Option<Film> = None;
    let (mut taken, mut batch, mut fraction) = (0, 1, 0.0_f64);
    let is_late = || job.deadline.is_some_and(|deadline| Instant::now() >= deadline);
    let out_of_time = || is_late() || job.time.is_some_and(|limit| start.elapsed() >= limit);
    let (stop, lost) = loop {
        let samples = batch.min(job.settings().samples - taken);
        let part = Settings { first_sample: taken, samples, time: None, ..job.settings().clone() };
        // A picture with holes is no picture: time counts once every pixel has a sample.
        let may_time_out = sum.is_some();
        let batch_start = Instant::now();
        let mut observe = |progress: Progress| {
            fraction = fraction.max(share(job, taken, &progress, start.elapsed()));
            observe(Progress { fraction, samples: taken + progress.samples, elapsed: start.elapsed() });
            let stop = interrupted().is_some() || (may_time_out && out_of_time());
            if stop { Control::Stop } else { Control::Continue }
        };
        let rendered = match sampled(&part, &mut observe) {
            Ok(rendered) => rendered,
            Err(lost @ Error::DeviceLost { .. }) if sum.is_some() => break (Stop::DeviceLost, Some(lost)),
            Err(error) => return Err(error),
        };
        match &mut sum {
            Some(sum) => sum.merge(&rendered.film)?,
            None => sum = Some(rendered.film),
        }
        taken += samples;
        let signal = interrupted();
        if rendered.stop == StopReason::Samples && taken == job.settings().samples {
            break (Stop::Samples, None);
        } else if let Some(signal) = signal {
            break (Stop::Signal(signal), None);
        } else if out_of_time() {
            break (Stop::Time, None);
        }
        if batch_start.elapsed() * 2 <= BATCH {
            batch = batch.saturating_mul(2);
        }
    };
    let film = sum.ok_or_else(|| Error::Internal("no batch was rendered".into()))?;
    Ok(Taken { film, stop, elapsed: start.elapsed(), lost })
}

/// How much is done: of the samples or of the time, whichever ends first.
fn share(job: &Job, taken: u32, progress: &Progress, elapsed: Duration) -> f64 {
    let samples = f64::from(taken) + progress.fraction * f64::from(job.settings().samples - taken).min(1.0);
    let by_samples = samples / f64::from(job.settings().samples);
    let rest = job.deadline.map(|deadline| elapsed + deadline.saturating_duration_since(Instant::now()));
    let limit = job.time.or(rest);
    let by_time = limit.map_or(0.0, |limit| elapsed.as_secs_f64() / limit.as_secs_f64().max(1e-9));
    by_samples.max(by_time).min(1.0)
}

#[cfg(all(test, feature = "gpu"))]
mod tests {
    use super::*;
    use twinlight::Backend;
    use twinlight::gpu::{DeviceOptions, GpuBackend};
    use twinlight::methods::plan::{Effects, Method, Plan, Request};
    use twinlight::methods::reference;
    use twinlight::scene::{Camera, Limits, compile};

    fn open() -> Option<GpuBackend> {
        match GpuBackend::open(&DeviceOptions::default()) {
            Ok(gpu) => Some(gpu),
            Err(none) if std::env::var_os("TWINLIGHT_REQUIRE_GPU").is_none_or(|value| value == "0") => {
                println!("skipped, no adapter: {none}");
                None
            }
            Err(none) => panic!("TWINLIGHT_REQUIRE_GPU is set: {none}"),
        }
    }

    /// D1: whatever was sampled before a device goes away is the picture, and a new device goes on.
    #[test]
    fn d1_a_lost_device_leaves_the_batches_before() {
        let scene = twinlight::fixtures::scenes::builtin("cornell").unwrap();
        let compiled = compile(&scene, &Limits::default()).unwrap();
        let settings = Settings { width: 16, height: 16, samples: 64, ..Settings::default() };
        let camera = Camera::of_scene(&scene).unwrap();
        let request =
            Request { method: Method::Reference, picture: settings, effects: Effects::Auto, tolerance: 0.0 };
        let plan = Plan::new(&compiled, &camera, &request).unwrap();
        let job = Job {
            plan,
            plan_time: Duration::ZERO,
            begin: Instant::now(),
            time: None,
            deadline: None,
            chosen: None,
            camera,
        };
        // Batches have 1, 2, 4 … samples.
        for (lost_at, saved) in [(1, 0), (3, 1), (4, 3)] {
            let Some(gpu) = open() else { return };
            let resident = gpu.upload_scene(&compiled).unwrap();
            let destroy = |progress: Progress| {
                if progress.samples >= lost_at {
                    gpu.device().destroy();
                }
            };
            let sampled = |settings: &Settings, observe: &mut dyn FnMut(Progress) -> Control| {
                reference::render(&gpu, &resident, &compiled, &job.camera, settings, observe)
            };
            let taken = take(&job, sampled, || None, destroy);
            if saved == 0 {
                assert!(matches!(taken, Err(Error::DeviceLost { .. })));
                continue;
            }
            let taken = taken.unwrap();
            assert_eq!(taken.stop, Stop::DeviceLost);
            assert!(matches!(taken.lost, Some(Error::DeviceLost { .. })));
            let settings = Settings { samples: saved, ..job.settings().clone() };
            let Some(new) = open() else { return };
            let resident = new.upload_scene(&compiled).unwrap();
            let expected =
                reference::render(&new, &resident, &compiled, &job.camera, &settings, |_| Control::Continue);
            assert_eq!(taken.film, expected.unwrap().film, "lost at sample {lost_at}");
        }
    }
}
