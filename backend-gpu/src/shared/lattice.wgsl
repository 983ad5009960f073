// Twin of `lattice`: views and meshes in integers, and the bindings of them.

const DEPTH_ORIGIN: u32 = 536870912u;

struct View {
    right: vec4<i32>,
    down: vec4<i32>,
    forward: vec4<i32>,
}

@group(0) @binding(1) var<storage, read> views: array<View>;
// x and y in the halves of the first word, x in the low one; z in the second.
@group(0) @binding(2) var<storage, read> vertices: array<vec2<u32>>;
// Three vertices each.
@group(0) @binding(3) var<storage, read> triangles: array<u32>;

fn subpixel_bits(size: u32) -> u32 {
    return 15u - (32u - countLeadingZeros(size - 1u));
}

fn position_of(vertex: u32) -> vec3<i32> {
    let words = vertices[vertex];
    return vec3<i32>(i32(words.x << 16u) >> 16u, i32(words.x) >> 16u, i32(words.y));
}

fn along(row: vec4<i32>, p: vec3<i32>) -> i32 {
    return row.x * p.x + row.y * p.y + row.z * p.z;
}

// Screen coordinates, and the distance along the view.
fn project(view: View, p: vec3<i32>, size: u32) -> vec3<i32> {
    let origin = i32((size << (subpixel_bits(size) + 14u)) + (1u << 14u));
    let x = (along(view.right, p) + origin) >> 15u;
    let y = (along(view.down, p) + origin) >> 15u;
    return vec3<i32>(x, y, along(view.forward, p));
}
