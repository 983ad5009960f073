// kernel family: reduce_mips
// contract core/src/kernels/reduce_mips.rs
// cpu backend-cpu/src/kernels/reduce_mips.rs
// gpu backend-gpu/src/kernels/reduce_mips.wgsl
// oracle conformance/src/oracle/reduce_mips.rs
//! `reduce_mips`: a pass over each level's words for masks, and over each level's values, whose children follow each other in the level
//! below. Levels are made from the mask alone: ranks and codes of other origin can't lead astray.

use crate::buffer::try_zeroed;
use crate::kernels::voxelize::lists;
use crate::simd::Isa;
use crate::{CpuBackend, CpuBuffer};
use bytemuck::Pod;
use rayon::prelude::*;
use twinlight_core::Result;
use twinlight_core::kernels::reduce_mips::{
    ANISOTROPIC, HARMONICS, HARMONICS_8, ISOTROPIC, SUMS, VoxelLevelBuffers, VoxelLevels, VoxelLight,
    word_starts,
};
use twinlight_core::kernels::voxelize::Voxels;

mod anisotropic;
mod children;
mod harmonics;
mod harmonics_8;
mod isotropic;
mod totals;

use anisotropic::Anisotropic;
use children::Below;
use harmonics::Harmonics;
use isotropic::Isotropic;
use totals::{Ranges, Sums};

/// Words of a mask per task.
const WORDS: usize = 1 << 12;

/// Values per task: what the caches hold of the widest, with their children.
const CHUNK: usize = 1 << 11;

/// A way to store light in W words.
trait Storage<const W: usize> {
    fn leaf(light: &VoxelLight) -> [u32; W];

    /// What a parent stores of its children, which are those of `octants` in their order.
    fn parent(children: &[[u32; W]], octants: u32) -> [u32; W];
}

/// The buffers have the lengths that the grid asks for.
pub(crate) fn voxel_levels(isa: Isa, voxels: &Voxels<CpuBackend>) -> Result<VoxelLevels<CpuBackend>> {
    let firsts = word_starts(voxels.grid.padded());
    let words = firsts[firsts.len() - 1];
    // [1] level masks
    let mut mask = try_zeroed::<u32>(words)?;
    mask[..firsts[1]].copy_from_slice(voxels.mask.as_slice());
    for ends in firsts.windows(3) {
        let (below, level) = mask[ends[0]..ends[2]].split_at_mut(ends[1] - ends[0]);
        reduce_mask(below, level);
    }
    // [2] rank
    let ranks = lists::ranks(isa, &mask)?;
    let starts: Vec<u32> = firsts.iter().map(|&word| ranks[word]).collect();
    // [3] list
    let mut active = try_zeroed::<u32>(ranks[words] as usize)?;
    for (words, values) in firsts.windows(2).zip(starts.windows(2)) {
        let codes = &mut active[values[0] as usize..values[1] as usize];
        lists::fill_codes(&mask[words[0]..words[1]], &ranks[words[0]..=words[1]], codes);
    }
    let [mask, ranks, active] = [mask, ranks, active].map(CpuBuffer::from);
    Ok(VoxelLevelBuffers { grid: voxels.grid, starts, mask, ranks, active })
}

/// A bit for each byte of the level below, in words that are 0.
fn reduce_mask(below: &[u32], level: &mut [u32]) {
    let chunks = level.par_chunks_mut(WORDS).zip(below.par_chunks(8 * WORDS));
    chunks.for_each(|(level, below)| {
        for (word, children) in level.iter_mut().zip(below.chunks(8)) {
            // Most of a grid is empty.
            if children.iter().fold(0, |all, child| all | child) == 0 {
                continue;
            }
            let bits = children.iter().enumerate().map(|(i, child)| filled_bytes(*child) << (4 * i));
            *word = bits.fold(0, |word, bits| word | bits);
        }
    });
}

/// Four bits, set where the byte isn't 0.
#[inline(always)]
fn filled_bytes(word: u32) -> u32 {
    let nibbles = word | (word >> 4);
    let pairs = nibbles | (nibbles >> 2);
    let bytes = (pairs | (pairs >> 1)) & 0x0101_0101;
    // Each lowest bit arrives at one of the bits 24 to 27, and what else there is neither meets nor passes them.
    (bytes.wrapping_mul(0x0102_0408) >> 24) & 0xf
}

/// Levels, leaves and storage fit each other; `words` is the length of a value.
pub(crate) fn reduce_mips(
    levels: &VoxelLevels<CpuBackend>,
    leaves: &[VoxelLight],
    storage: u32,
    words: usize,
) -> Result<CpuBuffer<u32>> {
    let count = levels.active.as_slice().len();
    let mut values = try_zeroed::<u32>(words * count)?;
    match storage {
        ISOTROPIC => fill::<4, Isotropic>(levels, leaves, &mut values),
        ANISOTROPIC => fill::<24, Anisotropic>(levels, leaves, &mut values),
        HARMONICS => fill::<13, Harmonics>(levels, leaves, &mut values),
        HARMONICS_8 => {
            let mut harmonics = try_zeroed::<u32>(13 * count)?;
            fill::<13, Harmonics>(levels, leaves, &mut harmonics);
            // [6] pack: harmonics in bytes
            let chunks = as_values_mut::<4>(&mut values).par_chunks_mut(CHUNK);
            chunks.zip(as_values::<13>(&harmonics).par_chunks(CHUNK)).for_each(|(packed, harmonics)| {
                packed
                    .iter_mut()
                    .zip(harmonics)
                    .for_each(|(packed, value)| *packed = harmonics_8::pack(value));
            });
        }
        SUMS => fill::<2, Sums>(levels, leaves, &mut values),
        _ => fill::<2, Ranges>(levels, leaves, &mut values),
    }
    Ok(CpuBuffer::from(values))
}

/// The values of all levels.
fn fill<const W: usize, S: Storage<W>>(
    levels: &VoxelLevels<CpuBackend>,
    leaves: &[VoxelLight],
    values: &mut [u32],
) where
    [u32; W]: Pod,
{
    let values = as_values_mut::<W>(values);
    // [4] leaves
    let chunks = values[..leaves.len()].par_chunks_mut(CHUNK).zip(leaves.par_chunks(CHUNK));
    chunks.for_each(|(values, leaves)| {
        values.iter_mut().zip(leaves).for_each(|(value, light)| *value = S::leaf(light));
    });
    // [5] reduce: level by level
    let firsts = word_starts(levels.grid.padded());
    for level in 1..levels.starts.len() - 1 {
        let [begin, middle, end] = [level - 1, level, level + 1].map(|l| levels.starts[l] as usize);
        let (children, parents) = values[begin..end].split_at_mut(middle - begin);
        let words = firsts[level - 1]..firsts[level];
        let below = Below {
            mask: &levels.mask.as_slice()[words.clone()],
            ranks: &levels.ranks.as_slice()[words],
            begin: begin as u32,
            values: children,
        };
        let codes = levels.active.as_slice()[middle..end].par_chunks(CHUNK);
        parents.par_chunks_mut(CHUNK).zip(codes).for_each(|(parents, codes)| {
            for (parent, &code) in parents.iter_mut().zip(codes) {
                let (children, octants) = below.children(code);
                *parent = S::parent(children, octants);
            }
        });
    }
}

fn as_values<const W: usize>(words: &[u32]) -> &[[u32; W]]
where
    [u32; W]: Pod,
{
    bytemuck::cast_slice(words)
}

fn as_values_mut<const W: usize>(words: &mut [u32]) -> &mut [[u32; W]]
where
    [u32; W]: Pod,
{
    bytemuck::cast_slice_mut(words)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn bytes_become_bits(bytes in prop::array::uniform4(prop_oneof![Just(0_u8), any::<u8>()])) {
            let want: u32 = (0..4).map(|i| u32::from(bytes[i] != 0) << i).sum();
            prop_assert_eq!(filled_bytes(u32::from_le_bytes(bytes)), want);
        }
    }
}
