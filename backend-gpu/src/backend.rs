//! [`Backend`] on a [`GpuDevice`].

use crate::buffer::GpuBuffer;
use crate::device::{DeviceOptions, GpuDevice};
use crate::kernels::{scan, sort};
use crate::strict::Mode;
use bytemuck::Pod;
use twinlight_core::kernels::shade_primary::{GBufferTexel, ShadePrimaryParams};
use twinlight_core::kernels::trace::{Hit, Ray};
use twinlight_core::kernels::trace_paths::{FilmTexel, TracePathsParams};
use twinlight_core::scene::CompiledScene;
use twinlight_core::{Backend, BackendInfo, Error, Result};

/// The kernels in WGSL on one device.
#[derive(Debug, Clone)]
pub struct GpuBackend {
    device: GpuDevice,
}

/// A scene on a device.
#[derive(Debug)]
pub struct GpuScene {}

impl GpuBackend {
    /// Opens a device; see [`GpuDevice::open`].
    ///
    /// # Errors
    /// [`Error::BackendUnavailable`], [`Error::Unsupported`].
    pub fn open(options: &DeviceOptions) -> Result<Self> {
        GpuDevice::open(options).map(Self::new)
    }

    /// Runs the kernels on an open device.
    pub fn new(device: GpuDevice) -> Self {
        Self { device }
    }

    /// The device.
    pub fn device(&self) -> &GpuDevice {
        &self.device
    }

    fn without_twin<T>(&self, kernel: &str) -> Result<T> {
        Err(Error::Unsupported(format!("{kernel} has no WGSL twin in this build; use the CPU backend")))
    }
}

impl Backend for GpuBackend {
    type Buffer<T: Pod + Send + Sync> = GpuBuffer<T>;
    type Scene = GpuScene;

    fn info(&self) -> BackendInfo {
        let report = self.device.report();
        BackendInfo {
            kind: "gpu",
            device: report.name.clone(),
            driver: format!("{}, {} {}", report.backend, report.driver, report.driver_info)
                .trim_end()
                .to_owned(),
            strict: self.device.mode() == Mode::Strict,
        }
    }

    fn upload<T: Pod + Send + Sync>(&self, data: &[T]) -> Result<GpuBuffer<T>> {
        self.device.upload(data)
    }

    fn zeroed<T: Pod + Send + Sync>(&self, len: usize) -> Result<GpuBuffer<T>> {
        self.device.zeroed(len)
    }

    fn download<T: Pod + Send + Sync>(&self, buffer: &GpuBuffer<T>) -> Result<Vec<T>> {
        self.device.download(buffer)
    }

    fn len<T: Pod + Send + Sync>(&self, buffer: &GpuBuffer<T>) -> usize {
        buffer.len()
    }

    fn upload_scene(&self, _scene: &CompiledScene) -> Result<GpuScene> {
        self.without_twin("upload_scene")
    }

    fn scan(&self, input: &GpuBuffer<u32>, output: &mut GpuBuffer<u32>) -> Result<u32> {
        scan::run(&self.device, input, output)
    }

    fn sort_u32(&self, keys: &mut GpuBuffer<u32>, payload: &mut GpuBuffer<u32>) -> Result<()> {
        sort::run(&self.device, keys, payload)
    }

    fn sort_u64(&self, keys: &mut GpuBuffer<u64>, payload: &mut GpuBuffer<u32>) -> Result<()> {
        sort::run(&self.device, keys, payload)
    }

    fn trace_closest(&self, _: &GpuScene, _: &GpuBuffer<Ray>, _: &mut GpuBuffer<Hit>) -> Result<()> {
        self.without_twin("trace_closest")
    }

    fn trace_any(&self, _: &GpuScene, _: &GpuBuffer<Ray>, _: &mut GpuBuffer<u32>) -> Result<()> {
        self.without_twin("trace_any")
    }

    fn shade_primary(
        &self,
        _: &GpuScene,
        _: &ShadePrimaryParams,
        _: &mut GpuBuffer<GBufferTexel>,
    ) -> Result<()> {
        self.without_twin("shade_primary")
    }

    fn trace_paths(&self, _: &GpuScene, _: &TracePathsParams, _: &mut GpuBuffer<FilmTexel>) -> Result<()> {
        self.without_twin("trace_paths")
    }
}
