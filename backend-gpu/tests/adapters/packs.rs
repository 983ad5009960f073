//! `pack_lhb` where one binding has no room.

use crate::{Check, Target};
use libtest_mimic::Failed;
use twinlight_backend_gpu::{DeviceOptions, GpuBackend, GpuDevice};
use twinlight_core::kernels::pack_lhb::{PackLhbParams, PackedLhbBuffers};
use twinlight_core::kernels::rasterize_lhb::{CAP_NEAR, LhbBuffers, LhbElement};
use twinlight_core::{Backend, Error, Result};

pub const CHECKS: &[(&str, Check)] = &[("d3: packed elements beyond a binding are refused", small_bindings)];

/// Packs and unpacks `count` elements in the first of `size`² pixels.
fn both_ways(gpu: &GpuBackend, size: u32, count: u32, layers: u32) -> Result<usize> {
    let mut offsets = vec![count; (size * size) as usize + 1];
    offsets[0] = 0;
    let lhb = LhbBuffers {
        size,
        view_count: 1,
        offsets: gpu.upload(&offsets)?,
        elements: gpu.upload(&vec![LhbElement { surface: 1, depth: 1 }; count as usize])?,
        left_out: gpu.zeroed(0)?,
    };
    let packed = gpu.pack_lhb(&lhb, &PackLhbParams { layers, cap_side: CAP_NEAR })?;
    Ok(gpu.len(&gpu.unpack_lhb(&packed)?.elements))
}

/// Bindings of 16 KiB: 4096 words, 2048 elements.
fn small_bindings(target: &Target) -> std::result::Result<(), Failed> {
    let options = DeviceOptions { max_storage_binding_bytes: 16 << 10, ..target.options.clone() };
    let gpu = GpuBackend::new(GpuDevice::open(&options)?);
    for (size, count, layers) in [(63, 2048, 0), (32, 2048, 4), (63, 2, 1)] {
        let back = both_ways(&gpu, size, count, layers)?;
        if back != count.min(if layers > 0 { layers } else { count }) as usize {
            return Err(format!("{back} of {count} elements in {layers} layers").into());
        }
    }
    for (size, count, layers) in [(64, 1, 0), (1, 2049, 0), (1, 2049, 1), (32, 1, 5), (64, 1, 1)] {
        let result = both_ways(&gpu, size, count, layers);
        if !matches!(result, Err(Error::LimitExceeded { .. })) {
            return Err(format!("{count} elements in {size}² pixels, {layers} layers: {result:?}").into());
        }
    }
    // Words that have room, and whose elements have none.
    let packed = PackedLhbBuffers {
        size: 1,
        view_count: 1,
        layers: 0,
        offsets: gpu.upload(&[0, 2049])?,
        words: gpu.zeroed(2049)?,
        left_out: gpu.zeroed(0)?,
    };
    match gpu.unpack_lhb(&packed) {
        Err(Error::LimitExceeded { .. }) => Ok(()),
        other => Err(format!("2049 words: {other:?}").into()),
    }
}
