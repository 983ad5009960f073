//! Strict mode evaluates floats as written; portable mode is the control that shows the difference it makes.

use crate::{Check, Target, numbers};
use libtest_mimic::Failed;
use twinlight_backend_gpu::source::{KernelSource, WgslFile};
use twinlight_backend_gpu::{GpuDevice, Mode};

pub const CHECKS: &[(&str, Check)] = &[("float expressions round as written in strict mode", expressions)];

/// Each line is one that a driver of ours was seen to rewrite: a common factor, a cancelling pair, two constants, a
/// division by a literal.
const TEXT: &str = "
struct ExpressionParams { count: u32 }
@group(0) @binding(0) var<uniform> params: ExpressionParams;
@group(0) @binding(1) var<storage, read> input: array<f32>;
@group(0) @binding(2) var<storage, read_write> results: array<f32>;
@compute @workgroup_size(64)
fn evaluate(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= params.count {
        return;
    }
    let x = input[3u * id.x];
    let y = input[3u * id.x + 1u];
    let z = input[3u * id.x + 2u];
    let first = 8u * id.x;
    results[first] = x * y + x * z;
    results[first + 1u] = (x + y) - x;
    results[first + 2u] = (x * 3.1) * 5.3;
    results[first + 3u] = (x + 0.1) + 0.7;
    results[first + 4u] = x / 3.0;
    results[first + 5u] = sqrt(x) * sqrt(x);
    results[first + 6u] = dot(vec3<f32>(x, y, z), vec3<f32>(y, z, x));
    results[first + 7u] = x - (x - y);
}
";
const SOURCE: KernelSource =
    KernelSource { stem: "expressions", files: &[WgslFile { path: "expressions.wgsl", text: TEXT }] };
const COUNT: usize = 4096;

fn expressions(target: &Target) -> Result<(), Failed> {
    let device = target.device()?;
    // Normal numbers in [1/2, 128): no operation comes near subnormals.
    let input: Vec<f32> = numbers(11, 3 * COUNT)
        .iter()
        .map(|number| f32::from_bits(0x3f00_0000 + (number % 0x0400_0000) as u32))
        .collect();
    let got = evaluate(device, &input)?;
    let want: Vec<f32> = input.chunks_exact(3).flat_map(|v| as_written(v[0], v[1], v[2])).collect();
    let mut differing = [0usize; 8];
    for (at, (got, want)) in got.iter().zip(&want).enumerate() {
        differing[at % 8] += usize::from(got.to_bits() != want.to_bits());
    }
    let any = differing.iter().any(|&count| count > 0);
    match device.mode() {
        Mode::Strict if any => Err(format!("of {COUNT} results differ {differing:?}").into()),
        // Were it to agree, the input or the comparison would be too weak to show what strict mode is for.
        Mode::Portable if !any && device.report().device_type == "cpu" => {
            Err("nothing differs: weak test".into())
        }
        _ => Ok(()),
    }
}

fn evaluate(device: &GpuDevice, input: &[f32]) -> Result<Vec<f32>, Failed> {
    let values = device.upload(input)?;
    let results = device.zeroed::<f32>(8 * COUNT)?;
    let pipeline = device.pipeline(&SOURCE, "evaluate")?;
    let mut recorder = device.record("evaluate expressions");
    let buffers = [("input", values.binding()), ("results", results.binding())];
    recorder.dispatch("evaluate", &pipeline, &(COUNT as u32), &buffers, COUNT as u32 / 64)?;
    recorder.run()?;
    Ok(device.download(&results)?)
}

fn as_written(x: f32, y: f32, z: f32) -> [f32; 8] {
    [
        x * y + x * z,
        (x + y) - x,
        (x * 3.1) * 5.3,
        (x + 0.1) + 0.7,
        x / 3.0,
        x.sqrt() * x.sqrt(),
        (x * y + y * z) + z * x,
        x - (x - y),
    ]
}
