//! Compute pipelines: layouts by reflection, one compilation per device and entry point.

use crate::device::GpuDevice;
use crate::reflect::{self, Access, Interface};
use crate::source::{CheckedModule, KernelSource};
use crate::strict::{self, Mode};
use std::collections::HashMap;
use std::num::NonZeroU64;
use std::sync::{Arc, Mutex, PoisonError};
use twinlight_core::{Error, Result};

/// A compiled entry point.
#[derive(Debug)]
pub struct Pipeline {
    /// What it binds.
    pub interface: Interface,
    pub(crate) raw: wgpu::ComputePipeline,
    pub(crate) layout: wgpu::BindGroupLayout,
}

/// What a device has compiled so far.
#[derive(Debug, Default)]
pub(crate) struct PipelineCache {
    modules: Mutex<HashMap<&'static str, Arc<CheckedModule>>>,
    pipelines: Mutex<HashMap<(&'static str, &'static str), Arc<Pipeline>>>,
}

impl GpuDevice {
    /// The pipeline of an entry point, compiled at its first use.
    ///
    /// # Errors
    /// [`Error::LimitExceeded`] when the kernel needs more than the adapter has, [`Error::Internal`] with the
    /// compiler's words, [`Error::DeviceLost`].
    pub fn pipeline(&self, source: &KernelSource, entry_point: &'static str) -> Result<Arc<Pipeline>> {
        let cache = &self.shared.pipelines;
        // Held while compiling, so that two threads don't compile the same kernel twice.
        let mut pipelines = cache.pipelines.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(pipeline) = pipelines.get(&(source.stem, entry_point)) {
            return Ok(Arc::clone(pipeline));
        }
        let checked = {
            let mut modules = cache.modules.lock().unwrap_or_else(PoisonError::into_inner);
            match modules.get(source.stem) {
                Some(checked) => Arc::clone(checked),
                None => {
                    let checked = Arc::new(source.check()?);
                    modules.insert(source.stem, Arc::clone(&checked));
                    checked
                }
            }
        };
        let pipeline = Arc::new(self.compile(&checked, entry_point)?);
        pipelines.insert((source.stem, entry_point), Arc::clone(&pipeline));
        Ok(pipeline)
    }

    fn compile(&self, checked: &CheckedModule, entry_point: &str) -> Result<Pipeline> {
        let interface = reflect::interface(checked, entry_point)?;
        self.expect_fit(&interface)?;
        let words = match self.mode() {
            Mode::Strict => Some(strict::compile(checked, &interface)?),
            Mode::Portable => None,
        };
        let label = Some(entry_point);
        let (raw, layout) = self.scoped(0, |device| {
            let entries: Vec<_> = interface.bindings.iter().map(layout_entry).collect();
            let layout = device
                .create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label, entries: &entries });
            let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label,
                bind_group_layouts: &[Some(&layout)],
                immediate_size: 0,
            });
            let module = match words {
                Some(words) => passthrough(device, &interface, words),
                None => device.create_shader_module(wgpu::ShaderModuleDescriptor {
                    label,
                    source: wgpu::ShaderSource::Wgsl(checked.text.as_str().into()),
                }),
            };
            let raw = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label,
                layout: Some(&pipeline_layout),
                module: &module,
                entry_point: label,
                compilation_options: wgpu::PipelineCompilationOptions {
                    constants: &[],
                    // Zeroing 16 KiB per workgroup costs more than most kernels; ours write before they read.
                    zero_initialize_workgroup_memory: false,
                },
                cache: None,
            });
            (raw, layout)
        })?;
        Ok(Pipeline { interface, raw, layout })
    }

    fn expect_fit(&self, interface: &Interface) -> Result<()> {
        let limits = self.report().limits;
        let storage =
            interface.bindings.iter().filter(|binding| binding.access != Access::Uniform).count() as u64;
        let invocations = interface.workgroup_size.iter().map(|&size| u64::from(size)).product();
        let needs = [
            ("storage buffers", storage, u64::from(limits.storage_buffers)),
            ("invocations per workgroup", invocations, u64::from(limits.workgroup_invocations)),
            ("bytes of workgroup memory", interface.workgroup_bytes, u64::from(limits.workgroup_bytes)),
        ];
        for (what, needed, limit) in needs {
            if needed > limit {
                return Err(Error::limit(format!("{what} of {}", interface.entry_point), needed, limit));
            }
        }
        Ok(())
    }
}

fn passthrough(device: &wgpu::Device, interface: &Interface, words: Vec<u32>) -> wgpu::ShaderModule {
    let [x, y, z] = interface.workgroup_size;
    let entry_point = wgpu::PassthroughShaderEntryPoint {
        name: interface.entry_point.as_str().into(),
        workgroup_size: (x, y, z),
    };
    let descriptor = wgpu::ShaderModuleDescriptorPassthrough {
        label: Some(interface.entry_point.as_str()),
        entry_points: vec![entry_point].into(),
        spirv: Some(words.into()),
        ..Default::default()
    };
    // SAFETY: the words are naga's translation of a module that naga validated, with every buffer and array access
    // clamped into range and every loop bounded; the decorations added only restrict the driver.
    unsafe { device.create_shader_module_passthrough(descriptor) }
}

fn layout_entry(binding: &reflect::Binding) -> wgpu::BindGroupLayoutEntry {
    let ty = match binding.access {
        Access::Uniform => wgpu::BufferBindingType::Uniform,
        Access::Read => wgpu::BufferBindingType::Storage { read_only: true },
        Access::ReadWrite => wgpu::BufferBindingType::Storage { read_only: false },
    };
    wgpu::BindGroupLayoutEntry {
        binding: binding.binding,
        visibility: wgpu::ShaderStages::COMPUTE,
        ty: wgpu::BindingType::Buffer {
            ty,
            has_dynamic_offset: false,
            // Checked by wgpu when a buffer is bound, in strict mode too.
            min_binding_size: NonZeroU64::new(binding.min_bytes),
        },
        count: None,
    }
}
