// kernel family: trace_cones
// contract core/src/kernels/trace_cones.rs
// cpu backend-cpu/src/kernels/trace_cones.rs
// gpu backend-gpu/src/kernels/trace_cones.wgsl
// oracle conformance/src/oracle/trace_cones.rs
//! Host side of `trace_cones`.

use crate::backend::GpuBackend;
use crate::buffer::{GpuBuffer, chunks};
use crate::device::GpuDevice;
use crate::shared;
use crate::source::{KernelSource, WgslFile};
use bytemuck::{Pod, Zeroable};
use twinlight_core::Result;
use twinlight_core::kernels::reduce_mips::{VoxelLevels, word_starts};
use twinlight_core::kernels::trace_cones::{Cone, ConeLight, TraceConesBlock};

/// The WGSL.
pub const SOURCE: KernelSource = KernelSource {
    stem: "trace_cones",
    files: &[
        shared::DISPATCH,
        shared::MORTON,
        shared::CONE,
        WgslFile { path: "backend-gpu/src/kernels/trace_cones.wgsl", text: include_str!("trace_cones.wgsl") },
    ],
};

/// Cones per workgroup; twin of the WGSL constant.
pub const WORKGROUP_SIZE: u32 = 64;

/// Twin of the WGSL struct.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct TraceConesCall {
    /// What the caller asks for.
    pub call: TraceConesBlock,
    /// Voxels per axis of level 0.
    pub dims: [u32; 3],
    /// Number of levels.
    pub level_count: u32,
    /// First word of each level's mask.
    pub word_starts: [[u32; 4]; 3],
    /// Words of all values.
    pub value_words: u32,
    /// Number of cones.
    pub cone_count: u32,
    /// Unused, 0.
    pub padding: [u32; 2],
}

impl TraceConesCall {
    fn new(levels: &VoxelLevels<GpuBackend>, values: usize, params: &TraceConesBlock) -> Self {
        let grid = &levels.grid;
        let mut starts = [0; 12];
        for (start, word) in starts.iter_mut().zip(word_starts(grid.padded())) {
            *start = word as u32;
        }
        Self {
            call: *params,
            dims: grid.dims,
            level_count: grid.level_count(),
            word_starts: bytemuck::cast(starts),
            value_words: values as u32,
            cone_count: 0,
            padding: [0; 2],
        }
    }
}

/// Cones per submission: one that takes seconds looks like a device that hangs.
const SUBMISSION: usize = 1 << 18;

/// Runs the kernel; see the contract.
///
/// # Errors
/// As [`twinlight_core::Backend::trace_cones`]; [`twinlight_core::Error::LimitExceeded`] for levels and values beyond one binding.
pub fn run(
    device: &GpuDevice,
    levels: &VoxelLevels<GpuBackend>,
    values: &GpuBuffer<u32>,
    cones: &GpuBuffer<Cone>,
    params: &TraceConesBlock,
    light: &mut GpuBuffer<ConeLight>,
) -> Result<()> {
    params.check(levels, GpuBuffer::len, values.len(), [cones.len(), light.len()])?;
    device.expect_bindable::<u32>("ranks of voxels", levels.ranks.len())?;
    device.expect_bindable::<u32>("values of voxels", values.len())?;
    let pipeline = device.pipeline(&SOURCE, "trace_cones")?;
    let whole = TraceConesCall::new(levels, values.len(), params);
    for chunk in chunks(cones.len(), device.elements_per_binding(size_of::<Cone>()).min(SUBMISSION)) {
        let mut recorder = device.record("trace cones");
        let call = TraceConesCall { cone_count: chunk.len() as u32, ..whole };
        let buffers = [
            ("mask", levels.mask.binding()),
            ("ranks", levels.ranks.binding()),
            ("values", values.binding()),
            ("cones", cones.binding_of(chunk.clone())),
            ("light", light.binding_of(chunk)),
        ];
        let workgroups = call.cone_count.div_ceil(WORKGROUP_SIZE);
        recorder.dispatch("trace cones", &pipeline, &call, &buffers, workgroups)?;
        recorder.run()?;
    }
    Ok(())
}
