//! The suite for this workspace's own backends, compiled with this crate. Compiling it takes most of a minute per backend, and
//! whoever calls [`crate::suite`] and [`crate::cross::checks`] with a type compiles them for it again.

use crate::cross::{CrossCheck, checks};
use crate::suite;
use crate::trial::{Options, Trial};
use twinlight_backend_cpu::CpuBackend;
#[cfg(feature = "gpu")]
use twinlight_backend_gpu::GpuBackend;

/// [`crate::suite`] on the CPU.
pub fn cpu_suite<'a>(backend: &'a CpuBackend, options: &'a Options) -> Vec<Trial<'a>> {
    suite(backend, options)
}

/// [`crate::suite`] on a GPU.
#[cfg(feature = "gpu")]
pub fn gpu_suite<'a>(backend: &'a GpuBackend, options: &'a Options) -> Vec<Trial<'a>> {
    suite(backend, options)
}

/// [`crate::cross::checks`] of two CPU backends.
pub fn cpu_checks() -> Vec<(&'static str, CrossCheck<CpuBackend, CpuBackend>)> {
    checks()
}

/// [`crate::cross::checks`] of a GPU against the CPU.
#[cfg(feature = "gpu")]
pub fn gpu_checks() -> Vec<(&'static str, CrossCheck<CpuBackend, GpuBackend>)> {
    checks()
}
