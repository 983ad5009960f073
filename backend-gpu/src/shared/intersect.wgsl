// Ray against triangle, box and sphere. Twin of core/src/transport/intersect.rs, which says what a hit means.

const MIN_DIRECTION: f32 = 8.6736174e-19f;
const SLAB_FAR_FACTOR: f32 = 1.0000004768371582f;
const PAD_EXTENT: f32 = 9.5367431640625e-7f;
const PAD_COORDINATE: f32 = 2.384185791015625e-7f;
const SIDE_ERROR: f32 = 9.5367431640625e-7f;

struct RayFrame {
    origin: vec3<f32>,
    direction: vec3<f32>,
    inverse: vec3<f32>,
    axes: vec3<u32>,
    shear: vec3<f32>,
}

fn smaller(a: f32, b: f32) -> f32 {
    return select(b, a, a < b);
}

fn larger(a: f32, b: f32) -> f32 {
    return select(b, a, a > b);
}

fn safe_reciprocal(d: f32) -> f32 {
    let magnitude = select(abs(d), MIN_DIRECTION, abs(d) < MIN_DIRECTION);
    let reciprocal = 1.0f / magnitude;
    return select(reciprocal, -reciprocal, d < 0.0f);
}

fn ray_frame(origin: vec3<f32>, direction: vec3<f32>) -> RayFrame {
    let magnitude = abs(direction);
    var kz = 0u;
    if magnitude.y > magnitude.x {
        kz = 1u;
    }
    if magnitude.z > select(magnitude.x, magnitude.y, kz == 1u) {
        kz = 2u;
    }
    var kx = select(kz + 1u, 0u, kz == 2u);
    var ky = select(kx + 1u, 0u, kx == 2u);
    let dominant = direction[kz];
    if dominant < 0.0f {
        let swapped = kx;
        kx = ky;
        ky = swapped;
    }
    let scale = 1.0f / dominant;
    let shear = vec3<f32>(direction[kx] / dominant, direction[ky] / dominant, scale);
    let inverse =
        vec3<f32>(safe_reciprocal(direction.x), safe_reciprocal(direction.y), safe_reciprocal(direction.z));
    return RayFrame(origin, direction, inverse, vec3<u32>(kx, ky, kz), shear);
}

// Entry and exit parameters of a ray and a box.
fn slab(frame: RayFrame, low: vec3<f32>, high: vec3<f32>) -> vec2<f32> {
    let a = (low - frame.origin) * frame.inverse;
    let b = (high - frame.origin) * frame.inverse;
    let near = larger(larger(smaller(a.x, b.x), smaller(a.y, b.y)), smaller(a.z, b.z));
    let far = smaller(smaller(larger(a.x, b.x), larger(a.y, b.y)), larger(a.z, b.z));
    return vec2<f32>(near, select(far * SLAB_FAR_FACTOR, far, far < 0.0f));
}

struct Bounds {
    low: vec3<f32>,
    high: vec3<f32>,
}

fn padded_bounds(p0: vec3<f32>, p1: vec3<f32>, p2: vec3<f32>) -> Bounds {
    let low = vec3<f32>(
        smaller(smaller(p0.x, p1.x), p2.x),
        smaller(smaller(p0.y, p1.y), p2.y),
        smaller(smaller(p0.z, p1.z), p2.z),
    );
    let high = vec3<f32>(
        larger(larger(p0.x, p1.x), p2.x),
        larger(larger(p0.y, p1.y), p2.y),
        larger(larger(p0.z, p1.z), p2.z),
    );
    let size = high - low;
    let extent = larger(larger(size.x, size.y), size.z);
    let reach = vec3<f32>(
        larger(abs(low.x), abs(high.x)),
        larger(abs(low.y), abs(high.y)),
        larger(abs(low.z), abs(high.z)),
    );
    let coordinate = larger(larger(reach.x, reach.y), reach.z);
    let pad = vec3<f32>(extent * PAD_EXTENT + coordinate * PAD_COORDINATE);
    return Bounds(low - pad, high + pad);
}

struct TriangleHit {
    met: bool,
    t: f32,
    u: f32,
    v: f32,
}

struct PlaneHit {
    met: bool,
    t: f32,
}

// Where a ray meets the plane of a triangle (corners relative to the ray's origin), or t_edge where rounding leaves open
// on which side of it the ray starts; not met when it starts on one side and goes away from it.
fn plane_t(
    frame: RayFrame,
    normal: vec3<f32>,
    a: vec3<f32>,
    b: vec3<f32>,
    c: vec3<f32>,
    t_edge: f32,
) -> PlaneHit {
    let height = -dot_product(normal, a);
    let slope = dot_product(normal, frame.direction);
    let x = larger(larger(abs(a.x), abs(b.x)), abs(c.x));
    let y = larger(larger(abs(a.y), abs(b.y)), abs(c.y));
    let z = larger(larger(abs(a.z), abs(b.z)), abs(c.z));
    let doubt = larger(larger(x, y), z) * SIDE_ERROR;
    if height > doubt {
        return PlaneHit(slope < 0.0f, height / -slope);
    }
    if height < -doubt {
        return PlaneHit(slope > 0.0f, -height / slope);
    }
    return PlaneHit(true, t_edge);
}

// Conditions 2 to 4 for a triangle whose edges let the ray through.
fn triangle_t(
    frame: RayFrame,
    normal: vec3<f32>,
    p0: vec3<f32>,
    p1: vec3<f32>,
    p2: vec3<f32>,
    edges: vec3<f32>,
    t_min: f32,
    t_max: f32,
) -> PlaneHit {
    let miss = PlaneHit(false, 0.0f);
    let determinant = (edges.x + edges.y) + edges.z;
    // Zero or NaN, by its bits: a driver may turn `!(x < 0 || x > 0)` into `x >= 0 && x <= 0`, which NaN passes.
    let magnitude = bitcast<u32>(determinant) & 0x7fffffffu;
    if magnitude == 0u || magnitude > 0x7f800000u {
        return miss;
    }
    let kz = frame.axes.z;
    let a = p0 - frame.origin;
    let b = p1 - frame.origin;
    let c = p2 - frame.origin;
    let az = frame.shear.z * a[kz];
    let bz = frame.shear.z * b[kz];
    let cz = frame.shear.z * c[kz];
    let low = smaller(smaller(az, bz), cz);
    let high = larger(larger(az, bz), cz);
    if !(high > t_min && low <= t_max) {
        return miss;
    }
    let bounds = padded_bounds(p0, p1, p2);
    let range = slab(frame, bounds.low, bounds.high);
    let near = range.x;
    if !(larger(near, 0.0f) <= range.y) {
        return miss;
    }
    let t_edge = ((edges.x * az + edges.y * bz) + edges.z * cz) / determinant;
    let plane = plane_t(frame, normal, a, b, c, t_edge);
    let t = smaller(larger(plane.t, low), high);
    let t_i = larger(t, near);
    return PlaneHit(plane.met && t > t_min && t_i <= t_max, t_i);
}

fn triangle(
    frame: RayFrame,
    normal: vec3<f32>,
    p0: vec3<f32>,
    p1: vec3<f32>,
    p2: vec3<f32>,
    t_min: f32,
    t_max: f32,
) -> TriangleHit {
    let miss = TriangleHit(false, 0.0f, 0.0f, 0.0f);
    let kx = frame.axes.x;
    let ky = frame.axes.y;
    let kz = frame.axes.z;
    let a = p0 - frame.origin;
    let b = p1 - frame.origin;
    let c = p2 - frame.origin;
    let ax = a[kx] - frame.shear.x * a[kz];
    let ay = a[ky] - frame.shear.y * a[kz];
    let bx = b[kx] - frame.shear.x * b[kz];
    let by = b[ky] - frame.shear.y * b[kz];
    let cx = c[kx] - frame.shear.x * c[kz];
    let cy = c[ky] - frame.shear.y * c[kz];
    let u = cx * by - cy * bx;
    let v = ax * cy - ay * cx;
    let w = bx * ay - by * ax;
    if (u < 0.0f || v < 0.0f || w < 0.0f) && (u > 0.0f || v > 0.0f || w > 0.0f) {
        return miss;
    }
    let hit = triangle_t(frame, normal, p0, p1, p2, vec3<f32>(u, v, w), t_min, t_max);
    if !hit.met {
        return miss;
    }
    let determinant = (u + v) + w;
    return TriangleHit(true, hit.t, v / determinant, w / determinant);
}

struct SphereRoots {
    met: bool,
    near: f32,
    far: f32,
}

// Entry and exit of a ray and a sphere.
fn sphere(origin: vec3<f32>, direction: vec3<f32>, center: vec3<f32>, radius: f32) -> SphereRoots {
    let miss = SphereRoots(false, 0.0f, 0.0f);
    let f = origin - center;
    let a = dot_product(direction, direction);
    let b = -dot_product(f, direction);
    let s = b / a;
    let perpendicular = f + direction * s;
    let discriminant = radius * radius - dot_product(perpendicular, perpendicular);
    if !(discriminant >= 0.0f) {
        return miss;
    }
    let c = dot_product(f, f) - radius * radius;
    let root = sqrt(a * discriminant);
    let q = select(b + root, b - root, b < 0.0f);
    let t0 = c / q;
    let t1 = q / a;
    if !(q < 0.0f || q > 0.0f) {
        return miss;
    }
    if t0 < t1 {
        return SphereRoots(true, t0, t1);
    }
    return SphereRoots(true, t1, t0);
}
