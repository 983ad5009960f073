//! The part that needs a backend.

use super::job::Job;
use super::passes::{self, Stop, Taken};
use super::progress::Display;
use crate::args::RenderArgs;
use crate::device::Device;
use crate::exit::{Failure, Stage};
use crate::interrupt::Interrupt;
use crate::source::Prepared;
use std::time::{Duration, Instant};
use twinlight::cpu::CpuBackend;
#[cfg(feature = "gpu")]
use twinlight::gpu::GpuBackend;
use twinlight::methods::reference::{Control, Progress, Settings};
use twinlight::methods::{Surfaces, slhb};
use twinlight::{Backend, BackendInfo, Error};

/// Hit buffers, for the sidecar.
pub struct HitBuffers {
    /// To rasterize.
    pub time: Duration,
    /// Lines of the set of directions.
    pub views: usize,
    /// Of all lists.
    pub elements: usize,
    /// Of those, the ones kept from a frame before.
    pub kept: usize,
    /// To pack them and to read them back.
    pub pack_time: Duration,
    /// On the device, as they are stored.
    pub bytes: u64,
    /// Of what is read back of them for lookups.
    pub read_back_bytes: u64,
}

/// Lit voxels, for the sidecar.
pub struct Voxelized {
    /// Active voxels of the finest level.
    pub count: u32,
    /// Of levels and values.
    pub bytes: u64,
    /// To voxelize, sum up surfaces and list levels.
    pub voxelize_time: Duration,
    /// To light them.
    pub light_time: Duration,
    /// To reduce them.
    pub reduce_time: Duration,
}

/// What a backend made of a job.
pub struct Done {
    /// The samples.
    pub taken: Taken,
    /// What the camera sees, if it was looked at.
    pub surfaces: Option<Surfaces>,
    /// The method's hit buffers, where it has any.
    pub lookups: Option<HitBuffers>,
    /// The method's voxels, where it has any.
    pub voxels: Option<Voxelized>,
    /// What ran it.
    pub info: BackendInfo,
    /// Time to make the scene resident.
    pub upload_time: Duration,
}

/// Hit buffers of what stays from frame to frame, for whichever backend renders.
#[derive(Default)]
pub struct Kept {
    cpu: slhb::Kept<CpuBackend>,
    #[cfg(feature = "gpu")]
    gpu: slhb::Kept<GpuBackend>,
}

/// Renders on `device`; if that was our own choice and it can't hold the scene, on the CPU.
///
/// # Errors
/// What the backend and the method refuse.
pub fn render(
    device: &Device,
    args: &RenderArgs,
    prepared: &Prepared,
    job: &Job,
    interrupt: &Interrupt,
    kept: &mut Kept,
    display: &mut Display,
    tell: &mut impl FnMut(String),
) -> Result<Done, Failure> {
    let mut session = Session { args, prepared, job, interrupt, display };
    let done = match device {
        Device::Cpu(backend) => session.run(backend, &mut kept.cpu, tell),
        #[cfg(feature = "gpu")]
        Device::Gpu(backend) => match session.run(&**backend, &mut kept.gpu, tell) {
            Err(error)
                if args.device.backend == crate::args::BackendChoice::Auto && fits_elsewhere(&error) =>
            {
                tell(format!("{} can't render this, the CPU does: {error}", backend.info().device));
                session.run(&crate::device::cpu(args.device.threads)?, &mut kept.cpu, tell)
            }
            other => other,
        },
    };
    done.map_err(Failure::at(Stage::Device))
}

/// Whether another backend may do what this one refused.
#[cfg(feature = "gpu")]
fn fits_elsewhere(error: &Error) -> bool {
    matches!(error, Error::Unsupported(_) | Error::LimitExceeded { .. } | Error::OutOfMemory { .. })
}

struct Session<'a> {
    args: &'a RenderArgs,
    prepared: &'a Prepared<'a>,
    job: &'a Job,
    interrupt: &'a Interrupt,
    display: &'a mut Display,
}

impl Session<'_> {
    fn run<B: Backend>(
        &mut self,
        backend: &B,
        kept: &mut slhb::Kept<B>,
        tell: &mut impl FnMut(String),
    ) -> twinlight::Result<Done> {
        let plan = &self.job.plan;
        let scene = &*plan.edits.apply(&self.prepared.compiled);
        let start = Instant::now();
        let resident = backend.upload_scene(scene)?;
        let upload_time = start.elapsed();

        // Keeping takes memory, and a single picture has no use for it.
        let kept = self.args.frames.is_some().then_some(kept);
        let built = plan.build(backend, &resident, scene, kept)?;
        let lit = &built.voxels;
        if let Some(lit) = lit.as_ref().filter(|lit| lit.saturated > 0) {
            let (saturated, all) = (lit.saturated, lit.voxels());
            tell(format!(
                "{saturated} of {all} voxels are too bright for their integers: light is missing near lamps"
            ));
        }
        let lookups = built.buffers.as_ref().map(|buffers| HitBuffers {
            time: buffers.build_time,
            views: buffers.views.len(),
            elements: buffers.elements(backend),
            kept: buffers.kept_elements,
            pack_time: buffers.pack_time,
            bytes: buffers.bytes(backend),
            read_back_bytes: buffers.read_back_bytes,
        });

        let caught = || self.interrupt.caught();
        let observe = |progress| self.display.update(&progress);
        let sampled = |settings: &Settings, observe: &mut dyn FnMut(Progress) -> Control| {
            plan.sample(backend, &resident, scene, &built, &self.job.camera, settings, observe)
        };
        let taken = passes::take(self.job, sampled, caught, observe);
        self.display.clear();
        let taken = taken?;
        // Of a sequence, complete frames are saved and no others.
        let saved = self.args.frames.is_none();
        if let Some(lost) = taken.lost.as_ref().filter(|_| saved) {
            tell(format!("{lost}; what was finished before is saved"));
        }

        // A lost device answers nothing more, and an interrupted user waits for nothing more.
        let wanted = matches!(taken.stop, Stop::Samples | Stop::Time);
        if !wanted && saved {
            tell(format!("{}: the render ended early ({})", self.missing(), taken.stop.name()));
        }
        let (camera, film) = (&self.job.camera, &taken.film);
        let surfaces = wanted.then(|| plan.surfaces(backend, &resident, scene, &built, camera, film));
        let surfaces = match surfaces {
            None => None,
            Some(Ok(surfaces)) => Some(surfaces),
            // What was sampled is a picture without them.
            Some(Err(
                why @ (Error::Unsupported(_) | Error::LimitExceeded { .. } | Error::OutOfMemory { .. }),
            )) => {
                tell(format!("{}: {why}", self.missing()));
                None
            }
            Some(Err(error)) => return Err(error),
        };
        let voxels = lit.as_ref().map(|lit| Voxelized {
            count: lit.voxels(),
            bytes: lit.bytes(backend),
            voxelize_time: lit.voxelize_time,
            light_time: lit.light_time,
            reduce_time: lit.reduce_time,
        });
        Ok(Done { taken, surfaces, lookups, voxels, info: backend.info(), upload_time })
    }

    /// What a picture lacks without [`Surfaces`].
    fn missing(&self) -> &'static str {
        let plan = &self.job.plan;
        if plan.voxels.is_some() {
            "no albedo, normal, depth and id layers, and no indirect light"
        } else if plan.filter > 1 {
            "no albedo, normal, depth and id layers, and indirect light is not filtered"
        } else {
            "no albedo, normal, depth and id layers"
        }
    }
}
