// What is done to the lists: their sizes, their order, their cap.

// Lists up to this long are sorted by one invocation. Longer ones are cut into tiles, each of them sorted by a workgroup.
const SHORT_LIST: u32 = 32u;
const TILE_SIZE: u32 = 1024u;
// Lists whose counts are summed by one invocation.
const LISTS_PER_LANE: u32 = 16u;

const CAP_FAR: u32 = 1u;

// A tile of a list that isn't short.
struct ListTile {
    // The list's place in the elements.
    list_begin: u32,
    list_len: u32,
    // Its first element in the list.
    begin: u32,
}

// Sums over 4096 lists: their elements, low word first, and their tiles; and the longest of them.
struct ListSums {
    elements_low: u32,
    elements_high: u32,
    tiles: u32,
    longest: u32,
}

@group(0) @binding(10) var<storage, read_write> list_sums: array<ListSums>;
@group(0) @binding(11) var<storage, read_write> new_tiles: array<ListTile>;
@group(0) @binding(12) var<storage, read> tiles: array<ListTile>;
// Elements on their way from `elements`.
@group(0) @binding(13) var<storage, read_write> moved: array<LhbElement>;
@group(0) @binding(14) var<storage, read_write> left_out: array<u32>;

var<workgroup> partial_sums: array<ListSums, 256>;
// Depth and surface.
var<workgroup> tile_keys: array<vec2<u32>, 1024>;

// Tiles of a list.
fn tiles_of(len: u32) -> u32 {
    return select(0u, (len + TILE_SIZE - 1u) / TILE_SIZE, len > SHORT_LIST);
}

fn add_sums(a: ListSums, b: ListSums) -> ListSums {
    let sum = wide_add(vec2<u32>(a.elements_low, a.elements_high), vec2<u32>(b.elements_low, b.elements_high));
    return ListSums(sum.x, sum.y, a.tiles + b.tiles, max(a.longest, b.longest));
}

// [2] the scan is modulo 2^32; these sums are not
@compute @workgroup_size(256)
fn sum_lists(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let group = workgroup.y * workgroups.x + workgroup.x;
    let begin = (group * WORKGROUP_SIZE + lane) * LISTS_PER_LANE;
    var sums = ListSums();
    for (var list = begin; list < min(begin + LISTS_PER_LANE, params.list_count); list++) {
        let count = atomicLoad(&counts[list]);
        sums = add_sums(sums, ListSums(count, 0u, tiles_of(count), count));
    }
    partial_sums[lane] = sums;
    workgroupBarrier();
    // Rows of a folded dispatch may be longer than needed.
    if lane == 0u && begin < params.list_count {
        for (var i = 1u; i < WORKGROUP_SIZE; i++) {
            sums = add_sums(sums, partial_sums[i]);
        }
        list_sums[group] = sums;
    }
}

// Whether an element goes before another: by depth, then by triangle. Keys are depth and surface.
fn goes_before(a: vec2<u32>, b: vec2<u32>) -> bool {
    return a.x < b.x || (a.x == b.x && a.y < b.y);
}

fn key_of(element: LhbElement) -> vec2<u32> {
    return vec2<u32>(element.depth, element.surface);
}

fn element_of(key: vec2<u32>) -> LhbElement {
    return LhbElement(key.y, key.x);
}

// [4] sort: short lists by insertion; of the others a table of tiles, in any order
@compute @workgroup_size(256)
fn sort_lists(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let list = invocation_index(workgroup, workgroups, lane, WORKGROUP_SIZE);
    if list >= params.list_count {
        return;
    }
    let begin = offsets[list];
    let len = offsets[list + 1u] - begin;
    if len > SHORT_LIST {
        let tile_count = tiles_of(len);
        let first = atomicAdd(&status[1], tile_count);
        for (var i = 0u; i < tile_count; i++) {
            new_tiles[first + i] = ListTile(begin, len, i * TILE_SIZE);
        }
    } else {
        insert_in_order(begin, len);
    }
    if !loops_run(params.loop_rounds) {
        atomicStore(&status[0], 1u);
    }
}

fn insert_in_order(begin: u32, len: u32) {
    for (var i = 1u; i < len; i++) {
        let key = key_of(elements[begin + i]);
        var place = begin + i;
        while place > begin {
            let before = elements[place - 1u];
            if !goes_before(key, key_of(before)) {
                break;
            }
            elements[place] = before;
            place -= 1u;
        }
        elements[place] = element_of(key);
    }
}

// Tiles by a bitonic network (Batcher 1968). What is missing to a power of two goes after every element.
@compute @workgroup_size(256)
fn sort_tiles(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = workgroup.y * workgroups.x + workgroup.x;
    if index >= params.tile_count {
        return;
    }
    let tile = tiles[index];
    let begin = tile.list_begin + tile.begin;
    let len = min(tile.list_len - tile.begin, TILE_SIZE);
    var width = 2u;
    while width < len {
        width *= 2u;
    }
    for (var i = lane; i < width; i += WORKGROUP_SIZE) {
        tile_keys[i] = vec2<u32>(0xffffffffu);
        if i < len {
            tile_keys[i] = key_of(elements[begin + i]);
        }
    }
    workgroupBarrier();
    for (var run = 2u; run <= width; run *= 2u) {
        for (var distance = run / 2u; distance > 0u; distance /= 2u) {
            for (var i = lane; i < width / 2u; i += WORKGROUP_SIZE) {
                let low = i / distance * distance * 2u + i % distance;
                order_pair(low, low + distance, (low & run) == 0u);
            }
            workgroupBarrier();
        }
    }
    for (var i = lane; i < len; i += WORKGROUP_SIZE) {
        elements[begin + i] = element_of(tile_keys[i]);
    }
}

fn order_pair(low: u32, high: u32, ascending: bool) {
    let a = tile_keys[low];
    let b = tile_keys[high];
    if goes_before(b, a) == ascending {
        tile_keys[low] = b;
        tile_keys[high] = a;
    }
}

// Sorted runs of lists of several tiles become runs twice as long. An element's place is its own place in its run and the
// number of elements before it in the run beside.
@compute @workgroup_size(256)
fn merge_runs(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = workgroup.y * workgroups.x + workgroup.x;
    if index >= params.tile_count {
        return;
    }
    let tile = tiles[index];
    if tile.list_len <= TILE_SIZE {
        return;
    }
    let run_begin = tile.begin / params.run * params.run;
    let beside = run_begin ^ params.run;
    let beside_end = min(beside + params.run, tile.list_len);
    for (var i = lane; i < min(tile.list_len - tile.begin, TILE_SIZE); i += WORKGROUP_SIZE) {
        let element = elements[tile.list_begin + tile.begin + i];
        let before = count_before(element, tile.list_begin, min(beside, tile.list_len), beside_end);
        let place = min(run_begin, beside) + (tile.begin - run_begin) + i + before;
        moved[tile.list_begin + place] = element;
    }
}

// How many elements of a run of a list go before another.
fn count_before(element: LhbElement, list_begin: u32, begin: u32, end: u32) -> u32 {
    var low = begin;
    var high = end;
    while low < high {
        let middle = (low + high) / 2u;
        if goes_before(key_of(elements[list_begin + middle]), key_of(element)) {
            low = middle + 1u;
        } else {
            high = middle;
        }
    }
    return low - begin;
}

// [5] cap: what is left out of every list, and what is kept
@compute @workgroup_size(256)
fn cap_lists(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let list = invocation_index(workgroup, workgroups, lane, WORKGROUP_SIZE);
    if list >= params.list_count {
        return;
    }
    let len = offsets[list + 1u] - offsets[list];
    let kept = min(len, params.call.layer_cap);
    atomicStore(&counts[list], kept);
    left_out[list] = len - kept;
}

@compute @workgroup_size(256)
fn copy_capped(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let to = invocation_index(workgroup, workgroups, lane, WORKGROUP_SIZE);
    if to >= params.element_count {
        return;
    }
    let list = last_start(to, params.list_count);
    var begin = offsets[list];
    if params.call.cap_side == CAP_FAR {
        begin = offsets[list + 1u] - (starts[list + 1u] - starts[list]);
    }
    moved[to] = elements[begin + to - starts[list]];
}
