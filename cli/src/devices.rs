//! `devices`: what kernels can run on.

use crate::exit::Failure;
use crate::report;
use serde_json::{Value, json};
use twinlight::Backend;
use twinlight::cpu::CpuBackend;

/// Runs the command.
///
/// # Errors
/// When stdout can't be written.
pub fn run(as_json: bool) -> Result<(), Failure> {
    let cpu = CpuBackend::new();
    let info = cpu.info();
    if as_json {
        let value = json!({
            "cpu": { "device": info.device, "driver": info.driver, "threads": cpu.threads(), "strict": true },
            "gpu_support": cfg!(feature = "gpu"),
            "adapters": adapters_json(),
        });
        return report::print(&format!("{value:#}\n"));
    }
    let mut text = format!("cpu    {}\n       {}\n", info.device, info.driver);
    text.push_str(&adapters_text());
    report::print(&text)
}

#[cfg(feature = "gpu")]
fn adapters_json() -> Value {
    let adapters = twinlight::gpu::adapters();
    let adapter = |(index, a): (usize, &twinlight::gpu::AdapterReport)| {
        json!({
            "index": index, "name": a.name, "api": a.backend, "type": a.device_type, "driver": a.driver,
            "driver_info": a.driver_info, "strict": a.strict, "unusable": a.unusable,
            "limits": {
                "buffer_bytes": a.limits.buffer_bytes,
                "storage_binding_bytes": a.limits.storage_binding_bytes,
                "storage_buffers": a.limits.storage_buffers,
                "workgroup_invocations": a.limits.workgroup_invocations,
                "workgroup_bytes": a.limits.workgroup_bytes,
                "workgroups_per_dimension": a.limits.workgroups_per_dimension,
            },
        })
    };
    adapters.iter().enumerate().map(adapter).collect()
}

#[cfg(not(feature = "gpu"))]
fn adapters_json() -> Value {
    json!([])
}

#[cfg(feature = "gpu")]
fn adapters_text() -> String {
    use std::fmt::Write as _;
    let adapters = twinlight::gpu::adapters();
    let mut text = String::new();
    // Writing to a string can't fail.
    for (index, a) in adapters.iter().enumerate() {
        let strict = if a.strict { "yes, the CPU's bits" } else { "no, portable only" };
        let _ = writeln!(text, "\ngpu:{index}  {} ({}, {})", a.name, a.backend, a.device_type);
        let _ = writeln!(text, "       driver {} {}", a.driver, a.driver_info);
        let _ = writeln!(text, "       strict mode: {strict}");
        let l = &a.limits;
        let _ = writeln!(
            text,
            "       buffers up to {}, seen at once {}; {} per kernel; workgroups of {}, {} shared, {} per dimension",
            report::bytes(l.buffer_bytes),
            report::bytes(l.storage_binding_bytes),
            l.storage_buffers,
            l.workgroup_invocations,
            report::bytes(l.workgroup_bytes.into()),
            l.workgroups_per_dimension
        );
        if let Some(why) = &a.unusable {
            let _ = writeln!(text, "       can't run the kernels: {why}");
        }
    }
    if adapters.is_empty() {
        text.push_str("\nno GPU adapter: no Vulkan, Metal or DirectX 12 driver offers one\n");
    }
    text
}

#[cfg(not(feature = "gpu"))]
fn adapters_text() -> String {
    "\nthis twinlight was built without GPU support\n".into()
}
