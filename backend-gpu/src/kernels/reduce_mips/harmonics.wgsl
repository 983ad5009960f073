// Harmonics of `reduce_mips`: the contract's matrix, and bytes.

const NEAR_LESS_FAR: u32 = 2659u;
const TWO_THIRDS: u32 = 10923u;

fn coefficients(value: u32, channel: u32) -> vec4<i32> {
    let first = 13u * value + 1u + 4u * channel;
    return bitcast<vec4<i32>>(vec4<u32>(values[first], values[first + 1u], values[first + 2u], values[first + 3u]));
}

fn store_coefficients(value: u32, channel: u32, a: vec4<i32>) {
    let first = 13u * value + 1u + 4u * channel;
    let words = bitcast<vec4<u32>>(a);
    values[first] = words.x;
    values[first + 1u] = words.y;
    values[first + 2u] = words.z;
    values[first + 3u] = words.w;
}

// One invocation per channel; the first one's has the opacity too.
@compute @workgroup_size(256)
fn reduce_harmonics(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = invocation_index(workgroup, workgroups, lane, WORKGROUP_SIZE);
    let value = params.value_begin + index / 3u;
    if value >= params.value_end {
        return;
    }
    let channel = index % 3u;
    let children = children_of(value);
    var opacity = 4u;
    var sum = vec4<i32>(0);
    var octants = children.octants;
    for (var i = 0u; i < children.count; i++) {
        let child = children.first + i;
        opacity += values[13u * child];
        sum += seen_from(coefficients(child, channel), firstTrailingBit(octants));
        octants &= octants - 1u;
    }
    if channel == 0u {
        values[13u * value] = opacity >> 3u;
    }
    // To the nearest; halves away from 0.
    store_coefficients(value, channel, with_signs((magnitudes(sum) + 4u) >> vec4<u32>(3u), sum));
}

// What a child in `octant` has to its parent's coefficients.
fn seen_from(a: vec4<i32>, octant: u32) -> vec4<i32> {
    let upper = (vec3<u32>(octant) & vec3<u32>(1u, 2u, 4u)) != vec3<u32>(0u);
    let signs = select(vec3<i32>(-1), vec3<i32>(1), upper);
    let along = signs * scaled(NEAR_LESS_FAR, a).yzw;
    let gradient = signs * scaled(2u * NEAR_LESS_FAR, a).x;
    return vec4<i32>(a.x + along.x + along.y + along.z, gradient + scaled(TWO_THIRDS, a).yzw);
}

// m(k, x) of the contract, for k < 2^14: towards 0.
fn scaled(k: u32, x: vec4<i32>) -> vec4<i32> {
    let magnitude = magnitudes(x);
    let low = (k * (magnitude & vec4<u32>(0x3fffu))) >> vec4<u32>(14u);
    return with_signs(k * (magnitude >> vec4<u32>(14u)) + low, x);
}

fn magnitudes(x: vec4<i32>) -> vec4<u32> {
    return bitcast<vec4<u32>>(abs(x));
}

fn with_signs(magnitude: vec4<u32>, signed: vec4<i32>) -> vec4<i32> {
    let positive = bitcast<vec4<i32>>(magnitude);
    return select(positive, -positive, signed < vec4<i32>(0));
}

@compute @workgroup_size(256)
fn pack_harmonics(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let value = invocation_index(workgroup, workgroups, lane, WORKGROUP_SIZE);
    if value >= params.value_end {
        return;
    }
    let most = max(max(magnitudes(kept(value, 0u)), magnitudes(kept(value, 1u))), magnitudes(kept(value, 2u)));
    let exponent = max(least_exponent(most.x, 8u), least_exponent(max(most.y, max(most.z, most.w)), 7u));
    packed[4u * value] = harmonics[13u * value] + (exponent << 24u);
    for (var channel = 0u; channel < 3u; channel++) {
        let a = kept(value, channel);
        let bytes = bitcast<vec4<u32>>(with_signs(rounded(magnitudes(a), exponent), a)) & vec4<u32>(0xffu);
        packed[4u * value + 1u + channel] = bytes.x | (bytes.y << 8u) | (bytes.z << 16u) | (bytes.w << 24u);
    }
}

// A channel's coefficients. The byte of the constant one has no sign.
fn kept(value: u32, channel: u32) -> vec4<i32> {
    let first = 13u * value + 1u + 4u * channel;
    let words = vec4<u32>(harmonics[first], harmonics[first + 1u], harmonics[first + 2u], harmonics[first + 3u]);
    let a = bitcast<vec4<i32>>(words);
    return vec4<i32>(max(a.x, 0), a.yzw);
}

// The least e for which r of a magnitude has so many bits: rounding may need one more than the magnitude has too many.
fn least_exponent(magnitude: u32, bits: u32) -> u32 {
    let digits = 32u - countLeadingZeros(magnitude);
    let exponent = max(digits, bits) - bits;
    return exponent + (rounded(vec4<u32>(magnitude), exponent).x >> bits);
}

// To the nearest; halves up.
fn rounded(magnitude: vec4<u32>, exponent: u32) -> vec4<u32> {
    return (magnitude + vec4<u32>((1u << exponent) >> 1u)) >> vec4<u32>(exponent);
}
