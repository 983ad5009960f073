// Ray origins off the surface they start on. Twin of core/src/transport/offset.rs.

const POSITION_ERROR: f32 = 5.364421e-7f;
const PLANE_ERROR: f32 = 1.9073486e-6f;

// Bound of the absolute error of the point a + b + c of a triangle, and of a later intersection with that triangle.
fn triangle_error(
    p0: vec3<f32>,
    p1: vec3<f32>,
    p2: vec3<f32>,
    a: vec3<f32>,
    b: vec3<f32>,
    c: vec3<f32>,
) -> vec3<f32> {
    let e1 = abs(p1 - p0);
    let e2 = abs(p2 - p0);
    let x = select(e2.x, e1.x, e1.x > e2.x);
    let y = select(e2.y, e1.y, e1.y > e2.y);
    let z = select(e2.z, e1.z, e1.z > e2.z);
    let xy = select(y, x, x > y);
    let extent = select(z, xy, xy > z);
    return ((abs(a) + abs(b)) + abs(c)) * POSITION_ERROR + vec3<f32>(extent * PLANE_ERROR);
}

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
    let distance = dot_product(a, error);
    let side = select(distance, -distance, dot_product(direction, normal) < 0.0f);
    let offset = normal * side;
    let moved = position + offset;
    return vec3<f32>(nudged(moved.x, offset.x), nudged(moved.y, offset.y), nudged(moved.z, offset.z));
}
