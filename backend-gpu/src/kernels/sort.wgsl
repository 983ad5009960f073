// kernel family: sort
// contract core/src/kernels/sort.rs
// cpu backend-cpu/src/kernels/sort.rs
// gpu backend-gpu/src/kernels/sort.wgsl
// oracle conformance/src/oracle/sort.rs
//
// One pass sorts stably by one digit of 4 bits. Between [1] and [3] the host scans the counts (kernel scan).

// Invocations per workgroup.
const WORKGROUP_SIZE: u32 = 256u;
// Rows of WORKGROUP_SIZE elements per workgroup.
const ROWS: u32 = 8u;
// Elements per workgroup.
const TILE_SIZE: u32 = 2048u;
const DIGIT_BITS: u32 = 4u;
const DIGITS: u32 = 16u;
// A tile has one bit per element and digit, 32 to a word.
const WORDS_PER_DIGIT: u32 = 64u;
// Each invocation counts the bits of this many words.
const WORDS_PER_LANE: u32 = 4u;
const LANES_PER_DIGIT: u32 = 16u;

struct SortParams {
    // Pairs.
    count: u32,
    // Tiles that hold them.
    tile_count: u32,
    // Words per key: 1, or 2 with the low one first.
    key_words: u32,
    // The word that this pass sorts by, and the digit's lowest bit in it.
    word: u32,
    shift: u32,
    // Keys of the other chunk, and whether its equal keys go before this chunk's.
    other_count: u32,
    other_first: u32,
    // The places of the result that `keys_back` and `payload_back` hold.
    window_begin: u32,
    window_count: u32,
}

@group(0) @binding(0) var<uniform> params: SortParams;
@group(0) @binding(1) var<storage, read> keys_front: array<u32>;
@group(0) @binding(2) var<storage, read> payload_front: array<u32>;
@group(0) @binding(3) var<storage, read_write> digit_counts: array<u32>;
@group(0) @binding(4) var<storage, read> digit_offsets: array<u32>;
@group(0) @binding(5) var<storage, read_write> keys_back: array<u32>;
@group(0) @binding(6) var<storage, read_write> payload_back: array<u32>;
@group(0) @binding(7) var<storage, read> keys_other: array<u32>;
@group(0) @binding(8) var<storage, read_write> ranks: array<u32>;

var<workgroup> tile_counts: array<atomic<u32>, 16>;
// Bit e of the words of digit d: element e of the tile has the digit d.
var<workgroup> members: array<atomic<u32>, 1024>;
// Destination of the first member of each word.
var<workgroup> word_offsets: array<u32, 1024>;
var<workgroup> lane_offsets: array<u32, 256>;

fn digit_of(pair: u32) -> u32 {
    return (keys_front[pair * params.key_words + params.word] >> params.shift) & (DIGITS - 1u);
}

// [1] count the digits of every tile, digit by digit in memory
@compute @workgroup_size(256)
fn count_digits(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let tile = workgroup.y * workgroups.x + workgroup.x;
    if tile >= params.tile_count {
        return;
    }
    if lane < DIGITS {
        atomicStore(&tile_counts[lane], 0u);
    }
    workgroupBarrier();
    for (var row = 0u; row < ROWS; row++) {
        let pair = tile * TILE_SIZE + row * WORKGROUP_SIZE + lane;
        if pair < params.count {
            atomicAdd(&tile_counts[digit_of(pair)], 1u);
        }
    }
    workgroupBarrier();
    if lane < DIGITS {
        digit_counts[lane * params.tile_count + tile] = atomicLoad(&tile_counts[lane]);
    }
}

// [2] scan the counts: kernel scan, from the host

// [3] scatter: the rank of an element is the number of members before it, read off the bits, whatever the order in
// which they were set
@compute @workgroup_size(256)
fn scatter_pairs(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let tile = workgroup.y * workgroups.x + workgroup.x;
    if tile >= params.tile_count {
        return;
    }
    let first_word = lane * WORDS_PER_LANE;
    for (var i = 0u; i < WORDS_PER_LANE; i++) {
        atomicStore(&members[first_word + i], 0u);
    }
    workgroupBarrier();
    for (var row = 0u; row < ROWS; row++) {
        let element = row * WORKGROUP_SIZE + lane;
        let pair = tile * TILE_SIZE + element;
        if pair < params.count {
            atomicOr(&members[digit_of(pair) * WORDS_PER_DIGIT + element / 32u], 1u << (element % 32u));
        }
    }
    workgroupBarrier();
    var lane_count = 0u;
    for (var i = 0u; i < WORDS_PER_LANE; i++) {
        lane_count += countOneBits(atomicLoad(&members[first_word + i]));
    }
    lane_offsets[lane] = lane_count;
    workgroupBarrier();
    if lane < DIGITS {
        var offset = digit_offsets[lane * params.tile_count + tile];
        for (var i = 0u; i < LANES_PER_DIGIT; i++) {
            let at = lane * LANES_PER_DIGIT + i;
            let next = lane_offsets[at];
            lane_offsets[at] = offset;
            offset += next;
        }
    }
    workgroupBarrier();
    var word_offset = lane_offsets[lane];
    for (var i = 0u; i < WORDS_PER_LANE; i++) {
        word_offsets[first_word + i] = word_offset;
        word_offset += countOneBits(atomicLoad(&members[first_word + i]));
    }
    workgroupBarrier();
    for (var row = 0u; row < ROWS; row++) {
        let element = row * WORKGROUP_SIZE + lane;
        let pair = tile * TILE_SIZE + element;
        if pair < params.count {
            let word = digit_of(pair) * WORDS_PER_DIGIT + element / 32u;
            let before = atomicLoad(&members[word]) & ((1u << (element % 32u)) - 1u);
            let to = word_offsets[word] + countOneBits(before);
            for (var i = 0u; i < params.key_words; i++) {
                keys_back[to * params.key_words + i] = keys_front[pair * params.key_words + i];
            }
            payload_back[to] = payload_front[pair];
        }
    }
}

// More pairs than a binding holds are sorted in chunks. A pair's place among all is its place in its chunk and, for every
// other chunk, the number of pairs there that go before it.

// Whether a pair of the other chunk goes before one of this chunk.
fn goes_before(other: u32, pair: u32) -> bool {
    for (var i = params.key_words; i > 0u; i--) {
        let theirs = keys_other[other * params.key_words + i - 1u];
        let ours = keys_front[pair * params.key_words + i - 1u];
        if theirs != ours {
            return theirs < ours;
        }
    }
    return params.other_first != 0u;
}

@compute @workgroup_size(256)
fn add_ranks(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let pair = (workgroup.y * workgroups.x + workgroup.x) * WORKGROUP_SIZE + lane;
    if pair >= params.count {
        return;
    }
    var low = 0u;
    var high = params.other_count;
    while low < high {
        let middle = (low + high) / 2u;
        if goes_before(middle, pair) {
            low = middle + 1u;
        } else {
            high = middle;
        }
    }
    ranks[pair] += low;
}

@compute @workgroup_size(256)
fn place_pairs(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let pair = (workgroup.y * workgroups.x + workgroup.x) * WORKGROUP_SIZE + lane;
    if pair >= params.count {
        return;
    }
    // Places before the window wrap to large numbers.
    let to = pair + ranks[pair] - params.window_begin;
    if to >= params.window_count {
        return;
    }
    for (var i = 0u; i < params.key_words; i++) {
        keys_back[to * params.key_words + i] = keys_front[pair * params.key_words + i];
    }
    payload_back[to] = payload_front[pair];
}
