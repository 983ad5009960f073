// kernel family: scan
// contract core/src/kernels/scan.rs
// cpu backend-cpu/src/kernels/scan.rs
// gpu backend-gpu/src/kernels/scan.wgsl
// oracle conformance/src/oracle/scan.rs
//
// Reduce, scan, scan: no workgroup waits for another, so nothing is assumed of the scheduler (a decoupled look-back
// would spin for ever on adapters that run workgroups one after the other).

// Invocations per workgroup.
const WORKGROUP_SIZE: u32 = 256u;
// Each invocation takes ROWS runs of RUN neighbours; a row of runs is ROW_SIZE elements.
const ROWS: u32 = 4u;
const RUN: u32 = 4u;
const ROW_SIZE: u32 = 1024u;
// Elements per workgroup.
const TILE_SIZE: u32 = 4096u;
// The 256 partial sums are scanned as 16 bundles of 16: two barriers instead of the sixteen of a doubling scan.
const BUNDLE_SIZE: u32 = 16u;

struct ScanParams {
    // Elements of input and output.
    count: u32,
    // Tiles that hold them.
    tile_count: u32,
}

@group(0) @binding(0) var<uniform> params: ScanParams;
@group(0) @binding(1) var<storage, read> input: array<u32>;
// Sums of the tiles; after [2] their exclusive scan, and the total behind it.
@group(0) @binding(2) var<storage, read_write> tile_sums: array<u32>;
@group(0) @binding(3) var<storage, read_write> output: array<u32>;

// Partial sums of the four rows, one component each.
var<workgroup> partial_sums: array<vec4<u32>, 256>;
var<workgroup> bundle_sums: array<vec4<u32>, 17>;

// Exclusive scan over the workgroup, per component. The total is left in bundle_sums[BUNDLE_SIZE].
fn scan_partial_sums(lane: u32, value: vec4<u32>) -> vec4<u32> {
    partial_sums[lane] = value;
    workgroupBarrier();
    if lane < BUNDLE_SIZE {
        var sum = vec4<u32>();
        for (var i = 0u; i < BUNDLE_SIZE; i++) {
            let at = lane * BUNDLE_SIZE + i;
            let next = partial_sums[at];
            partial_sums[at] = sum;
            sum += next;
        }
        bundle_sums[lane] = sum;
    }
    workgroupBarrier();
    if lane == 0u {
        var sum = vec4<u32>();
        for (var i = 0u; i < BUNDLE_SIZE; i++) {
            let next = bundle_sums[i];
            bundle_sums[i] = sum;
            sum += next;
        }
        bundle_sums[BUNDLE_SIZE] = sum;
    }
    workgroupBarrier();
    return partial_sums[lane] + bundle_sums[lane / BUNDLE_SIZE];
}

// First element of an invocation's run in a row of a tile.
fn run_begin(tile: u32, row: u32, lane: u32) -> u32 {
    return tile * TILE_SIZE + row * ROW_SIZE + lane * RUN;
}

// Sums of rows 0..r for every r.
fn rows_before(totals: vec4<u32>) -> vec4<u32> {
    return vec4<u32>(0u, totals.x, totals.x + totals.y, totals.x + totals.y + totals.z);
}

// [1] reduce: the sum of every tile
@compute @workgroup_size(256)
fn reduce_tiles(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let tile = workgroup.y * workgroups.x + workgroup.x;
    if tile >= params.tile_count {
        return;
    }
    var sum = 0u;
    for (var row = 0u; row < ROWS; row++) {
        let begin = run_begin(tile, row, lane);
        for (var i = begin; i < min(begin + RUN, params.count); i++) {
            sum += input[i];
        }
    }
    scan_partial_sums(lane, vec4<u32>(sum, 0u, 0u, 0u));
    if lane == 0u {
        tile_sums[tile] = bundle_sums[BUNDLE_SIZE].x;
    }
}

// [2] scan the sums: one workgroup, tile after tile, in place
@compute @workgroup_size(256)
fn scan_tile_sums(@builtin(local_invocation_index) lane: u32) {
    var carry = 0u;
    for (var first = 0u; first < params.tile_count; first += TILE_SIZE) {
        var sums = vec4<u32>();
        for (var row = 0u; row < ROWS; row++) {
            let begin = first + run_begin(0u, row, lane);
            for (var i = begin; i < min(begin + RUN, params.tile_count); i++) {
                sums[row] += tile_sums[i];
            }
        }
        let before = scan_partial_sums(lane, sums);
        let totals = bundle_sums[BUNDLE_SIZE];
        let offsets = before + rows_before(totals) + vec4<u32>(carry);
        for (var row = 0u; row < ROWS; row++) {
            let begin = first + run_begin(0u, row, lane);
            var offset = offsets[row];
            for (var i = begin; i < min(begin + RUN, params.tile_count); i++) {
                let next = tile_sums[i];
                tile_sums[i] = offset;
                offset += next;
            }
        }
        carry += totals.x + totals.y + totals.z + totals.w;
        // The next round overwrites what this one still reads.
        workgroupBarrier();
    }
    if lane == 0u {
        tile_sums[params.tile_count] = carry;
    }
}

// [3] scan the tiles, each from the sum of those before it
@compute @workgroup_size(256)
fn scan_tiles(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let tile = workgroup.y * workgroups.x + workgroup.x;
    if tile >= params.tile_count {
        return;
    }
    var sums = vec4<u32>();
    for (var row = 0u; row < ROWS; row++) {
        let begin = run_begin(tile, row, lane);
        for (var i = begin; i < min(begin + RUN, params.count); i++) {
            sums[row] += input[i];
        }
    }
    let before = scan_partial_sums(lane, sums);
    let offsets = before + rows_before(bundle_sums[BUNDLE_SIZE]) + vec4<u32>(tile_sums[tile]);
    for (var row = 0u; row < ROWS; row++) {
        let begin = run_begin(tile, row, lane);
        var offset = offsets[row];
        for (var i = begin; i < min(begin + RUN, params.count); i++) {
            output[i] = offset;
            offset += input[i];
        }
    }
}
