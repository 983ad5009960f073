//! Buffers, limits, and what happens when the device goes away.

use crate::{Check, Target, expect_same};
use libtest_mimic::Failed;
use std::time::Duration;
use twinlight_backend_gpu::kernels::{scan, sort};
use twinlight_backend_gpu::source::{KernelSource, WgslFile};
use twinlight_backend_gpu::{DeviceOptions, GpuDevice};
use twinlight_core::Error;

pub const CHECKS: &[(&str, Check)] = &[
    ("buffers keep their bytes", buffers_keep_their_bytes),
    ("a buffer beyond the limit is refused", large_buffer_is_refused),
    ("buffers of another device are refused", foreign_buffer_is_refused),
    ("lengths that differ are refused", lengths_are_checked),
    ("a destroyed device is lost, and a new one works", destroyed_device_is_lost),
    ("a faulty kernel is a typed error", faulty_kernel_is_an_error),
    ("an index out of range stays inside the buffer", index_is_restricted),
    ("a dispatch that outlasts the timeout is a lost device", wait_is_bounded),
];

fn buffers_keep_their_bytes(target: &Target) -> Result<(), Failed> {
    let device = target.device()?;
    expect_same("zeroed", &device.download(&device.zeroed::<u64>(1001)?)?, &[0; 1001])?;
    expect_same("empty", &device.download(&device.upload::<u32>(&[])?)?, &[])?;
    for len in 0..9 {
        let bytes: Vec<u8> = (1..=len).collect();
        expect_same("bytes", &device.download(&device.upload(&bytes)?)?, &bytes)?;
        let triples: Vec<[u16; 3]> = (0..u16::from(len)).map(|i| [i, i + 1, 7]).collect();
        expect_same("triples", &device.download(&device.upload(&triples)?)?, &triples)?;
    }
    let buffer = device.upload(&[1u8, 2, 3, 4, 5, 6, 7])?;
    expect_same("range", &device.download_range(&buffer, 3, 3)?, &[4, 5, 6])?;
    match device.download_range(&buffer, 3, 5) {
        Err(Error::InvalidInput { .. }) => Ok(()),
        other => Err(format!("a range beyond the end: {other:?}").into()),
    }
}

fn large_buffer_is_refused(target: &Target) -> Result<(), Failed> {
    let device = GpuDevice::open(&DeviceOptions { max_buffer_bytes: 1 << 20, ..target.options.clone() })?;
    device.zeroed::<u32>(1 << 18)?;
    for len in [(1 << 18) + 1, usize::MAX / 2] {
        match device.zeroed::<u32>(len) {
            Err(Error::LimitExceeded { limit: 0x10_0000, .. }) => {}
            other => return Err(format!("{len} words: {:?}", other.err()).into()),
        }
    }
    Ok(())
}

fn foreign_buffer_is_refused(target: &Target) -> Result<(), Failed> {
    let other = GpuDevice::open(&target.options)?;
    let input = other.zeroed::<u32>(5)?;
    let device = target.device()?;
    match scan::run(device, &input, &mut device.zeroed::<u32>(5)?) {
        Err(Error::InvalidInput { .. }) => Ok(()),
        other => Err(format!("{other:?}").into()),
    }
}

fn lengths_are_checked(target: &Target) -> Result<(), Failed> {
    let device = target.device()?;
    let scanned = scan::run(device, &device.zeroed::<u32>(5)?, &mut device.zeroed::<u32>(6)?).map(|_| ());
    let sorted = sort::run(device, &mut device.zeroed::<u64>(5)?, &mut device.zeroed::<u32>(6)?);
    for result in [scanned, sorted] {
        if !matches!(result, Err(Error::InvalidInput { .. })) {
            return Err(format!("{result:?}").into());
        }
    }
    Ok(())
}

fn destroyed_device_is_lost(target: &Target) -> Result<(), Failed> {
    let device = GpuDevice::open(&target.options)?;
    let input = device.upload(&[1u32, 2, 3])?;
    let mut output = device.zeroed::<u32>(3)?;
    device.destroy();
    let failures = [
        device.zeroed::<u32>(1).map(|_| ()),
        device.upload(&[1u32]).map(|_| ()),
        device.download(&input).map(|_| ()),
        scan::run(&device, &input, &mut output).map(|_| ()),
    ];
    for (step, failure) in failures.into_iter().enumerate() {
        if !matches!(failure, Err(Error::DeviceLost { retryable: true, .. })) {
            return Err(format!("step {step} after destroy: {failure:?}").into());
        }
    }
    let device = GpuDevice::open(&target.options)?;
    expect_same("a new device", &device.download(&device.upload(&[5u32])?)?, &[5])
}

fn faulty_kernel_is_an_error(target: &Target) -> Result<(), Failed> {
    const TEXT: &str = "@compute @workgroup_size(1)\nfn faulty() {\n    let x: u32 = 1.5;\n}\n";
    const SOURCE: KernelSource =
        KernelSource { stem: "faulty", files: &[WgslFile { path: "faulty.wgsl", text: TEXT }] };
    match target.device()?.pipeline(&SOURCE, "faulty") {
        Err(Error::Internal(text)) if text.contains("faulty.wgsl:3:") => {}
        other => return Err(format!("{other:?}").into()),
    }
    // The device survives.
    target.device()?.zeroed::<u32>(1)?;
    Ok(())
}

const PROBE: &str = "
struct ProbeParams { value: u32 }
@group(0) @binding(0) var<uniform> params: ProbeParams;
@group(0) @binding(3) var<storage, read_write> values: array<u32>;
@compute @workgroup_size(1)
fn write_far() {
    values[params.value] = 7u;
    var local = array<u32, 4>(1u, 2u, 3u, 4u);
    local[params.value] = 9u;
    values[0] = local[params.value];
}
@compute @workgroup_size(1)
fn spin() {
    var value = 1u;
    // Nested, because llvmpipe ends every loop after 65535 rounds.
    for (var i = 0u; i < params.value; i++) {
        for (var j = 0u; j < 10000u; j++) {
            value = (value ^ (value >> 7u)) * 5u + j;
        }
    }
    values[0] = value;
}
";
const PROBE_SOURCE: KernelSource =
    KernelSource { stem: "probe", files: &[WgslFile { path: "probe.wgsl", text: PROBE }] };

fn index_is_restricted(target: &Target) -> Result<(), Failed> {
    let device = target.device()?;
    let values = device.zeroed::<u32>(4)?;
    let pipeline = device.pipeline(&PROBE_SOURCE, "write_far")?;
    for index in [4u32, 1 << 20, 1 << 30, u32::MAX] {
        let mut recorder = device.record("write beyond the end");
        recorder.dispatch("write", &pipeline, &index, &[("values", values.binding())], 1)?;
        recorder.run()?;
    }
    // Clamped to the last element or dropped: WGSL allows both, and the rest is untouched. The local array clamps.
    let got = device.download(&values)?;
    expect_same("elements between", &got[1..3], &[0, 0])?;
    expect_same("clamped local", &got[..1], &[9])
}

fn wait_is_bounded(target: &Target) -> Result<(), Failed> {
    let timeout = Duration::from_millis(2);
    let device = GpuDevice::open(&DeviceOptions { timeout, ..target.options.clone() })?;
    let values = device.zeroed::<u32>(1)?;
    let pipeline = device.pipeline(&PROBE_SOURCE, "spin")?;
    let mut recorder = device.record("outlast the timeout");
    recorder.dispatch("spin", &pipeline, &3000u32, &[("values", values.binding())], 1)?;
    let outcome = recorder.run();
    if device.report().driver == "llvmpipe" && outcome.is_ok() {
        // It may run compute inside the submitting call; then there is no wait to bound.
        return Ok(());
    }
    for failure in [outcome, device.zeroed::<u32>(1).map(|_| ())] {
        if !matches!(failure, Err(Error::DeviceLost { .. })) {
            return Err(format!("{failure:?}").into());
        }
    }
    Ok(())
}
