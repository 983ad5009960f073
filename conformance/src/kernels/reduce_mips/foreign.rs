//! What is refused, and buffers that no kernel made.

use super::inputs::{Field, SPREADS, grid, spread};
use super::{Resident, STORAGES, agrees, downloaded, same_levels};
use crate::trial::{Check, Context, Failure, Listing, ensure, list_trials};
use std::fmt::Debug;
use twinlight_core::kernels::reduce_mips::{
    ISOTROPIC, ReduceMipsParams, VoxelLevelBuffers, VoxelLevels, VoxelLight, words_of,
};
use twinlight_core::kernels::voxelize::{VoxelBuffers, Voxels};
use twinlight_core::lattice::VoxelGrid;
use twinlight_core::{Backend, Error};
use twinlight_fixtures::random::Random;

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "reduce_mips":
        unknown_storages_are_refused, unlike_lengths_are_refused, impossible_grids_are_refused, starts_must_rise,
        ranks_and_codes_of_other_origin, levels_of_other_origin, leaves_beyond_their_limits,
    );
}

fn refused<T: Debug>(result: Result<T, Error>) -> Check {
    match result {
        Err(Error::InvalidInput { .. }) => Ok(()),
        Err(other) => Err(other.into()),
        Ok(there) => Err(Failure::Mismatch(format!("not refused: {there:?}"))),
    }
}

fn some_field(seed: u64) -> Field {
    spread(&mut Random::new(seed), [20, 31, 9], SPREADS[1], 300)
}

fn resized<B: Backend>(
    cx: &Context<'_, B>,
    buffer: &B::Buffer<u32>,
    by: i32,
) -> Result<B::Buffer<u32>, Error> {
    let mut words = cx.backend.download(buffer)?;
    words.resize(words.len().saturating_add_signed(by as isize), 0);
    cx.backend.upload(&words)
}

/// The values' length, or whatever an error says.
fn reduced<B: Backend>(
    cx: &Context<'_, B>,
    levels: &VoxelLevels<B>,
    leaves: &B::Buffer<VoxelLight>,
    storage: u32,
) -> Result<usize, Error> {
    let values = cx.backend.reduce_mips(levels, leaves, &ReduceMipsParams { storage })?;
    Ok(cx.backend.download(&values)?.len())
}

fn unknown_storages_are_refused<B: Backend>(cx: &Context<'_, B>) -> Check {
    let field = some_field(31);
    let resident = Resident::new(cx, &field)?;
    for storage in [6, 7, 1 << 31, u32::MAX] {
        refused(reduced(cx, &resident.levels, &resident.leaves, storage))
            .map_err(|f| f.within(&format!("storage {storage}")))?;
    }
    // A refused call leaves its inputs and the backend as they were.
    resident.inputs_are_kept(cx)?;
    agrees(cx, &field)
}

/// Masks, ranks, codes and leaves that are one too few or too many.
fn unlike_lengths_are_refused<B: Backend>(cx: &Context<'_, B>) -> Check {
    let field = some_field(32);
    let Resident { voxels, levels, leaves, .. } = &Resident::new(cx, &field)?;
    for by in [-1, 1] {
        let place = |f: Failure| f.within(&format!("{by} more"));
        let mask = resized(cx, &voxels.mask, by)?;
        refused(cx.backend.voxel_levels(&VoxelBuffers { mask, ..copy(cx, voxels)? })).map_err(place)?;
        let ranks = resized(cx, &voxels.ranks, by)?;
        refused(cx.backend.voxel_levels(&VoxelBuffers { ranks, ..copy(cx, voxels)? })).map_err(place)?;
        for part in 0..3 {
            let mut wrong = copy_levels(cx, levels)?;
            let buffer = [&mut wrong.mask, &mut wrong.ranks, &mut wrong.active].into_iter().nth(part);
            buffer.into_iter().try_for_each(|buffer| -> Check {
                *buffer = resized(cx, buffer, by)?;
                Ok(())
            })?;
            let place = |f: Failure| f.within(&format!("{by} more in buffer {part}"));
            refused(reduced(cx, &wrong, leaves, ISOTROPIC)).map_err(place)?;
        }
        let mut lights = field.lights();
        lights.resize(lights.len().saturating_add_signed(by as isize), VoxelLight::default());
        refused(reduced(cx, levels, &cx.backend.upload(&lights)?, ISOTROPIC)).map_err(place)?;
    }
    Ok(())
}

/// Grids without voxels, of more than there may be, and of another number of levels than the buffers have.
fn impossible_grids_are_refused<B: Backend>(cx: &Context<'_, B>) -> Check {
    let field = some_field(33);
    let Resident { voxels, levels, leaves, .. } = &Resident::new(cx, &field)?;
    let of = |dims| VoxelGrid { dims, ..field.grid };
    let budget = VoxelGrid { subvoxel_bits: 0, ..field.grid };
    for wrong in [of([0, 31, 9]), of([20, 513, 9]), of([u32::MAX; 3]), of([16, 3, 9]), of([64; 3]), budget] {
        let place = |f: Failure| f.within(&format!("{wrong:?}"));
        refused(cx.backend.voxel_levels(&VoxelBuffers { grid: wrong, ..copy(cx, voxels)? }))
            .map_err(place)?;
        let wrong = VoxelLevelBuffers { grid: wrong, ..copy_levels(cx, levels)? };
        refused(reduced(cx, &wrong, leaves, ISOTROPIC)).map_err(place)?;
    }
    Ok(())
}

fn starts_must_rise<B: Backend>(cx: &Context<'_, B>) -> Check {
    let field = some_field(34);
    let Resident { levels, leaves, .. } = &Resident::new(cx, &field)?;
    let sound = &levels.starts;
    let last = sound.len() - 1;
    let with = |place: usize, start: u32| {
        let mut starts = sound.clone();
        starts[place] = start;
        starts
    };
    let longer = [sound.as_slice(), &[sound[last]]].concat();
    let falling = with(2, sound[3] + 1);
    for starts in [Vec::new(), sound[..last].to_vec(), longer, with(0, 1), falling, with(last, u32::MAX)] {
        let place = format!("{starts:?}");
        let wrong = VoxelLevelBuffers { starts, ..copy_levels(cx, levels)? };
        refused(reduced(cx, &wrong, leaves, ISOTROPIC)).map_err(|f| f.within(&place))?;
    }
    Ok(())
}

/// Voxels whose ranks and lists are not their mask's: some levels of sound lengths, or an error; the next call is as before.
fn ranks_and_codes_of_other_origin<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 35);
    let field = some_field(35);
    let resident = Resident::new(cx, &field)?;
    for most in [0, 9, u32::MAX] {
        let mut words = |count: usize| -> Vec<u32> { (0..count).map(|_| random.next_u32() & most).collect() };
        let mut voxels = copy(cx, &resident.voxels)?;
        voxels.ranks = cx.backend.upload(&words(cx.backend.len(&voxels.ranks)))?;
        voxels.active = cx.backend.upload(&words(777))?;
        voxels.parents = cx.backend.upload(&words(3))?;
        if let Ok(levels) = cx.backend.voxel_levels(&voxels) {
            levels.check(|buffer| cx.backend.len(buffer))?;
        }
        // Bits outside of the grid, in levels of less than a word too.
        for dims in [[20, 31, 9], [2, 2, 1], [1, 1, 1]] {
            let grid = grid(dims);
            voxels.grid = grid;
            voxels.mask = cx.backend.upload(&words(grid.mask_words()))?;
            voxels.ranks = cx.backend.upload(&words(grid.mask_words() + 1))?;
            let Ok(levels) = cx.backend.voxel_levels(&voxels) else { continue };
            levels.check(|buffer| cx.backend.len(buffer))?;
            let leaves = cx.backend.zeroed::<VoxelLight>(levels.starts[1] as usize)?;
            for (storage, _) in STORAGES {
                lengths_fit(cx, &levels, &leaves, storage)?;
            }
        }
    }
    resident.levels_agree(cx)
}

/// Values of the length that is asked for, or an error.
fn lengths_fit<B: Backend>(
    cx: &Context<'_, B>,
    levels: &VoxelLevels<B>,
    leaves: &B::Buffer<VoxelLight>,
    storage: u32,
) -> Check {
    let want = words_of(storage)? * cx.backend.len(&levels.active);
    let found = reduced(cx, levels, leaves, storage);
    ensure(found.as_ref().map_or(true, |&found| found == want), || format!("{found:?} words, want {want}"))
}

/// Levels of any mask, ranks and codes, with starts that rise: some values, or an error.
fn levels_of_other_origin<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 36);
    let field = some_field(36);
    let resident = Resident::new(cx, &field)?;
    for most in [0, 7, 500, u32::MAX] {
        let mut words = |buffer: &B::Buffer<u32>| -> Result<B::Buffer<u32>, Error> {
            let len = cx.backend.len(buffer);
            cx.backend.upload(&(0..len).map(|_| random.next_u32() & most).collect::<Vec<u32>>())
        };
        let VoxelLevelBuffers { mask, ranks, active, .. } = &resident.levels;
        for foreign in 1..8 {
            let mut levels = copy_levels(cx, &resident.levels)?;
            levels.mask = if foreign & 1 == 0 { levels.mask } else { words(mask)? };
            levels.ranks = if foreign & 2 == 0 { levels.ranks } else { words(ranks)? };
            levels.active = if foreign & 4 == 0 { levels.active } else { words(active)? };
            for (storage, _) in STORAGES {
                lengths_fit(cx, &levels, &resident.leaves, storage)?;
            }
        }
    }
    let levels = downloaded(cx, &resident.levels)?;
    same_levels(cx, &levels, &resident.want)?;
    agrees(cx, &field)
}

/// Values of the length that is asked for, whatever leaves say.
fn leaves_beyond_their_limits<B: Backend>(cx: &Context<'_, B>) -> Check {
    let field = some_field(37);
    let resident = Resident::new(cx, &field)?;
    let beyond =
        [[u32::MAX; 4], [1 << 31, 1 << 30, 1 << 29, u32::MAX], [0, 0, 0, 1 << 17], [1 << 23, 0, 0, 0]];
    for [r, g, b, opacity] in beyond {
        let light = VoxelLight { rgb: [r, g, b], opacity };
        let leaves = cx.backend.upload(&vec![light; field.leaves.len()])?;
        for (storage, _) in STORAGES {
            lengths_fit(cx, &resident.levels, &leaves, storage)?;
        }
    }
    agrees(cx, &field)
}

fn copied<B: Backend>(cx: &Context<'_, B>, buffer: &B::Buffer<u32>) -> Result<B::Buffer<u32>, Error> {
    cx.backend.upload(&cx.backend.download(buffer)?)
}

fn copy<B: Backend>(cx: &Context<'_, B>, voxels: &Voxels<B>) -> Result<Voxels<B>, Error> {
    Ok(VoxelBuffers {
        grid: voxels.grid,
        small: copied(cx, &voxels.small)?,
        large: copied(cx, &voxels.large)?,
        mask: copied(cx, &voxels.mask)?,
        ranks: copied(cx, &voxels.ranks)?,
        active: copied(cx, &voxels.active)?,
        parents: copied(cx, &voxels.parents)?,
    })
}

fn copy_levels<B: Backend>(cx: &Context<'_, B>, levels: &VoxelLevels<B>) -> Result<VoxelLevels<B>, Error> {
    Ok(VoxelLevelBuffers {
        grid: levels.grid,
        starts: levels.starts.clone(),
        mask: copied(cx, &levels.mask)?,
        ranks: copied(cx, &levels.ranks)?,
        active: copied(cx, &levels.active)?,
    })
}
