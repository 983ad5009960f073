//! A device: opened on one adapter in one mode, with every failure a typed error and every wait bounded.

use crate::adapter::{self, AdapterReport, AdapterSelector};
use crate::pipeline::PipelineCache;
use crate::strict::Mode;
use std::fmt;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, OnceLock};
use std::time::Duration;
use twinlight_core::{Error, Result};

/// How to open a device.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DeviceOptions {
    /// Which adapter.
    pub adapter: AdapterSelector,
    /// Strict or portable; `None` takes strict where the adapter has it.
    pub mode: Option<Mode>,
    /// Longest wait for one submission; after it the device counts as lost.
    pub timeout: Duration,
    /// Upper bound on a storage binding, bytes, below the adapter's own: for memory budgets and tests.
    pub max_storage_binding_bytes: u64,
    /// Upper bound on a buffer, bytes, below the adapter's own.
    pub max_buffer_bytes: u64,
    /// Upper bound on workgroups per dimension, below the adapter's own.
    pub max_workgroups_per_dimension: u32,
}

impl Default for DeviceOptions {
    fn default() -> Self {
        Self {
            adapter: AdapterSelector::Auto,
            mode: None,
            timeout: Duration::from_secs(120),
            max_storage_binding_bytes: u64::MAX,
            max_buffer_bytes: u64::MAX,
            max_workgroups_per_dimension: u32::MAX,
        }
    }
}

/// The first fault outside any error scope, and why the device went away if it did.
#[derive(Debug, Default)]
struct Faults {
    lost: OnceLock<String>,
    uncaptured: OnceLock<String>,
}

/// An open device. Clones share it.
#[derive(Clone)]
pub struct GpuDevice {
    pub(crate) shared: Arc<Shared>,
}

pub(crate) struct Shared {
    pub(crate) raw: wgpu::Device,
    pub(crate) queue: wgpu::Queue,
    pub(crate) pipelines: PipelineCache,
    /// Tells the buffers of two devices apart.
    pub(crate) serial: u64,
    report: AdapterReport,
    mode: Mode,
    timeout: Duration,
    faults: Arc<Faults>,
}

impl fmt::Debug for GpuDevice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "GpuDevice({}, {})", self.shared.report, self.shared.mode.name())
    }
}

impl GpuDevice {
    /// Opens a device.
    ///
    /// # Errors
    /// [`Error::BackendUnavailable`] when no adapter fits or the driver refuses, [`Error::Unsupported`] when strict
    /// mode is asked of an adapter that has none.
    pub fn open(options: &DeviceOptions) -> Result<Self> {
        static NEXT_SERIAL: AtomicU64 = AtomicU64::new(0);
        let adapters = adapter::enumerate();
        let reports: Vec<AdapterReport> = adapters.iter().map(adapter::report).collect();
        let index = adapter::select(&reports, &options.adapter)?;
        let (adapter, mut report) = (&adapters[index], reports[index].clone());
        let mode = match options.mode {
            Some(Mode::Strict) if !report.strict => {
                return Err(Error::Unsupported(format!(
                    "strict mode on {report}: it takes no SPIR-V; use portable"
                )));
            }
            Some(mode) => mode,
            None if report.strict => Mode::Strict,
            None => Mode::Portable,
        };
        report.limits.buffer_bytes = report.limits.buffer_bytes.min(options.max_buffer_bytes);
        report.limits.storage_binding_bytes = report
            .limits
            .storage_binding_bytes
            .min(options.max_storage_binding_bytes)
            .min(report.limits.buffer_bytes);
        report.limits.workgroups_per_dimension =
            report.limits.workgroups_per_dimension.min(options.max_workgroups_per_dimension);

        let (raw, queue) = pollster::block_on(adapter.request_device(&descriptor(adapter, mode)))
            .map_err(|error| Error::BackendUnavailable { tried: format!("{report}: {error}") })?;
        let faults = watch(&raw);
        let serial = NEXT_SERIAL.fetch_add(1, Ordering::Relaxed);
        let pipelines = PipelineCache::default();
        let timeout = options.timeout;
        Ok(Self { shared: Arc::new(Shared { raw, queue, pipelines, serial, report, mode, timeout, faults }) })
    }

    /// The adapter, with the limits this device was opened with.
    pub fn report(&self) -> &AdapterReport {
        &self.shared.report
    }

    /// How this device compiles float arithmetic.
    pub fn mode(&self) -> Mode {
        self.shared.mode
    }

    /// The longest wait for one submission.
    pub fn timeout(&self) -> Duration {
        self.shared.timeout
    }

    /// Destroys the device, as a driver reset would: every later call returns [`Error::DeviceLost`].
    pub fn destroy(&self) {
        self.shared.raw.destroy();
        // The callback only runs at the next poll; the flag must stand when this returns.
        let _ = self.shared.faults.lost.set("the device was destroyed".into());
    }

    /// Fails if the device is lost or an error was reported outside any scope.
    pub(crate) fn check(&self) -> Result<()> {
        if let Some(reason) = self.shared.faults.lost.get() {
            return Err(Error::DeviceLost { reason: reason.clone(), retryable: true });
        }
        match self.shared.faults.uncaptured.get() {
            Some(error) => Err(Error::Internal(error.clone())),
            None => Ok(()),
        }
    }

    /// Runs `work` and turns the errors wgpu reports meanwhile into ours. `bytes` is what an allocation asks for.
    pub(crate) fn scoped<T>(&self, bytes: u64, work: impl FnOnce(&wgpu::Device) -> T) -> Result<T> {
        self.check()?;
        let device = &self.shared.raw;
        let internal = device.push_error_scope(wgpu::ErrorFilter::Internal);
        let memory = device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
        let validation = device.push_error_scope(wgpu::ErrorFilter::Validation);
        let done = work(device);
        let errors = [validation, memory, internal].map(|scope| pollster::block_on(scope.pop()));
        // A lost device shows as validation errors: name the cause, not the symptom.
        self.check()?;
        match errors.into_iter().flatten().next() {
            None => Ok(done),
            Some(wgpu::Error::OutOfMemory { .. }) => {
                Err(Error::OutOfMemory { device: self.shared.report.name.clone(), bytes })
            }
            Some(error) => Err(Error::Internal(format!("{} on {}", error, self.shared.report))),
        }
    }

    /// Submits and waits until the device has finished.
    ///
    /// # Errors
    /// [`Error::DeviceLost`] when it doesn't within the timeout.
    pub(crate) fn finish(&self, commands: wgpu::CommandBuffer) -> Result<()> {
        let shared = &self.shared;
        let index = self.scoped(0, |_| shared.queue.submit([commands]))?;
        let wait = wgpu::PollType::Wait { submission_index: Some(index), timeout: Some(shared.timeout) };
        let polled = self.scoped(0, |device| device.poll(wait))?;
        match polled {
            Ok(_) => Ok(()),
            Err(wgpu::PollError::Timeout) => {
                let reason = format!("no answer within {} s", shared.timeout.as_secs_f32());
                let _ = shared.faults.lost.set(reason.clone());
                Err(Error::DeviceLost { reason, retryable: true })
            }
            Err(error) => Err(Error::Internal(format!("waiting for {}: {error}", shared.report))),
        }
    }
}

/// WebGPU's default limits, lowered to what the adapter has, with its own buffer sizes.
fn descriptor(adapter: &wgpu::Adapter, mode: Mode) -> wgpu::DeviceDescriptor<'static> {
    let has = adapter.limits();
    let mut limits = wgpu::Limits::default().or_worse_values_from(&has);
    limits.max_buffer_size = has.max_buffer_size;
    limits.max_storage_buffer_binding_size = has.max_storage_buffer_binding_size;
    let software = adapter.get_info().device_type == wgpu::DeviceType::Cpu;
    wgpu::DeviceDescriptor {
        label: Some("twinlight"),
        required_features: match mode {
            Mode::Strict => wgpu::Features::PASSTHROUGH_SHADERS,
            Mode::Portable => wgpu::Features::empty(),
        },
        required_limits: limits,
        experimental_features: wgpu::ExperimentalFeatures::disabled(),
        // A software device takes its memory from the host's: don't let it reserve large blocks.
        memory_hints: if software { wgpu::MemoryHints::MemoryUsage } else { wgpu::MemoryHints::Performance },
        trace: wgpu::Trace::Off,
    }
}

/// Records what wgpu reports outside our calls; its default would be to panic.
fn watch(device: &wgpu::Device) -> Arc<Faults> {
    let faults = Arc::new(Faults::default());
    let seen = Arc::clone(&faults);
    device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
        let _ = seen.uncaptured.set(error.to_string());
    }));
    let seen = Arc::clone(&faults);
    device.set_device_lost_callback(move |reason, message| {
        // Dropping the last handle reports "destroyed" too; by then nobody is left to ask.
        let _ = seen.lost.set(format!("{reason:?}: {message}"));
    });
    faults
}
