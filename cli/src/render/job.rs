//! What to render: flags before the scene's own settings before defaults.

use crate::args::{Bounces, ConeName, GatherName, MethodName, MissesName, RenderArgs, Size};
use crate::exit::{Failure, Stage};
use crate::source::Prepared;
use clap::ValueEnum;
use std::time::Duration;
use twinlight::Error;
use twinlight::kernels::shade_primary::GBufferTexel;
use twinlight::kernels::trace_paths::FilmTexel;
use twinlight::methods::reference::Settings;
use twinlight::methods::slhb::LookupSettings;
use twinlight::methods::voxel::VoxelSettings;
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
    /// How.
    pub method: MethodName,
    /// For slhb.
    pub lookups: LookupSettings,
    /// Window over which indirect light is averaged, pixels; 1 averages nothing.
    pub filter: u32,
    /// For voxel.
    pub voxels: VoxelSettings,
    /// For the method.
    pub settings: Settings,
    /// Time limit.
    pub time: Option<Duration>,
    /// Where from.
    pub camera: Camera,
}

impl Job {
    /// Merges flags and the scene's settings.
    ///
    /// # Errors
    /// [`Failure::Usage`] for flags of another method, [`Error::InvalidInput`] for settings of the scene file that make no sense, [`Error::LimitExceeded`] when the
    /// picture needs more memory than allowed.
    pub fn new(args: &RenderArgs, prepared: &Prepared) -> Result<Self, Failure> {
        let own = &prepared.settings;
        let input = |place: &str, what: String| Failure::Library(Stage::Input, Error::invalid(place, what));
        let method = match (args.method, own.method.as_deref()) {
            (Some(method), _) => method,
            (None, None) => MethodName::Reference,
            (None, Some(name)) => MethodName::from_str(name, false).map_err(|_| {
                input(
                    "render.method",
                    format!("no method is called '{name}'; there are reference, slhb and voxel"),
                )
            })?,
        };
        if let Some(flag) = args.slhb.asked_for().filter(|_| method != MethodName::Slhb) {
            let what = format!("{flag} is for --method slhb, and this is {}", method.key());
            return Err(Failure::Usage(what));
        }
        if let Some(flag) = args.voxel.asked_for().filter(|_| method != MethodName::Voxel) {
            let what = format!("{flag} is for --method voxel, and this is {}", method.key());
            return Err(Failure::Usage(what));
        }
        let size = args.size.or(own.size.map(|[w, h]| Size(w, h))).unwrap_or(Size(512, 512));
        let time = args.time.map(Duration::from_secs_f64);
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
        let bounces = args.bounces.map_or(own.bounces, |Bounces(bounces)| bounces);
        let seed = args.seed.or(own.seed).unwrap_or(0);
        let voxels = args.voxel.settings(bounces, seed);
        // Cones gather the rest.
        let sampled = if method == MethodName::Voxel { Some(voxels.bounces.min(1)) } else { bounces };
        let settings = Settings {
            width: size.0,
            height: size.1,
            samples,
            bounces: sampled,
            seed,
            sampler: args.sampler.into(),
            ..Settings::default()
        };
        let pixels = u64::from(size.0) * u64::from(size.1);
        let (needed, limit) = (pixels.saturating_mul(BYTES_PER_PIXEL), args.load.max_memory.0);
        if needed > limit {
            let what = format!("bytes for a picture of {}x{} pixels", size.0, size.1);
            return Err(Failure::Library(Stage::Input, Error::limit(what, needed, limit)));
        }
        let camera = Camera::of_scene(&prepared.scene);
        let camera =
            camera.ok_or_else(|| input("camera", "the scene has none and no bounds to frame".into()))?;
        let knobs = &args.slhb;
        let lookups = LookupSettings {
            directions: knobs.directions.clone(),
            size: knobs.lhb_size,
            layers: knobs.layers.0,
            elements: knobs.elements,
            cone: knobs.cone == ConeName::Auto,
            trace_misses: knobs.misses == MissesName::Trace,
            shadows: knobs.shadows.into(),
            gather: knobs.gather == GatherName::All,
            interleave: knobs.interleave,
        };
        Ok(Self { method, lookups, filter: knobs.filter, voxels, settings, time, camera })
    }

    /// How often light is scattered at most, whichever way it is followed.
    pub fn bounces(&self) -> Option<u32> {
        if self.method == MethodName::Voxel { Some(self.voxels.bounces) } else { self.settings.bounces }
    }
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
