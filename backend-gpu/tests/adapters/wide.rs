//! `shared/wide.wgsl` against Rust's own integers.

use crate::{Check, Target, expect_same, numbers};
use libtest_mimic::Failed;
use twinlight_backend_gpu::shared;
use twinlight_backend_gpu::source::{KernelSource, WgslFile};

pub const CHECKS: &[(&str, Check)] = &[("64-bit integers are those of Rust", agrees)];

const SOURCE: KernelSource = KernelSource {
    stem: "wide_probe",
    files: &[
        shared::DISPATCH,
        shared::WIDE,
        WgslFile { path: "backend-gpu/tests/adapters/wide.wgsl", text: include_str!("wide.wgsl") },
    ],
};

/// Random numbers of every length, and all pairs of edges.
fn inputs() -> Vec<(i64, i64)> {
    let mut edges: Vec<i64> =
        vec![0, 1, 2, 3, 0xffff, 0x1_0000, 0x1_0001, 0x7fff_ffff, 0x8000_0000, 0xffff_ffff];
    edges.extend([1 << 29, (1 << 30) - 1, 1 << 30, (1 << 31) - 2, 1 << 32, (1 << 32) + 1, 0x7fff_ffff_ffff]);
    edges.extend([0x8000_7fff, 0x7fff_8000, 0x4000_ffff, 1 << 61, (1 << 62) - 1, i64::MAX, i64::MIN]);
    let negative: Vec<i64> = edges.iter().map(|n| n.wrapping_neg()).collect();
    edges.extend(negative);
    let mut pairs: Vec<(i64, i64)> = edges.iter().flat_map(|&a| edges.iter().map(move |&b| (a, b))).collect();
    pairs.extend(
        numbers(1, 300_000)
            .chunks_exact(3)
            .map(|n| (n[0] as i64 >> (n[2] % 64), n[1] as i64 >> (n[2] / 64 % 64))),
    );
    pairs
}

fn agrees(target: &Target) -> Result<(), Failed> {
    let device = target.device()?;
    let pairs = inputs();
    let a = device.upload(&pairs.iter().map(|p| p.0).collect::<Vec<i64>>())?;
    let b = device.upload(&pairs.iter().map(|p| p.1).collect::<Vec<i64>>())?;
    let results = device.zeroed::<u64>(6 * pairs.len())?;
    let count = pairs.len() as u32;
    let mut recorder = device.record("64-bit arithmetic");
    let buffers = [("wide_a", a.binding()), ("wide_b", b.binding()), ("results", results.binding())];
    recorder.dispatch("probe", &device.pipeline(&SOURCE, "probe")?, &count, &buffers, count.div_ceil(64))?;
    recorder.run()?;
    let results = device.download(&results)?;
    for (&(a, b), got) in pairs.iter().zip(results.chunks_exact(6)) {
        let word = b as i32;
        let divisor = (i64::from(word) & 0x7fff_ffff).max(1);
        let quotient = a.div_euclid(divisor) as u32;
        let want = [
            (i64::from(a as i32) * i64::from(word)) as u64,
            a.wrapping_add(b) as u64,
            a.wrapping_sub(b) as u64,
            a.wrapping_mul(word.into()) as u64,
            (a as u64) << (b as u32 % 31 + 1),
            u64::from(quotient) | (divisor as u64) << 32,
        ];
        expect_same(&format!("of {a:#x} and {b:#x}"), got, &want)?;
    }
    Ok(())
}
