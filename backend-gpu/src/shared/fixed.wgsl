// Fixed point in pairs of u32, (low, high). Twin of core/src/math/fixed.rs.

const OUT_OF_RANGE: vec2<u32> = vec2<u32>(0xffffffffu, 0xffffffffu);

// floor(x * 2^exponent + 1/2) for x >= 0, computed on the bits of x.
fn from_float(x: f32, exponent: i32) -> vec2<u32> {
    let bits = bitcast<u32>(x);
    let biased = bits >> 23u;
    // Subnormals count as 0: adapters flush them.
    if biased == 0u || bits == 0x80000000u {
        return vec2<u32>(0u, 0u);
    }
    // Sign bit set, infinity or NaN.
    if biased >= 255u {
        return OUT_OF_RANGE;
    }
    let mantissa = (bits & 0x007fffffu) | 0x00800000u;
    let shift = i32(biased) - 150 + exponent;
    if shift > 38 {
        return OUT_OF_RANGE;
    }
    if shift >= 0 {
        return shift_left(mantissa, u32(shift));
    }
    let down = u32(-shift);
    if down > 24u {
        return vec2<u32>(0u, 0u);
    }
    return vec2<u32>(((mantissa >> (down - 1u)) + 1u) >> 1u, 0u);
}

// value * 2^shift for shift in 0..=38 and value below 2^24.
fn shift_left(value: u32, shift: u32) -> vec2<u32> {
    if shift >= 32u {
        return vec2<u32>(0u, value << (shift - 32u));
    }
    if shift == 0u {
        return vec2<u32>(value, 0u);
    }
    return vec2<u32>(value << shift, value >> (32u - shift));
}

// Sum, saturating at 2^64 - 1.
fn add_saturating(a: vec2<u32>, b: vec2<u32>) -> vec2<u32> {
    let low = a.x + b.x;
    let carry = select(0u, 1u, low < a.x);
    let high = a.y + b.y;
    let high_carried = high + carry;
    return select(vec2<u32>(low, high_carried), OUT_OF_RANGE, high < a.y || high_carried < high);
}
