// kernel family: sum_voxels
// contract core/src/kernels/sum_voxels.rs
// cpu backend-cpu/src/kernels/sum_voxels.rs
// gpu backend-gpu/src/kernels/sum_voxels.wgsl
// oracle conformance/src/oracle/sum_voxels.rs
//
// Triangles are cut into items as in voxelize; each item adds what its cells meet. Integers are added: no order shows.

const WORKGROUP_SIZE: u32 = 256u;

// Words of a voxel's sums, and their parts.
const SUM_WORDS: u32 = 12u;
const COUNT: u32 = 3u;
const NORMAL: u32 = 4u;
const EMISSION: u32 = 8u;

struct SumVoxelsBlock {
    items: VoxelItems,
    texel_count: u32,
    // Voxels of the dispatch.
    active_begin: u32,
    active_end: u32,
    padding: u32,
}

@group(0) @binding(0) var<uniform> params: SumVoxelsBlock;
@group(0) @binding(3) var<storage, read> mask: array<u32>;
@group(0) @binding(4) var<storage, read> ranks: array<u32>;
@group(0) @binding(5) var<storage, read> surfaces: array<VoxelSurface>;
@group(0) @binding(6) var<storage, read> texels: array<u32>;
@group(0) @binding(7) var<storage, read_write> sums: array<atomic<u32>>;
@group(0) @binding(8) var<storage, read_write> most: array<atomic<u32>>;

// [1] add: an item is some cells of a triangle
@compute @workgroup_size(256)
fn add_items(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = params.items.item_begin + invocation_index(workgroup, workgroups, lane, WORKGROUP_SIZE);
    if index >= params.items.item_end {
        return;
    }
    let item = item_at(index);
    let triangle = listed_triangle(item.place);
    let end = min(item.end, cells(triangle));
    for (var cell = item.begin; cell < end; cell++) {
        let at = cell_column(triangle, cell);
        let heights = column(triangle, at);
        for (var k = heights.x; k <= heights.y; k++) {
            let voxel = vec3<i32>(at, k);
            if meets(triangle, voxel) {
                add(triangle, listed[item.place].triangle, voxel);
            }
        }
    }
}

// Adds a fragment of triangle `number` if its voxel is one of the dispatch's.
fn add(triangle: VoxelTriangle, number: u32, voxel: vec3<i32>) {
    let code = morton_code(vec3<u32>(turned_back(voxel, triangle.axis)));
    let word = mask[code >> 5u];
    let bit = 1u << (code & 31u);
    let rank = ranks[code >> 5u] + countOneBits(word & (bit - 1u));
    // Voxels of other origin.
    if (word & bit) == 0u || rank < params.active_begin || rank >= params.active_end {
        return;
    }
    let fragment = fragment_at(surfaces[number], weights(triangle, voxel));
    let first = SUM_WORDS * (rank - params.active_begin);
    add_three(first, fragment.albedo);
    atomicAdd(&sums[first + COUNT], 1u);
    add_three(first + NORMAL, vec3<u32>(fragment.normal));
    add_three(first + EMISSION, fragment.emission);
}

fn add_three(first: u32, values: vec3<u32>) {
    add_word(first, values.x);
    add_word(first + 1u, values.y);
    add_word(first + 2u, values.z);
}

// Most surfaces don't shine, and many have normals along an axis.
fn add_word(place: u32, value: u32) {
    if value != 0u {
        atomicAdd(&sums[place], value);
    }
}

// [2] check: the most fragments of a voxel, which the host refuses if they are too many
@compute @workgroup_size(256)
fn find_most(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let voxel = invocation_index(workgroup, workgroups, lane, WORKGROUP_SIZE);
    if voxel >= params.active_end - params.active_begin {
        return;
    }
    let count = atomicLoad(&sums[SUM_WORDS * voxel + COUNT]);
    if count > atomicLoad(&most[0]) {
        atomicMax(&most[0], count);
    }
}
