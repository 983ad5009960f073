// Owen-scrambled Sobol points, two dimensions at a time. Twin of core/src/math/sobol.rs.

// Owen scrambling of a word whose bits are in reversed significance.
fn scramble_reversed(value: u32, seed: u32) -> u32 {
    var x = value;
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16u) | 1u;
    x ^= x * 0x05526c56u;
    return x ^ (x * 0x53a22864u);
}

// Sobol's second dimension, in reversed significance: a Taylor shift over GF(2).
fn second_dimension_reversed(index: u32) -> u32 {
    var x = index;
    x ^= x >> 16u;
    x ^= (x >> 8u) & 0x00ff00ffu;
    x ^= (x >> 4u) & 0x0f0f0f0fu;
    x ^= (x >> 2u) & 0x33333333u;
    return x ^ ((x >> 1u) & 0x55555555u);
}

// Pair number `pair` of point `sample` of the sequence that belongs to `stream`.
fn sobol_pair(stream: u32, sample: u32, pair: u32) -> vec2<u32> {
    let seed = mix_bits(stream + pair * 0x9e3779b9u);
    let shuffled = reverseBits(scramble_reversed(reverseBits(sample), seed));
    // Why products are seeds enough: see the Rust twin.
    let first = reverseBits(scramble_reversed(shuffled, seed * 0xc2b2ae35u));
    let second = second_dimension_reversed(shuffled);
    return vec2<u32>(first, reverseBits(scramble_reversed(second, seed * 0x27d4eb2fu)));
}

// As sobol_pair, but independent from sample to sample.
fn independent_pair(stream: u32, sample: u32, pair: u32) -> vec2<u32> {
    let first = mix_pair(mix_pair(stream, pair), sample);
    return vec2<u32>(first, mix_bits(first ^ 0x68bc21ebu));
}
