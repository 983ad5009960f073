// kernel family: trace_paths
// contract core/src/kernels/trace_paths.rs
// cpu backend-cpu/src/kernels/trace_paths.rs
// gpu backend-gpu/src/kernels/trace_paths.wgsl
// oracle conformance/src/oracle/trace_paths.rs
//! Host side of `trace_paths`.

use crate::buffer::GpuBuffer;
use crate::device::GpuDevice;
use crate::kernels::path::{Batches, PathState, WORKGROUP_SIZE, follow, texels_of};
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
        shared::PATH,
        WgslFile { path: "backend-gpu/src/kernels/trace_paths.wgsl", text: include_str!("trace_paths.wgsl") },
    ],
};

/// Vertices per path and dispatch; twin of the WGSL constant.
pub const VERTICES_PER_DISPATCH: u32 = 8;
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
    let batches = Batches::new(device, params, size_of::<PathState>());
    let tracer = PathTracer {
        trace_segment: device.pipeline(&SOURCE, "trace_segment")?,
        add_samples: device.pipeline(&SOURCE, "add_samples")?,
        paths: device.zeroed(batches.paths())?,
        status: status::new(device)?,
        device,
        scene,
    };
    batches.of(params).try_for_each(|batch| tracer.run(&batch, film))
}

struct PathTracer<'a> {
    trace_segment: Arc<Pipeline>,
    add_samples: Arc<Pipeline>,
    paths: GpuBuffer<PathState>,
    status: GpuBuffer<u32>,
    device: &'a GpuDevice,
    scene: &'a GpuScene,
}

impl PathTracer<'_> {
    /// Traces the paths of one batch to their ends and adds them to the film.
    fn run(&self, batch: &TracePathsParams, film: &GpuBuffer<FilmTexel>) -> Result<()> {
        let (texels, film_begin) = texels_of(batch, film);
        let params = TracePathsBlock {
            call: *batch,
            environment: self.scene.environment,
            segment: 0,
            alive_word: 0,
            loop_rounds: status::LOOP_ROUNDS,
            film_begin,
        };
        let paths = ("paths", self.paths.binding());
        let buffers = self.scene.buffers_and(&[paths, ("status", self.status.binding())]);
        let path_groups = (batch.pixel_count * batch.sample_count).div_ceil(WORKGROUP_SIZE);
        let pixel_groups = batch.pixel_count.div_ceil(WORKGROUP_SIZE);
        // Every dispatch visits this many vertices, and the vertex after the last bounce ends a path.
        let most = batch.max_bounces.saturating_add(1).div_ceil(VERTICES_PER_DISPATCH);
        follow(
            self.device,
            "trace_paths",
            &self.status,
            most,
            |recorder, segment, alive_word| {
                let params = TracePathsBlock { segment, alive_word, ..params };
                recorder.dispatch("extend paths", &self.trace_segment, &params, &buffers, path_groups)
            },
            |recorder| {
                let buffers = [paths, ("film", texels)];
                recorder.dispatch("add samples", &self.add_samples, &params, &buffers, pixel_groups)
            },
        )
    }
}
