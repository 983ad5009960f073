// kernel family: trace
// contract core/src/kernels/trace.rs
// cpu backend-cpu/src/kernels/trace.rs
// gpu backend-gpu/src/kernels/trace.wgsl
// oracle conformance/src/oracle/trace.rs
//! Host side of `trace`.

use crate::buffer::{GpuBuffer, chunks};
use crate::device::GpuDevice;
use crate::kernels::status;
use crate::scene::GpuScene;
use crate::shared;
use crate::source::{KernelSource, WgslFile};
use bytemuck::{Pod, Zeroable};
use twinlight_core::kernels::trace::{Hit, Ray};
use twinlight_core::{Error, Result};

/// The WGSL.
pub const SOURCE: KernelSource = KernelSource {
    stem: "trace",
    files: &[
        shared::DISPATCH,
        shared::SCENE,
        shared::VECTOR,
        shared::TRIG,
        shared::INTERSECT,
        shared::TRAVERSE,
        WgslFile { path: "backend-gpu/src/kernels/trace.wgsl", text: include_str!("trace.wgsl") },
    ],
};

/// Rays per workgroup; twin of the WGSL constant.
pub const WORKGROUP_SIZE: u32 = 64;

/// Twin of the WGSL struct.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct TraceParams {
    /// Number of rays.
    pub ray_count: u32,
    /// For `loops_run`.
    pub loop_rounds: u32,
}

/// Closest hits; see the contract.
///
/// # Errors
/// [`Error::InvalidInput`] when the lengths differ, [`Error::LimitExceeded`] beyond 2³² rays,
/// [`Error::Unsupported`] when the driver ends loops early.
pub fn closest(
    device: &GpuDevice,
    scene: &GpuScene,
    rays: &GpuBuffer<Ray>,
    hits: &mut GpuBuffer<Hit>,
) -> Result<()> {
    run(device, scene, rays, "trace_closest", ("hits", hits))
}

/// Occlusion; see the contract.
///
/// # Errors
/// As [`closest`].
pub fn any(
    device: &GpuDevice,
    scene: &GpuScene,
    rays: &GpuBuffer<Ray>,
    occluded: &mut GpuBuffer<u32>,
) -> Result<()> {
    run(device, scene, rays, "trace_any", ("blocked", occluded))
}

fn run<T: Pod>(
    device: &GpuDevice,
    scene: &GpuScene,
    rays: &GpuBuffer<Ray>,
    entry_point: &'static str,
    (name, results): (&'static str, &GpuBuffer<T>),
) -> Result<()> {
    if rays.len() != results.len() {
        return Err(Error::invalid(entry_point, format!("{} rays, {} results", rays.len(), results.len())));
    }
    u32::try_from(rays.len())
        .map_err(|_| Error::limit("rays of one call", rays.len() as u64, u32::MAX.into()))?;
    let pipeline = device.pipeline(&SOURCE, entry_point)?;
    let status = status::new(device)?;
    let mut recorder = device.record("trace rays");
    for chunk in chunks(rays.len(), device.elements_per_binding(size_of::<Ray>().max(size_of::<T>()))) {
        let ray_count = chunk.len() as u32;
        let params = TraceParams { ray_count, loop_rounds: status::LOOP_ROUNDS };
        let buffers = scene.buffers_and(&[
            ("rays", rays.binding_of(chunk.clone())),
            ("status", status.binding()),
            (name, results.binding_of(chunk)),
        ]);
        recorder.dispatch(entry_point, &pipeline, &params, &buffers, ray_count.div_ceil(WORKGROUP_SIZE))?;
    }
    recorder.run()?;
    status::read(device, &status, entry_point)?;
    Ok(())
}
