//! What to render: flags before the scene's own settings before defaults.

use crate::args::{Bounces, ConeName, GatherName, MethodName, MissesName, PictureArgs, Size, SlhbArgs};
use crate::budget::{Chosen, Wish};
use crate::exit::{Failure, Stage};
use crate::source::Prepared;
use clap::ValueEnum;
use std::time::{Duration, Instant};
use twinlight::Error;
use twinlight::kernels::shade_primary::GBufferTexel;
use twinlight::kernels::trace_paths::FilmTexel;
use twinlight::methods::plan::{Method, Plan, Request};
use twinlight::methods::reference::Settings;
use twinlight::methods::slhb::LookupSettings;
use twinlight::scene::Camera;

/// Samples per pixel when only the time is limited: never the first to end.
const UNLIMITED_SAMPLES: u32 = 1 << 24;

/// Bytes per pixel of what is held at once beside the scene: the film on the device, here and being merged, the
/// G-buffer, and the channels of an EXR twice, as planes and as a file.
const BYTES_PER_PIXEL: u64 =
    3 * size_of::<FilmTexel>() as u64 + 2 * size_of::<GBufferTexel>() as u64 + 2 * 19 * 4;

/// A render that was checked against the limits.
#[derive(Debug)]
pub struct Job {
    /// What to do.
    pub plan: Plan,
    /// Time to make the plan.
    pub plan_time: Duration,
    /// When work on the compiled scene began.
    pub begin: Instant,
    /// Time limit of sampling.
    pub time: Option<Duration>,
    /// When sampling is to end, whenever it began.
    pub deadline: Option<Instant>,
    /// What method and knobs were chosen by, if they were.
    pub chosen: Option<(Wish, Chosen)>,
    /// Where from.
    pub camera: Camera,
}

impl Job {
    /// Merges flags and the scene's settings.
    ///
    /// # Errors
    /// [`Failure::Usage`] for flags of another method, [`Error::InvalidInput`] for settings of the scene file that make no sense, [`Error::LimitExceeded`] when the
    /// picture needs more memory than allowed.
    pub fn new(args: &PictureArgs, time: Option<f64>, prepared: &Prepared) -> Result<Self, Failure> {
        let method = method(args, prepared)?;
        let time = time.map(Duration::from_secs_f64);
        let picture = picture(args, time, prepared)?;
        check_memory(&picture, args.load.max_memory.0)?;
        let camera = Camera::of_scene(&prepared.scene);
        let camera =
            camera.ok_or_else(|| input("camera", "the scene has none and no bounds to frame".into()))?;
        let request = Request {
            tolerance: tolerance(args, method),
            method: settings(args, method, &picture),
            picture,
            effects: args.effects.clone(),
        };
        let start = Instant::now();
        let plan = Plan::new(&prepared.compiled, &camera, &request).map_err(Failure::at(Stage::Input))?;
        Ok(Self {
            plan,
            plan_time: start.elapsed(),
            begin: start,
            time,
            deadline: None,
            chosen: None,
            camera,
        })
    }

    /// Everything is to be done at `begin` + `budget`, of which work after sampling takes `after`.
    pub fn end_by(&mut self, begin: Instant, budget: Duration, after: Duration) {
        self.begin = begin;
        self.deadline = Some(begin + budget.saturating_sub(after));
        let picture = &mut self.plan.request.picture;
        // A pass can't be ended: the last one may be a twentieth too long.
        picture.pass = picture.pass.min(budget / 20);
    }

    /// Of the picture.
    pub fn settings(&self) -> &Settings {
        &self.plan.request.picture
    }
}

fn input(place: &str, what: String) -> Failure {
    Failure::Library(Stage::Input, Error::invalid(place, what))
}

/// The flag's method, else the scene's, and no flags of others.
fn method(args: &PictureArgs, prepared: &Prepared) -> Result<MethodName, Failure> {
    let method = match (args.method, prepared.settings.method.as_deref()) {
        (Some(method), _) => method,
        (None, None) => MethodName::Reference,
        (None, Some(name)) => MethodName::from_str(name, false).map_err(|_| {
            let what = format!("no method is called '{name}'; there are reference, slhb and voxel");
            input("render.method", what)
        })?,
    };
    let others = [(args.slhb.asked_for(), MethodName::Slhb), (args.voxel.asked_for(), MethodName::Voxel)];
    for (flag, owner) in others {
        if let Some(flag) = flag.filter(|_| method != owner) {
            let what = format!("{flag} is for --method {}, and this is {}", owner.key(), method.key());
            return Err(Failure::Usage(what));
        }
    }
    Ok(method)
}

/// Size, samples and bounces: of the flags, else of the scene, else the usual.
fn picture(args: &PictureArgs, time: Option<Duration>, prepared: &Prepared) -> Result<Settings, Failure> {
    let own = &prepared.settings;
    let size = args.size.or(own.size.map(|[w, h]| Size(w, h))).unwrap_or(Size(512, 512));
    let samples = match (args.spp, time) {
        (Some(spp), _) => spp,
        (None, Some(_)) => UNLIMITED_SAMPLES,
        (None, None) => own.spp.unwrap_or(64),
    };
    if samples == 0 || samples > UNLIMITED_SAMPLES {
        return Err(input("render.spp", format!("{samples} is not within 1 and {UNLIMITED_SAMPLES}")));
    }
    let samples = if args.slhb.gather == GatherName::All {
        rounds_of(args.slhb.directions.len() as u32, samples, args.spp)?
    } else {
        samples
    };
    Ok(Settings {
        width: size.0,
        height: size.1,
        samples,
        bounces: args.bounces.map_or(own.bounces, |Bounces(bounces)| bounces),
        seed: args.seed.or(own.seed).unwrap_or(0),
        sampler: args.sampler.into(),
        ..Settings::default()
    })
}

fn check_memory(picture: &Settings, limit: u64) -> Result<(), Failure> {
    let pixels = u64::from(picture.width) * u64::from(picture.height);
    let needed = pixels.saturating_mul(BYTES_PER_PIXEL);
    if needed > limit {
        let what = format!("bytes for a picture of {}x{} pixels", picture.width, picture.height);
        return Err(Failure::Library(Stage::Input, Error::limit(what, needed, limit)));
    }
    Ok(())
}

fn settings(args: &PictureArgs, method: MethodName, picture: &Settings) -> Method {
    match method {
        MethodName::Reference => Method::Reference,
        MethodName::Slhb => Method::Slhb { lookups: lookups(&args.slhb), filter: args.slhb.filter },
        MethodName::Voxel => Method::Voxel(args.voxel.settings(picture.bounces, picture.seed)),
    }
}

/// What the flags say about hit buffers.
pub fn lookups(knobs: &SlhbArgs) -> LookupSettings {
    LookupSettings {
        directions: knobs.directions.clone(),
        size: knobs.lhb_size,
        layers: knobs.layers.0,
        elements: knobs.elements,
        cone: knobs.cone == ConeName::Auto,
        trace_misses: knobs.misses == MissesName::Trace,
        shadows: knobs.shadows.into(),
        gather: knobs.gather == GatherName::All,
        interleave: knobs.interleave,
    }
}

/// Radiance that a pixel may lack: a share of what the exposure makes white. What the others are judged by leaves out only what isn't there.
fn tolerance(args: &PictureArgs, method: MethodName) -> f64 {
    let usual = if method == MethodName::Reference { 0.0 } else { 1.0 / 255.0 };
    args.tolerance.unwrap_or(usual) * (-args.tone.exposure).exp2()
}

/// Samples in which each direction has the same share: `samples` rounded up, unless they were asked for.
fn rounds_of(directions: u32, samples: u32, asked: Option<u32>) -> Result<u32, Failure> {
    let rounded = samples.div_ceil(directions).saturating_mul(directions).min(UNLIMITED_SAMPLES);
    match asked {
        Some(spp) if !spp.is_multiple_of(directions) => Err(Failure::Usage(format!(
            "--spp {spp}: --gather all shares samples among {directions} directions: ask for {rounded}, or another multiple"
        ))),
        _ => Ok(rounded),
    }
}
