// kernel family: pack_lhb
// contract core/src/kernels/pack_lhb.rs
// cpu backend-cpu/src/kernels/pack_lhb.rs
// gpu backend-gpu/src/kernels/pack_lhb.wgsl
// oracle conformance/src/oracle/pack_lhb.rs
//
// One invocation per word, in either direction: neighbours read and write neighbours. Layers that are read back are counted by one
// invocation per list, which searches for the first empty word.

const WORKGROUP_SIZE: u32 = 256u;

const CAP_FAR: u32 = 1u;
const EMPTY: u32 = 0xffffffffu;
const MAX_TRIANGLES: u32 = 1048575u;

// Words of `status`.
const MALFORMED: u32 = 1u;
// The greatest number of a triangle that a word has no room for, plus 1.
const TRIANGLES: u32 = 2u;

struct PackLhbBlock {
    layers: u32,
    cap_side: u32,
    list_count: u32,
    element_count: u32,
    word_count: u32,
    // 1 where it is known what was left out before.
    has_left_out: u32,
    // For loops_run.
    loop_rounds: u32,
    padding: u32,
}

struct LhbElement {
    surface: u32,
    depth: u32,
}

@group(0) @binding(0) var<uniform> params: PackLhbBlock;
@group(0) @binding(1) var<storage, read> list_offsets: array<u32>;
@group(0) @binding(2) var<storage, read> list_elements: array<LhbElement>;
@group(0) @binding(3) var<storage, read> list_left_out: array<u32>;
@group(0) @binding(4) var<storage, read_write> words: array<u32>;
@group(0) @binding(5) var<storage, read_write> left_out: array<u32>;
@group(0) @binding(6) var<storage, read> packed_words: array<u32>;
@group(0) @binding(7) var<storage, read_write> sizes: array<u32>;
@group(0) @binding(8) var<storage, read> offsets: array<u32>;
@group(0) @binding(9) var<storage, read_write> elements: array<LhbElement>;
@group(0) @binding(10) var<storage, read_write> status: array<atomic<u32>>;

// The word of an element, whose triangle the host refuses if there is no room for its number.
fn word_of(element: LhbElement) -> u32 {
    let triangle = element.surface >> 1u;
    if triangle >= MAX_TRIANGLES {
        atomicMax(&status[TRIANGLES], triangle + 1u);
    }
    return packed_element(element);
}

// [1] pack elements: every one
@compute @workgroup_size(256)
fn pack_elements(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = invocation_index(workgroup, workgroups, lane, WORKGROUP_SIZE);
    if index < params.word_count {
        words[index] = word_of(list_elements[index]);
    }
}

// [2] fill layers: every word of them; the host refuses offsets that fall or leave their elements
@compute @workgroup_size(256)
fn fill_layers(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = invocation_index(workgroup, workgroups, lane, WORKGROUP_SIZE);
    if index >= params.word_count {
        return;
    }
    let list = index / params.layers;
    let layer = index % params.layers;
    let begin = list_offsets[list];
    let end = list_offsets[list + 1u];
    if begin > end || end > params.element_count {
        atomicStore(&status[MALFORMED], 1u);
        return;
    }
    let stays = min(end - begin, params.layers);
    let beyond = end - begin - stays;
    if layer == 0u {
        left_out[list] = left_out_before(list) + beyond;
    }
    if layer >= stays {
        words[index] = EMPTY;
        return;
    }
    let first = begin + select(0u, beyond, params.cap_side == CAP_FAR);
    words[index] = word_of(list_elements[first + layer]);
}

fn left_out_before(list: u32) -> u32 {
    if params.has_left_out == 0u {
        return 0u;
    }
    return list_left_out[list];
}

// [3] unpack words: every one
@compute @workgroup_size(256)
fn unpack_words(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = invocation_index(workgroup, workgroups, lane, WORKGROUP_SIZE);
    if index < params.word_count {
        elements[index] = unpacked_element(packed_words[index]);
    }
}

// [4] size: of every list; one more stays 0, so that the scan ends with the total
@compute @workgroup_size(256)
fn size_layers(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let list = invocation_index(workgroup, workgroups, lane, WORKGROUP_SIZE);
    if list >= params.list_count {
        return;
    }
    sizes[list] = len_of(list);
    if !loops_run(params.loop_rounds) {
        atomicStore(&status[0], 1u);
    }
}

// How many words come before the empty ones.
fn len_of(list: u32) -> u32 {
    let begin = list * params.layers;
    var low = 0u;
    var high = params.layers;
    while low < high {
        let middle = low + (high - low) / 2u;
        if packed_words[begin + middle] != EMPTY {
            low = middle + 1u;
        } else {
            high = middle;
        }
    }
    return low;
}

// [5] scan: kernel scan, from the host

// [6] unpack layers: every word that isn't empty
@compute @workgroup_size(256)
fn unpack_layers(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = invocation_index(workgroup, workgroups, lane, WORKGROUP_SIZE);
    if index >= params.word_count {
        return;
    }
    let list = index / params.layers;
    let place = offsets[list] + index % params.layers;
    if place < offsets[list + 1u] {
        elements[place] = unpacked_element(packed_words[index]);
    }
}
