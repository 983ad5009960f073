//! `filter_indirect` against its CPU twin, bit for bit in strict mode, and in parts where a picture is beyond a binding.

use crate::{Check, Target, expect_same};
use libtest_mimic::Failed;
use twinlight_backend_cpu::CpuBackend;
use twinlight_backend_gpu::{DeviceOptions, GpuBackend, GpuDevice, Mode};
use twinlight_core::kernels::filter_indirect::{FilterIndirectParams, RadianceTexel};
use twinlight_core::{Backend, Error};
use twinlight_fixtures::inputs::surfaces;

pub const CHECKS: &[(&str, Check)] =
    &[("filters are those of the CPU twin", twins), ("d3: filters in parts", parts)];

/// The third material is not diffuse, the fourth has no entry.
const DIFFUSE: [u32; 3] = [1, 1, 0];

fn filtered<B: Backend>(
    backend: &B,
    (width, height): (u32, u32),
    window: u32,
) -> twinlight_core::Result<Vec<RadianceTexel>> {
    let params =
        FilterIndirectParams { width, height, window, least_cosine: 0.9, footprint: 0.1, padding: [0; 3] };
    let (gbuffer, light) = surfaces((width * height) as usize, u64::from(window));
    let mut output = backend.zeroed(light.len())?;
    let (gbuffer, light) = (backend.upload(&gbuffer)?, backend.upload(&light)?);
    backend.filter_indirect(&gbuffer, &backend.upload(&DIFFUSE)?, &light, &params, &mut output)?;
    backend.download(&output)
}

fn twins(target: &Target) -> Result<(), Failed> {
    let gpu = GpuBackend::new(target.device()?.clone());
    for (size, window) in
        [((0, 3), 8), ((1, 1), 32), ((61, 43), 1), ((61, 43), 4), ((100, 9), 9), ((33, 40), 32)]
    {
        let (got, want) = (filtered(&gpu, size, window)?, filtered(&CpuBackend::new(), size, window)?);
        // Elsewhere a neighbour at a limit is joined or not.
        if target.device()?.mode() == Mode::Strict {
            expect_same(&format!("{size:?}, window {window}"), &got, &want)?;
        }
    }
    Ok(())
}

/// A binding of 64 KiB holds 1024 texels of the G-buffer: of 61 a row, eight above and as many below a part leave it room for none.
fn parts(target: &Target) -> Result<(), Failed> {
    let options = DeviceOptions { max_storage_binding_bytes: 1 << 16, ..target.options.clone() };
    let small = GpuBackend::new(GpuDevice::open(&options)?);
    let gpu = GpuBackend::new(target.device()?.clone());
    for (size, window) in [((61, 90), 1), ((61, 90), 8), ((16, 333), 32)] {
        let (got, want) = (filtered(&small, size, window)?, filtered(&gpu, size, window)?);
        expect_same(&format!("{size:?}, window {window}"), &got, &want)?;
    }
    match filtered(&small, (61, 90), 16) {
        Err(Error::LimitExceeded { limit: 0x1_0000, .. }) => Ok(()),
        other => Err(format!("{:?}", other.map(|texels| texels.len())).into()),
    }
}
