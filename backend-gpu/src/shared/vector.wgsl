// Vectors beyond sums and products. Twin of core/src/math/vector.rs; the products are glam's.

// Built-in dot leaves its order of additions to the driver.
fn dot_product(a: vec3<f32>, b: vec3<f32>) -> f32 {
    return (a.x * b.x + a.y * b.y) + a.z * b.z;
}

// Built-in cross is an extended instruction, whose products strict mode can't keep from being fused.
fn cross_product(a: vec3<f32>, b: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(a.y * b.z - b.y * a.z, a.z * b.x - b.z * a.x, a.x * b.y - b.x * a.y);
}

// v / |v| for vectors of ordinary length; 0 for 0.
fn normalized(v: vec3<f32>) -> vec3<f32> {
    let squared = dot_product(v, v);
    if !(squared > 0.0f) {
        return vec3<f32>(0.0f);
    }
    return v * (1.0f / sqrt(squared));
}

struct Basis {
    tangent: vec3<f32>,
    bitangent: vec3<f32>,
}

// Two vectors that complete the unit vector n to a right-handed orthonormal basis (Duff et al. 2017).
fn basis(n: vec3<f32>) -> Basis {
    let side = select(1.0f, -1.0f, n.z < 0.0f);
    let a = -1.0f / (side + n.z);
    let b = n.x * n.y * a;
    return Basis(
        vec3<f32>(1.0f + side * n.x * n.x * a, side * b, -side * n.x),
        vec3<f32>(b, side + n.y * n.y * a, -n.y),
    );
}

// t v.x + b v.y + n v.z
fn to_world(t: vec3<f32>, b: vec3<f32>, n: vec3<f32>, v: vec3<f32>) -> vec3<f32> {
    return t * v.x + b * v.y + n * v.z;
}

// The point of the unit disc for a point of the unit square (Shirley & Chiu 1997).
fn concentric_disc(u: f32, v: f32) -> vec2<f32> {
    let x = 2.0f * u - 1.0f;
    let y = 2.0f * v - 1.0f;
    if x == 0.0f && y == 0.0f {
        return vec2<f32>(0.0f, 0.0f);
    }
    let horizontal = abs(x) > abs(y);
    let radius = select(y, x, horizontal);
    let ratio = select(x, y, horizontal) / radius;
    let sc = sin_cos_octant(ratio * FRAC_PI_4);
    // Around the vertical axis the angle counts from that axis, which exchanges sine and cosine.
    if horizontal {
        return vec2<f32>(radius * sc.y, radius * sc.x);
    }
    return vec2<f32>(radius * sc.x, radius * sc.y);
}
