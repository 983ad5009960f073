//! The time and the memory of one setting.

use crate::plan::Plan;
use crate::reference::{Control, Progress, StopReason};
use crate::{Calls, Metered, Picture};
use std::time::Instant;
use twinlight_core::kernels::shade_primary::GBufferTexel;
use twinlight_core::kernels::trace_paths::FilmTexel;
use twinlight_core::scene::{Camera, CompiledScene};
use twinlight_core::{Backend, Result};

/// How often a setting is rendered.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Effort {
    /// Timed runs at least, 1 or more.
    pub least: usize,
    /// Timed runs at most.
    pub most: usize,
    /// Timed runs beyond the least end when they took so long together. A first run that takes longer is warm for nearly all of its time, and counts.
    pub seconds: f64,
    /// Once this time has come, one timed run is enough: a slow setting must not take its second where nobody waits for it.
    pub until: Option<Instant>,
}

impl Effort {
    /// Whether a run more is wanted after `runs` timed ones that took `spent` seconds.
    fn wants_more(&self, runs: usize, spent: f64) -> bool {
        let is_late = self.until.is_some_and(|until| Instant::now() >= until);
        let least = if is_late { 1 } else { self.least };
        runs < least || (!is_late && runs < self.most && spent < self.seconds)
    }
}

impl Default for Effort {
    /// Two runs have a spread; five are enough where they take no time.
    fn default() -> Self {
        Self { least: 2, most: 5, seconds: 0.6, until: None }
    }
}

/// A few measured times.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spread {
    /// The middle one; of an even number the lower of the two, so that it is a time that was measured.
    pub median: f64,
    /// The least.
    pub least: f64,
    /// The most.
    pub most: f64,
}

impl Spread {
    /// Of times in any order; zeros where there are none.
    pub fn of(times: impl IntoIterator<Item = f64>) -> Self {
        let mut times: Vec<f64> = times.into_iter().collect();
        times.sort_by(f64::total_cmp);
        let at = |index: usize| times.get(index).copied().unwrap_or(0.0);
        let last = times.len().saturating_sub(1);
        Self { median: at(last / 2), least: at(0), most: at(last) }
    }
}

/// All calls of one kernel, or of one kind of transfer, in a render.
#[derive(Debug, Clone, PartialEq)]
pub struct StepTime {
    /// The method of [`Backend`].
    pub name: String,
    /// How often it was called.
    pub calls: u64,
    /// Seconds in the run whose total is the median.
    pub seconds: f64,
    /// Seconds in all runs.
    pub spread: Spread,
}

/// What one setting takes, and what it makes.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// Mean radiance per pixel, W·sr⁻¹·m⁻².
    pub radiance: Vec<[f32; 3]>,
    /// Bytes of the scene, of hit buffers or voxels, of the film and the G-buffer: what is on the device at once.
    pub bytes: u64,
    /// Seconds of a whole render, from the compiled scene to the picture.
    pub seconds: Spread,
    /// Timed runs.
    pub runs: usize,
    /// Kernels and transfers, in the order of first calls.
    pub steps: Vec<StepTime>,
}

/// One timed run.
struct Run {
    seconds: f64,
    calls: Vec<Calls>,
}

/// The first run.
struct First {
    radiance: Vec<[f32; 3]>,
    bytes: u64,
    run: Run,
}

/// Renders what the plan says, once to warm up and then a few times; all runs are timed but the first, if that is short. Every call waits
/// for the device. `scene_bytes` are those of the scene as it is resident; `go_on` is asked after every pass: `None` when it said no.
///
/// # Errors
/// As [`Plan::run`].
pub fn measure<B: Backend>(
    backend: &B,
    scene: &CompiledScene,
    camera: &Camera,
    plan: &Plan,
    scene_bytes: u64,
    effort: &Effort,
    go_on: impl Fn() -> bool,
) -> Result<Option<Measured>> {
    let Some(First { radiance, bytes, run }) = first(backend, scene, camera, plan, &go_on)? else {
        return Ok(None);
    };
    let mut runs: Vec<Run> = Some(run).filter(|run| run.seconds > effort.seconds).into_iter().collect();
    let mut spent: f64 = runs.iter().map(|run| run.seconds).sum();
    while effort.wants_more(runs.len(), spent) {
        let Some(run) = timed(backend, scene, camera, plan, &go_on)? else { return Ok(None) };
        spent += run.seconds;
        runs.push(run);
    }
    let (seconds, steps) = summary(&runs);
    Ok(Some(Measured { radiance, bytes: scene_bytes + bytes, seconds, runs: runs.len(), steps }))
}

fn control(go_on: &impl Fn() -> bool) -> impl Fn(Progress) -> Control {
    move |_| if go_on() { Control::Continue } else { Control::Stop }
}

/// [`Plan::run`] in its parts, between which the bytes of what they build are known: the picture, those and the time.
fn first<B: Backend>(
    backend: &B,
    scene: &CompiledScene,
    camera: &Camera,
    plan: &Plan,
    go_on: &impl Fn() -> bool,
) -> Result<Option<First>> {
    let (metered, start) = (Metered::waiting(backend), Instant::now());
    let backend = &metered;
    let scene = &*plan.edits.apply(scene);
    let resident = backend.upload_scene(scene)?;
    let built = plan.build(backend, &resident, scene, None)?;
    let settings = &plan.request.picture;
    let rendered = plan.sample(backend, &resident, scene, &built, camera, settings, control(go_on))?;
    if rendered.stop != StopReason::Samples || !go_on() {
        return Ok(None);
    }
    let surfaces = plan.surfaces(backend, &resident, scene, &built, camera, &rendered.film)?;
    let buffers =
        built.buffers.as_ref().map_or(0, |buffers| buffers.bytes(backend) + buffers.read_back_bytes);
    let voxels = built.voxels.as_ref().map_or(0, |lit| lit.bytes(backend));
    // To release what was built is part of a render too.
    drop((built, resident));
    let run = Run { seconds: start.elapsed().as_secs_f64(), calls: metered.calls() };
    let pixels = u64::from(settings.width) * u64::from(settings.height);
    let images = pixels * (size_of::<FilmTexel>() + size_of::<GBufferTexel>()) as u64;
    let radiance = Picture { rendered, surfaces }.radiance();
    Ok(Some(First { radiance, bytes: buffers + voxels + images, run }))
}

fn timed<B: Backend>(
    backend: &B,
    scene: &CompiledScene,
    camera: &Camera,
    plan: &Plan,
    go_on: &impl Fn() -> bool,
) -> Result<Option<Run>> {
    let metered = Metered::waiting(backend);
    let start = Instant::now();
    let picture = plan.run(&metered, scene, camera, control(go_on))?;
    let seconds = start.elapsed().as_secs_f64();
    let is_whole = picture.rendered.stop == StopReason::Samples && go_on();
    Ok(is_whole.then(|| Run { seconds, calls: metered.calls() }))
}

/// The time of renders, and of the steps of the median one.
fn summary(runs: &[Run]) -> (Spread, Vec<StepTime>) {
    let seconds = Spread::of(runs.iter().map(|run| run.seconds));
    let median = runs.iter().find(|run| run.seconds == seconds.median);
    let steps = median.into_iter().flat_map(|run| &run.calls).map(|calls| {
        let same = runs.iter().flat_map(|run| &run.calls).filter(|other| other.name == calls.name);
        StepTime {
            name: calls.name.into(),
            calls: calls.count,
            seconds: calls.time.as_secs_f64(),
            spread: Spread::of(same.map(|calls| calls.time.as_secs_f64())),
        }
    });
    (seconds, steps.collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::{Effects, Method, Request};
    use crate::reference::Settings;
    use crate::voxel::VoxelSettings;
    use std::cell::Cell;
    use std::time::Duration;
    use twinlight_backend_cpu::CpuBackend;
    use twinlight_core::scene::{Limits, compile};

    fn with<T>(grid: u32, use_it: impl FnOnce(&CompiledScene, &Camera, &Plan) -> T) -> T {
        let room = twinlight_fixtures::scenes::builtin("cornell").unwrap();
        let compiled = compile(&room, &Limits::default()).unwrap();
        let camera = Camera::of_scene(&room).unwrap();
        let request = Request {
            method: Method::Voxel(VoxelSettings { grid, ..VoxelSettings::default() }),
            picture: Settings { width: 8, height: 8, samples: 2, ..Settings::default() },
            effects: Effects::Auto,
            tolerance: 1.0 / 255.0,
        };
        use_it(&compiled, &camera, &Plan::new(&compiled, &camera, &request).unwrap())
    }

    #[test]
    fn a_measurement_is_of_the_picture_that_the_plan_makes() {
        let measured = |grid| {
            with(grid, |scene, camera, plan| {
                let backend = CpuBackend::new();
                let effort = Effort { least: 3, most: 3, seconds: 0.0, until: None };
                let measured =
                    measure(&backend, scene, camera, plan, 1000, &effort, || true).unwrap().unwrap();
                let picture = plan.run(&backend, scene, camera, |_| Control::Continue).unwrap();
                assert_eq!(measured.radiance, picture.radiance());
                measured
            })
        };
        let (coarse, fine) = (measured(8), measured(32));
        assert!(coarse.bytes > 1000 && fine.bytes > coarse.bytes, "{} {}", coarse.bytes, fine.bytes);
        assert_eq!((coarse.runs, fine.runs), (3, 3));
        let steps: f64 = coarse.steps.iter().map(|step| step.seconds).sum();
        assert!(steps > 0.0 && steps <= coarse.seconds.median);
        for name in ["upload_scene", "voxelize", "trace_cones", "trace_paths"] {
            let step = coarse.steps.iter().find(|step| step.name == name).unwrap();
            assert!(step.calls > 0 && step.spread.least <= step.seconds && step.seconds <= step.spread.most);
        }
    }

    #[test]
    fn more_runs_until_the_time_is_up() {
        with(8, |scene, camera, plan| {
            let runs = |effort: Effort| {
                let counted = CpuBackend::new();
                let measured = measure(&counted, scene, camera, plan, 0, &effort, || true);
                measured.unwrap().unwrap().runs
            };
            assert_eq!(runs(Effort { least: 1, most: 4, seconds: 1e9, until: None }), 4);
            assert_eq!(runs(Effort { least: 2, most: 4, seconds: 0.0, until: None }), 2);
        });
    }

    #[test]
    fn one_run_is_enough_when_it_is_late() {
        let now = Instant::now();
        let late = Effort { until: Some(now), ..Effort::default() };
        let early = Effort { until: Some(now + Duration::from_secs(3600)), ..Effort::default() };
        assert!(late.wants_more(0, 0.0) && !late.wants_more(1, 0.0));
        assert!(early.wants_more(1, 9.0) && !early.wants_more(2, 9.0) && early.wants_more(4, 0.1));
    }

    /// Wherever a measurement is stopped, nothing half-measured comes out.
    #[test]
    fn a_stopped_measurement_is_none() {
        with(8, |scene, camera, plan| {
            let asked = Cell::new(0);
            let effort = Effort { least: 2, most: 2, seconds: 0.0, until: None };
            let run = |most: u32| {
                asked.set(0);
                let go_on = || {
                    asked.set(asked.get() + 1);
                    asked.get() <= most
                };
                measure(&CpuBackend::new(), scene, camera, plan, 0, &effort, go_on).unwrap().is_some()
            };
            assert!(run(u32::MAX));
            let all = asked.get();
            assert!((0..all).all(|most| !run(most)), "{all}");
        });
    }

    #[test]
    fn spreads() {
        let spread = Spread::of([3.0, 1.0, 2.0, 9.0]);
        assert_eq!((spread.median, spread.least, spread.most), (2.0, 1.0, 9.0));
        assert_eq!(Spread::of([]), Spread { median: 0.0, least: 0.0, most: 0.0 });
    }
}
