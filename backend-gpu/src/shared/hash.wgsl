// Integer hashing. Twin of core/src/math/hash.rs.

// A bijection of u32 that mixes every input bit into every output bit.
fn mix_bits(value: u32) -> u32 {
    var x = value;
    x ^= x >> 16u;
    x *= 0x7feb352du;
    x ^= x >> 15u;
    x *= 0x846ca68bu;
    return x ^ (x >> 16u);
}

// Hash of an ordered pair.
fn mix_pair(a: u32, b: u32) -> u32 {
    return mix_bits(mix_bits(a) + b * 0x9e3779b9u);
}

// A number in [0, 1) from the upper 24 bits: never 1, and exact.
fn to_unit(bits: u32) -> f32 {
    return f32(bits >> 8u) * 5.960464477539063e-8f;
}

// The high and the low word of bits * n: a uniform index below n, and a fresh draw that is independent of it.
fn to_index(bits: u32, n: u32) -> vec2<u32> {
    let bl = bits & 0xffffu;
    let bh = bits >> 16u;
    let nl = n & 0xffffu;
    let nh = n >> 16u;
    let low = bl * nl;
    let middle = bh * nl + (low >> 16u);
    let carry = (middle & 0xffffu) + bl * nh;
    return vec2<u32>(bh * nh + (middle >> 16u) + (carry >> 16u), (carry << 16u) | (low & 0xffffu));
}
