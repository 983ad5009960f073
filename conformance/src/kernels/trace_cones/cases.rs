//! Nothing, one, many; every size, storage and kind of cone; what is refused.

use super::inputs::{Leaves, Lit, cone, filled, plain, scattered, some_block, some_cone};
use super::{OPEN, STORAGES, agrees, same, traced, undecided, uploaded};
use crate::kernels::property;
use crate::trial::{Check, Context, Listing, ensure, list_trials};
use proptest::prelude::*;
use twinlight_core::kernels::reduce_mips::{ISOTROPIC, OPAQUE, RANGES, SUMS, VoxelLight};
use twinlight_core::kernels::trace_cones::{Cone, ConeLight, SIXTY_DEGREES, TraceConesBlock, VoxelFrame};
use twinlight_core::{Backend, Error};
use twinlight_fixtures::random::Random;

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "trace_cones":
        nothing, single_voxel, many_cones, every_size, some_pyramids, most_ends_are_decided,
        unsound_calls_are_refused,
    );
}

/// No cones, and cones through grids without voxels.
fn nothing<B: Backend>(cx: &Context<'_, B>) -> Check {
    for dims in [[1, 1, 1], [5, 1, 3], [16, 16, 16]] {
        for storage in STORAGES {
            let lit = Lit::new(dims, &Leaves::new(), storage);
            same("no cones", &traced(cx.backend, &lit, &plain(storage), &[])?, &[])?;
            let cones = [0.0, 0.3, 0.9].map(|sine| cone([0.5; 3], [0.6, 0.64, 0.48], sine));
            same("no voxels", &traced(cx.backend, &lit, &plain(storage), &cones)?, &[OPEN; 3])?;
        }
    }
    Ok(())
}

/// One voxel is its own last level.
fn single_voxel<B: Backend>(cx: &Context<'_, B>) -> Check {
    let leaves = filled([0; 3], [1; 3], VoxelLight { rgb: [70_000, 3, 0], opacity: 9000 });
    for storage in STORAGES {
        let lit = Lit::new([1; 3], &leaves, storage);
        let mut random = Random::new(cx.options.seed ^ 31);
        for flags in [0, SIXTY_DEGREES] {
            let block = TraceConesBlock { flags, ..plain(storage) };
            let cones: Vec<Cone> = (0..20).map(|_| some_cone(&mut random, &block, [1; 3])).collect();
            agrees(cx, &lit, &block, &cones)?;
        }
    }
    Ok(())
}

/// More than a workgroup, a chunk and their multiples; the last is as good as any.
fn many_cones<B: Backend>(cx: &Context<'_, B>) -> Check {
    let lit = Lit::new(
        [6; 3],
        &filled([4, 0, 0], [5, 6, 6], VoxelLight { rgb: [9; 3], opacity: OPAQUE }),
        ISOTROPIC,
    );
    let towards = cone([0.5, 2.5, 2.5], [1.0, 0.0, 0.0], 0.0);
    for count in [1, 63, 64, 65, 256, 257, 1000] {
        let cones: Vec<Cone> = (0..count).map(|i| Cone { start: (i % 4) as f32, ..towards }).collect();
        let want = ConeLight { rgb: [9.0; 3], transmittance: 0.0 };
        same(
            &format!("{count} cones"),
            &traced(cx.backend, &lit, &plain(ISOTROPIC), &cones)?,
            &vec![want; count],
        )?;
    }
    Ok(())
}

/// Odd sizes, sizes beside powers of two, and grids that are one thick.
fn every_size<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 32);
    for dims in [[1, 1, 2], [2, 3, 1], [3, 3, 3], [5, 1, 7], [1, 9, 4], [17, 2, 5], [12, 20, 1], [31, 1, 1]] {
        for storage in STORAGES {
            let count = (dims[0] * dims[1] * dims[2]) as usize / 2 + 1;
            let lit = Lit::new(dims, &scattered(&mut random, dims, count), storage);
            let side = f64::from(dims[0].max(dims[1]).max(dims[2]));
            let block = some_block(&mut random, storage, side);
            let cones: Vec<Cone> = (0..10).map(|_| some_cone(&mut random, &block, dims)).collect();
            agrees(cx, &lit, &block, &cones)?;
        }
    }
    Ok(())
}

/// Grids of up to 32³, from nearly empty to nearly full.
fn some_pyramids<B: Backend>(cx: &Context<'_, B>) -> Check {
    let dims = prop::array::uniform3(1..=32_u32);
    let inputs = (dims, 1..400_usize, prop::sample::select(STORAGES.to_vec()), any::<u64>());
    property::hold(cx, inputs, |(dims, count, storage, seed)| {
        let mut random = Random::new(seed);
        let lit = Lit::new(dims, &scattered(&mut random, dims, count), storage);
        let block = some_block(&mut random, storage, 32.0);
        let cones: Vec<Cone> = (0..16).map(|_| some_cone(&mut random, &block, dims)).collect();
        agrees(cx, &lit, &block, &cones)
    })
}

/// The oracle lets few cones end as they please: among some, one in twenty at most.
fn most_ends_are_decided<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 33);
    let lit = Lit::new([16, 11, 13], &scattered(&mut random, [16, 11, 13], 90), ISOTROPIC);
    let block = some_block(&mut random, ISOTROPIC, 16.0);
    let cones: Vec<Cone> = (0..200).map(|_| some_cone(&mut random, &block, [16, 11, 13])).collect();
    agrees(cx, &lit, &block, &cones)?;
    let doubtful = undecided(&lit, &block, &cones);
    ensure(doubtful * 20 <= cones.len(), || format!("{doubtful} of {} cones are undecided", cones.len()))
}

/// Storages without light, lengths that don't fit, frames that are no numbers.
fn unsound_calls_are_refused<B: Backend>(cx: &Context<'_, B>) -> Check {
    let lit = Lit::new([3; 3], &filled([0; 3], [3, 3, 1], VoxelLight { rgb: [1; 3], opacity: 1 }), ISOTROPIC);
    let sound = plain(ISOTROPIC);
    let frames = [f32::NAN, f32::INFINITY, 0.0, -1.0].map(|voxels_per_unit| TraceConesBlock {
        frame: VoxelFrame { voxels_per_unit, ..sound.frame },
        ..sound
    });
    let corner = [0.0, f32::NEG_INFINITY, 0.0];
    let moved = TraceConesBlock { frame: VoxelFrame { corner, ..sound.frame }, ..sound };
    let unit = TraceConesBlock { unit: f32::NAN, ..sound };
    let storages = [SUMS, RANGES, 6, 1].map(|storage| TraceConesBlock { storage, ..sound });
    let blocks = frames.into_iter().chain([moved, unit]).chain(storages);
    for block in blocks {
        refused(&format!("{block:?}"), traced(cx.backend, &lit, &block, &[]))?;
    }
    let short = Lit { values: lit.values[1..].to_vec(), ..lit.clone() };
    refused("a word less", traced(cx.backend, &short, &sound, &[]))?;
    let mut levels = lit.levels.clone();
    levels.ranks.pop();
    let short = Lit { levels, ..lit.clone() };
    refused("a rank less", traced(cx.backend, &short, &sound, &[]))?;
    let (levels, values) = (uploaded(cx.backend, &lit)?, cx.backend.upload(&lit.values)?);
    let (cones, mut light) = (cx.backend.zeroed::<Cone>(3)?, cx.backend.zeroed::<ConeLight>(2)?);
    let lengths = cx.backend.trace_cones(&levels, &values, &cones, &sound, &mut light);
    refused("a light less", lengths.map(|()| Vec::new()))
}

fn refused(what: &str, result: twinlight_core::Result<Vec<ConeLight>>) -> Check {
    ensure(matches!(result, Err(Error::InvalidInput { .. })), || format!("{what}: {result:?}"))
}
