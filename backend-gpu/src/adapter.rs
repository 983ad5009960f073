//! Adapters: what is there, what it can do, which one to take.

use std::fmt;
use std::str::FromStr;
use twinlight_core::{Error, Result};

/// What this crate's kernels assume of an adapter: SwiftShader's limits, WebGPU's defaults, whichever is smaller.
const NEEDED_STORAGE_BUFFERS: u32 = 8;
const NEEDED_INVOCATIONS: u32 = 256;
const NEEDED_WORKGROUP_BYTES: u32 = 16 * 1024;

/// Which adapter to take.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum AdapterSelector {
    /// The first of the best kind: discrete GPU, integrated GPU, virtual GPU, software.
    #[default]
    Auto,
    /// By position in [`adapters`].
    Index(usize),
    /// The first whose name, driver or API contains this text, whatever the case.
    Name(String),
}

impl FromStr for AdapterSelector {
    type Err = std::convert::Infallible;

    /// `auto` or nothing, a number, or part of a name.
    fn from_str(text: &str) -> std::result::Result<Self, Self::Err> {
        Ok(match text.trim() {
            "" | "auto" => Self::Auto,
            other => other.parse().map_or_else(|_| Self::Name(other.to_owned()), Self::Index),
        })
    }
}

/// The limits of an adapter that decide what fits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AdapterLimits {
    /// Largest buffer, bytes.
    pub buffer_bytes: u64,
    /// Largest part of a buffer that a kernel can see at once, bytes.
    pub storage_binding_bytes: u64,
    /// Storage buffers per kernel.
    pub storage_buffers: u32,
    /// Invocations per workgroup.
    pub workgroup_invocations: u32,
    /// Workgroup memory, bytes.
    pub workgroup_bytes: u32,
    /// Workgroups per dimension of a dispatch.
    pub workgroups_per_dimension: u32,
}

/// One adapter, for reports.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct AdapterReport {
    /// Name given by the driver.
    pub name: String,
    /// Graphics API: `vulkan`, `metal`, `dx12`.
    pub backend: String,
    /// `discrete`, `integrated`, `virtual`, `cpu` or `other`.
    pub device_type: String,
    /// Driver name.
    pub driver: String,
    /// Driver version.
    pub driver_info: String,
    /// Its limits.
    pub limits: AdapterLimits,
    /// Whether strict mode can be had ([`crate::strict`]).
    pub strict: bool,
    /// Why no kernel can run here, if none can.
    pub unusable: Option<String>,
}

impl fmt::Display for AdapterReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{} ({}, {}, {} {})",
            self.name, self.backend, self.device_type, self.driver, self.driver_info
        )
    }
}

/// Every adapter of this machine, in the driver's order; an empty list when there is no driver.
pub fn adapters() -> Vec<AdapterReport> {
    enumerate().iter().map(report).collect()
}

pub(crate) fn enumerate() -> Vec<wgpu::Adapter> {
    let backends = wgpu::Backends::VULKAN | wgpu::Backends::METAL | wgpu::Backends::DX12;
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.backends = backends;
    // wgpu validates; the driver's own validation layers are for people who debug wgpu (WGPU_VALIDATION=1).
    descriptor.flags = wgpu::InstanceFlags::empty().with_env();
    pollster::block_on(wgpu::Instance::new(descriptor).enumerate_adapters(backends))
}

/// Position of the adapter that `selector` names.
///
/// # Errors
/// [`Error::BackendUnavailable`] with every adapter that was looked at.
pub fn select(reports: &[AdapterReport], selector: &AdapterSelector) -> Result<usize> {
    let usable = |index: &usize| reports[*index].unusable.is_none();
    let found = match selector {
        AdapterSelector::Auto => {
            (0..reports.len()).filter(usable).min_by_key(|&index| (rank(&reports[index].device_type), index))
        }
        AdapterSelector::Index(index) => Some(*index).filter(|&index| index < reports.len()),
        AdapterSelector::Name(text) => (0..reports.len()).find(|&index| matches(&reports[index], text)),
    };
    let refuse = |why: &str| Error::BackendUnavailable { tried: format!("{why}; {}", list(reports)) };
    let Some(index) = found else {
        return Err(refuse(&match selector {
            AdapterSelector::Auto => "no usable GPU adapter".to_owned(),
            AdapterSelector::Index(index) => format!("no GPU adapter {index}"),
            AdapterSelector::Name(text) => format!("no GPU adapter named like \"{text}\""),
        }));
    };
    match &reports[index].unusable {
        Some(why) => Err(refuse(&format!("GPU adapter {index} can't run the kernels: {why}"))),
        None => Ok(index),
    }
}

fn rank(device_type: &str) -> u32 {
    match device_type {
        "discrete" => 0,
        "integrated" => 1,
        "virtual" => 2,
        "cpu" => 3,
        _ => 4,
    }
}

fn matches(report: &AdapterReport, text: &str) -> bool {
    let text = text.to_lowercase();
    [&report.name, &report.driver, &report.driver_info, &report.backend]
        .iter()
        .any(|field| field.to_lowercase().contains(&text))
}

fn list(reports: &[AdapterReport]) -> String {
    if reports.is_empty() {
        return "no Vulkan, Metal or DirectX 12 driver offers any".to_owned();
    }
    let lines: Vec<String> =
        reports.iter().enumerate().map(|(index, report)| format!("{index}: {report}")).collect();
    format!("found {}", lines.join(", "))
}

pub(crate) fn report(adapter: &wgpu::Adapter) -> AdapterReport {
    let info = adapter.get_info();
    let limits = adapter.limits();
    let limits = AdapterLimits {
        buffer_bytes: limits.max_buffer_size,
        storage_binding_bytes: limits.max_storage_buffer_binding_size,
        storage_buffers: limits.max_storage_buffers_per_shader_stage,
        workgroup_invocations: limits.max_compute_invocations_per_workgroup,
        workgroup_bytes: limits.max_compute_workgroup_storage_size,
        workgroups_per_dimension: limits.max_compute_workgroups_per_dimension,
    };
    let device_type = match info.device_type {
        wgpu::DeviceType::DiscreteGpu => "discrete",
        wgpu::DeviceType::IntegratedGpu => "integrated",
        wgpu::DeviceType::VirtualGpu => "virtual",
        wgpu::DeviceType::Cpu => "cpu",
        wgpu::DeviceType::Other => "other",
    };
    // Passthrough takes SPIR-V on Vulkan alone; Metal and DirectX would want their own languages.
    let strict = info.backend == wgpu::Backend::Vulkan
        && adapter.features().contains(wgpu::Features::PASSTHROUGH_SHADERS);
    AdapterReport {
        name: info.name,
        backend: info.backend.to_string(),
        device_type: device_type.to_owned(),
        driver: info.driver,
        driver_info: info.driver_info,
        unusable: shortfall(&limits),
        limits,
        strict,
    }
}

fn shortfall(limits: &AdapterLimits) -> Option<String> {
    let needs = [
        ("storage buffers per kernel", limits.storage_buffers, NEEDED_STORAGE_BUFFERS),
        ("invocations per workgroup", limits.workgroup_invocations, NEEDED_INVOCATIONS),
        ("bytes of workgroup memory", limits.workgroup_bytes, NEEDED_WORKGROUP_BYTES),
    ];
    let (what, has, needs) = needs.into_iter().find(|&(_, has, needs)| has < needs)?;
    Some(format!("{has} {what}, needs {needs}"))
}
