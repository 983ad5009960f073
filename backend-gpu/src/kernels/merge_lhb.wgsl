// kernel family: merge_lhb
// contract core/src/kernels/merge_lhb.rs
// cpu backend-cpu/src/kernels/merge_lhb.rs
// gpu backend-gpu/src/kernels/merge_lhb.wgsl
// oracle conformance/src/oracle/merge_lhb.rs
//
// One invocation per list merges it; lists that are too long for one are merged by an invocation per element, which finds its
// list by the offsets, and its place in either input by the path that a merge takes through both (Green, McColl and Bader,
// "GPU merge path", 2012).

const WORKGROUP_SIZE: u32 = 256u;

const CAP_FAR: u32 = 1u;

// Elements of both inputs up to which a list is one invocation's work.
const LONG_LIST: u32 = 1024u;

// Words of `status`.
const MALFORMED: u32 = 1u;
const HAS_LONG_LISTS: u32 = 2u;

struct MergeLhbParams {
    first_triangle: u32,
    layer_cap: u32,
    cap_side: u32,
    padding: u32,
}

struct MergeLhbBlock {
    call: MergeLhbParams,
    list_count: u32,
    // Elements of the inputs, and of the result.
    kept_count: u32,
    added_count: u32,
    element_count: u32,
    // For loops_run.
    loop_rounds: u32,
}

struct LhbElement {
    surface: u32,
    depth: u32,
}

@group(0) @binding(0) var<uniform> params: MergeLhbBlock;
@group(0) @binding(1) var<storage, read> kept_offsets: array<u32>;
@group(0) @binding(2) var<storage, read> kept_elements: array<LhbElement>;
@group(0) @binding(3) var<storage, read> kept_left_out: array<u32>;
@group(0) @binding(4) var<storage, read> added_offsets: array<u32>;
@group(0) @binding(5) var<storage, read> added_elements: array<LhbElement>;
@group(0) @binding(6) var<storage, read> added_left_out: array<u32>;
// Offsets without a cap, with one the number of elements of every list.
@group(0) @binding(7) var<storage, read_write> sizes: array<u32>;
@group(0) @binding(8) var<storage, read_write> left_out: array<u32>;
@group(0) @binding(9) var<storage, read> offsets: array<u32>;
@group(0) @binding(10) var<storage, read_write> elements: array<LhbElement>;
@group(0) @binding(11) var<storage, read_write> status: array<atomic<u32>>;

// The elements of a list that are left, in both inputs.
struct Rest {
    kept: u32,
    kept_end: u32,
    added: u32,
    added_end: u32,
}

fn list_of(list: u32) -> Rest {
    return Rest(kept_offsets[list], kept_offsets[list + 1u], added_offsets[list], added_offsets[list + 1u]);
}

fn len_of(rest: Rest) -> u32 {
    return (rest.kept_end - rest.kept) + (rest.added_end - rest.added);
}

// [1] size: of every list and, behind the last, the end of all; the host refuses offsets that fall or leave their elements
@compute @workgroup_size(256)
fn size_lists(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let list = invocation_index(workgroup, workgroups, lane, WORKGROUP_SIZE);
    if list > params.list_count {
        return;
    }
    let is_capped = params.call.layer_cap > 0u;
    if !is_capped {
        sizes[list] = kept_offsets[list] + added_offsets[list];
    }
    if kept_offsets[list] > params.kept_count || added_offsets[list] > params.added_count {
        atomicStore(&status[MALFORMED], 1u);
    }
    if list == params.list_count {
        return;
    }
    let both = list_of(list);
    if both.kept > both.kept_end || both.added > both.added_end {
        atomicStore(&status[MALFORMED], 1u);
    }
    let len = len_of(both);
    if len > LONG_LIST {
        atomicStore(&status[HAS_LONG_LISTS], 1u);
    }
    if is_capped {
        let stays = min(len, params.call.layer_cap);
        sizes[list] = stays;
        left_out[list] = kept_left_out[list] + added_left_out[list] + (len - stays);
    }
}

// [2] scan: with a cap, kernel scan, from the host

// How many elements of a list go before those that stay.
fn skipped(len: u32, stays: u32) -> u32 {
    return select(0u, len - stays, params.call.cap_side == CAP_FAR);
}

// Whether the next element is an added one; there is one left.
fn is_added(rest: Rest) -> bool {
    if rest.kept == rest.kept_end || rest.added == rest.added_end {
        return rest.kept == rest.kept_end;
    }
    return added_elements[rest.added].depth < kept_elements[rest.kept].depth;
}

// The next element.
fn next_of(rest: Rest) -> LhbElement {
    if is_added(rest) {
        return renumbered(added_elements[rest.added]);
    }
    return kept_elements[rest.kept];
}

fn behind_next(rest: Rest) -> Rest {
    let added = select(0u, 1u, is_added(rest));
    return Rest(rest.kept + 1u - added, rest.kept_end, rest.added + added, rest.added_end);
}

fn renumbered(added: LhbElement) -> LhbElement {
    return LhbElement(added.surface + 2u * params.call.first_triangle, added.depth);
}

// [3] merge: every list that isn't long
@compute @workgroup_size(256)
fn merge_lists(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let list = invocation_index(workgroup, workgroups, lane, WORKGROUP_SIZE);
    if list >= params.list_count {
        return;
    }
    var rest = list_of(list);
    let len = len_of(rest);
    if len <= LONG_LIST {
        let begin = offsets[list];
        let stays = offsets[list + 1u] - begin;
        for (var i = 0u; i < skipped(len, stays); i++) {
            rest = behind_next(rest);
        }
        for (var i = 0u; i < stays; i++) {
            elements[begin + i] = next_of(rest);
            rest = behind_next(rest);
        }
    }
    if !loops_run(params.loop_rounds) {
        atomicStore(&status[0], 1u);
    }
}

// The elements of long lists.
@compute @workgroup_size(256)
fn merge_long_lists(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let to = invocation_index(workgroup, workgroups, lane, WORKGROUP_SIZE);
    // Before the first list there may be elements of none.
    if to >= params.element_count || to < offsets[0] {
        return;
    }
    let list = list_at(to);
    let both = list_of(list);
    let len = len_of(both);
    if len > LONG_LIST {
        let before = to - offsets[list] + skipped(len, offsets[list + 1u] - offsets[list]);
        elements[to] = next_of(behind(both, before));
    }
    if !loops_run(params.loop_rounds) {
        atomicStore(&status[0], 1u);
    }
}

// The list of an element: the last that doesn't begin behind it.
fn list_at(place: u32) -> u32 {
    var low = 0u;
    var high = params.list_count;
    while high - low > 1u {
        let middle = low + (high - low) / 2u;
        if offsets[middle] > place {
            high = middle;
        } else {
            low = middle;
        }
    }
    return low;
}

// What is left of a sorted list when its first `count` elements are taken, fewer than all. Of these, the kept ones are as many as go
// before the added one that is then the last taken.
fn behind(rest: Rest, count: u32) -> Rest {
    let kept_len = rest.kept_end - rest.kept;
    let added_len = rest.added_end - rest.added;
    var low = count - min(count, added_len);
    var high = min(count, kept_len);
    while low < high {
        let middle = low + (high - low) / 2u;
        let added = added_elements[rest.added + count - 1u - middle];
        if kept_elements[rest.kept + middle].depth <= added.depth {
            low = middle + 1u;
        } else {
            high = middle;
        }
    }
    return Rest(rest.kept + low, rest.kept_end, rest.added + count - low, rest.added_end);
}
