//! Choosing the backend.

use crate::args::{BackendChoice, DeviceArgs, ModeName};
use crate::exit::{Failure, Stage};
use twinlight::cpu::CpuBackend;
#[cfg(feature = "gpu")]
use twinlight::gpu::{self, AdapterSelector, DeviceOptions, GpuBackend};

/// A backend, open.
pub enum Device {
    /// Kernels on rayon.
    Cpu(CpuBackend),
    /// Kernels on wgpu.
    #[cfg(feature = "gpu")]
    Gpu(Box<GpuBackend>),
}

/// Opens the backend that flags name; the second value is a notice about what could not be had.
///
/// # Errors
/// [`twinlight::Error::BackendUnavailable`] and what opening a device refuses.
pub fn open(args: &DeviceArgs) -> Result<(Device, Option<String>), Failure> {
    let (mode, threads) = (args.mode, args.threads);
    match &args.backend {
        BackendChoice::Cpu => Ok((Device::Cpu(cpu(threads)?), None)),
        BackendChoice::Gpu(selector) => gpu(selector, mode),
        BackendChoice::Auto => auto(mode, threads),
    }
}

/// The CPU backend.
///
/// # Errors
/// When the system refuses the threads.
pub fn cpu(threads: Option<u16>) -> Result<CpuBackend, Failure> {
    match threads {
        Some(threads) => CpuBackend::with_threads(threads.into()).map_err(Failure::at(Stage::Device)),
        None => Ok(CpuBackend::new()),
    }
}

#[cfg(feature = "gpu")]
fn auto(mode: Option<ModeName>, threads: Option<u16>) -> Result<(Device, Option<String>), Failure> {
    // A software adapter runs on the same processor, slower than the CPU backend.
    let reports = gpu::adapters();
    let hardware = |r: &gpu::AdapterReport| matches!(&*r.device_type, "discrete" | "integrated" | "virtual");
    let rank = |r: &gpu::AdapterReport| {
        ["discrete", "integrated", "virtual"].iter().position(|t| r.device_type == *t)
    };
    let best = reports
        .iter()
        .enumerate()
        .filter(|(_, r)| hardware(r) && r.unusable.is_none())
        .min_by_key(|(_, r)| rank(r));
    let Some((index, report)) = best else { return Ok((Device::Cpu(cpu(threads)?), None)) };
    match open_gpu(AdapterSelector::Index(index), mode) {
        Ok(device) => Ok((device, None)),
        Err(failure) => Ok((
            Device::Cpu(cpu(threads)?),
            Some(format!("{report} could not be used, the CPU is: {failure}")),
        )),
    }
}

#[cfg(not(feature = "gpu"))]
fn auto(_: Option<ModeName>, threads: Option<u16>) -> Result<(Device, Option<String>), Failure> {
    Ok((Device::Cpu(cpu(threads)?), None))
}

#[cfg(feature = "gpu")]
fn gpu(selector: &str, mode: Option<ModeName>) -> Result<(Device, Option<String>), Failure> {
    // Parsing a selector can't fail: what is no number is a name.
    let selector = selector.parse().unwrap_or_default();
    let device = open_gpu(selector, mode)?;
    let notice = match &device {
        Device::Gpu(backend) if backend.device().report().device_type == "cpu" => {
            let name = &backend.device().report().name;
            Some(format!("{name} is a GPU in software, many times slower than --backend cpu"))
        }
        _ => None,
    };
    Ok((device, notice))
}

#[cfg(feature = "gpu")]
fn open_gpu(adapter: AdapterSelector, mode: Option<ModeName>) -> Result<Device, Failure> {
    let mode = mode.map(|mode| match mode {
        ModeName::Strict => gpu::Mode::Strict,
        ModeName::Portable => gpu::Mode::Portable,
    });
    let options = DeviceOptions { adapter, mode, ..DeviceOptions::default() };
    let backend = GpuBackend::open(&options).map_err(Failure::at(Stage::Device))?;
    Ok(Device::Gpu(Box::new(backend)))
}

#[cfg(not(feature = "gpu"))]
fn gpu(_: &str, _: Option<ModeName>) -> Result<(Device, Option<String>), Failure> {
    let tried = "gpu: this twinlight was built without GPU support".into();
    Err(Failure::Library(Stage::Device, twinlight::Error::BackendUnavailable { tried }))
}
