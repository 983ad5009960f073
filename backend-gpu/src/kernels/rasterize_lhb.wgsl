// kernel family: rasterize_lhb
// contract core/src/kernels/rasterize_lhb.rs
// cpu backend-cpu/src/kernels/rasterize_lhb.rs
// gpu backend-gpu/src/kernels/rasterize_lhb.wgsl
// oracle conformance/src/oracle/rasterize_lhb.rs
//
// A pair is a triangle in a view. Pairs of few pixels are worked on by one invocation each; the others are cut into items
// of one invocation each, which find their pair by the scan of the numbers of items. Between the phases the host scans
// (kernel scan). The geometry is in rasterize_lhb/outline.wgsl, what is done to lists in rasterize_lhb/lists.wgsl.

const WORKGROUP_SIZE: u32 = 256u;

const PATH_AUTO: u32 = 0u;
const PATH_MICRO: u32 = 1u;
const PATH_BLOCKS: u32 = 2u;
const PATH_LINEAR: u32 = 3u;
const PATH_SPANS: u32 = 4u;

// Pixels of the bounds up to which a pair is no more than one invocation's work.
const MICRO_PIXELS: u32 = 32u;
// Pixels of the bounds up to which running over them is cheaper than finding the spans of every row: measured on the
// software adapters.
const LINEAR_PIXELS: u32 = 256u;
// Pixels of an item, except of the path by spans, where an item is a row.
const ITEM_PIXELS: u32 = 128u;
// Pixels along the side of a block, and in a row of an item of blocks.
const BLOCK_SIDE: u32 = 4u;
const BLOCKS_WIDTH: u32 = 32u;

struct RasterizeLhbParams {
    size: u32,
    path: u32,
    layer_cap: u32,
    cap_side: u32,
}

struct RasterizeLhbBlock {
    call: RasterizeLhbParams,
    // The pairs of the dispatch: some triangles in some views.
    view_begin: u32,
    triangle_begin: u32,
    triangle_count: u32,
    pair_count: u32,
    view_count: u32,
    // Of the mesh.
    vertex_count: u32,
    // The items of the dispatch, of all those of the pairs.
    item_begin: u32,
    item_end: u32,
    // 0 counts elements, 1 writes them.
    fill: u32,
    // Pixels of all views.
    list_count: u32,
    // Elements that the cap keeps.
    element_count: u32,
    // Length of the sorted runs that are merged.
    run: u32,
    // Tiles of long lists.
    tile_count: u32,
    // For loops_run.
    loop_rounds: u32,
    padding: vec2<u32>,
}

struct LhbElement {
    surface: u32,
    depth: u32,
}

@group(0) @binding(0) var<uniform> params: RasterizeLhbBlock;
@group(0) @binding(1) var<storage, read> views: array<View>;
// x and y in the halves of the first word, x in the low one; z in the second.
@group(0) @binding(2) var<storage, read> vertices: array<vec2<u32>>;
// Three vertices each.
@group(0) @binding(3) var<storage, read> triangles: array<u32>;
// The vertices in the views of the dispatch: x and y in the halves of the first word, x in the low one; z in the second.
@group(0) @binding(15) var<storage, read_write> projected: array<vec2<u32>>;
// Items of every pair.
@group(0) @binding(4) var<storage, read_write> items: array<u32>;
// The scan of the items of every pair, or of the elements that the cap keeps of every list.
@group(0) @binding(5) var<storage, read> starts: array<u32>;
// Elements of every list; while they are written, those that are still missing.
@group(0) @binding(6) var<storage, read_write> counts: array<atomic<u32>>;
@group(0) @binding(7) var<storage, read> offsets: array<u32>;
@group(0) @binding(8) var<storage, read_write> elements: array<LhbElement>;
@group(0) @binding(9) var<storage, read_write> status: array<atomic<u32>>;

fn position_of(vertex: u32) -> vec3<i32> {
    let words = vertices[vertex];
    return vec3<i32>(i32(words.x << 16u) >> 16u, i32(words.x) >> 16u, i32(words.y));
}

// The last of `count` starts that is not above `value`.
fn last_start(value: u32, count: u32) -> u32 {
    var low = 0u;
    var high = count;
    while high - low > 1u {
        let middle = low + (high - low) / 2u;
        if starts[middle] > value {
            high = middle;
        } else {
            low = middle;
        }
    }
    return low;
}

fn outline_of_pair(pair: u32) -> Outline {
    let view = pair / params.triangle_count;
    return setup(view, params.triangle_begin + pair - view * params.triangle_count);
}

// The path of a pair whose bounds hold `pixels` pixels.
fn path_of(pixels: u32) -> u32 {
    if params.call.path != PATH_AUTO {
        return params.call.path;
    }
    if pixels <= MICRO_PIXELS {
        return PATH_MICRO;
    }
    return select(PATH_SPANS, PATH_LINEAR, pixels <= LINEAR_PIXELS);
}

// How many items a pair is cut into; 0 where it is not cut.
fn items_of(size: vec2<u32>) -> u32 {
    let pixels = size.x * size.y;
    let path = path_of(pixels);
    if path == PATH_MICRO && pixels <= MICRO_PIXELS {
        return 0u;
    }
    switch path {
        case PATH_BLOCKS: {
            return items_across(size) * ((size.y + BLOCK_SIDE - 1u) / BLOCK_SIDE);
        }
        case PATH_SPANS: {
            return select(0u, size.y, size.x > 0u);
        }
        default: {
            return (pixels + ITEM_PIXELS - 1u) / ITEM_PIXELS;
        }
    }
}

// Items of blocks in a row of them.
fn items_across(size: vec2<u32>) -> u32 {
    return (size.x + BLOCKS_WIDTH - 1u) / BLOCKS_WIDTH;
}

// What an invocation knows of its pair.
struct Pen {
    outline: Outline,
    edges: Edges,
    plane: Plane,
}

fn pen_of(outline: Outline) -> Pen {
    var plane = Plane();
    if params.fill != 0u {
        plane = plane_of(outline);
    }
    return Pen(outline, edges_of(outline), plane);
}

// A pixel that is covered. The places in a list are given out in any order; [4] puts an end to that.
fn touch(pen: Pen, column: u32, row: u32) {
    let first = vec2<u32>(pen.outline.first);
    let list = pen.outline.list + (first.y + row) * params.call.size + first.x + column;
    if params.fill == 0u {
        atomicAdd(&counts[list], 1u);
    } else {
        let place = offsets[list] + atomicSub(&counts[list], 1u) - 1u;
        elements[place] = LhbElement(pen.outline.surface, depth_at(pen.plane, column, row));
    }
}

fn touch_where_covered(pen: Pen, at: vec3<i32>, column: u32, row: u32) {
    if covers(at) {
        touch(pen, column, row);
    }
}

// [1] count: vertices are projected once per view; then one round over the triangles, without depths, counts the
// elements of every list. [3] is the other round.
@compute @workgroup_size(256)
fn project_vertices(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = invocation_index(workgroup, workgroups, lane, WORKGROUP_SIZE);
    if index >= params.view_count * params.vertex_count {
        return;
    }
    let view = index / params.vertex_count;
    let vertex = index - view * params.vertex_count;
    let p = project(views[params.view_begin + view], position_of(vertex), params.call.size);
    projected[index] = vec2<u32>(u32(p.x) | (u32(p.y) << 16u), u32(p.z));
}

@compute @workgroup_size(256)
fn raster_pairs(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let pair = invocation_index(workgroup, workgroups, lane, WORKGROUP_SIZE);
    if pair >= params.pair_count {
        return;
    }
    let outline = outline_of_pair(pair);
    let size = outline.size;
    let cut = items_of(size);
    if params.fill == 0u {
        items[pair] = cut;
    }
    if cut > 0u || size.x == 0u {
        return;
    }
    let pen = pen_of(outline);
    for (var row = 0u; row < size.y; row++) {
        var at = edges_at(pen.edges, 0u, row);
        for (var column = 0u; column < size.x; column++) {
            touch_where_covered(pen, at, column, row);
            at += pen.edges.step_x;
        }
    }
}

@compute @workgroup_size(256)
fn raster_items(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let item = params.item_begin + invocation_index(workgroup, workgroups, lane, WORKGROUP_SIZE);
    if item >= params.item_end {
        return;
    }
    let pair = last_start(item, params.pair_count);
    let pen = pen_of(outline_of_pair(pair));
    let size = pen.outline.size;
    let part = item - starts[pair];
    switch path_of(size.x * size.y) {
        case PATH_BLOCKS: {
            let across = items_across(size);
            raster_blocks(pen, part % across * BLOCKS_WIDTH, part / across * BLOCK_SIDE);
        }
        case PATH_LINEAR: {
            raster_run(pen, part * ITEM_PIXELS);
        }
        case PATH_SPANS: {
            raster_span(pen, part);
        }
        default: {
            raster_pixels(pen, part * ITEM_PIXELS);
        }
    }
}

// A micro triangle that isn't one: every pixel anew.
fn raster_pixels(pen: Pen, begin: u32) {
    let size = pen.outline.size;
    for (var pixel = begin; pixel < min(begin + ITEM_PIXELS, size.x * size.y); pixel++) {
        let column = pixel % size.x;
        let row = pixel / size.x;
        touch_where_covered(pen, edges_at(pen.edges, column, row), column, row);
    }
}

// The same pixels, from one to the next.
fn raster_run(pen: Pen, begin: u32) {
    let size = pen.outline.size;
    var column = begin % size.x;
    var row = begin / size.x;
    var at = edges_at(pen.edges, column, row);
    for (var pixel = begin; pixel < min(begin + ITEM_PIXELS, size.x * size.y); pixel++) {
        touch_where_covered(pen, at, column, row);
        column += 1u;
        at += pen.edges.step_x;
        if column == size.x {
            column = 0u;
            row += 1u;
            at = edges_at(pen.edges, column, row);
        }
    }
}

// Blocks side by side.
fn raster_blocks(pen: Pen, begin: u32, top: u32) {
    let size = pen.outline.size;
    let bottom = min(top + BLOCK_SIDE, size.y) - 1u;
    for (var left = begin; left < min(begin + BLOCKS_WIDTH, size.x); left += BLOCK_SIDE) {
        raster_block(pen, vec2<u32>(left, top), vec2<u32>(min(left + BLOCK_SIDE, size.x) - 1u, bottom));
    }
}

// A block is outside where one edge leaves out all of its corners: it may hold a triangle that covers none of them. It
// ends at the bounds, beyond which edge functions may overflow.
fn raster_block(pen: Pen, low: vec2<u32>, high: vec2<u32>) {
    let a = edges_at(pen.edges, low.x, low.y);
    let b = edges_at(pen.edges, high.x, low.y);
    let c = edges_at(pen.edges, low.x, high.y);
    let d = edges_at(pen.edges, high.x, high.y);
    if !covers(max(max(a, b), max(c, d))) {
        return;
    }
    let inside = covers(min(min(a, b), min(c, d)));
    for (var row = low.y; row <= high.y; row++) {
        var at = edges_at(pen.edges, low.x, row);
        for (var column = low.x; column <= high.x; column++) {
            if inside || covers(at) {
                touch(pen, column, row);
            }
            at += pen.edges.step_x;
        }
    }
}

// The covered pixels of a row are between the edges that end it on the left and those that end it on the right.
fn raster_span(pen: Pen, row: u32) {
    let at = edges_at(pen.edges, 0u, row);
    var span = vec2<i32>(0, i32(pen.outline.size.x) - 1);
    span = clip_span(span, at.x, pen.edges.step_x.x);
    span = clip_span(span, at.y, pen.edges.step_x.y);
    span = clip_span(span, at.z, pen.edges.step_x.z);
    for (var column = span.x; column <= span.y; column++) {
        touch(pen, u32(column), row);
    }
}

// First and last column c of a span with at + c * step >= 0.
fn clip_span(span: vec2<i32>, at: i32, step: i32) -> vec2<i32> {
    if step > 0 {
        return vec2<i32>(max(span.x, -divide_floor(at, step)), span.y);
    }
    if step < 0 {
        return vec2<i32>(span.x, min(span.y, divide_floor(at, -step)));
    }
    return select(vec2<i32>(0, -1), span, at >= 0);
}

// floor(n / d), for d > 0.
fn divide_floor(n: i32, d: i32) -> i32 {
    let quotient = n / d;
    return select(quotient, quotient - 1, quotient * d > n);
}

// [2] offsets: kernel scan, from the host, and the sums of the counts in 64 bits: sum_lists

// [3] fill: raster_pairs and raster_items once more, with depths

// [4] sort: sort_lists, sort_tiles, merge_runs

// [5] cap: cap_lists, kernel scan from the host, copy_capped
