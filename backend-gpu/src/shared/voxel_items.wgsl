// The triangles of a list cut into items, some cells each: what one invocation works on. So one triangle as large as a wall
// keeps as many invocations busy as it has cells. Wants shared/voxel.wgsl and `params.items`.

// What the parameters of the kernels over items begin with.
struct VoxelItems {
    grid: VoxelGrid,
    separation: u32,
    // Triangles of the mesh.
    triangle_count: u32,
    // Triangles of the dispatch's part of the list.
    list_count: u32,
    cells_per_item: u32,
    // Most items of a triangle.
    most_items: u32,
    // Items of the dispatch.
    item_begin: u32,
    item_end: u32,
    padding: u32,
}

// A triangle of the list in grid coordinates.
struct ListedTriangle {
    // Per corner x and y in the halves of a word, x in the low one, and z.
    corners: array<vec2<u32>, 3>,
    triangle: u32,
    padding: u32,
}

// Cells of a triangle.
struct VoxelItem {
    // The triangle's place in `listed`.
    place: u32,
    begin: u32,
    // Too large for the last one: `cells` bounds it.
    end: u32,
}

@group(0) @binding(1) var<storage, read> listed: array<ListedTriangle>;
// The scan of the numbers of items.
@group(0) @binding(2) var<storage, read> item_offsets: array<u32>;

// An item below the last offset and its triangle's number of items.
fn item_at(item: u32) -> VoxelItem {
    var low = 0u;
    var high = params.items.list_count;
    // The last triangle whose items begin at this one or before.
    while high - low > 1u {
        let middle = low + (high - low) / 2u;
        if item_offsets[middle] <= item {
            low = middle;
        } else {
            high = middle;
        }
    }
    let begin = (item - item_offsets[low]) * params.items.cells_per_item;
    return VoxelItem(low, begin, begin + params.items.cells_per_item);
}

fn listed_triangle(place: u32) -> VoxelTriangle {
    let corners = listed[place].corners;
    return voxel_triangle(unpacked_point(corners[0]), unpacked_point(corners[1]), unpacked_point(corners[2]));
}

// 16 bits each, but for z, which has a word.
fn unpacked_point(words: vec2<u32>) -> vec3<i32> {
    let xy = vec2<i32>(vec2<u32>(words.x << 16u, words.x)) >> vec2<u32>(16u);
    return vec3<i32>(xy, i32(words.y));
}

fn packed_point(p: vec3<i32>) -> vec2<u32> {
    return vec2<u32>((u32(p.x) & 0xffffu) | (u32(p.y) << 16u), u32(p.z));
}
