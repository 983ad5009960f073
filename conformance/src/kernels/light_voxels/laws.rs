//! What holds for any scene.

use super::inputs::{block, voxel, voxels};
use super::{Case, lit_in};
use crate::compare::{Shape, exact};
use crate::oracle::light_voxels::Voxel;
use crate::scenes::compiled;
use crate::trial::{Check, Context, Listing, ensure, list_trials};
use twinlight_core::Backend;
use twinlight_core::kernels::light_voxels::LightVoxelsBlock;
use twinlight_core::kernels::reduce_mips::VoxelLight;
use twinlight_core::scene::{CompiledScene, Environment, Scene};
use twinlight_fixtures::scenes;

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "light_voxels":
        any_order_any_split, repeated, seeds_differ, codes_differ, twice_the_scale,
    );
}

/// Voxels among one light of each kind.
fn among_lights(count: usize) -> Case {
    let scene = compiled(&scenes::lights());
    Case { block: over(&scene, 8.0), scene, voxels: voxels(60, count) }
}

/// [`block`] over the floor of the scene of all lights.
fn over(scene: &CompiledScene, side: f32) -> LightVoxelsBlock {
    let mut block = block();
    block.frame.voxels_per_unit = 8.0 / side;
    let low = [-side / 2.0, -0.1, -side / 2.0];
    block.frame.corner = [0, 1, 2].map(|axis| low[axis] - scene.origin[axis] as f32);
    block
}

/// A voxel's leaf is its own: it depends on no other, and stands where its code does.
fn any_order_any_split<B: Backend>(cx: &Context<'_, B>) -> Check {
    let case = among_lights(300);
    let whole = case.lit(cx)?;
    let resident = cx.backend.upload_scene(&case.scene)?;
    for step in [1, 7, 64, 299] {
        let step = if step == 1 && !cx.full() { 50 } else { step };
        let mut parts = Vec::new();
        for part in case.voxels.chunks(step) {
            parts.extend(lit_in(cx, &resident, &case.block, part)?);
        }
        exact(cx, &format!("leaves, {step} at a time"), &parts, &whole, Shape::Line)?;
    }
    let backwards: Vec<Voxel> = case.voxels.iter().rev().copied().collect();
    let mut leaves = lit_in(cx, &resident, &case.block, &backwards)?;
    leaves.reverse();
    exact(cx, "leaves of reversed voxels", &leaves, &whole, Shape::Line)
}

fn repeated<B: Backend>(cx: &Context<'_, B>) -> Check {
    let case = among_lights(100);
    exact(cx, "leaves of a second run", &case.lit(cx)?, &case.lit(cx)?, Shape::Line)
}

fn different(a: &[VoxelLight], b: &[VoxelLight]) -> usize {
    a.iter().zip(b).filter(|(a, b)| a != b).count()
}

/// Other seeds, other samples: in a scene of 28 lights hardly a leaf stays.
fn seeds_differ<B: Backend>(cx: &Context<'_, B>) -> Check {
    let case = among_lights(100);
    let first = case.lit(cx)?;
    for seed in [6, 5 << 16, u32::MAX] {
        let count = different(&case.with(|block| block.seed = seed).lit(cx)?, &first);
        ensure(count > 50, || format!("seed {seed} changes only {count} of 100 leaves"))?;
    }
    Ok(())
}

/// Voxels draw their own numbers: a row of the same surface in an even sky has different shares of it.
fn codes_differ<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut case = among_lights(0);
    case.scene = compiled(&Scene { environment: Some(Environment::constant([1.0; 3])), ..Scene::default() });
    case.voxels = (0..64).map(|code| Voxel { code, ..voxel([0; 3], [0, 9, 0]) }).collect();
    let mut leaves: Vec<[u32; 3]> = case.lit(cx)?.iter().map(|leaf| leaf.rgb).collect();
    leaves.sort_unstable();
    leaves.dedup();
    ensure(leaves.len() > 32, || format!("{} different leaves of 64 voxels", leaves.len()))
}

/// Twice the leaves, but for what was rounded.
fn twice_the_scale<B: Backend>(cx: &Context<'_, B>) -> Check {
    let case = among_lights(200).with(|block| block.scale = 64.0);
    let (once, twice) = (case.lit(cx)?, case.with(|block| block.scale = 128.0).lit(cx)?);
    for (a, b) in once.iter().zip(&twice) {
        let near = (0..3).all(|channel| (2 * a.rgb[channel]).abs_diff(b.rgb[channel]) <= 1);
        ensure(near && a.opacity == b.opacity, || format!("{a:?} becomes {b:?}"))?;
    }
    Ok(())
}
