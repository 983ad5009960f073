// kernel family: reduce_mips
// contract core/src/kernels/reduce_mips.rs
// cpu backend-cpu/src/kernels/reduce_mips.rs
// gpu backend-gpu/src/kernels/reduce_mips.wgsl
// oracle conformance/src/oracle/reduce_mips.rs
//! Oracle of `reduce_mips`: sets and maps by code, where both twins count bits, and integers of 128 bits. Sums and ranges are
//! taken over the leaves below, not over children.

use std::collections::{BTreeMap, BTreeSet};
use twinlight_core::kernels::reduce_mips::{
    ANISOTROPIC, HARMONICS, HARMONICS_8, ISOTROPIC, OPAQUE, RANGES, SUMS, VoxelLight,
};

mod harmonics;

pub use harmonics::{NEAR_LESS_FAR, TWO_THIRDS, packed, scaled};

/// What a voxel stores, word by word before it becomes one.
type Value = Vec<i128>;
/// Values of a level by code.
type Level = BTreeMap<u32, Value>;
/// Children by octant.
type Children<'a> = [Option<&'a Value>; 8];

/// Levels on the host.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Levels {
    /// As [`twinlight_core::kernels::reduce_mips::VoxelLevelBuffers::starts`].
    pub starts: Vec<u32>,
    /// Its `mask`.
    pub mask: Vec<u32>,
    /// Its `ranks`.
    pub ranks: Vec<u32>,
    /// Its `active`.
    pub active: Vec<u32>,
}

/// The codes that are active on each level, from those of level 0, in a grid whose longest axis is padded to `padded` voxels.
pub fn codes(padded: u32, leaves: &BTreeSet<u32>) -> Vec<BTreeSet<u32>> {
    let mut levels = vec![leaves.clone()];
    let mut side = padded;
    while side > 1 {
        side /= 2;
        levels.push(levels[levels.len() - 1].iter().map(|code| code / 8).collect());
    }
    levels
}

/// What the contract promises of those.
pub fn levels(padded: u32, leaves: &BTreeSet<u32>) -> Levels {
    let mut found = Levels { starts: vec![0], mask: Vec::new(), ranks: Vec::new(), active: Vec::new() };
    for (level, codes) in codes(padded, leaves).iter().enumerate() {
        let side = u64::from(padded) >> level;
        let mut words = vec![0; (side * side * side).div_ceil(32).max(1) as usize];
        for &code in codes {
            words[code as usize / 32] += 1 << (code % 32);
            found.active.push(code);
        }
        found.mask.extend(words);
        found.starts.push(found.active.len() as u32);
    }
    let mut before = 0;
    for word in &found.mask {
        found.ranks.push(before);
        before += word.count_ones();
    }
    found.ranks.push(before);
    found
}

/// What the contract promises the voxels of all levels to store of their leaves.
pub fn reduce(padded: u32, leaves: &BTreeMap<u32, VoxelLight>, storage: u32) -> Vec<u32> {
    let levels = codes(padded, &leaves.keys().copied().collect());
    match storage {
        SUMS | RANGES => {
            let each = levels.iter().enumerate().flat_map(|(level, codes)| {
                codes.iter().flat_map(move |&code| of_leaves_below(leaves, level as u32, code, storage))
            });
            each.collect()
        }
        HARMONICS_8 => {
            let values = reduced(&levels, leaves, HARMONICS);
            values.iter().flat_map(|value| packed(value)).collect()
        }
        _ => reduced(&levels, leaves, storage).concat().into_iter().map(|word| word as u32).collect(),
    }
}

/// The sum, or the least and the greatest, of what is in a voxel.
fn of_leaves_below(leaves: &BTreeMap<u32, VoxelLight>, level: u32, code: u32, storage: u32) -> [u32; 2] {
    let volume = 8_u64.pow(level);
    let first = u64::from(code) * volume;
    let below = leaves.range(first as u32..=(first + volume - 1) as u32);
    let totals: Vec<u64> = below.map(|(_, leaf)| leaf.rgb.iter().map(|&c| u64::from(c)).sum()).collect();
    if storage == SUMS {
        let sum: u64 = totals.iter().sum();
        return [sum as u32, (sum >> 32) as u32];
    }
    let ends = [totals.iter().min(), totals.iter().max()];
    ends.map(|end| end.copied().unwrap_or_default() as u32)
}

/// All values, level by level.
fn reduced(levels: &[BTreeSet<u32>], leaves: &BTreeMap<u32, VoxelLight>, storage: u32) -> Vec<Value> {
    let mut below: Level = leaves.iter().map(|(&code, light)| (code, leaf(light, storage))).collect();
    let mut values: Vec<Value> = below.values().cloned().collect();
    for codes in &levels[1..] {
        let of = |code: u32| {
            let children: Children<'_> = std::array::from_fn(|octant| below.get(&(code * 8 + octant as u32)));
            (code, parent(&children, storage))
        };
        let level: Level = codes.iter().map(|&code| of(code)).collect();
        values.extend(level.values().cloned());
        below = level;
    }
    values
}

fn leaf(light: &VoxelLight, storage: u32) -> Value {
    let [r, g, b] = light.rgb.map(i128::from);
    let opacity = i128::from(light.opacity);
    match storage {
        ISOTROPIC => vec![r, g, b, opacity],
        ANISOTROPIC => [r, g, b, opacity].repeat(6),
        _ => vec![opacity, r, 0, 0, 0, g, 0, 0, 0, b, 0, 0, 0],
    }
}

fn parent(children: &Children<'_>, storage: u32) -> Value {
    match storage {
        ISOTROPIC => isotropic(children),
        ANISOTROPIC => (0..6).flat_map(|face| through_face(children, face)).collect(),
        _ => harmonics::parent(children),
    }
}

fn isotropic(children: &Children<'_>) -> Value {
    (0..4).map(|word| (sum(children, word) + 4).div_euclid(8)).collect()
}

fn sum(children: &Children<'_>, word: usize) -> i128 {
    children.iter().flatten().map(|child| child[word]).sum()
}

/// The four words of a face: 0 is +x, 1 is −x, and so on.
fn through_face(children: &Children<'_>, face: usize) -> Value {
    let (axis, is_lower) = (face / 2, face % 2);
    let word = |octant: usize, word: usize| children[octant].map_or(0, |child| child[4 * face + word]);
    let column = |other: usize, w: usize| {
        // The two other axes of a column, and its children on that side and behind.
        let place = |upper: usize| match axis {
            0 => upper + 2 * other,
            1 => other % 2 + 2 * upper + 4 * (other / 2),
            _ => other + 4 * upper,
        };
        let (front, back) = (place(1 - is_lower), place(is_lower));
        let passes = i128::from(OPAQUE) - word(front, 3);
        word(front, w) + (passes * word(back, w)).div_euclid(i128::from(OPAQUE))
    };
    (0..4).map(|w| ((0..4).map(|other| column(other, w)).sum::<i128>() + 2).div_euclid(4)).collect()
}

#[cfg(test)]
mod tests;
