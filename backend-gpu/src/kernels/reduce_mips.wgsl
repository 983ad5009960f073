// kernel family: reduce_mips
// contract core/src/kernels/reduce_mips.rs
// cpu backend-cpu/src/kernels/reduce_mips.rs
// gpu backend-gpu/src/kernels/reduce_mips.wgsl
// oracle conformance/src/oracle/reduce_mips.rs
//
// A dispatch per level: for masks one invocation per word, for values one per parent, or per face or channel of it. Levels are made from
// the mask alone: ranks and codes of other origin can't lead astray.

const WORKGROUP_SIZE: u32 = 256u;

const ANISOTROPIC: u32 = 1u;
const HARMONICS: u32 = 2u;
const SUMS: u32 = 4u;
const RANGES: u32 = 5u;
const OPAQUE: u32 = 65536u;

struct ReduceMipsBlock {
    storage: u32,
    // Voxels on the longest axis of level 0, and the number of levels.
    padded: u32,
    level_count: u32,
    // Words of all levels.
    word_count: u32,
    // The level in work, the words of its mask, and the first of the level below, which ends where this one begins.
    level: u32,
    word_begin: u32,
    word_end: u32,
    below_word: u32,
    // Its values, and the first of the level below, likewise.
    value_begin: u32,
    value_end: u32,
    below_value: u32,
    padding: u32,
}

struct VoxelLight {
    rgb: vec3<u32>,
    opacity: u32,
}

@group(0) @binding(0) var<uniform> params: ReduceMipsBlock;
@group(0) @binding(1) var<storage, read> voxel_mask: array<u32>;
@group(0) @binding(2) var<storage, read_write> mask: array<u32>;
@group(0) @binding(3) var<storage, read_write> counts: array<u32>;
@group(0) @binding(4) var<storage, read_write> starts: array<u32>;
@group(0) @binding(5) var<storage, read_write> active_codes: array<u32>;
@group(0) @binding(6) var<storage, read> level_mask: array<u32>;
@group(0) @binding(7) var<storage, read> level_ranks: array<u32>;
@group(0) @binding(8) var<storage, read> level_codes: array<u32>;
@group(0) @binding(9) var<storage, read> leaves: array<VoxelLight>;
@group(0) @binding(10) var<storage, read_write> values: array<u32>;
@group(0) @binding(11) var<storage, read> harmonics: array<u32>;
@group(0) @binding(12) var<storage, read_write> packed: array<u32>;

// [1] level masks: a bit for each byte of the level below; and the bits of each word
@compute @workgroup_size(256)
fn fill_mask(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = invocation_index(workgroup, workgroups, lane, WORKGROUP_SIZE);
    let word = params.word_begin + index;
    if word >= params.word_end {
        return;
    }
    var bits = 0u;
    if params.level == 0u {
        bits = voxel_mask[index];
    } else {
        for (var i = 0u; i < 8u; i++) {
            let child = params.below_word + 8u * index + i;
            // Levels of less than 8 words are below a single one.
            if child < params.word_begin {
                bits |= filled_bytes(mask[child]) << (4u * i);
            }
        }
    }
    mask[word] = bits;
    counts[word] = countOneBits(bits);
}

// Four bits, set where the byte isn't 0.
fn filled_bytes(word: u32) -> u32 {
    let nibbles = word | (word >> 4u);
    let pairs = nibbles | (nibbles >> 2u);
    let bytes = (pairs | (pairs >> 1u)) & 0x01010101u;
    // Each lowest bit arrives at one of the bits 24 to 27, and what else there is neither meets nor passes them.
    return ((bytes * 0x01020408u) >> 24u) & 0xfu;
}

// [2] rank: kernel scan of the bits of each word, from the host

// [3] list: the codes of every word's bits; and the first value of each level
@compute @workgroup_size(256)
fn list_codes(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let word = invocation_index(workgroup, workgroups, lane, WORKGROUP_SIZE);
    if word >= params.word_count {
        return;
    }
    var place = level_ranks[word];
    let level = level_of(word);
    if word == level.y {
        starts[level.x] = place;
    }
    let code = (word - level.y) << 5u;
    var bits = level_mask[word];
    while bits != 0u {
        active_codes[place] = code | firstTrailingBit(bits);
        place += 1u;
        bits &= bits - 1u;
    }
}

// The level that a word is of, and its first word.
fn level_of(word: u32) -> vec2<u32> {
    var begin = 0u;
    var side = params.padded;
    for (var level = 0u; level < params.level_count; level++) {
        let end = begin + max(1u, (side * side * side) >> 5u);
        if word < end {
            return vec2<u32>(level, begin);
        }
        begin = end;
        side >>= 1u;
    }
    return vec2<u32>(params.level_count, begin);
}

// [4] leaves: what they store
@compute @workgroup_size(256)
fn store_leaves(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = invocation_index(workgroup, workgroups, lane, WORKGROUP_SIZE);
    if index >= params.value_end {
        return;
    }
    let leaf = leaves[index];
    let words = vec4<u32>(leaf.rgb, leaf.opacity);
    switch params.storage {
        case ANISOTROPIC: {
            for (var face = 0u; face < 6u; face++) {
                store_four(6u * index + face, words);
            }
        }
        case HARMONICS: {
            values[13u * index] = leaf.opacity;
            for (var channel = 0u; channel < 3u; channel++) {
                store_coefficients(index, channel, vec4<i32>(i32(leaf.rgb[channel]), 0, 0, 0));
            }
        }
        case SUMS: {
            let sum = wide_add(wide_add(vec2<u32>(leaf.rgb.r, 0u), vec2<u32>(leaf.rgb.g, 0u)), vec2<u32>(leaf.rgb.b, 0u));
            store_two(index, sum);
        }
        case RANGES: {
            store_two(index, vec2<u32>(leaf.rgb.r + leaf.rgb.g + leaf.rgb.b));
        }
        default: {
            store_four(index, words);
        }
    }
}

fn store_two(place: u32, words: vec2<u32>) {
    values[2u * place] = words.x;
    values[2u * place + 1u] = words.y;
}

fn two_at(place: u32) -> vec2<u32> {
    return vec2<u32>(values[2u * place], values[2u * place + 1u]);
}

fn store_four(place: u32, words: vec4<u32>) {
    let first = 4u * place;
    values[first] = words.x;
    values[first + 1u] = words.y;
    values[first + 2u] = words.z;
    values[first + 3u] = words.w;
}

fn four_at(place: u32) -> vec4<u32> {
    let first = 4u * place;
    return vec4<u32>(values[first], values[first + 1u], values[first + 2u], values[first + 3u]);
}

// Children follow each other in the level below.
struct Children {
    // Value of the first.
    first: u32,
    count: u32,
    // A bit for each one's octant.
    octants: u32,
}

// The children of a value; none where masks, ranks and codes of other origin lead out of the level.
fn children_of(value: u32) -> Children {
    let code = level_codes[value];
    let word = code >> 2u;
    if word >= params.word_begin - params.below_word {
        return Children(0u, 0u, 0u);
    }
    let bits = level_mask[params.below_word + word];
    let shift = (code & 3u) * 8u;
    let octants = (bits >> shift) & 0xffu;
    let count = countOneBits(octants);
    let before = countOneBits(bits & ((1u << shift) - 1u));
    let first = level_ranks[params.below_word + word] - params.below_value + before;
    let there = params.value_begin - params.below_value;
    if first > there || count > there - first {
        return Children(0u, 0u, 0u);
    }
    return Children(params.below_value + first, count, octants);
}

// The child in an octant that has one.
fn child_in(children: Children, octant: u32) -> u32 {
    return children.first + countOneBits(children.octants & ((1u << octant) - 1u));
}

// [5] reduce: level by level
@compute @workgroup_size(256)
fn reduce_isotropic(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let value = params.value_begin + invocation_index(workgroup, workgroups, lane, WORKGROUP_SIZE);
    if value >= params.value_end {
        return;
    }
    let children = children_of(value);
    var sum = vec4<u32>(4u);
    for (var i = 0u; i < children.count; i++) {
        sum += four_at(children.first + i);
    }
    store_four(value, sum >> vec4<u32>(3u));
}

// One invocation per face.
@compute @workgroup_size(256)
fn reduce_anisotropic(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = invocation_index(workgroup, workgroups, lane, WORKGROUP_SIZE);
    let value = params.value_begin + index / 6u;
    if value >= params.value_end {
        return;
    }
    let face = index % 6u;
    let axis = face / 2u;
    // Octants in front have this bit of the axis.
    let front_bit = (1u - face % 2u) << axis;
    let children = children_of(value);
    var sum = vec4<u32>(2u);
    for (var octant = 0u; octant < 8u; octant++) {
        if (octant & (1u << axis)) == front_bit {
            let front = face_in(children, octant, face);
            let back = face_in(children, octant ^ (1u << axis), face);
            sum += front + passed(OPAQUE - front.w, back);
        }
    }
    store_four(6u * value + face, sum >> vec4<u32>(2u));
}

fn face_in(children: Children, octant: u32, face: u32) -> vec4<u32> {
    if (children.octants & (1u << octant)) == 0u {
        return vec4<u32>(0u);
    }
    return four_at(6u * child_in(children, octant) + face);
}

// floor(passes * back / 2^16), for passes up to 2^16.
fn passed(passes: u32, back: vec4<u32>) -> vec4<u32> {
    let low = (passes * (back & vec4<u32>(0xffffu))) >> vec4<u32>(16u);
    return passes * (back >> vec4<u32>(16u)) + low;
}

@compute @workgroup_size(256)
fn reduce_sums(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let value = params.value_begin + invocation_index(workgroup, workgroups, lane, WORKGROUP_SIZE);
    if value >= params.value_end {
        return;
    }
    let children = children_of(value);
    var sum = vec2<u32>(0u);
    for (var i = 0u; i < children.count; i++) {
        sum = wide_add(sum, two_at(children.first + i));
    }
    store_two(value, sum);
}

@compute @workgroup_size(256)
fn reduce_ranges(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let value = params.value_begin + invocation_index(workgroup, workgroups, lane, WORKGROUP_SIZE);
    if value >= params.value_end {
        return;
    }
    let children = children_of(value);
    var ends = vec2<u32>(0xffffffffu, 0u);
    for (var i = 0u; i < children.count; i++) {
        let child = two_at(children.first + i);
        ends = vec2<u32>(min(ends.x, child.x), max(ends.y, child.y));
    }
    store_two(value, ends);
}

// Harmonics: reduce_mips/harmonics.wgsl

// [6] pack: harmonics in bytes, there too
