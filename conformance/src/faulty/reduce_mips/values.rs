//! Values with a bug, by code.

use crate::faults::Fault;
use crate::oracle::reduce_mips::{NEAR_LESS_FAR, TWO_THIRDS, packed, scaled};
use std::collections::BTreeMap;
use twinlight_core::kernels::reduce_mips::{
    ANISOTROPIC, HARMONICS, HARMONICS_8, ISOTROPIC, OPAQUE, SUMS, VoxelLight,
};

type Value = Vec<i128>;
type Children<'a> = [Option<&'a Value>; 8];

/// A call whose levels are sound.
pub(super) struct Values<'a> {
    pub(super) fault: Fault,
    pub(super) storage: u32,
    pub(super) starts: &'a [u32],
    pub(super) active: &'a [u32],
    pub(super) leaves: &'a [VoxelLight],
}

impl Values<'_> {
    pub(super) fn words(&self) -> Vec<u32> {
        let mut below: BTreeMap<u32, Value> =
            self.active.iter().zip(self.leaves).map(|(&code, leaf)| (code, self.leaf(leaf))).collect();
        let mut words: Vec<u32> = below.values().flat_map(|value| self.stored(value)).collect();
        for ends in self.starts[1..].windows(2) {
            let mut level = BTreeMap::new();
            for &code in &self.active[ends[0] as usize..ends[1] as usize] {
                let children =
                    std::array::from_fn(|octant| below.get(&(8 * code + self.seen(octant as u32))));
                level.insert(code, self.parent(&children));
            }
            self.lose_last(&mut level);
            words.extend(level.values().flat_map(|value| self.stored(value)));
            below = level;
        }
        words
    }

    /// The octant that is looked at for one.
    fn seen(&self, octant: u32) -> u32 {
        match self.fault {
            Fault::MipsSwapsHalves => octant ^ 1,
            Fault::MipsSwapsAxes => (octant & 1) | ((octant & 2) << 1) | ((octant & 4) >> 1),
            _ => octant,
        }
    }

    fn lose_last(&self, level: &mut BTreeMap<u32, Value>) {
        if self.fault == Fault::MipsLosesLast && level.len() > 256 {
            level.values_mut().next_back().into_iter().for_each(|value| value.fill(0));
        }
    }

    fn leaf(&self, light: &VoxelLight) -> Value {
        let mut light = *light;
        if self.fault == Fault::MipsWeighsLeaves {
            light.rgb = light.rgb.map(|c| ((u64::from(c) * u64::from(light.opacity)) >> 16) as u32);
        }
        let [r, g, b] = light.rgb.map(i128::from);
        let opacity = i128::from(light.opacity);
        match self.storage {
            ISOTROPIC => vec![r, g, b, opacity],
            ANISOTROPIC => [r, g, b, opacity].repeat(6),
            HARMONICS | HARMONICS_8 => vec![opacity, r, 0, 0, 0, g, 0, 0, 0, b, 0, 0, 0],
            SUMS => vec![r + g + b],
            _ => vec![r + g + b; 2],
        }
    }

    fn parent(&self, children: &Children<'_>) -> Value {
        match self.storage {
            ISOTROPIC => (0..4).map(|word| self.mean(children, word)).collect(),
            ANISOTROPIC => (0..6).flat_map(|face| self.through_face(children, face)).collect(),
            HARMONICS | HARMONICS_8 => self.harmonics(children),
            SUMS => vec![children.iter().flatten().map(|child| child[0]).sum()],
            _ => self.range(children),
        }
    }

    fn mean(&self, children: &Children<'_>, word: usize) -> i128 {
        let sum: i128 = children.iter().flatten().map(|child| child[word]).sum();
        let there = children.iter().flatten().count().max(1) as i128;
        match self.fault {
            Fault::MipsRoundsDown => sum >> 3,
            Fault::MipsDividesByThoseThere => (sum + there / 2) / there,
            Fault::MipsQuarters => (sum + 2) >> 2,
            _ => (sum + 4) >> 3,
        }
    }

    fn through_face(&self, children: &Children<'_>, face: usize) -> Value {
        let bit = 1 << (face / 2);
        let front_bit = if face.is_multiple_of(2) != (self.fault == Fault::MipsBackFirst) { bit } else { 0 };
        let mut sums = [if self.fault == Fault::MipsColumnsRoundDown { 0 } else { 2 }; 4];
        for octant in (0..8).filter(|octant| octant & bit == front_bit) {
            let word = |octant: usize, w: usize| children[octant].map_or(0, |child| child[4 * face + w]);
            let passes = match self.fault {
                Fault::MipsUnweighed => i128::from(OPAQUE),
                Fault::MipsCoversByBack => i128::from(OPAQUE) - word(octant ^ bit, 3),
                Fault::MipsAlmostOpaque => i128::from(OPAQUE) - 1 - word(octant, 3),
                _ => i128::from(OPAQUE) - word(octant, 3),
            };
            for (w, sum) in sums.iter_mut().enumerate() {
                let half = if self.fault == Fault::MipsBehindRounds { 1 << 15 } else { 0 };
                *sum += word(octant, w) + ((passes * word(octant ^ bit, w) + half) >> 16);
            }
        }
        let shift = if self.fault == Fault::MipsColumnsOfEight { 3 } else { 2 };
        sums.iter().map(|sum| sum >> shift).collect()
    }

    fn harmonics(&self, children: &Children<'_>) -> Value {
        let mut value = vec![self.mean(children, 0)];
        for channel in 0..3 {
            let mut sums = [0; 4];
            for (octant, child) in children.iter().enumerate() {
                let Some(child) = child else { continue };
                self.add(&mut sums, &child[1 + 4 * channel..][..4], octant);
            }
            value.extend(sums.map(|sum| self.eighth(sum)));
        }
        value
    }

    /// Adds what a child in `octant` has to its parent's coefficients.
    fn add(&self, sums: &mut [i128; 4], a: &[i128], octant: usize) {
        let (k, near_far) = match self.fault {
            Fault::MipsWithoutPi => (1 << 14, NEAR_LESS_FAR * 355 / 113),
            Fault::MipsFarForNear => (1 << 14, -NEAR_LESS_FAR),
            _ => (1 << 14, NEAR_LESS_FAR),
        };
        let constant = if self.fault == Fault::MipsWithoutPi { k * 355 / 113 } else { k };
        sums[0] += self.scaled(constant, a[0]);
        let gradient = if self.fault == Fault::MipsHalvesGradient { near_far } else { 2 * near_far };
        let own = match self.fault {
            Fault::MipsWithoutPi => TWO_THIRDS * 355 / 113,
            Fault::MipsKeepsGradient => 1 << 14,
            _ => TWO_THIRDS,
        };
        for axis in 0..3 {
            let sign = if octant >> axis & 1 == 1 { 1 } else { -1 };
            sums[0] += sign * self.scaled(near_far, a[axis + 1]);
            sums[axis + 1] += sign * self.scaled(gradient, a[0]) + self.scaled(own, a[axis + 1]);
        }
    }

    fn scaled(&self, k: i128, x: i128) -> i128 {
        match self.fault {
            Fault::MipsFloors => (k * x) >> 14,
            Fault::MipsScalesRounded => ((k * x.abs() + (1 << 13)) >> 14) * x.signum(),
            _ => scaled(k, x),
        }
    }

    fn eighth(&self, sum: i128) -> i128 {
        match self.fault {
            Fault::MipsTruncates => sum / 8,
            Fault::MipsHalvesUp => (sum + 4) >> 3,
            _ => (sum.abs() + 4) / 8 * sum.signum(),
        }
    }

    fn range(&self, children: &Children<'_>) -> Value {
        let seen = children.iter().flatten();
        let least = seen.clone().map(|child| child[0]).min().unwrap_or(0);
        let greatest = seen.map(|child| child[1]).max().unwrap_or(0);
        match self.fault {
            Fault::MipsMissingIsLeast if children.iter().any(Option::is_none) => vec![0, greatest],
            Fault::MipsRangeOfLeast => vec![least, least],
            _ => vec![least, greatest],
        }
    }

    /// What a storage's buffer has of a value.
    fn stored(&self, value: &Value) -> Vec<u32> {
        match self.storage {
            SUMS => {
                let sum = value[0] as u64;
                let high = if self.fault == Fault::MipsLosesCarry { 0 } else { (sum >> 32) as u32 };
                if self.fault == Fault::MipsHighFirst {
                    vec![high, sum as u32]
                } else {
                    vec![sum as u32, high]
                }
            }
            HARMONICS_8 => self.bytes(value).to_vec(),
            _ => value.iter().map(|&word| word as u32).collect(),
        }
    }

    fn bytes(&self, value: &Value) -> [u32; 4] {
        let sound = packed(value);
        let exponent = sound[0] >> 24;
        let other = match self.fault {
            Fault::MipsExponentTooSmall => exponent.saturating_sub(1),
            Fault::MipsExponentTooLarge => exponent + 1,
            _ => exponent,
        };
        let digit = |i: usize| {
            let half = if self.fault == Fault::MipsBytesTruncate { 0 } else { (1 << other) >> 1 };
            (((value[1 + i].abs() + half) >> other) * value[1 + i].signum()).rem_euclid(256) as u32
        };
        let word = |channel: usize| {
            let bytes = std::array::from_fn(|k| digit(4 * channel + k) as u8);
            match self.fault {
                Fault::MipsBytesReversed => u32::from_be_bytes(bytes),
                Fault::MipsBytesSigned => u32::from_le_bytes(bytes.map(|byte| byte.min(127))),
                _ => u32::from_le_bytes(bytes),
            }
        };
        let opacity = value[0] as u32;
        let head = if self.fault == Fault::MipsForgetsExponent {
            opacity
        } else {
            opacity.wrapping_add(other << 24)
        };
        [head, word(0), word(1), word(2)]
    }
}
