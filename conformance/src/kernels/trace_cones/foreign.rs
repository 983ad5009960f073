//! Levels, values and cones that nobody made: some light, and no crash.

use super::inputs::{Lit, cone, filled, plain, scattered, some_block, some_cone};
use super::{OPEN, STORAGES, agrees, same, traced};
use crate::trial::{Check, Context, Listing, list_trials};
use twinlight_core::Backend;
use twinlight_core::kernels::reduce_mips::{ANISOTROPIC, HARMONICS, HARMONICS_8, VoxelLight};
use twinlight_core::kernels::trace_cones::{Cone, SIXTY_DEGREES, TraceConesBlock};
use twinlight_fixtures::random::Random;

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "trace_cones": foreign_levels, foreign_values, beyond_their_limits, cones_that_are_no_numbers);
}

const DIMS: [u32; 3] = [9, 4, 13];

/// Masks and ranks of any bits, of the right lengths.
fn foreign_levels<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 71);
    for storage in STORAGES {
        let mut lit = Lit::new(DIMS, &scattered(&mut random, DIMS, 60), storage);
        lit.levels.mask.fill_with(|| random.next_u32());
        for ranks in [random.next_u32() % 500, u32::MAX] {
            lit.levels.ranks.fill_with(|| ranks.wrapping_add(random.next_u32() >> 20));
            let block = some_block(&mut random, storage, 13.0);
            let cones: Vec<Cone> = (0..30).map(|_| some_cone(&mut random, &block, DIMS)).collect();
            traced(cx.backend, &lit, &block, &cones)?;
        }
    }
    Ok(())
}

/// Values of any bits: those of storages that count on signs, limits and exponents.
fn foreign_values<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 72);
    for storage in STORAGES {
        let mut lit = Lit::new(DIMS, &scattered(&mut random, DIMS, 60), storage);
        lit.values.fill_with(|| random.next_u32());
        let block = some_block(&mut random, storage, 13.0);
        let cones: Vec<Cone> = (0..30).map(|_| some_cone(&mut random, &block, DIMS)).collect();
        traced(cx.backend, &lit, &block, &cones)?;
    }
    Ok(())
}

/// Opacities up to four times what is opaque, lobes that are steeper than they are high, and directions of any length.
fn beyond_their_limits<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 74);
    // A block of voxels, beside each other as those must be whose mean is beyond 1, and nothing around it.
    let leaves = filled([1, 0, 3], [8, 4, 9], VoxelLight::default());
    for storage in STORAGES {
        let of_leaves = Lit::new(DIMS, &leaves, storage);
        let values = made_up(&mut random, storage, of_leaves.levels.active.len());
        let lit = Lit::made_up(of_leaves.grid, of_leaves.levels, values, storage);
        let block = some_block(&mut random, storage, 13.0);
        let longer = |mut cone: Cone, by: f32| {
            cone.direction = cone.direction.map(|c| c * by);
            cone
        };
        let cones = (0..60).map(|_| some_cone(&mut random, &block, DIMS)).collect::<Vec<Cone>>();
        let cones: Vec<Cone> =
            cones.into_iter().enumerate().map(|(i, cone)| longer(cone, [1.0, 0.5, 1.5][i % 3])).collect();
        agrees(cx, &lit, &block, &cones)?;
    }
    Ok(())
}

/// Words of `count` values.
fn made_up(random: &mut Random, storage: u32, count: usize) -> Vec<u32> {
    let opacity = |random: &mut Random| {
        let bits = [8, 16, 16, 16][random.index(4)];
        random.index(4 << bits) as u32
    };
    let light = |random: &mut Random| random.index(5000) as u32;
    let signed = |random: &mut Random| (random.index(10_000) as i32 - 5000) as u32;
    let mut values = Vec::new();
    for _ in 0..count {
        match storage {
            HARMONICS => {
                values.push(opacity(random));
                for _ in 0..3 {
                    values.extend([light(random), signed(random), signed(random), signed(random)]);
                }
            }
            HARMONICS_8 => {
                values.push(opacity(random) | (random.index(12) as u32) << 24);
                values.extend([(); 3].map(|()| random.next_u32()));
            }
            _ => {
                for _ in 0..if storage == ANISOTROPIC { 6 } else { 1 } {
                    values.extend([light(random), light(random), light(random), opacity(random)]);
                }
            }
        }
    }
    values
}

/// Origins and directions that are no numbers are outside of every grid. Whatever else is none ends sooner or later.
fn cones_that_are_no_numbers<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 73);
    for storage in STORAGES {
        let lit = Lit::new(DIMS, &scattered(&mut random, DIMS, 200), storage);
        let base = cone([4.5, 2.5, 6.5], [0.6, 0.0, 0.8], 0.3);
        for flags in [0, SIXTY_DEGREES] {
            let block = TraceConesBlock { flags, ..plain(storage) };
            for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
                let nowhere = [
                    Cone { origin: [4.5, bad, 6.5], ..base },
                    Cone { direction: [0.6, bad, 0.8], start: 1.0, ..base },
                ];
                let light = traced(cx.backend, &lit, &block, &nowhere)?;
                // Only strict mode may be asked what compares with NaN.
                if cx.backend.info().strict {
                    same(&format!("{lit:?} and {bad}"), &light, &[OPEN; 2])?;
                }
                let others = [
                    Cone { start: bad, ..base },
                    Cone { normal: [bad, 0.0, 1.0], ..base },
                    Cone { direction: [0.0; 3], sine: bad, ..base },
                ];
                traced(cx.backend, &lit, &block, &others)?;
                traced(cx.backend, &lit, &TraceConesBlock { reach: bad, ..block }, &[base])?;
            }
        }
    }
    Ok(())
}
