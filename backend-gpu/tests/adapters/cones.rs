//! `trace_cones` against its CPU twin, bit for bit in strict mode, and in parts where cones are beyond a binding.

use crate::{Check, Target, expect_same, numbers};
use libtest_mimic::Failed;
use twinlight_backend_cpu::CpuBackend;
use twinlight_backend_gpu::{DeviceOptions, GpuBackend, GpuDevice, Mode};
use twinlight_core::kernels::reduce_mips::{HARMONICS_8, VoxelLevelBuffers, word_starts, words_of};
use twinlight_core::kernels::trace_cones::{Cone, ConeLight, SIXTY_DEGREES, TraceConesBlock, VoxelFrame};
use twinlight_core::lattice::VoxelGrid;
use twinlight_core::{Backend, Error};

pub const CHECKS: &[(&str, Check)] =
    &[("cones are those of the CPU twin", twins), ("d3: cones in parts", parts)];

/// Levels of made-up voxels: a bit in 16, or none, with made-up values.
struct Levels {
    grid: VoxelGrid,
    starts: Vec<u32>,
    mask: Vec<u32>,
    ranks: Vec<u32>,
    values: Vec<u32>,
}

impl Levels {
    fn new(dims: [u32; 3], storage: u32) -> Result<Self, Error> {
        let grid = VoxelGrid { dims, scale: 1 << 14, offset: [0; 3], subvoxel_bits: 9 };
        let words = word_starts(grid.padded());
        let sparse = |bits: &u64| (bits & (bits >> 16) & (bits >> 32) & (bits >> 8)) as u32;
        let mut mask: Vec<u32> = numbers(1, words[words.len() - 1]).iter().map(sparse).collect();
        // Levels of fewer than 32 voxels have no bits beyond those.
        for (level, &word) in words[..words.len() - 1].iter().enumerate() {
            let side = grid.padded() >> level;
            if side * side * side < 32 {
                mask[word] &= (1 << (side * side * side)) - 1;
            }
        }
        let mut ranks = vec![0];
        for word in &mask {
            ranks.push(ranks[ranks.len() - 1] + word.count_ones());
        }
        let starts: Vec<u32> = words.iter().map(|&word| ranks[word]).collect();
        let count = words_of(storage)? * starts[starts.len() - 1] as usize;
        // Opacities of a tenth, radiance and exponents that floats hold well.
        let values = numbers(2, count).iter().map(|bits| (bits & 0x0700_1fff) as u32).collect();
        Ok(Self { grid, starts, mask, ranks, values })
    }
}

fn traced<B: Backend>(
    backend: &B,
    levels: &Levels,
    block: &TraceConesBlock,
    cones: &[Cone],
) -> twinlight_core::Result<Vec<ConeLight>> {
    let resident = VoxelLevelBuffers {
        grid: levels.grid,
        starts: levels.starts.clone(),
        mask: backend.upload(&levels.mask)?,
        ranks: backend.upload(&levels.ranks)?,
        active: backend.zeroed(levels.starts[levels.starts.len() - 1] as usize)?,
    };
    let mut light = backend.zeroed(cones.len())?;
    backend.trace_cones(
        &resident,
        &backend.upload(&levels.values)?,
        &backend.upload(cones)?,
        block,
        &mut light,
    )?;
    backend.download(&light)
}

/// Cones from anywhere in a grid of 40 voxels and a little beyond, a third of them narrow; half of them leave a surface.
fn some_cones(seed: u64, count: usize) -> Vec<Cone> {
    let unit = |bits: u64| (bits >> 40) as f32 / 16_777_216.0;
    let cone = |n: &[u64]| {
        let along = |i: usize| unit(n[i]) * 2.0 - 1.0;
        let normal = if n[9] & 1 == 0 { [along(6), along(7), along(8)] } else { [0.0; 3] };
        Cone {
            origin: [0, 1, 2].map(|a| unit(n[a]) * 42.0 - 1.0),
            sine: if n[9].is_multiple_of(3) { 0.0 } else { unit(n[10]) },
            direction: [along(3), along(4), along(5)],
            start: unit(n[11]) * 3.0,
            normal,
            padding: 0,
        }
    };
    numbers(seed, 12 * count).chunks(12).map(cone).collect()
}

fn block(storage: u32, flags: u32) -> TraceConesBlock {
    let frame = VoxelFrame { corner: [-0.1, 0.2, 0.0], voxels_per_unit: 1.1 };
    TraceConesBlock { frame, unit: 0.01, reach: 60.0, storage, flags }
}

fn bits(light: &[ConeLight]) -> Vec<[u32; 4]> {
    let of = |light: &ConeLight| {
        let [r, g, b] = light.rgb;
        [r, g, b, light.transmittance].map(f32::to_bits)
    };
    light.iter().map(of).collect()
}

fn twins(target: &Target) -> Result<(), Failed> {
    let gpu = GpuBackend::new(target.device()?.clone());
    for storage in 0..=HARMONICS_8 {
        for dims in [[40, 37, 40], [1, 1, 1], [33, 2, 9]] {
            let levels = Levels::new(dims, storage)?;
            for (flags, count) in [(0, 700), (SIXTY_DEGREES, 300), (0, 0)] {
                let cones = some_cones(u64::from(storage), count);
                let block = block(storage, flags);
                let (got, want) = (
                    traced(&gpu, &levels, &block, &cones)?,
                    traced(&CpuBackend::new(), &levels, &block, &cones)?,
                );
                // Elsewhere a rounding ends a cone a sample sooner; the suite has the intervals.
                if target.device()?.mode() == Mode::Strict {
                    expect_same(&format!("storage {storage}, {dims:?}, {flags}"), &bits(&got), &bits(&want))?;
                }
            }
        }
    }
    Ok(())
}

/// A binding of 64 KiB holds 1365 cones, and no 40³ voxels of 24 words.
fn parts(target: &Target) -> Result<(), Failed> {
    let options = DeviceOptions { max_storage_binding_bytes: 1 << 16, ..target.options.clone() };
    let small = GpuBackend::new(GpuDevice::open(&options)?);
    let gpu = GpuBackend::new(target.device()?.clone());
    let levels = Levels::new([20, 9, 20], 0)?;
    let cones = some_cones(9, 3000);
    let (got, want) =
        (traced(&small, &levels, &block(0, 0), &cones)?, traced(&gpu, &levels, &block(0, 0), &cones)?);
    expect_same("3000 cones", &bits(&got), &bits(&want))?;
    match traced(&small, &Levels::new([40; 3], 1)?, &block(1, 0), &cones) {
        Err(Error::LimitExceeded { limit: 0x1_0000, .. }) => Ok(()),
        other => Err(format!("{:?}", other.map(|light| light.len())).into()),
    }
}
