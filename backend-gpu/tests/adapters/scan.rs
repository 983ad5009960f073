//! `scan` against a serial sum, at the lengths where tiles, rows and workgroups begin and end.

use crate::{Check, Target, expect_same, numbers};
use libtest_mimic::Failed;
use twinlight_backend_gpu::kernels::scan;
use twinlight_backend_gpu::{DeviceOptions, GpuDevice};

pub const CHECKS: &[(&str, Check)] =
    &[("scan equals a serial sum", equals_a_serial_sum), ("scan folds its workgroups", folds_its_workgroups)];

fn equals_a_serial_sum(target: &Target) -> Result<(), Failed> {
    let device = target.device()?;
    for len in [0, 1, 3, 4, 5, 1023, 1024, 1025, 4095, 4096, 4097, 12_288, 100_003, 4096 * 4096 + 4097] {
        compare(device, len)?;
    }
    Ok(())
}

fn folds_its_workgroups(target: &Target) -> Result<(), Failed> {
    let options = DeviceOptions { max_workgroups_per_dimension: 7, ..target.options.clone() };
    let device = GpuDevice::open(&options)?;
    for tiles in [7, 8, 13, 49] {
        compare(&device, tiles * scan::TILE_SIZE as usize - 3)?;
    }
    match compare(&device, 50 * scan::TILE_SIZE as usize) {
        Err(error) if error.message().is_some_and(|text| text.contains("workgroups")) => Ok(()),
        other => Err(format!("50 tiles in 49 workgroups: {other:?}").into()),
    }
}

fn compare(device: &GpuDevice, len: usize) -> Result<(), Failed> {
    let values: Vec<u32> = numbers(len as u64, len).iter().map(|&number| number as u32).collect();
    let mut total = 0u32;
    let mut want = Vec::with_capacity(len);
    for value in &values {
        want.push(total);
        total = total.wrapping_add(*value);
    }
    let input = device.upload(&values)?;
    let mut output = device.upload(&vec![u32::MAX; len])?;
    let sum = scan::run(device, &input, &mut output)?;
    expect_same(&format!("scan of {len}"), &device.download(&output)?, &want)?;
    expect_same(&format!("total of {len}"), &[sum], &[total])
}
