//! What to render: flags before the scene's own settings before defaults.

use crate::args::{Bounces, RenderArgs, Size};
use crate::exit::{Failure, Stage};
use crate::source::Prepared;
use std::time::Duration;
use twinlight::Error;
use twinlight::kernels::shade_primary::GBufferTexel;
use twinlight::kernels::trace_paths::FilmTexel;
use twinlight::methods::reference::Settings;
use twinlight::scene::Camera;

/// The one method there is.
pub const METHOD: &str = "reference";

/// Samples per pixel when only the time is limited: never the first to end.
const UNLIMITED_SAMPLES: u32 = 1 << 24;

/// Bytes per pixel of what is held at once beside the scene: the film on the device, here and being merged, the
/// G-buffer, and the channels of an EXR twice, as planes and as a file.
const BYTES_PER_PIXEL: u64 =
    3 * size_of::<FilmTexel>() as u64 + 2 * size_of::<GBufferTexel>() as u64 + 2 * 19 * 4;

/// A render that was checked against the limits.
#[derive(Debug)]
pub struct Job {
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
    /// [`Error::InvalidInput`] for settings of the scene file that make no sense, [`Error::LimitExceeded`] when the
    /// picture needs more memory than allowed.
    pub fn new(args: &RenderArgs, prepared: &Prepared) -> Result<Self, Failure> {
        let own = &prepared.settings;
        let input = |place: &str, what: String| Failure::Library(Stage::Input, Error::invalid(place, what));
        if let Some(method) = own.method.as_deref().filter(|m| *m != METHOD && args.method.is_none()) {
            return Err(input("render.method", format!("no method is called '{method}'; there is {METHOD}")));
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
        let settings = Settings {
            width: size.0,
            height: size.1,
            samples,
            bounces: args.bounces.map_or(own.bounces, |Bounces(bounces)| bounces),
            seed: args.seed.or(own.seed).unwrap_or(0),
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
        Ok(Self { settings, time, camera })
    }
}
