//! M1 to M3 of the hard cases.

use super::inputs::{Field, SPREADS, brightest, full, grid, spread};
use super::{Resident, STORAGES, agrees};
use crate::oracle::reduce_mips::reduce;
use crate::trial::{Check, Context, Listing, ensure, list_trials};
use twinlight_core::Backend;
use twinlight_core::kernels::reduce_mips::{ANISOTROPIC, ISOTROPIC, OPAQUE, SUMS, VoxelLight, words_of};
use twinlight_fixtures::random::Random;

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "reduce_mips": m1_light_is_kept, m2_nothing_and_one_voxel, m3_constants_stay);
}

/// Σ value·volume of one level and of the next differ by at most ½ per word and voxel of the next, in its volume.
fn m1_light_is_kept<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 11);
    for dims in [[3, 5, 7], [33, 17, 9], [1, 61, 3], [64, 64, 64]] {
        let field = spread(&mut random, dims, SPREADS[1], 900);
        let resident = Resident::new(cx, &field)?;
        let values = resident.values(cx, ISOTROPIC)?;
        let total = |level: usize, word: usize| -> i128 {
            let ends = [level, level + 1].map(|l| 4 * resident.want.starts[l] as usize);
            let volume = 1_i128 << (3 * level);
            values[ends[0]..ends[1]].iter().skip(word).step_by(4).map(|&v| i128::from(v) * volume).sum()
        };
        for level in 1..resident.want.starts.len() - 1 {
            let voxels = resident.want.starts[level + 1] - resident.want.starts[level];
            for word in 0..4 {
                let [below, here] = [level - 1, level].map(|l| total(l, word));
                let doubled = 2 * (here - below).abs();
                ensure(doubled <= i128::from(voxels) << (3 * level), || {
                    format!("{field:?}: word {word} sums to {below} below and to {here} on level {level}")
                })?;
            }
        }
    }
    Ok(())
}

/// No voxels: levels of zeroes and no values. A grid of one voxel has one level, which is itself.
fn m2_nothing_and_one_voxel<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 12);
    for dims in [[1, 1, 1], [2, 2, 2], [3, 1, 1], [5, 64, 33]] {
        agrees(cx, &Field::of(grid(dims), [], &mut random))?;
    }
    let one = Field { grid: grid([1; 3]), leaves: [(0, brightest())].into() };
    agrees(cx, &one)?;
    let resident = Resident::new(cx, &one)?;
    for (storage, name) in STORAGES {
        let words = resident.values(cx, storage)?.len();
        ensure(words == words_of(storage)?, || format!("{words} words of one voxel, {name}"))?;
    }
    Ok(())
}

/// The same in every voxel of a cube is the same on every level.
fn m3_constants_stay<B: Backend>(cx: &Context<'_, B>) -> Check {
    let opaque = |rgb| VoxelLight { rgb, opacity: OPAQUE };
    let thin = VoxelLight { rgb: [13, 0, 7_001], opacity: 999 };
    for light in [opaque([1, 2, 3]), opaque([12_345, 0, 4_194_304]), brightest(), opaque([0; 3]), thin] {
        for side in [1, 2, 8, 16] {
            let field =
                Field { grid: grid([side; 3]), leaves: full(side).map(|code| (code, light)).collect() };
            let resident = Resident::new(cx, &field)?;
            for (storage, name) in STORAGES {
                // Sums grow with the volume, and a column of two thin voxels covers more than one.
                if storage == SUMS || (storage == ANISOTROPIC && light.opacity < OPAQUE) {
                    continue;
                }
                let constant = reduce(1, &[(0, light)].into(), storage);
                let values = resident.values(cx, storage)?;
                let other = values.chunks(constant.len()).position(|value| value != constant);
                ensure(other.is_none(), || {
                    format!("{light:?} in {side}³, {name}: value {other:?} is another")
                })?;
            }
        }
    }
    Ok(())
}
