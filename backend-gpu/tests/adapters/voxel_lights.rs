//! `light_voxels` against its CPU twin, bit for bit in strict mode, and in parts where voxels are beyond a binding.

use crate::{Check, Target, expect_same, numbers};
use libtest_mimic::Failed;
use twinlight_backend_cpu::CpuBackend;
use twinlight_backend_gpu::{DeviceOptions, GpuBackend, GpuDevice, Mode};
use twinlight_core::Backend;
use twinlight_core::kernels::filter_indirect::RadianceTexel;
use twinlight_core::kernels::light_voxels::LightVoxelsBlock;
use twinlight_core::kernels::reduce_mips::VoxelLight;
use twinlight_core::kernels::sum_voxels::VoxelSums;
use twinlight_core::kernels::trace_cones::VoxelFrame;
use twinlight_core::math::morton::morton_code;
use twinlight_core::scene::{CompiledScene, Limits, compile};
use twinlight_fixtures::scenes::builtin;

pub const CHECKS: &[(&str, Check)] = &[
    ("lit voxels are those of the CPU twin", twins),
    ("samples and voxels in parts", parts),
    ("d3: lit voxels in parts", small_bindings),
];

/// Every kind of light, a map of the sky, many spheres, none at all.
const SCENES: [&str; 7] = ["cornell", "materials", "lights", "veach", "textured", "environment", "empty"];

/// What leaves may differ by in portable mode, where drivers round as they like: 2⁻¹² of light, and a unit where a half is rounded.
/// A shadow ray past an edge may go either way: such voxels are a few in a hundred.
const PORTABLE_SHARE: f64 = 0.95;

struct Voxels {
    active: Vec<u32>,
    sums: Vec<VoxelSums>,
    gathered: Vec<RadianceTexel>,
}

/// `len` voxels of a grid of 32³, with all that sums may hold.
fn voxels(seed: u64, len: usize) -> Voxels {
    let drawn = numbers(seed, 4 * len);
    let mut active: Vec<u32> = drawn[..len]
        .iter()
        .map(|bits| morton_code([*bits as u32 % 32, (*bits >> 20) as u32 % 32, (*bits >> 40) as u32 % 32]))
        .collect();
    active.sort_unstable();
    let sums = drawn[len..3 * len].chunks(2).map(|pair| sums_of(pair[0], pair[1])).collect();
    let texel =
        |bits: &u64| RadianceTexel { rgb: [*bits as u8, (*bits >> 8) as u8, 0].map(f32::from), padding: 0 };
    Voxels { active, sums, gathered: drawn[3 * len..].iter().map(texel).collect() }
}

/// One in eight without fragments, one in eight without a normal.
fn sums_of(a: u64, b: u64) -> VoxelSums {
    let count = if a.is_multiple_of(8) { 0 } else { a as u32 % 5 };
    let of = |shift: u32| (b >> shift) as u32 % 4096 * count;
    let normal = |shift: u32| (a >> shift) as i32 % 128 * count as i32;
    let has_normal = a >> 3 & 7 != 0;
    VoxelSums {
        albedo: [of(0), of(12), of(24)],
        count,
        normal: if has_normal { [normal(8), normal(16), normal(24)] } else { [0; 3] },
        emission: [of(36) / 64, of(48) / 64, 0],
        ..VoxelSums::default()
    }
}

/// A grid that is a little larger than the scene, of voxels that are cubes.
fn block(scene: &CompiledScene, samples: u32) -> LightVoxelsBlock {
    let (low, high) = scene.bounds;
    let extent = (0..3).map(|axis| high[axis] - low[axis]).fold(1e-3, f32::max);
    LightVoxelsBlock {
        frame: VoxelFrame { corner: low.map(|x| x - extent / 16.0), voxels_per_unit: 28.0 / extent },
        seed: 77,
        samples,
        scale: 4096.0,
        emission_unit: 0.25,
    }
}

fn lit<B: Backend>(
    backend: &B,
    scene: &CompiledScene,
    voxels: &Voxels,
    block: &LightVoxelsBlock,
    with_gathered: bool,
) -> twinlight_core::Result<Vec<VoxelLight>> {
    let gathered = if with_gathered { &voxels.gathered[..] } else { &[] };
    let garbage = VoxelLight { rgb: [u32::MAX, 0x7f80_0001, 7], opacity: 9 };
    let mut leaves = backend.upload(&vec![garbage; voxels.active.len()])?;
    backend.light_voxels(
        &backend.upload_scene(scene)?,
        &backend.upload(&voxels.active)?,
        &backend.upload(&voxels.sums)?,
        &backend.upload(gathered)?,
        block,
        &mut leaves,
    )?;
    backend.download(&leaves)
}

fn scene(name: &str) -> Result<CompiledScene, Failed> {
    Ok(compile(&builtin(name).ok_or("no such scene")?, &Limits::default())?)
}

/// Bit for bit in strict mode, else but for roundings.
fn compare(target: &Target, what: &str, got: &[VoxelLight], want: &[VoxelLight]) -> Result<(), Failed> {
    if target.device()?.mode() == Mode::Strict {
        return expect_same(what, got, want);
    }
    let near = |got: &VoxelLight, want: &VoxelLight| {
        got.opacity == want.opacity
            && got.rgb.iter().zip(want.rgb).all(|(got, want)| got.abs_diff(want) <= 1 + want / 4096)
    };
    let same = got.iter().zip(want).filter(|(got, want)| near(got, want)).count();
    if got.len() == want.len() && same as f64 >= PORTABLE_SHARE * want.len() as f64 {
        return Ok(());
    }
    Err(format!("{what}: {same} of {} leaves agree", want.len()).into())
}

fn twins(target: &Target) -> Result<(), Failed> {
    let gpu = GpuBackend::new(target.device()?.clone());
    for (seed, name) in SCENES.iter().enumerate() {
        let scene = scene(name)?;
        let voxels = voxels(seed as u64, 600);
        for (samples, with_gathered) in [(5, true), (1, false), (0, true)] {
            let block = block(&scene, samples);
            let got = lit(&gpu, &scene, &voxels, &block, with_gathered)?;
            let want = lit(&CpuBackend::new(), &scene, &voxels, &block, with_gathered)?;
            compare(target, &format!("{name}, {samples} samples"), &got, &want)?;
        }
    }
    Ok(())
}

/// Samples beyond a dispatch and beyond a submission; no voxels, one, one beyond a workgroup.
fn parts(target: &Target) -> Result<(), Failed> {
    let gpu = GpuBackend::new(target.device()?.clone());
    let scene = scene("lights")?;
    for (len, samples) in [(0, 3), (1, 16), (65, 17), (64, 32), (9, 150)] {
        let (voxels, block) = (voxels(9, len), block(&scene, samples));
        let got = lit(&gpu, &scene, &voxels, &block, true)?;
        let want = lit(&CpuBackend::new(), &scene, &voxels, &block, true)?;
        compare(target, &format!("{len} voxels, {samples} samples"), &got, &want)?;
    }
    Ok(())
}

/// A binding of 16 KiB holds 320 sums.
fn small_bindings(target: &Target) -> Result<(), Failed> {
    let options = DeviceOptions { max_storage_binding_bytes: 16 << 10, ..target.options.clone() };
    let small = GpuBackend::new(GpuDevice::open(&options)?);
    let gpu = GpuBackend::new(target.device()?.clone());
    let scene = scene("lights")?;
    for (len, samples, with_gathered) in [(320, 2, true), (321, 20, true), (1000, 33, false)] {
        let (voxels, block) = (voxels(11, len), block(&scene, samples));
        let got = lit(&small, &scene, &voxels, &block, with_gathered)?;
        let want = lit(&gpu, &scene, &voxels, &block, with_gathered)?;
        expect_same(&format!("{len} voxels, {samples} samples"), &got, &want)?;
    }
    Ok(())
}
