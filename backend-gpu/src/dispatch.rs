//! Recording and running dispatches: buffers bound by the names of the WGSL variables, any number of workgroups.

use crate::buffer::BufferRef;
use crate::device::GpuDevice;
use crate::pipeline::Pipeline;
use crate::reflect::Access;
use bytemuck::Pod;
use std::sync::Arc;
use twinlight_core::{Error, Result};

/// Name of the one `var<uniform>` of every kernel.
const PARAMS: &str = "params";

/// A list of dispatches that run in order in one submission; each sees what those before it wrote.
#[derive(Debug)]
pub struct Recorder<'a> {
    device: &'a GpuDevice,
    label: &'a str,
    steps: Vec<Step<'a>>,
    /// The parameter blocks of all steps, each at the device's alignment.
    params: Vec<u8>,
}

#[derive(Debug)]
struct Step<'a> {
    label: &'a str,
    pipeline: Arc<Pipeline>,
    buffers: Vec<(u32, BufferRef<'a>)>,
    /// Offset and size of the parameter block.
    params: (u64, u64),
    workgroups: (u32, u32),
}

impl GpuDevice {
    /// Starts a submission. `label` says in a plain sentence what it does.
    pub fn record<'a>(&'a self, label: &'a str) -> Recorder<'a> {
        Recorder { device: self, label, steps: Vec::new(), params: Vec::new() }
    }
}

impl<'a> Recorder<'a> {
    /// Appends a dispatch of `workgroups` workgroups.
    ///
    /// `buffers` names every storage variable of the entry point, and may name others; `params` fills `var<uniform> params`. More workgroups
    /// than one dimension holds are folded into rows of equal length, so the last row may be longer than needed: the
    /// kernel takes `workgroup_id.y * num_workgroups.x + workgroup_id.x` as its index and returns beyond its count.
    ///
    /// # Errors
    /// [`Error::LimitExceeded`] when a buffer is larger than a binding may be, before the device is touched;
    /// [`Error::Internal`] when the buffers named are not those of the shader.
    pub fn dispatch<P: Pod>(
        &mut self,
        label: &'a str,
        pipeline: &Arc<Pipeline>,
        params: &P,
        buffers: &[(&str, BufferRef<'a>)],
        workgroups: u32,
    ) -> Result<()> {
        if workgroups == 0 {
            return Ok(());
        }
        let interface = &pipeline.interface;
        let mut bound = Vec::with_capacity(buffers.len());
        let mut params_range = (0, 0);
        for binding in &interface.bindings {
            if binding.access == Access::Uniform {
                let bytes = bytemuck::bytes_of(params);
                if binding.name != PARAMS || binding.min_bytes != bytes.len() as u64 {
                    return Err(
                        self.misuse(label, &format!("uniform {} of {} bytes", binding.name, bytes.len()))
                    );
                }
                params_range = self.push_params(bytes);
                continue;
            }
            let named = buffers.iter().find(|(name, _)| *name == binding.name);
            let Some(&(_, buffer)) = named else {
                return Err(self.misuse(label, &format!("no buffer for {}", binding.name)));
            };
            self.expect_bindable(&binding.name, buffer)?;
            bound.push((binding.binding, buffer));
        }
        let workgroups = fold(workgroups, self.device.report().limits.workgroups_per_dimension)?;
        let pipeline = Arc::clone(pipeline);
        self.steps.push(Step { label, pipeline, buffers: bound, params: params_range, workgroups });
        Ok(())
    }

    /// Runs everything recorded and waits for it.
    ///
    /// # Errors
    /// [`Error::DeviceLost`], [`Error::OutOfMemory`], or [`Error::Internal`] with wgpu's words.
    pub fn run(self) -> Result<()> {
        if self.steps.is_empty() {
            return self.device.check();
        }
        let commands = self.device.scoped(self.params.len() as u64, |device| self.encode(device))?;
        self.device.finish(commands)
    }

    fn encode(&self, device: &wgpu::Device) -> wgpu::CommandBuffer {
        let label = Some(self.label);
        let params = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("parameters"),
            size: self.params.len().max(16) as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        if !self.params.is_empty() {
            self.device.shared.queue.write_buffer(&params, 0, &self.params);
        }
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label });
        let mut pass =
            encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label, timestamp_writes: None });
        for step in &self.steps {
            pass.push_debug_group(step.label);
            pass.set_pipeline(&step.pipeline.raw);
            pass.set_bind_group(0, &step.bind_group(device, &params), &[]);
            pass.dispatch_workgroups(step.workgroups.0, step.workgroups.1, 1);
            pass.pop_debug_group();
        }
        drop(pass);
        encoder.finish()
    }

    fn push_params(&mut self, bytes: &[u8]) -> (u64, u64) {
        let alignment = self.device.shared.raw.limits().min_uniform_buffer_offset_alignment as usize;
        let begin = self.params.len().next_multiple_of(alignment);
        self.params.resize(begin, 0);
        self.params.extend_from_slice(bytes);
        self.params.resize(self.params.len().next_multiple_of(16), 0);
        (begin as u64, bytes.len() as u64)
    }

    fn expect_bindable(&self, name: &str, buffer: BufferRef<'_>) -> Result<()> {
        self.device.expect_own(buffer)?;
        let (bytes, limit) = (buffer.bytes, self.device.report().limits.storage_binding_bytes);
        if bytes > limit {
            let what = format!("bytes of {name} in one binding on {}", self.device.report().name);
            return Err(Error::limit(what, bytes, limit));
        }
        Ok(())
    }

    fn misuse(&self, label: &str, what: &str) -> Error {
        Error::Internal(format!("{} / {label}: {what}", self.label))
    }
}

impl Step<'_> {
    fn bind_group(&self, device: &wgpu::Device, params: &wgpu::Buffer) -> wgpu::BindGroup {
        let (offset, size) = self.params;
        let uniform =
            self.pipeline.interface.bindings.iter().find(|binding| binding.access == Access::Uniform);
        let uniform = uniform.map(|binding| wgpu::BindGroupEntry {
            binding: binding.binding,
            resource: wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                buffer: params,
                offset,
                size: std::num::NonZeroU64::new(size),
            }),
        });
        let storage = self.buffers.iter().map(|(binding, buffer)| wgpu::BindGroupEntry {
            binding: *binding,
            resource: wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                buffer: buffer.raw,
                offset: buffer.offset,
                size: std::num::NonZeroU64::new(buffer.bytes),
            }),
        });
        let entries: Vec<_> = uniform.into_iter().chain(storage).collect();
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(self.label),
            layout: &self.pipeline.layout,
            entries: &entries,
        })
    }
}

/// Columns and rows that hold `workgroups`, at most `limit` each.
fn fold(workgroups: u32, limit: u32) -> Result<(u32, u32)> {
    let limit = limit.max(1);
    let rows = workgroups.div_ceil(limit);
    if rows > limit {
        let most = u64::from(limit) * u64::from(limit);
        return Err(Error::limit("workgroups of one dispatch", u64::from(workgroups), most));
    }
    Ok((workgroups.div_ceil(rows.max(1)), rows))
}

#[cfg(test)]
mod tests {
    use super::fold;

    #[test]
    fn folding_covers_every_workgroup_within_the_limit() {
        for limit in [1, 2, 3, 7, 65535] {
            for workgroups in (1..200).chain([65535, 65536, 131_071, 4_000_000]) {
                match fold(workgroups, limit) {
                    Ok((columns, rows)) => {
                        assert!(columns <= limit && rows <= limit, "{workgroups} by {limit}");
                        let total = u64::from(columns) * u64::from(rows);
                        assert!(total >= u64::from(workgroups));
                        // Less than one row is wasted.
                        assert!(total < u64::from(workgroups) + u64::from(rows), "{workgroups} by {limit}");
                    }
                    Err(_) => assert!(u64::from(workgroups) > u64::from(limit) * u64::from(limit)),
                }
            }
        }
    }
}
