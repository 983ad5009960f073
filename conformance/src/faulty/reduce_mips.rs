//! Bugs in `reduce_mips`: levels and values made on the host, wrong in one step.

use crate::faults::Fault;
use crate::oracle::reduce_mips::{Levels, levels};
use std::collections::BTreeSet;
use twinlight_core::kernels::reduce_mips::{
    ReduceMipsParams, VoxelLevelBuffers, VoxelLevels, VoxelLight, check_voxels,
};
use twinlight_core::kernels::voxelize::Voxels;
use twinlight_core::{Backend, Result};

mod values;

use values::Values;

pub(super) fn voxel_levels<B: Backend>(
    inner: &B,
    fault: Fault,
    voxels: &Voxels<B>,
) -> Result<VoxelLevels<B>> {
    let sound = inner.voxel_levels(voxels);
    let fit = check_voxels(voxels, |buffer| inner.len(buffer)).is_ok();
    let broken = if fault == Fault::MipsAcceptsAnything && !fit {
        Levels { starts: vec![0], mask: Vec::new(), ranks: Vec::new(), active: Vec::new() }
    } else if is_of_levels(fault) && fit {
        let padded = voxels.grid.padded();
        let mask = inner.download(&voxels.mask)?;
        let bits = |(i, word): (usize, &u32)| {
            let word = *word;
            (0..32).filter(move |bit| word >> bit & 1 == 1).map(move |bit| 32 * i as u32 + bit)
        };
        let codes: BTreeSet<u32> = mask.iter().enumerate().flat_map(bits).collect();
        // Bugs must show in sound masks: those of other origin are left to the sound backend.
        if codes.last().is_some_and(|&code| u64::from(code) >= u64::from(padded).pow(3)) {
            return sound;
        }
        broken_levels(fault, padded, &codes)
    } else {
        return sound;
    };
    Ok(VoxelLevelBuffers {
        grid: voxels.grid,
        starts: broken.starts,
        mask: inner.upload(&broken.mask)?,
        ranks: inner.upload(&broken.ranks)?,
        active: inner.upload(&broken.active)?,
    })
}

fn is_of_levels(fault: Fault) -> bool {
    matches!(
        fault,
        Fault::MipsStartsOff
            | Fault::MipsRanksPerLevel
            | Fault::MipsRanksInclusive
            | Fault::MipsLosesParent
            | Fault::MipsUpperChildren
            | Fault::MipsDescends
            | Fault::MipsParentOfSixteen
            | Fault::MipsLosesTop
    )
}

fn broken_levels(fault: Fault, padded: u32, codes: &BTreeSet<u32>) -> Levels {
    let mut found = levels(padded, codes);
    let values =
        |found: &Levels, level: usize| found.starts[level] as usize..found.starts[level + 1] as usize;
    let level_count = found.starts.len() - 1;
    let words =
        |level: usize| (0..level).map(|l| (padded as usize >> l).pow(3).div_ceil(32).max(1)).sum::<usize>();
    match fault {
        Fault::MipsStartsOff => found.starts[1..level_count].iter_mut().for_each(|start| *start += 1),
        Fault::MipsRanksPerLevel => {
            for level in 1..level_count {
                found.ranks[words(level)..words(level + 1)]
                    .iter_mut()
                    .for_each(|r| *r -= found.starts[level]);
            }
        }
        Fault::MipsRanksInclusive => {
            for word in 0..found.mask.len() {
                found.ranks[word] += found.mask[word].count_ones();
            }
        }
        Fault::MipsLosesParent if level_count > 1 => {
            if let Some(&code) = found.active[values(&found, 1)].last() {
                found.mask[words(1) + code as usize / 32] &= !(1 << (code % 32));
            }
        }
        Fault::MipsUpperChildren if level_count > 1 => {
            let parents: BTreeSet<u32> =
                codes.iter().filter(|&code| code % 8 < 4).map(|code| code / 8).collect();
            found.mask[words(1)..words(2)].fill(0);
            parents.iter().for_each(|&code| found.mask[words(1) + code as usize / 32] |= 1 << (code % 32));
        }
        Fault::MipsDescends => (0..level_count).for_each(|level| {
            let range = values(&found, level);
            found.active[range].reverse();
        }),
        Fault::MipsParentOfSixteen if level_count > 1 => {
            let range = values(&found, 1);
            found.active[range].iter_mut().for_each(|code| *code /= 2);
        }
        Fault::MipsLosesTop if level_count > 1 => {
            found.starts[level_count] = found.starts[level_count - 1];
            found.mask[words(level_count - 1)] = 0;
        }
        _ => {}
    }
    found
}

pub(super) fn reduce_mips<B: Backend>(
    inner: &B,
    fault: Fault,
    levels: &VoxelLevels<B>,
    leaves: &B::Buffer<VoxelLight>,
    params: &ReduceMipsParams,
) -> Result<B::Buffer<u32>> {
    let sound = inner.reduce_mips(levels, leaves, params);
    let fit = params.check(levels, |buffer| inner.len(buffer), inner.len(leaves)).is_ok();
    if fault == Fault::MipsAcceptsAnything && !fit {
        return inner.zeroed(0);
    }
    if fault == Fault::None || is_of_levels(fault) || !is_of_mips(fault) || !fit {
        return sound;
    }
    let active = inner.download(&levels.active)?;
    let leaves = inner.download(leaves)?;
    // As above: each value but those of the last level is the child of one.
    let (starts, mut below) = (&levels.starts, 0..0);
    for ends in starts.windows(2) {
        let range = ends[0] as usize..ends[1] as usize;
        let parents: BTreeSet<u32> = active[below.clone()].iter().map(|code| code / 8).collect();
        if ends[0] > 0 && !active[range.clone()].iter().eq(&parents) {
            return sound;
        }
        below = range;
    }
    let values = Values { fault, storage: params.storage, starts, active: &active, leaves: &leaves };
    inner.upload(&values.words())
}

fn is_of_mips(fault: Fault) -> bool {
    crate::faults::FAULTS.iter().any(|(of, kernel, _)| *of == fault && *kernel == "reduce_mips")
}
