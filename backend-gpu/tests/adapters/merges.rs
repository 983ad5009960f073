//! `merge_lhb` against its CPU twin.

use crate::{Check, Target, expect_same, numbers};
use libtest_mimic::Failed;
use twinlight_backend_cpu::CpuBackend;
use twinlight_backend_gpu::{DeviceOptions, GpuBackend, GpuDevice};
use twinlight_core::kernels::merge_lhb::MergeLhbParams;
use twinlight_core::kernels::rasterize_lhb::{CAP_FAR, CAP_NEAR, LhbBuffers, LhbElement};
use twinlight_core::{Backend, Error, Result};

pub const CHECKS: &[(&str, Check)] = &[
    ("merges are those of the CPU twin", merges),
    ("merges of a hundred thousand layers", layers),
    ("merges of malformed offsets are refused", malformed),
    ("d3: merges beyond a binding are refused", small_bindings),
];

const FIRST: u32 = 5000;

/// Lists on the host.
#[derive(Clone)]
struct Lists {
    size: u32,
    offsets: Vec<u32>,
    elements: Vec<LhbElement>,
    left_out: Vec<u32>,
}

impl Lists {
    /// `size`² lists of sorted elements, `len(n)` of them for a random n.
    fn new(size: u32, seed: u64, len: impl Fn(u64) -> u64) -> Self {
        let lens = numbers(seed, (size * size) as usize).into_iter().map(len);
        let (mut offsets, mut elements) = (vec![0], Vec::new());
        for (list, len) in lens.enumerate() {
            let words = numbers(seed ^ list as u64, len as usize);
            let mut list: Vec<_> = words
                .iter()
                .map(|w| LhbElement { surface: *w as u32 % 10_000, depth: (w >> 32) as u32 % 99 })
                .collect();
            list.sort_by_key(|element| element.depth);
            elements.extend(list);
            offsets.push(elements.len() as u32);
        }
        let left_out = numbers(seed, (size * size) as usize).into_iter().map(|n| n as u32).collect();
        Self { size, offsets, elements, left_out }
    }
}

/// Offsets, elements and numbers left out of the merged lists.
type Merged = (Vec<u32>, Vec<LhbElement>, Vec<u32>);

fn merged<B: Backend>(backend: &B, kept: &Lists, added: &Lists, params: &MergeLhbParams) -> Result<Merged> {
    let upload = |lists: &Lists| {
        let left_out = if params.layer_cap > 0 { lists.left_out.as_slice() } else { &[] };
        Ok::<_, Error>(LhbBuffers {
            size: lists.size,
            view_count: 1,
            offsets: backend.upload(&lists.offsets)?,
            elements: backend.upload(&lists.elements)?,
            left_out: backend.upload(left_out)?,
        })
    };
    let merged = backend.merge_lhb(&upload(kept)?, &upload(added)?, params)?;
    Ok((
        backend.download(&merged.offsets)?,
        backend.download(&merged.elements)?,
        backend.download(&merged.left_out)?,
    ))
}

fn params(layer_cap: u32, cap_side: u32) -> MergeLhbParams {
    MergeLhbParams { first_triangle: FIRST, layer_cap, cap_side, padding: 0 }
}

fn gpu(target: &Target) -> std::result::Result<GpuBackend, Failed> {
    Ok(GpuBackend::new(target.device()?.clone()))
}

/// Both backends' results, for some caps on both sides.
fn expect_twins(
    target: &Target,
    kept: &Lists,
    added: &Lists,
    caps: &[u32],
) -> std::result::Result<(), Failed> {
    let (cpu, gpu) = (CpuBackend::new(), gpu(target)?);
    for cap in caps {
        for side in [CAP_NEAR, CAP_FAR] {
            let params = params(*cap, side);
            let want = merged(&cpu, kept, added, &params)?;
            let got = merged(&gpu, kept, added, &params)?;
            expect_same(&format!("offsets, {params:?}"), &got.0, &want.0)?;
            expect_same(&format!("elements, {params:?}"), &got.1, &want.1)?;
            expect_same(&format!("left out, {params:?}"), &got.2, &want.2)?;
        }
    }
    Ok(())
}

/// Lists that neither has, that one has and that both have, on both sides of the length that one invocation merges.
fn merges(target: &Target) -> std::result::Result<(), Failed> {
    for size in [1, 33] {
        let few = Lists::new(size, 1, |n| n % 3);
        let rare = Lists::new(size, 2, |n| if n % 11 == 0 { n / 11 % 40 } else { 0 });
        let none = Lists::new(size, 3, |_| 0);
        for (kept, added) in [(&few, &rare), (&rare, &few), (&few, &none), (&none, &few), (&none, &none)] {
            expect_twins(target, kept, added, &[0, 1, 3])?;
        }
    }
    for added in [0, 1, 500, 512, 513, 1024, 2000] {
        let added = Lists::new(3, 4, |n| if n % 2 == 0 { added } else { 1 });
        expect_twins(target, &Lists::new(3, 5, |_| 512), &added, &[0, 100, 1024, 1025])?;
    }
    Ok(())
}

/// More than the loops of one invocation may count to on every adapter, with equal depths throughout.
fn layers(target: &Target) -> std::result::Result<(), Failed> {
    let lists = |seed| Lists::new(2, seed, |n| n % 100_000);
    expect_twins(target, &lists(6), &lists(7), &[0, 70_000])
}

fn malformed(target: &Target) -> std::result::Result<(), Failed> {
    let gpu = gpu(target)?;
    let sound = Lists::new(20, 8, |n| n % 3);
    for (place, wrong) in [(0, 9), (7, u32::MAX), (200, 0), (400, 1), (400, 1 << 31)] {
        let mut broken = sound.clone();
        broken.offsets[place] = wrong;
        for cap in [0, 2] {
            for (kept, added) in [(&broken, &sound), (&sound, &broken)] {
                let result = merged(&gpu, kept, added, &params(cap, CAP_NEAR));
                if !matches!(result, Err(Error::InvalidInput { .. })) {
                    return Err(format!("offset {place} of {wrong}, cap {cap}: {result:?}").into());
                }
            }
        }
    }
    Ok(())
}

/// Bindings of 16 KiB: 2048 elements.
fn small_bindings(target: &Target) -> std::result::Result<(), Failed> {
    let options = DeviceOptions { max_storage_binding_bytes: 16 << 10, ..target.options.clone() };
    let gpu = GpuBackend::new(GpuDevice::open(&options)?);
    let lists = |size, len| Lists::new(size, 9, move |_| len);
    merged(&gpu, &lists(32, 1), &lists(32, 1), &params(0, CAP_NEAR))?;
    for (kept, added) in
        [(lists(64, 0), lists(64, 0)), (lists(1, 2049), lists(1, 0)), (lists(1, 1025), lists(1, 1024))]
    {
        let result = merged(&gpu, &kept, &added, &params(0, CAP_NEAR));
        if !matches!(result, Err(Error::LimitExceeded { .. })) {
            return Err(
                format!("{} offsets: {:?}", kept.offsets.len(), result.map(|lists| lists.1.len())).into()
            );
        }
    }
    Ok(())
}
