//! What a camera sees, for what is done to pictures.

use twinlight_core::kernels::shade_primary::{GBufferTexel, ShadePrimaryParams};
use twinlight_core::scene::{Camera, CompiledScene};
use twinlight_core::{Backend, Result};

/// The G-buffer of `width` × `height` pixels of `scene` (resident on `backend` as `resident`), on the device.
///
/// # Errors
/// What the camera and the backend refuse.
pub fn gbuffer<B: Backend>(
    backend: &B,
    resident: &B::Scene,
    scene: &CompiledScene,
    camera: &Camera,
    (width, height): (u32, u32),
) -> Result<B::Buffer<GBufferTexel>> {
    let camera = camera.record(width, height, scene.origin)?;
    let params = ShadePrimaryParams { camera, width, height, padding: [0; 2] };
    let mut gbuffer = backend.zeroed::<GBufferTexel>(width as usize * height as usize)?;
    backend.shade_primary(resident, &params, &mut gbuffer)?;
    Ok(gbuffer)
}
