//! Owen-scrambled Sobol points, two dimensions at a time. Twin: `backend-gpu/src/shared/sobol.wgsl`.
//!
//! Each pair of dimensions is the (0, 2)-sequence of Sobol's first two dimensions, its index shuffled and its values
//! scrambled by nested uniform (Owen) scrambling with a seed of its own, so that pairs are independent of each other
//! (padding). Burley, "Practical hash-based Owen scrambling", JCGT 9(4) 2020; hash of Laine & Karras 2011 with
//! Vegdahl's constants. Everything is u32 arithmetic: the points are Exact.

use super::hash::{mix, mix_pair};

/// Owen scrambling of a word whose bits are in reversed significance: bit i of the result depends on bits 0..=i only.
#[inline(always)]
pub fn scramble_reversed(value: u32, seed: u32) -> u32 {
    let mut x = value;
    x ^= x.wrapping_mul(0x3d20_adea);
    x = x.wrapping_add(seed);
    x = x.wrapping_mul((seed >> 16) | 1);
    x ^= x.wrapping_mul(0x0552_6c56);
    x ^ x.wrapping_mul(0x53a2_2864)
}

/// Sobol's second dimension of `index`, in reversed significance. Its direction numbers are Pascal's triangle modulo 2,
/// so the matrix product is the Taylor shift j(x) → j(x + 1) over GF(2): five steps instead of 32.
#[inline(always)]
pub fn second_dimension_reversed(index: u32) -> u32 {
    let mut x = index;
    x ^= x >> 16;
    x ^= (x >> 8) & 0x00ff_00ff;
    x ^= (x >> 4) & 0x0f0f_0f0f;
    x ^= (x >> 2) & 0x3333_3333;
    x ^ ((x >> 1) & 0x5555_5555)
}

/// Distance of the seeds of neighbouring pairs before mixing: 2³² over the golden ratio.
pub const PAIR_STEP: u32 = 0x9e37_79b9;
/// Makes the scrambling seed of a pair's first number of the pair's seed. The three seeds are one mixed word times odd
/// constants: equally distributed, and far apart in every bit but the lowest few, which the shifted copy in the
/// scrambling ignores.
pub const FIRST_SEED: u32 = 0xc2b2_ae35;
/// As [`FIRST_SEED`], of the second number.
pub const SECOND_SEED: u32 = 0x27d4_eb2f;

/// Pair number `pair` of point `sample`, of the sequence that belongs to `stream`; 32 random bits each.
#[inline(always)]
pub fn sobol_pair(stream: u32, sample: u32, pair: u32) -> [u32; 2] {
    let seed = mix(stream.wrapping_add(pair.wrapping_mul(PAIR_STEP)));
    let shuffled = scramble_reversed(sample.reverse_bits(), seed).reverse_bits();
    let first = scramble_reversed(shuffled, seed.wrapping_mul(FIRST_SEED)).reverse_bits();
    let second = second_dimension_reversed(shuffled);
    [first, scramble_reversed(second, seed.wrapping_mul(SECOND_SEED)).reverse_bits()]
}

/// As [`sobol_pair`], but independent from sample to sample.
#[inline(always)]
pub fn independent_pair(stream: u32, sample: u32, pair: u32) -> [u32; 2] {
    let first = mix_pair(mix_pair(stream, pair), sample);
    [first, mix(first ^ 0x68bc_21eb)]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sobol's second dimension by its direction numbers.
    fn second_dimension_by_definition(index: u32) -> u32 {
        let mut direction = 0x8000_0000_u32;
        let mut value = 0;
        for bit in 0..32 {
            if index >> bit & 1 == 1 {
                value ^= direction;
            }
            direction ^= direction >> 1;
        }
        value
    }

    #[test]
    fn second_dimension_is_sobols() {
        for index in (0..4096).chain([0x8000_0000, 0xffff_ffff, 0x1234_5678]) {
            assert_eq!(
                second_dimension_reversed(index).reverse_bits(),
                second_dimension_by_definition(index)
            );
        }
    }

    /// Owen scrambling keeps the net property: of any aligned 2ᵐ points, each elementary interval holds exactly one.
    #[test]
    fn pairs_form_nets() {
        for stream in [0, 1, 77, 0xdead_beef] {
            for pair in 0..5 {
                for m in [1_u32, 4, 6, 8] {
                    for block in 0..3_u32 {
                        let base = block << m;
                        for split in 0..=m {
                            let mut seen = vec![false; 1 << m];
                            for i in 0..1_u32 << m {
                                let [x, y] = sobol_pair(stream, base + i, pair);
                                let column = if split == 0 { 0 } else { x >> (32 - split) };
                                let row = if split == m { 0 } else { y >> (32 - (m - split)) };
                                let cell = (column << (m - split) | row) as usize;
                                assert!(!seen[cell], "stream {stream} pair {pair} m {m} split {split}");
                                seen[cell] = true;
                            }
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn streams_differ() {
        assert_ne!(sobol_pair(1, 0, 0), sobol_pair(2, 0, 0));
        assert_ne!(sobol_pair(1, 0, 0), sobol_pair(1, 0, 1));
        assert_ne!(independent_pair(1, 0, 0), independent_pair(1, 1, 0));
    }
}
