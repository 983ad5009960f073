//! What changes light in a way that is known: units, frames, order, mirrors.

use super::inputs::{Lit, cone, plain, scattered, some_block, some_cone};
use super::{STORAGES, agreed, same, traced};
use crate::trial::{Check, Context, Listing, list_trials};
use twinlight_core::Backend;
use twinlight_core::kernels::reduce_mips::{ANISOTROPIC, ISOTROPIC};
use twinlight_core::kernels::trace_cones::{Cone, ConeLight, TraceConesBlock, VoxelFrame};
use twinlight_fixtures::random::Random;

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "trace_cones": frames_and_units_scale, order_is_free, levels_decide_alone, far_starts);
}

const DIMS: [u32; 3] = [11, 16, 6];

fn some_lit(cx_seed: u64, storage: u32) -> (Lit, Random) {
    let mut random = Random::new(cx_seed ^ 61);
    let lit = Lit::new(DIMS, &scattered(&mut random, DIMS, 200), storage);
    (lit, random)
}

/// Powers of two change no rounding: of lengths nothing is left in the light, of the unit all.
fn frames_and_units_scale<B: Backend>(cx: &Context<'_, B>) -> Check {
    for storage in STORAGES {
        let (lit, mut random) = some_lit(cx.options.seed, storage);
        let block = some_block(&mut random, storage, 16.0);
        let cones: Vec<Cone> = (0..40).map(|_| some_cone(&mut random, &block, DIMS)).collect();
        let light = agreed(cx, &lit, &block, &cones)?;
        let frame = block.frame;
        let shrunk = TraceConesBlock {
            frame: VoxelFrame {
                corner: frame.corner.map(|c| c * 0.25),
                voxels_per_unit: frame.voxels_per_unit * 4.0,
            },
            reach: block.reach * 0.25,
            unit: block.unit * 8.0,
            ..block
        };
        let small =
            |cone: &Cone| Cone { origin: cone.origin.map(|c| c * 0.25), start: cone.start * 0.25, ..*cone };
        let small: Vec<Cone> = cones.iter().map(small).collect();
        let brighter = |light: &ConeLight| ConeLight { rgb: light.rgb.map(|c| c * 8.0), ..*light };
        let want: Vec<ConeLight> = light.iter().map(brighter).collect();
        same(&format!("{lit:?}"), &agreed(cx, &lit, &shrunk, &small)?, &want)?;
    }
    Ok(())
}

/// A cone's light does not depend on its neighbours, and a second call gives the same.
fn order_is_free<B: Backend>(cx: &Context<'_, B>) -> Check {
    let (lit, mut random) = some_lit(cx.options.seed, ANISOTROPIC);
    let block = some_block(&mut random, ANISOTROPIC, 16.0);
    let mut cones: Vec<Cone> = (0..300).map(|_| some_cone(&mut random, &block, DIMS)).collect();
    let mut light = traced(cx.backend, &lit, &block, &cones)?;
    same("again", &traced(cx.backend, &lit, &block, &cones)?, &light)?;
    cones.reverse();
    light.reverse();
    same("reversed", &traced(cx.backend, &lit, &block, &cones)?, &light)
}

/// The codes of the voxels are not read: masks and ranks say where a value is.
fn levels_decide_alone<B: Backend>(cx: &Context<'_, B>) -> Check {
    let (lit, mut random) = some_lit(cx.options.seed, ISOTROPIC);
    let block = some_block(&mut random, ISOTROPIC, 16.0);
    let cones: Vec<Cone> = (0..60).map(|_| some_cone(&mut random, &block, DIMS)).collect();
    let light = agreed(cx, &lit, &block, &cones)?;
    let mut foreign = lit.clone();
    foreign.levels.active.fill(u32::MAX);
    same("foreign codes", &traced(cx.backend, &foreign, &block, &cones)?, &light)
}

/// First samples anywhere along a cone: also behind its apex, where they count as any, and beyond the grid, where there are none.
fn far_starts<B: Backend>(cx: &Context<'_, B>) -> Check {
    for storage in STORAGES {
        let (lit, _) = some_lit(cx.options.seed, storage);
        let base = cone([5.3, 7.7, 2.9], [0.48, 0.64, 0.6], 0.3);
        let starts = [-3.0, -0.7, 0.3, 1.0, 2.5, 4.1, 5.2, 50.0];
        let cones: Vec<Cone> = starts.map(|start| Cone { start, ..base }).to_vec();
        agreed(cx, &lit, &plain(storage), &cones)?;
    }
    Ok(())
}
