// Twin of `lattice`: views in integers.

const DEPTH_ORIGIN: u32 = 536870912u;

struct View {
    right: vec4<i32>,
    down: vec4<i32>,
    forward: vec4<i32>,
}

fn subpixel_bits(size: u32) -> u32 {
    return 15u - (32u - countLeadingZeros(size - 1u));
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
