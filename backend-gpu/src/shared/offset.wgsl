// Ray origins off the surface they start on. Twin of core/src/transport/offset.rs.

const POSITION_ERROR: f32 = 5.364421e-7f;

// The next f32 away from 0 on the side of `toward`; 0 goes to 2^-100.
fn nudged(x: f32, toward: f32) -> f32 {
    if toward == 0.0f {
        return x;
    }
    if x == 0.0f {
        return select(-7.888609e-31f, 7.888609e-31f, toward > 0.0f);
    }
    let bits = bitcast<u32>(x);
    let outwards = (x > 0.0f) == (toward > 0.0f);
    return bitcast<f32>(select(bits - 1u, bits + 1u, outwards));
}

fn offset_origin(
    position: vec3<f32>,
    error: vec3<f32>,
    normal: vec3<f32>,
    direction: vec3<f32>,
) -> vec3<f32> {
    let a = abs(normal);
    // The largest error counts for every axis: see the Rust twin.
    let xy = select(error.y, error.x, error.x > error.y);
    let largest = select(error.z, xy, xy > error.z);
    let distance = ((a.x + a.y) + a.z) * largest;
    let side = select(distance, -distance, dot_product(direction, normal) < 0.0f);
    let offset = normal * side;
    let moved = position + offset;
    return vec3<f32>(nudged(moved.x, offset.x), nudged(moved.y, offset.y), nudged(moved.z, offset.z));
}
