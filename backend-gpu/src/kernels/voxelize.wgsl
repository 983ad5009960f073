// kernel family: voxelize
// contract core/src/kernels/voxelize.rs
// cpu backend-cpu/src/kernels/voxelize.rs
// gpu backend-gpu/src/kernels/voxelize.wgsl
// oracle conformance/src/oracle/voxelize.rs
//
// Triangles are classed by one invocation each, then cut into items of some cells, which mark what they meet. Lists come from
// the mask by counts and their scan, so that they are in order whatever order bits were set in.

const WORKGROUP_SIZE: u32 = 256u;

struct VoxelizeBlock {
    items: VoxelItems,
    cutoff: u32,
    small_count: u32,
    word_count: u32,
    // 0 lists voxels, 1 lists those of the next level.
    level: u32,
    // Words of the mask per rank.
    words_per_rank: u32,
    // Codes of the dispatch.
    code_begin: u32,
    code_end: u32,
    padding: u32,
}

@group(0) @binding(0) var<uniform> params: VoxelizeBlock;
@group(0) @binding(3) var<storage, read> vertices: array<vec2<u32>>;
@group(0) @binding(4) var<storage, read> triangles: array<u32>;
// A word per triangle that says whether it is small, then one that says whether it is large; and their scan.
@group(0) @binding(5) var<storage, read_write> flags: array<u32>;
@group(0) @binding(6) var<storage, read> places: array<u32>;
@group(0) @binding(7) var<storage, read_write> small: array<u32>;
@group(0) @binding(8) var<storage, read_write> large: array<u32>;
@group(0) @binding(9) var<storage, read> list: array<u32>;
@group(0) @binding(10) var<storage, read_write> set_up: array<ListedTriangle>;
@group(0) @binding(11) var<storage, read_write> sizes: array<u32>;
@group(0) @binding(12) var<storage, read_write> marks: array<atomic<u32>>;
@group(0) @binding(13) var<storage, read> mask: array<u32>;
@group(0) @binding(14) var<storage, read_write> counts: array<u32>;
@group(0) @binding(15) var<storage, read> ranks: array<u32>;
@group(0) @binding(16) var<storage, read_write> codes: array<u32>;

// A corner of a triangle of the mesh, in grid coordinates.
fn corner(triangle: u32, number: u32) -> vec3<i32> {
    return place(unpacked_point(vertices[triangles[3u * triangle + number]]));
}

// [1] classify: flags, kernel scan, from the host, and the lists by it
@compute @workgroup_size(256)
fn classify(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = invocation_index(workgroup, workgroups, lane, WORKGROUP_SIZE);
    if index >= params.items.triangle_count {
        return;
    }
    let triangle = voxel_triangle(corner(index, 0u), corner(index, 1u), corner(index, 2u));
    let is_small = cells(triangle) <= params.cutoff;
    let is_met = !is_empty(triangle);
    flags[index] = select(0u, 1u, is_met && is_small);
    flags[params.items.triangle_count + index] = select(0u, 1u, is_met && !is_small);
}

@compute @workgroup_size(256)
fn list_classes(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = invocation_index(workgroup, workgroups, lane, WORKGROUP_SIZE);
    let triangle_count = params.items.triangle_count;
    if index >= triangle_count {
        return;
    }
    if flags[index] != 0u {
        small[places[index]] = index;
    }
    if flags[triangle_count + index] != 0u {
        large[places[triangle_count + index] - params.small_count] = index;
    }
}

// Triangles of a list, and how many items each has. Lists of other origin name triangles that aren't there, or none to be met.
@compute @workgroup_size(256)
fn size_items(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = invocation_index(workgroup, workgroups, lane, WORKGROUP_SIZE);
    if index >= params.items.list_count || list[index] >= params.items.triangle_count {
        return;
    }
    let number = list[index];
    let corners = array<vec3<i32>, 3>(corner(number, 0u), corner(number, 1u), corner(number, 2u));
    let words = array<vec2<u32>, 3>(packed_point(corners[0]), packed_point(corners[1]), packed_point(corners[2]));
    set_up[index] = ListedTriangle(words, number, 0u);
    let triangle = voxel_triangle(corners[0], corners[1], corners[2]);
    let items = (cells(triangle) + params.items.cells_per_item - 1u) / params.items.cells_per_item;
    sizes[index] = select(min(items, params.items.most_items), 0u, is_empty(triangle));
}

// [2] mark small: an item is all cells of a triangle, or a part if they are many
// [3] mark large: an item is a few cells
@compute @workgroup_size(256)
fn mark_items(
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
                mark(morton_code(vec3<u32>(turned_back(voxel, triangle.axis))));
            }
        }
    }
}

// Most bits are set already where triangles are small.
fn mark(code: u32) {
    let bit = 1u << (code & 31u);
    if (atomicLoad(&marks[code >> 5u]) & bit) == 0u {
        atomicOr(&marks[code >> 5u], bit);
    }
}

// The bits of a word of the mask at the level of the call.
fn bits_of(word: u32) -> u32 {
    let bits = mask[word];
    if params.level == 0u {
        return bits;
    }
    // A byte has the children of one voxel.
    let pairs = bits | (bits >> 4u);
    let halves = pairs | (pairs >> 2u);
    let parents = (halves | (halves >> 1u)) & 0x01010101u;
    return (parents | (parents >> 7u) | (parents >> 14u) | (parents >> 21u)) & 15u;
}

// [4] rank: the bits of some words, and kernel scan, from the host; one more stays 0, so that the scan ends with the total
@compute @workgroup_size(256)
fn count_codes(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = invocation_index(workgroup, workgroups, lane, WORKGROUP_SIZE);
    let begin = index * params.words_per_rank;
    if begin >= params.word_count {
        return;
    }
    var count = 0u;
    for (var word = begin; word < min(begin + params.words_per_rank, params.word_count); word++) {
        count += countOneBits(bits_of(word));
    }
    counts[index] = count;
}

// [5] list: the codes of those words from their rank on
@compute @workgroup_size(256)
fn list_codes(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = invocation_index(workgroup, workgroups, lane, WORKGROUP_SIZE);
    let begin = index * params.words_per_rank;
    if begin >= params.word_count {
        return;
    }
    var rank = ranks[index];
    for (var word = begin; word < min(begin + params.words_per_rank, params.word_count); word++) {
        let first = word << select(5u, 2u, params.level == 1u);
        for (var bits = bits_of(word); bits != 0u; bits &= bits - 1u) {
            if rank >= params.code_begin && rank < params.code_end {
                codes[rank - params.code_begin] = first | countTrailingZeros(bits);
            }
            rank += 1u;
        }
    }
}
