//! What is refused, and sums that no kernel made.

use super::garbage;
use super::inputs::{block, point, under, voxel};
use crate::compare::{Shape, exact};
use crate::scenes::compiled;
use crate::trial::{Check, Context, Failure, Listing, ensure, list_trials};
use twinlight_core::kernels::filter_indirect::RadianceTexel;
use twinlight_core::kernels::light_voxels::{LightVoxelsBlock, MAX_SAMPLES};
use twinlight_core::kernels::sum_voxels::VoxelSums;
use twinlight_core::{Backend, Error};
use twinlight_fixtures::scenes;

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "light_voxels": unlike_lengths_are_refused, bad_parameters_are_refused, sums_beyond_limits);
}

/// Calls with buffers of these lengths; leaves of a refused call are as they were.
fn refused<B: Backend>(
    cx: &Context<'_, B>,
    [active, sums, gathered, leaves]: [usize; 4],
    block: &LightVoxelsBlock,
    is_right: fn(&Error) -> bool,
) -> Check {
    let scene = cx.backend.upload_scene(&compiled(&scenes::lights()))?;
    let mut buffer = cx.backend.upload(&garbage(leaves))?;
    let (active, sums) = (cx.backend.zeroed::<u32>(active)?, cx.backend.zeroed::<VoxelSums>(sums)?);
    let gathered = cx.backend.zeroed::<RadianceTexel>(gathered)?;
    match cx.backend.light_voxels(&scene, &active, &sums, &gathered, block, &mut buffer) {
        Err(error) if is_right(&error) => {}
        Err(Error::Unsupported(what)) => return Err(Failure::Skip(what)),
        other => return Err(Failure::Mismatch(format!("{other:?}"))),
    }
    exact(cx, "refused leaves", &cx.backend.download(&buffer)?, &garbage(leaves), Shape::Line)
}

fn is_invalid(error: &Error) -> bool {
    matches!(error, Error::InvalidInput { .. })
}

fn unlike_lengths_are_refused<B: Backend>(cx: &Context<'_, B>) -> Check {
    for lengths in
        [[5, 4, 5, 5], [4, 5, 5, 5], [5, 5, 4, 5], [5, 5, 1, 5], [5, 5, 6, 5], [5, 5, 0, 4], [0, 0, 0, 1]]
    {
        refused(cx, lengths, &block(), is_invalid).map_err(|f| f.within(&format!("{lengths:?}")))?;
    }
    Ok(())
}

fn bad_parameters_are_refused<B: Backend>(cx: &Context<'_, B>) -> Check {
    let with = |change: &dyn Fn(&mut LightVoxelsBlock, f32), value| {
        let mut block = block();
        change(&mut block, value);
        block
    };
    for value in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        for block in [
            with(&|block, value| block.frame.corner[1] = value, value),
            with(&|block, value| block.frame.voxels_per_unit = value, value),
            with(&|block, value| block.scale = value, value),
            with(&|block, value| block.emission_unit = value, value),
        ] {
            refused(cx, [5, 5, 0, 5], &block, is_invalid).map_err(|f| f.within(&format!("{block:?}")))?;
        }
    }
    for value in [0.0, -1.0] {
        let block = with(&|block, value| block.frame.voxels_per_unit = value, value);
        refused(cx, [5, 5, 0, 5], &block, is_invalid).map_err(|f| f.within(&format!("{value} per unit")))?;
    }
    for samples in [MAX_SAMPLES + 1, u32::MAX] {
        let block = LightVoxelsBlock { samples, ..block() };
        let is_limit = |error: &Error| matches!(error, Error::LimitExceeded { .. });
        refused(cx, [5, 5, 0, 5], &block, is_limit).map_err(|f| f.within(&format!("{samples} samples")))?;
    }
    Ok(())
}

/// Sums and codes that `sum_voxels` never gives: still the contract's formula, within the leaves' limits.
fn sums_beyond_limits<B: Backend>(cx: &Context<'_, B>) -> Check {
    let change = |change: fn(&mut VoxelSums)| {
        let mut voxel = voxel([2, 3, 4], [3, 5, -2]);
        change(&mut voxel.sums);
        voxel
    };
    let mut beyond = voxel([2, 3, 4], [3, 5, -2]);
    beyond.code |= 0x3000_0000;
    let voxels = vec![
        change(|sums| sums.albedo = [4 * 4095, 100 * 4095, u32::MAX]),
        change(|sums| sums.count = u32::MAX),
        change(|sums| sums.normal = [i32::MIN, i32::MAX, i32::MIN]),
        change(|sums| sums.emission = [u32::MAX; 3]),
        change(|sums| (sums.padding, sums.padding_too) = (u32::MAX, u32::MAX)),
        beyond,
    ];
    let leaves = under(point([0.3, 2.0, 0.1]), voxels).agreed(cx)?;
    ensure(leaves[0].rgb[1] > 2 * leaves[4].rgb[1], || format!("albedo 100 is no brighter: {leaves:?}"))
}
