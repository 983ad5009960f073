// kernel family: shade_primary
// contract core/src/kernels/shade_primary.rs
// cpu backend-cpu/src/kernels/shade_primary.rs
// gpu backend-gpu/src/kernels/shade_primary.wgsl
// oracle conformance/src/oracle/shade_primary.rs
//! Host side of `shade_primary`.

use crate::buffer::{GpuBuffer, chunks};
use crate::device::GpuDevice;
use crate::kernels::status;
use crate::scene::GpuScene;
use crate::shared;
use crate::source::{KernelSource, WgslFile};
use bytemuck::{Pod, Zeroable};
use twinlight_core::kernels::shade_primary::{GBufferTexel, ShadePrimaryParams};
use twinlight_core::scene::EnvironmentHeader;
use twinlight_core::{Error, Result};

/// The WGSL.
pub const SOURCE: KernelSource = KernelSource {
    stem: "shade_primary",
    files: &[
        shared::DISPATCH,
        shared::HASH,
        shared::TRIG,
        shared::VECTOR,
        shared::SCENE,
        shared::INTERSECT,
        shared::TRAVERSE,
        shared::TEXTURE,
        shared::OFFSET,
        shared::SURFACE,
        shared::ENVIRONMENT,
        shared::LIGHT,
        WgslFile {
            path: "backend-gpu/src/kernels/shade_primary.wgsl",
            text: include_str!("shade_primary.wgsl"),
        },
    ],
};

/// Pixels per workgroup; twin of the WGSL constant.
pub const WORKGROUP_SIZE: u32 = 64;

/// Twin of the WGSL struct.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct ShadePrimaryBlock {
    /// The contract's parameters.
    pub call: ShadePrimaryParams,
    /// The scene's.
    pub environment: EnvironmentHeader,
    /// For `loops_run`.
    pub loop_rounds: u32,
    /// The pixels of the dispatch; `gbuffer` begins with the first of them.
    pub pixel_begin: u32,
    /// How many.
    pub pixel_count: u32,
    /// Unused, 0.
    pub padding: u32,
}

/// Fills a G-buffer; see the contract.
///
/// # Errors
/// [`Error::InvalidInput`] when the buffer has another size, [`Error::LimitExceeded`] beyond 2³² pixels,
/// [`Error::Unsupported`] when the driver ends loops early.
pub fn run(
    device: &GpuDevice,
    scene: &GpuScene,
    params: &ShadePrimaryParams,
    gbuffer: &mut GpuBuffer<GBufferTexel>,
) -> Result<()> {
    let pixels = u64::from(params.width) * u64::from(params.height);
    if pixels != gbuffer.len() as u64 {
        let what = format!(
            "G-buffer of {} texels for an image of {}x{}",
            gbuffer.len(),
            params.width,
            params.height
        );
        return Err(Error::invalid("shade_primary", what));
    }
    let pixels =
        u32::try_from(pixels).map_err(|_| Error::limit("pixels of one call", pixels, u32::MAX.into()))?;
    let pipeline = device.pipeline(&SOURCE, "shade_primary")?;
    let status = status::new(device)?;
    let mut recorder = device.record("shade what the camera sees");
    for chunk in chunks(pixels as usize, device.elements_per_binding(size_of::<GBufferTexel>())) {
        let block = ShadePrimaryBlock {
            call: *params,
            environment: scene.environment,
            loop_rounds: status::LOOP_ROUNDS,
            pixel_begin: chunk.start as u32,
            pixel_count: chunk.len() as u32,
            padding: 0,
        };
        let workgroups = block.pixel_count.div_ceil(WORKGROUP_SIZE);
        let buffers =
            scene.buffers_and(&[("gbuffer", gbuffer.binding_of(chunk)), ("status", status.binding())]);
        recorder.dispatch("shade", &pipeline, &block, &buffers, workgroups)?;
    }
    recorder.run()?;
    status::read(device, &status, "shade_primary")?;
    Ok(())
}
