//! The reference: what every picture is judged by.

use super::pictures::Pictures;
use super::progress::State;
use super::setup::Setup;
use crate::exit::{Failure, Stage};
use std::cell::Cell;
use std::time::{Duration, Instant};
use twinlight::Backend;
use twinlight::methods::cost::Reference;
use twinlight::methods::post::image::Image;
use twinlight::methods::reference::{Progress, Settings, StopReason};

/// Most samples per pixel of a half, if nobody asks for more.
const MOST_SAMPLES: u32 = 4096;

/// The share of the time limit that the reference takes, if nobody asks for samples.
const SHARE: f64 = 0.25;

/// Added to the seed of what is measured: no number that is random here is random there.
const SEEDS: [u32; 2] = [0x5eed_0001, 0x5eed_0002];

/// The reference, and what it took.
pub struct Judge {
    /// By which.
    pub reference: Reference,
    /// What rendering it took; `None` if it was somebody's picture.
    pub taken: Option<Taken>,
}

/// Of a reference that was rendered.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Taken {
    /// Samples per pixel, of both halves together.
    pub samples: u32,
    /// Time for them.
    pub seconds: f64,
}

impl Judge {
    /// The picture of the flag, else the reference of an earlier run, else a new one; `None` after a signal.
    ///
    /// # Errors
    /// Pictures that can't be read or written, and what the backend refuses.
    pub fn find<B: Backend>(
        setup: &Setup,
        pictures: &Pictures,
        backend: &B,
    ) -> Result<Option<Self>, Failure> {
        let args = setup.args;
        if let Some(path) = &args.reference {
            let reference = pictures.read_reference(path, (args.size.0, args.size.1))?;
            return Ok(Some(Self { reference, taken: None }));
        }
        if let Some((reference, taken)) = pictures.kept_reference() {
            return Ok(Some(Self { reference, taken: Some(taken) }));
        }
        let state = State { spent: 0.0, limit: args.time_limit, points: 0, planned: 0 };
        setup.progress.begin(&state, "the reference");
        let start = Instant::now();
        let Some((first, samples)) = half(setup, backend, SEEDS[0])? else { return Ok(None) };
        let Some((second, more)) = half(setup, backend, SEEDS[1])? else { return Ok(None) };
        let taken = Taken { samples: samples + more, seconds: start.elapsed().as_secs_f64() };
        pictures.keep_reference(&first, &second, taken)?;
        let reference = Reference::of_halves(first, second).map_err(Failure::Pictures)?;
        Ok(Some(Self { reference, taken: Some(taken) }))
    }
}

/// Half of the reference, and the samples that each of its pixels has.
fn half<B: Backend>(setup: &Setup, backend: &B, seed: u32) -> Result<Option<(Image, u32)>, Failure> {
    let args = setup.args;
    let samples = args.reference_spp.map_or(MOST_SAMPLES, |spp| spp.div_ceil(2));
    let flags = vec![("--spp", samples.to_string())];
    let job = setup.job("reference", flags, args.seed.wrapping_add(seed))?;
    let mut plan = job.plan;
    let seconds = Duration::from_secs_f64(0.5 * SHARE * args.time_limit);
    let time = args.reference_spp.is_none().then_some(seconds);
    plan.request.picture = Settings { time, ..plan.request.picture };
    let whole = Cell::new(0);
    let observe = |progress: Progress| {
        whole.set(progress.samples);
        setup.control(progress)
    };
    let picture = plan.run(backend, &setup.prepared.compiled, &job.camera, observe);
    let picture = picture.map_err(Failure::at(Stage::Device))?;
    if picture.rendered.stop == StopReason::Cancelled {
        return Ok(None);
    }
    Ok(Some((setup.image(picture.radiance())?, whole.get())))
}
