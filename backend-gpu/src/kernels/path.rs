//! What the kernels that follow paths share on the host: states, batches, and the submissions until all paths have ended.

use crate::buffer::{BufferRef, CHUNK_GRAIN, GpuBuffer};
use crate::device::GpuDevice;
use crate::dispatch::Recorder;
use crate::kernels::status;
use bytemuck::{Pod, Zeroable};
use twinlight_core::Result;
use twinlight_core::kernels::trace_paths::{FilmTexel, TracePathsParams};

/// Paths or pixels per workgroup; twin of the WGSL constant.
pub const WORKGROUP_SIZE: u32 = 64;
/// Paths under way at once at most: 80 to 144 MiB of states. Fewer where a binding holds less.
pub const MAX_PATHS: u32 = 1 << 20;
/// Segments per submission: their counts of living paths are the words of `status` behind the first.
const SEGMENTS_PER_SUBMISSION: u32 = status::STATUS_WORDS as u32 - 1;

/// Twin of the WGSL struct: a path between two dispatches.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct PathState {
    /// Start of the next ray.
    pub origin: [f32; 3],
    /// Density of the last scattering direction.
    pub pdf: f32,
    /// Direction of the next ray.
    pub direction: [f32; 3],
    /// Scattering vertices so far.
    pub vertices: u32,
    /// Product of weights.
    pub throughput: [f32; 3],
    /// 1 until the path ends.
    pub alive: u32,
    /// Light scattered at most once.
    pub direct: [f32; 3],
    /// The pixel whose numbers it draws.
    pub numbers_of: u32,
    /// Light scattered more often.
    pub indirect: [f32; 3],
    /// Unused, 0.
    pub padding_b: u32,
}

/// How a call is divided: pixels and samples per batch.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Batches {
    pixels: u32,
    samples: u32,
}

impl Batches {
    /// As large as states of `state_bytes` each allow. The call has pixels and samples.
    pub(crate) fn new(device: &GpuDevice, call: &TracePathsParams, state_bytes: usize) -> Self {
        let most = (MAX_PATHS as usize).min(device.elements_per_binding(state_bytes)).max(1) as u32;
        // A batch's texels are bound from a grain's beginning on, up to a grain less one before its first.
        let texels = device.elements_per_binding(size_of::<FilmTexel>()).saturating_sub(CHUNK_GRAIN).max(1);
        let pixels = call.pixel_count.min(most).min(u32::try_from(texels).unwrap_or(u32::MAX));
        Self { pixels, samples: (most / pixels).min(call.sample_count) }
    }

    /// Paths of a batch at most.
    pub(crate) fn paths(self) -> usize {
        (self.pixels * self.samples) as usize
    }

    pub(crate) fn of(self, call: &TracePathsParams) -> impl Iterator<Item = TracePathsParams> {
        let call = *call;
        (0..call.pixel_count).step_by(self.pixels as usize).flat_map(move |pixel| {
            (0..call.sample_count).step_by(self.samples as usize).map(move |sample| TracePathsParams {
                pixel_begin: call.pixel_begin + pixel,
                pixel_count: self.pixels.min(call.pixel_count - pixel),
                sample_begin: call.sample_begin + sample,
                sample_count: self.samples.min(call.sample_count - sample),
                ..call
            })
        })
    }
}

/// The texels of a batch, and the pixel that they begin with.
pub(crate) fn texels_of<'a>(
    batch: &TracePathsParams,
    film: &'a GpuBuffer<FilmTexel>,
) -> (BufferRef<'a>, u32) {
    let begin = batch.pixel_begin as usize / CHUNK_GRAIN * CHUNK_GRAIN;
    let end = (batch.pixel_begin + batch.pixel_count) as usize;
    (film.binding_of(begin..end), begin as u32)
}

/// Runs `segment` with 0, 1, … below `most` and the word of `status` that is to count the paths still alive, until there are
/// none; and `finish` at the end.
///
/// # Errors
/// As [`Recorder::run`] and [`status::read`].
pub(crate) fn follow<'a>(
    device: &'a GpuDevice,
    kernel: &str,
    status: &GpuBuffer<u32>,
    most: u32,
    segment: impl Fn(&mut Recorder<'a>, u32, u32) -> Result<()>,
    finish: impl Fn(&mut Recorder<'a>) -> Result<()>,
) -> Result<()> {
    let mut done = 0;
    loop {
        let count = SEGMENTS_PER_SUBMISSION.min(most - done);
        status::clear(device, status)?;
        let mut recorder = device.record("follow paths");
        for word in 1..=count {
            segment(&mut recorder, done, word)?;
            done += 1;
        }
        if done == most {
            finish(&mut recorder)?;
        }
        recorder.run()?;
        let words = status::read(device, status, kernel)?;
        if done == most {
            return Ok(());
        }
        if words[count as usize] == 0 {
            let mut recorder = device.record("add samples to the film");
            finish(&mut recorder)?;
            return recorder.run();
        }
    }
}
