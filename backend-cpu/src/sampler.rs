//! The numbers of one vertex, drawn together: `core/src/math/sobol.rs` lane by lane.

use crate::simd::{Width, Words};
use twinlight_core::kernels::trace_paths::{PAIRS_PER_VERTEX, SAMPLER_SOBOL};
use twinlight_core::math::hash::to_unit;
use twinlight_core::math::sobol::{FIRST_SEED, PAIR_STEP, SECOND_SEED, independent_pair, sobol_pair};

/// The numbers of one sample of a pixel.
pub(crate) struct Sampler {
    /// `SAMPLER_SOBOL` or `SAMPLER_INDEPENDENT`.
    pub kind: u32,
    /// Hash of seed and pixel.
    pub stream: u32,
    /// Index of the sample.
    pub sample: u32,
}

/// Every number of a vertex but the environment texel's, which few vertices need.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct VertexNumbers {
    /// Where the path goes on.
    pub direction: [f32; 2],
    /// The point of the light.
    pub light_point: [f32; 2],
    /// Which light, all 32 bits.
    pub light_choice: u32,
    /// Which lobe.
    pub lobe: f32,
    /// Whether the path goes on.
    pub roulette: f32,
}

/// The pairs that make up [`VertexNumbers`], counted from the vertex's first.
const DRAWN: [u32; 4] = [0, 1, 2, 4];

impl Sampler {
    /// One pair of numbers.
    #[inline(always)]
    #[must_use]
    pub(crate) fn pair(&self, pair: u32) -> [u32; 2] {
        if self.kind == SAMPLER_SOBOL {
            sobol_pair(self.stream, self.sample, pair)
        } else {
            independent_pair(self.stream, self.sample, pair)
        }
    }

    /// Number of the first pair of the vertex that `vertices` others precede.
    #[inline(always)]
    #[must_use]
    pub(crate) fn first_pair(vertices: u32) -> u32 {
        1_u32.wrapping_add(vertices.wrapping_mul(PAIRS_PER_VERTEX))
    }

    /// The numbers of the vertex whose first pair is `base`.
    #[inline(always)]
    #[must_use]
    pub(crate) fn vertex<W: Width>(&self, width: W, base: u32) -> VertexNumbers {
        let (bits, units) =
            if self.kind == SAMPLER_SOBOL { self.sobol(width, base) } else { self.independent(base) };
        VertexNumbers {
            direction: [units[0], units[4]],
            light_point: [units[1], units[5]],
            light_choice: bits[2],
            lobe: units[6],
            roulette: units[3],
        }
    }

    /// The first numbers of the pairs [`DRAWN`], then the second ones: bits, and units.
    #[inline(always)]
    fn sobol<W: Width>(&self, width: W, base: u32) -> ([u32; 8], [f32; 8]) {
        let [a, b, c, d] = DRAWN.map(|offset| offset.wrapping_mul(PAIR_STEP));
        let first = base.wrapping_mul(PAIR_STEP).wrapping_add(self.stream);
        let offsets = W::U8::load(width, &[a, b, c, d, a, b, c, d]);
        let seed = mix(width, offsets + W::U8::splat(width, first));
        let reversed_sample = W::U8::splat(width, self.sample.reverse_bits());
        let shuffled = scramble_reversed(width, reversed_sample, seed).reverse_bits();
        let points = shuffled.lower_then_upper(second_dimension_reversed(width, shuffled));
        let [f, s] = [FIRST_SEED, SECOND_SEED];
        let seeds = seed * W::U8::load(width, &[f, f, f, f, s, s, s, s]);
        let numbers = scramble_reversed(width, points, seeds).reverse_bits();
        (numbers.to_array(), numbers.to_units())
    }

    /// As [`Sampler::sobol`], of independent numbers.
    #[inline(always)]
    fn independent(&self, base: u32) -> ([u32; 8], [f32; 8]) {
        let (mut bits, mut units) = ([0; 8], [0.0; 8]);
        for (i, offset) in DRAWN.into_iter().enumerate() {
            let [first, second] = independent_pair(self.stream, self.sample, base.wrapping_add(offset));
            (bits[i], bits[i + 4]) = (first, second);
            (units[i], units[i + 4]) = (to_unit(first), to_unit(second));
        }
        (bits, units)
    }
}

/// `twinlight_core::math::hash::mix`.
#[inline(always)]
fn mix<W: Width>(width: W, value: W::U8) -> W::U8 {
    let x = value ^ value.shift_right::<16>();
    let x = x * W::U8::splat(width, 0x7feb_352d);
    let x = x ^ x.shift_right::<15>();
    let x = x * W::U8::splat(width, 0x846c_a68b);
    x ^ x.shift_right::<16>()
}

/// `twinlight_core::math::sobol::scramble_reversed`; adding 1 to an even number sets its lowest bit.
#[inline(always)]
fn scramble_reversed<W: Width>(width: W, value: W::U8, seed: W::U8) -> W::U8 {
    let splat = |x| W::U8::splat(width, x);
    let x = value ^ (value * splat(0x3d20_adea));
    let x = x + seed;
    let high = seed.shift_right::<16>();
    let x = x * ((high & splat(!1)) + splat(1));
    let x = x ^ (x * splat(0x0552_6c56));
    x ^ (x * splat(0x53a2_2864))
}

/// `twinlight_core::math::sobol::second_dimension_reversed`.
#[inline(always)]
fn second_dimension_reversed<W: Width>(width: W, index: W::U8) -> W::U8 {
    let splat = |x| W::U8::splat(width, x);
    let x = index ^ index.shift_right::<16>();
    let x = x ^ (x.shift_right::<8>() & splat(0x00ff_00ff));
    let x = x ^ (x.shift_right::<4>() & splat(0x0f0f_0f0f));
    let x = x ^ (x.shift_right::<2>() & splat(0x3333_3333));
    x ^ (x.shift_right::<1>() & splat(0x5555_5555))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd::{Isa, Kernel, dispatch};
    use proptest::prelude::*;
    use twinlight_core::kernels::trace_paths::SAMPLER_INDEPENDENT;

    struct Draw(Sampler, u32);

    impl Kernel for Draw {
        type Output = VertexNumbers;

        #[inline(always)]
        fn run<W: Width>(self, width: W) -> VertexNumbers {
            self.0.vertex(width, self.1)
        }
    }

    proptest! {
        #[test]
        fn a_vertex_has_the_numbers_of_its_pairs(stream: u32, sample: u32, vertices: u32) {
            for kind in [SAMPLER_SOBOL, SAMPLER_INDEPENDENT] {
                let base = Sampler::first_pair(vertices);
                let sampler = || Sampler { kind, stream, sample };
                let [direction, light_point, choice, roulette] =
                    DRAWN.map(|offset| sampler().pair(base.wrapping_add(offset)));
                let expected = VertexNumbers {
                    direction: direction.map(to_unit),
                    light_point: light_point.map(to_unit),
                    light_choice: choice[0],
                    lobe: to_unit(choice[1]),
                    roulette: to_unit(roulette[0]),
                };
                for isa in Isa::ALL.into_iter().filter(|isa| isa.is_available()) {
                    prop_assert_eq!(dispatch(isa, Draw(sampler(), base)), expected, "{}", isa.name());
                }
            }
        }
    }
}
