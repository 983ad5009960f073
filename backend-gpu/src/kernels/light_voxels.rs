// kernel family: light_voxels
// contract core/src/kernels/light_voxels.rs
// cpu backend-cpu/src/kernels/light_voxels.rs
// gpu backend-gpu/src/kernels/light_voxels.wgsl
// oracle conformance/src/oracle/light_voxels.rs
//! Host side of `light_voxels`.

use crate::buffer::{BufferRef, GpuBuffer, chunks};
use crate::device::GpuDevice;
use crate::dispatch::Recorder;
use crate::kernels::status;
use crate::pipeline::Pipeline;
use crate::scene::GpuScene;
use crate::shared;
use crate::source::{KernelSource, WgslFile};
use bytemuck::{Pod, Zeroable};
use std::sync::Arc;
use twinlight_core::Result;
use twinlight_core::kernels::filter_indirect::RadianceTexel;
use twinlight_core::kernels::light_voxels::LightVoxelsBlock;
use twinlight_core::kernels::reduce_mips::VoxelLight;
use twinlight_core::kernels::sum_voxels::VoxelSums;
use twinlight_core::scene::EnvironmentHeader;

/// The WGSL.
pub const SOURCE: KernelSource = KernelSource {
    stem: "light_voxels",
    files: &[
        shared::DISPATCH,
        shared::HASH,
        shared::SOBOL,
        shared::TRIG,
        shared::VECTOR,
        shared::MORTON,
        shared::SCENE,
        shared::INTERSECT,
        shared::TRAVERSE,
        shared::OFFSET,
        shared::ENVIRONMENT,
        shared::LIGHT,
        shared::VOXEL_LIGHT,
        WgslFile {
            path: "backend-gpu/src/kernels/light_voxels.wgsl",
            text: include_str!("light_voxels.wgsl"),
        },
    ],
};

/// Voxels per workgroup; twin of the WGSL constant.
pub const WORKGROUP_SIZE: u32 = 64;
/// Samples per voxel and dispatch: as many rays as a path tracer's dispatch has per path.
const SAMPLES_PER_DISPATCH: u32 = 16;
/// Voxels per dispatch at most: a million rays.
const VOXELS_PER_DISPATCH: usize = 1 << 16;
/// Dispatches per submission at most, so that drivers don't take a slow one for one that hangs.
const DISPATCHES_PER_SUBMISSION: u32 = 8;

/// Twin of the WGSL struct.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct LightVoxelsParams {
    /// The contract's parameters.
    pub call: LightVoxelsBlock,
    /// The scene's.
    pub environment: EnvironmentHeader,
    /// The voxels of the dispatch, with which the bound buffers begin.
    pub voxel_count: u32,
    /// Its first sample.
    pub sample_begin: u32,
    /// The one after its last.
    pub sample_end: u32,
    /// Whether leaves hold irradiance.
    pub is_lit: u32,
    /// Whether any was gathered.
    pub has_gathered: u32,
    /// For `loops_run`.
    pub loop_rounds: u32,
    /// Unused, 0.
    pub padding: [u32; 2],
}

/// Lights voxels; see the contract. After an error of the device the leaves are void.
///
/// # Errors
/// As [`LightVoxelsBlock::check`]; [`twinlight_core::Error::Unsupported`] when the driver ends loops early.
pub fn run(
    device: &GpuDevice,
    scene: &GpuScene,
    active: &GpuBuffer<u32>,
    sums: &GpuBuffer<VoxelSums>,
    gathered: &GpuBuffer<RadianceTexel>,
    params: &LightVoxelsBlock,
    leaves: &mut GpuBuffer<VoxelLight>,
) -> Result<()> {
    let count = params.check([active.len(), sums.len(), gathered.len(), leaves.len()])?;
    let status = status::new(device)?;
    let samples = if scene.environment.light_count > 0 { params.samples } else { 0 };
    let block = LightVoxelsParams {
        call: *params,
        environment: scene.environment,
        voxel_count: 0,
        sample_begin: 0,
        sample_end: samples,
        is_lit: u32::from(samples > 0),
        has_gathered: u32::from(!gathered.is_empty()),
        loop_rounds: status::LOOP_ROUNDS,
        padding: [0; 2],
    };
    let mut lighting = Lighting {
        device,
        add_samples: device.pipeline(&SOURCE, "add_samples")?,
        write_leaves: device.pipeline(&SOURCE, "write_leaves")?,
        recorder: device.record("light voxels"),
        recorded: 0,
    };
    let most = device.elements_per_binding(size_of::<VoxelSums>()).min(VOXELS_PER_DISPATCH);
    for chunk in chunks(count, most) {
        let block = LightVoxelsParams { voxel_count: chunk.len() as u32, ..block };
        let light = if gathered.is_empty() { gathered.binding() } else { gathered.binding_of(chunk.clone()) };
        let buffers = scene.buffers_and(&[
            ("active_codes", active.binding_of(chunk.clone())),
            ("sums", sums.binding_of(chunk.clone())),
            ("gathered", light),
            ("leaves", leaves.binding_of(chunk)),
            ("status", status.binding()),
        ]);
        lighting.light(&block, &buffers)?;
    }
    lighting.recorder.run()?;
    status::read(device, &status, "light_voxels")?;
    Ok(())
}

struct Lighting<'a> {
    device: &'a GpuDevice,
    add_samples: Arc<Pipeline>,
    write_leaves: Arc<Pipeline>,
    recorder: Recorder<'a>,
    recorded: u32,
}

impl<'a> Lighting<'a> {
    /// All samples of the voxels in `buffers`, and their leaves.
    fn light(&mut self, block: &LightVoxelsParams, buffers: &[(&'static str, BufferRef<'a>)]) -> Result<()> {
        for begin in (0..block.sample_end).step_by(SAMPLES_PER_DISPATCH as usize) {
            let end = block.sample_end.min(begin + SAMPLES_PER_DISPATCH);
            let part = LightVoxelsParams { sample_begin: begin, sample_end: end, ..*block };
            let pipeline = Arc::clone(&self.add_samples);
            self.dispatch("add samples", &pipeline, &part, buffers)?;
        }
        let pipeline = Arc::clone(&self.write_leaves);
        self.dispatch("write leaves", &pipeline, block, buffers)
    }

    /// Records a dispatch, after those before it have been run where they are many.
    fn dispatch(
        &mut self,
        label: &'static str,
        pipeline: &Arc<Pipeline>,
        block: &LightVoxelsParams,
        buffers: &[(&'static str, BufferRef<'a>)],
    ) -> Result<()> {
        if self.recorded == DISPATCHES_PER_SUBMISSION {
            std::mem::replace(&mut self.recorder, self.device.record("light voxels")).run()?;
            self.recorded = 0;
        }
        self.recorded += 1;
        let workgroups = block.voxel_count.div_ceil(WORKGROUP_SIZE);
        self.recorder.dispatch(label, pipeline, block, buffers, workgroups)
    }
}
