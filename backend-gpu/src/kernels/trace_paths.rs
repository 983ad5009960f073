// kernel family: trace_paths
// contract core/src/kernels/trace_paths.rs
// cpu backend-cpu/src/kernels/trace_paths.rs
// gpu backend-gpu/src/kernels/trace_paths.wgsl
// oracle conformance/src/oracle/trace_paths.rs
//! Host side of `trace_paths`.

use crate::buffer::{CHUNK_GRAIN, GpuBuffer};
use crate::device::GpuDevice;
use crate::kernels::status;
use crate::pipeline::Pipeline;
use crate::scene::GpuScene;
use crate::shared;
use crate::source::{KernelSource, WgslFile};
use bytemuck::{Pod, Zeroable};
use std::sync::Arc;
use twinlight_core::Result;
use twinlight_core::kernels::trace_paths::{FilmTexel, TracePathsParams};
use twinlight_core::scene::EnvironmentHeader;

/// The WGSL.
pub const SOURCE: KernelSource = KernelSource {
    stem: "trace_paths",
    files: &[
        shared::DISPATCH,
        shared::HASH,
        shared::SOBOL,
        shared::FIXED,
        shared::TRIG,
        shared::VECTOR,
        shared::SCENE,
        shared::INTERSECT,
        shared::TRAVERSE,
        shared::TEXTURE,
        shared::OFFSET,
        shared::SURFACE,
        shared::BSDF,
        shared::ENVIRONMENT,
        shared::LIGHT,
        WgslFile { path: "backend-gpu/src/kernels/trace_paths.wgsl", text: include_str!("trace_paths.wgsl") },
    ],
};

/// Paths or pixels per workgroup; twin of the WGSL constant.
pub const WORKGROUP_SIZE: u32 = 64;
/// Vertices per path and dispatch; twin of the WGSL constant.
pub const VERTICES_PER_DISPATCH: u32 = 8;
/// Paths under way at once at most: 80 MiB of states. Fewer where a binding holds less.
pub const MAX_PATHS: u32 = 1 << 20;
/// Dispatches per submission: their counts of living paths are the words of `status` behind the first.
const SEGMENTS_PER_SUBMISSION: u32 = status::STATUS_WORDS as u32 - 1;

/// Twin of the WGSL struct.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct TracePathsBlock {
    /// The pixels and samples of the dispatch.
    pub call: TracePathsParams,
    /// The scene's.
    pub environment: EnvironmentHeader,
    /// 0 starts the paths, others go on.
    pub segment: u32,
    /// Word of `status` that counts the paths still alive.
    pub alive_word: u32,
    /// For `loops_run`.
    pub loop_rounds: u32,
    /// The pixel that `film` begins with.
    pub film_begin: u32,
}

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
    /// Unused, 0.
    pub padding_a: u32,
    /// Light scattered more often.
    pub indirect: [f32; 3],
    /// Unused, 0.
    pub padding_b: u32,
}

/// Adds samples to a film; see the contract. After an error the film's sums are void.
///
/// # Errors
/// [`twinlight_core::Error::InvalidInput`] for parameters that don't fit the film, `Unsupported` when the driver ends
/// loops early.
pub fn run(
    device: &GpuDevice,
    scene: &GpuScene,
    params: &TracePathsParams,
    film: &mut GpuBuffer<FilmTexel>,
) -> Result<()> {
    params.check(film.len())?;
    if params.pixel_count == 0 || params.sample_count == 0 {
        return Ok(());
    }
    let max_paths =
        (MAX_PATHS as usize).min(device.elements_per_binding(size_of::<PathState>())).max(1) as u32;
    // A batch's texels are bound from a grain's beginning on, up to a grain less one before its first.
    let texels = device.elements_per_binding(size_of::<FilmTexel>()).saturating_sub(CHUNK_GRAIN).max(1);
    let pixels = params.pixel_count.min(max_paths).min(u32::try_from(texels).unwrap_or(u32::MAX));
    let samples = (max_paths / pixels).min(params.sample_count);
    let tracer = PathTracer {
        trace_segment: device.pipeline(&SOURCE, "trace_segment")?,
        add_samples: device.pipeline(&SOURCE, "add_samples")?,
        paths: device.zeroed((pixels * samples) as usize)?,
        device,
        scene,
    };
    for pixel in (0..params.pixel_count).step_by(pixels as usize) {
        for sample in (0..params.sample_count).step_by(samples as usize) {
            let batch = TracePathsParams {
                pixel_begin: params.pixel_begin + pixel,
                pixel_count: pixels.min(params.pixel_count - pixel),
                sample_begin: params.sample_begin + sample,
                sample_count: samples.min(params.sample_count - sample),
                ..*params
            };
            tracer.run(&batch, film)?;
        }
    }
    Ok(())
}

struct PathTracer<'a> {
    trace_segment: Arc<Pipeline>,
    add_samples: Arc<Pipeline>,
    paths: GpuBuffer<PathState>,
    device: &'a GpuDevice,
    scene: &'a GpuScene,
}

impl PathTracer<'_> {
    /// Traces the paths of one batch to their ends and adds them to the film.
    fn run(&self, batch: &TracePathsParams, film: &GpuBuffer<FilmTexel>) -> Result<()> {
        let paths = batch.pixel_count * batch.sample_count;
        // Every dispatch visits this many vertices, and the vertex after the last bounce ends a path.
        let most = batch.max_bounces.saturating_add(1).div_ceil(VERTICES_PER_DISPATCH);
        let mut segment = 0;
        loop {
            let status = status::new(self.device)?;
            let count = SEGMENTS_PER_SUBMISSION.min(most - segment);
            let buffers =
                self.scene.buffers_and(&[("paths", self.paths.binding()), ("status", status.binding())]);
            let film_begin = batch.pixel_begin as usize / CHUNK_GRAIN * CHUNK_GRAIN;
            let film_end = (batch.pixel_begin + batch.pixel_count) as usize;
            let texels = film.binding_of(film_begin..film_end);
            let ends = [("paths", self.paths.binding()), ("film", texels)];
            let mut block = TracePathsBlock {
                call: *batch,
                environment: self.scene.environment,
                segment,
                alive_word: 0,
                loop_rounds: status::LOOP_ROUNDS,
                film_begin: film_begin as u32,
            };
            let mut recorder = self.device.record("trace paths");
            for word in 1..=count {
                block.segment = segment;
                block.alive_word = word;
                let workgroups = paths.div_ceil(WORKGROUP_SIZE);
                recorder.dispatch("extend paths", &self.trace_segment, &block, &buffers, workgroups)?;
                segment += 1;
            }
            let last = segment == most;
            let workgroups = batch.pixel_count.div_ceil(WORKGROUP_SIZE);
            if last {
                recorder.dispatch("add samples", &self.add_samples, &block, &ends, workgroups)?;
            }
            recorder.run()?;
            let words = status::read(self.device, &status, "trace_paths")?;
            if last {
                return Ok(());
            }
            if words[count as usize] == 0 {
                let mut recorder = self.device.record("add samples to the film");
                recorder.dispatch("add samples", &self.add_samples, &block, &ends, workgroups)?;
                return recorder.run();
            }
        }
    }
}
