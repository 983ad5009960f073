//! Every set of octants, ladders of lengths, random grids, full ones, and the largest.

use super::agrees;
use super::inputs::{Field, SPREADS, brightest, full, grid, spread};
use crate::kernels::property::hold;
use crate::trial::{Check, Context, Listing, list_trials};
use proptest::prelude::*;
use twinlight_core::Backend;
use twinlight_core::kernels::reduce_mips::VoxelLight;
use twinlight_fixtures::random::Random;

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "reduce_mips":
        one_voxel_per_octant, every_set_of_octants, voxel_ladder, random_grids, odd_grids, one_thick_grids, full_grids,
        light_and_darkness, the_largest_grid,
    );
}

/// One voxel in each octant of two levels, alone.
fn one_voxel_per_octant<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 1);
    for octant in 0..8 {
        agrees(cx, &Field::of(grid([4; 3]), [octant * 8 + (octant + 3) % 8], &mut random))?;
    }
    Ok(())
}

/// The parents of level 1 have one set of children each.
fn every_set_of_octants<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 2);
    let codes = (0..256).flat_map(|set| (0..8).filter(move |i| set >> i & 1 == 1).map(move |i| 8 * set + i));
    agrees(cx, &Field::of(grid([16; 3]), codes, &mut random))
}

/// Around a byte, a word, a workgroup and a task, in a row of codes and one of eight.
fn voxel_ladder<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 3);
    for count in [1, 7, 8, 9, 31, 32, 33, 255, 256, 257, 2_047, 2_048, 2_049] {
        agrees(cx, &Field::of(grid([16; 3]), 0..count, &mut random))?;
    }
    for count in [2_047, 2_048, 2_049] {
        agrees(cx, &Field::of(grid([32; 3]), (0..count).map(|i| 8 * i + i % 8), &mut random))?;
    }
    Ok(())
}

fn random_grids<B: Backend>(cx: &Context<'_, B>) -> Check {
    let dims = prop::array::uniform3(1..=64_u32);
    hold(cx, (any::<u64>(), dims, 0..4_usize, 0..1_500_usize), |(seed, dims, kind, count)| {
        agrees(cx, &spread(&mut Random::new(seed), dims, SPREADS[kind], count))
    })
}

fn odd_grids<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 4);
    for dims in [[3, 5, 7], [9, 9, 9], [17, 3, 2], [31, 33, 5]] {
        for kind in SPREADS {
            agrees(cx, &spread(&mut random, dims, kind, 300))?;
        }
    }
    Ok(())
}

fn one_thick_grids<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 5);
    for dims in [[64, 1, 1], [1, 64, 1], [1, 1, 64], [1, 40, 33], [2, 1, 1], [1, 1, 2]] {
        agrees(cx, &spread(&mut random, dims, SPREADS[0], 200))?;
    }
    Ok(())
}

/// All voxels there are: more parents than a task has.
fn full_grids<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 6);
    for side in [1, 2, 4, 8, 32] {
        agrees(cx, &Field::of(grid([side; 3]), full(side), &mut random))?;
    }
    Ok(())
}

/// What makes sums the greatest and harmonics the steepest: the brightest beside nothing, in every half, and everywhere.
fn light_and_darkness<B: Backend>(cx: &Context<'_, B>) -> Check {
    for bright in [0x00, 0xaa, 0xcc, 0xf0, 0x80, 0x01, 0x69, 0xff] {
        let light = |code: u32| {
            // A voxel is bright as its octants on all levels are.
            let is_bright = (0..4).all(|level| bright >> (code >> (3 * level) & 7) & 1 == 1);
            (code, if is_bright { brightest() } else { VoxelLight { rgb: [0; 3], ..brightest() } })
        };
        agrees(cx, &Field { grid: grid([16; 3]), leaves: full(16).map(light).collect() })?;
    }
    Ok(())
}

/// 512 voxels to a side, few of them active, the first and the last among them.
fn the_largest_grid<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 7);
    let mut field = spread(&mut random, [512; 3], SPREADS[1], 400);
    field.leaves.extend(spread(&mut random, [512; 3], SPREADS[0], 300).leaves);
    field.leaves.extend(Field::of(field.grid, [0, (1 << 27) - 1], &mut random).leaves);
    agrees(cx, &field)
}
