//! `sort` against the standard library's stable sort.

use crate::{Check, Target, expect_same, numbers};
use bytemuck::Pod;
use libtest_mimic::Failed;
use twinlight_backend_gpu::GpuDevice;
use twinlight_backend_gpu::kernels::sort;

pub const CHECKS: &[(&str, Check)] = &[
    ("sort of 32-bit keys is the stable one", narrow_keys),
    ("sort of 64-bit keys is the stable one", wide_keys),
    ("sort keeps the order of equal keys", equal_keys),
    ("sort of many pairs scans in tiles", many_pairs),
];

fn narrow_keys(target: &Target) -> Result<(), Failed> {
    for len in [0, 1, 2, 31, 33, 255, 257, 2047, 2048, 2049, 50_001] {
        let keys: Vec<u32> = numbers(len as u64, len).iter().map(|&number| number as u32).collect();
        compare(target.device()?, &keys)?;
    }
    Ok(())
}

fn wide_keys(target: &Target) -> Result<(), Failed> {
    for len in [0, 1, 2, 2049, 20_011] {
        // Few distinct high words: the low ones must decide, and must not be taken for the high ones.
        let keys: Vec<u64> = numbers(7, len).iter().map(|number| number & 0x0000_0003_ffff_ffff).collect();
        compare(target.device()?, &keys)?;
    }
    compare(target.device()?, &numbers(8, 5000))
}

fn equal_keys(target: &Target) -> Result<(), Failed> {
    for distinct in [1, 2, 17] {
        let keys: Vec<u32> =
            numbers(distinct, 10_000).iter().map(|number| (number % distinct) as u32).collect();
        compare(target.device()?, &keys)?;
    }
    Ok(())
}

fn many_pairs(target: &Target) -> Result<(), Failed> {
    // More than 16384 counts of digits, so that the scan takes all its phases.
    let keys: Vec<u32> = numbers(3, 2_100_000).iter().map(|&number| number as u32).collect();
    compare(target.device()?, &keys)
}

fn compare<K: Pod + Ord + std::fmt::Debug>(device: &GpuDevice, keys: &[K]) -> Result<(), Failed> {
    let payload: Vec<u32> = (0..keys.len() as u32).collect();
    let mut pairs: Vec<(K, u32)> = keys.iter().copied().zip(payload.iter().copied()).collect();
    pairs.sort_by_key(|pair| pair.0);
    let (want_keys, want_payload): (Vec<K>, Vec<u32>) = pairs.into_iter().unzip();
    let mut keys = device.upload(keys)?;
    let mut payload = device.upload(&payload)?;
    sort::run(device, &mut keys, &mut payload)?;
    let what = format!("sort of {}", want_keys.len());
    expect_same(&format!("{what}: keys"), &device.download(&keys)?, &want_keys)?;
    expect_same(&format!("{what}: payload"), &device.download(&payload)?, &want_payload)
}
