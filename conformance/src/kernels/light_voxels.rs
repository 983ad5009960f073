// kernel family: light_voxels
// contract core/src/kernels/light_voxels.rs
// cpu backend-cpu/src/kernels/light_voxels.rs
// gpu backend-gpu/src/kernels/light_voxels.wgsl
// oracle conformance/src/oracle/light_voxels.rs
//! Cases and laws of `light_voxels`. Voxels are made up, or a room's. Where lights have no extent every sample gives the same, and leaves are
//! compared one by one; elsewhere their means over many seeds are.

mod cases;
mod foreign;
mod inputs;
mod laws;
mod means;
mod rooms;
mod shadows;

use crate::compare::{Evidence, Shape};
use crate::oracle::light_voxels::{Expected, Voxel, expected, units};
use crate::trial::{Check, Context, Failure, Listing, Options};
use twinlight_core::Backend;
use twinlight_core::kernels::filter_indirect::RadianceTexel;
use twinlight_core::kernels::light_voxels::LightVoxelsBlock;
use twinlight_core::kernels::reduce_mips::{OPAQUE, VoxelLight};
use twinlight_core::kernels::sum_voxels::VoxelSums;
use twinlight_core::kernels::trace_cones::VoxelFrame;
use twinlight_core::scene::CompiledScene;

/// Lists the trials.
pub fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    cases::list(list);
    shadows::list(list);
    foreign::list(list);
    laws::list(list);
    rooms::list(list);
    means::list(list);
}

type Checked<T> = Result<T, Failure>;

/// What a leaf of samples that are all the same may be off by, as a share of the light that would arrive straight: some hundred operations of
/// 2.5 ulp at most in WGSL, and 64 sums of one.
const ROUNDING: f64 = 1.0 / 16384.0;

/// Voxels of a scene.
#[derive(Debug, Clone)]
struct Case {
    scene: CompiledScene,
    block: LightVoxelsBlock,
    voxels: Vec<Voxel>,
}

impl Case {
    /// The backend's leaves.
    fn lit<B: Backend>(&self, cx: &Context<'_, B>) -> Checked<Vec<VoxelLight>> {
        let resident = cx.backend.upload_scene(&self.scene)?;
        lit_in(cx, &resident, &self.block, &self.voxels)
    }

    /// The backend's leaves, which are the oracle's. All lights are without extent.
    fn agreed<B: Backend>(&self, cx: &Context<'_, B>) -> Checked<Vec<VoxelLight>> {
        let leaves = self.lit(cx)?;
        let mut evidence = Evidence::new("leaves", Shape::Line);
        for (index, (leaf, voxel)) in leaves.iter().zip(&self.voxels).enumerate() {
            if voxel.sums.count == 0 {
                let none = *leaf == VoxelLight::default();
                evidence.holds(index, none, || format!("{leaf:?} without fragments"));
                continue;
            }
            check_leaf(&mut evidence, index, leaf, &expected(&self.scene, &self.block, voxel));
        }
        evidence.finish()?;
        Ok(leaves)
    }

    fn agrees<B: Backend>(&self, cx: &Context<'_, B>) -> Check {
        self.agreed(cx).map(|_| ())
    }

    fn with(&self, change: impl Fn(&mut LightVoxelsBlock)) -> Self {
        let mut case = self.clone();
        change(&mut case.block);
        case
    }
}

fn check_leaf(evidence: &mut Evidence, index: usize, leaf: &VoxelLight, want: &Expected) {
    evidence.holds(index, leaf.opacity == OPAQUE, || format!("opacity {}, want {OPAQUE}", leaf.opacity));
    for channel in 0..3 {
        let (got, value) = (leaf.rgb[channel], want.value[channel]);
        let slack = ROUNDING * want.most[channel];
        let (low, high) = (units(value - slack), units(value + slack));
        evidence.holds(index, low <= got && got <= high, || {
            format!("channel {channel}: got {got}, want {low} to {high}, which {value} is rounded to")
        });
    }
}

/// Leaves of voxels in a scene that is there already.
fn lit_in<B: Backend>(
    cx: &Context<'_, B>,
    scene: &B::Scene,
    block: &LightVoxelsBlock,
    voxels: &[Voxel],
) -> Checked<Vec<VoxelLight>> {
    let active: Vec<u32> = voxels.iter().map(|voxel| voxel.code).collect();
    let sums: Vec<VoxelSums> = voxels.iter().map(|voxel| voxel.sums).collect();
    let texel = |voxel: &Voxel| RadianceTexel { rgb: voxel.gathered, padding: 0 };
    let mut gathered: Vec<RadianceTexel> = voxels.iter().map(texel).collect();
    // None is as good as nothing.
    if gathered.iter().all(|texel| texel.rgb == [0.0; 3]) {
        gathered.clear();
    }
    let mut leaves = cx.backend.upload(&garbage(voxels.len()))?;
    cx.backend.light_voxels(
        scene,
        &cx.backend.upload(&active)?,
        &cx.backend.upload(&sums)?,
        &cx.backend.upload(&gathered)?,
        block,
        &mut leaves,
    )?;
    Ok(cx.backend.download(&leaves)?)
}

/// What leaves hold before the kernel runs.
fn garbage(len: usize) -> Vec<VoxelLight> {
    vec![VoxelLight { rgb: [0xffff_ffff, 0x7f80_0001, 7], opacity: 0xdead_beef }; len]
}

/// Leaves of made-up voxels all over a scene.
pub(crate) fn lit_over<B: Backend>(backend: &B, scene: &CompiledScene) -> Checked<Vec<VoxelLight>> {
    let (low, high) = scene.bounds;
    let extent = (0..3).map(|axis| high[axis] - low[axis]).fold(0.0, f32::max);
    let mut block = LightVoxelsBlock { samples: 4, scale: 4096.0, ..inputs::block() };
    block.frame = VoxelFrame { corner: low.map(|x| x - extent / 16.0), voxels_per_unit: 7.0 / extent };
    let cx = Context { backend, options: &Options::default(), name: "light_voxels" };
    lit_in(&cx, &backend.upload_scene(scene)?, &block, &inputs::voxels(80, 700))
}
