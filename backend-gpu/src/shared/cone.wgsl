// Cones through the levels of a grid of voxels. Twin of core/src/transport/cone.rs. The view is the kernel's globals `mask`, `ranks`, `values`
// and `params`.

// No value.
const NONE: u32 = 0xffffffffu;

// First word of a level's mask.
fn word_start(level: u32) -> u32 {
    return params.word_starts[level >> 2u][level & 3u];
}

// Number of the value of a voxel, or NONE.
fn value_of(level: u32, voxel: vec3<u32>) -> u32 {
    let code = morton_code(voxel);
    let at = word_start(level) + (code >> 5u);
    let occupied = mask[at];
    let bit = 1u << (code & 31u);
    if (occupied & bit) == 0u {
        return NONE;
    }
    return ranks[at] + countOneBits(occupied & (bit - 1u));
}

// Word `i` of a value; 0 beyond the buffer.
fn word(first: u32, i: u32) -> u32 {
    let at = first + i;
    if at < params.value_words {
        return values[at];
    }
    return 0u;
}

// Four words as floats.
fn four(first: u32) -> vec4<f32> {
    return vec4<f32>(f32(word(first, 0u)), f32(word(first, 1u)), f32(word(first, 2u)), f32(word(first, 3u)));
}

// Radiance of four coefficients against `direction`.
fn radiance(a: vec4<f32>, direction: vec3<f32>) -> f32 {
    let sum = a.x - ((a.y * direction.x + a.z * direction.y) + a.w * direction.z);
    return select(0.0f, sum, sum > 0.0f);
}

fn face(first: u32, axis: u32, component: f32) -> vec4<f32> {
    let side = select(1u, 0u, component < 0.0f);
    return four(first + 8u * axis + 4u * side) * (component * component);
}

// A signed byte.
fn byte(word: u32, i: u32) -> f32 {
    return f32(bitcast<i32>(word << (24u - 8u * i)) >> 24u);
}

// Radiance of channel `c` of harmonics.
fn of_harmonics(first: u32, c: u32, direction: vec3<f32>) -> f32 {
    let from_here = first + 1u + 4u * c;
    let a = vec4<i32>(
        bitcast<i32>(word(from_here, 0u)),
        bitcast<i32>(word(from_here, 1u)),
        bitcast<i32>(word(from_here, 2u)),
        bitcast<i32>(word(from_here, 3u)),
    );
    return radiance(vec4<f32>(a), direction);
}

// Radiance of channel `c` of harmonics in bytes.
fn of_bytes(first: u32, c: u32, direction: vec3<f32>, scale: f32) -> f32 {
    let q = word(first, 1u + c);
    return radiance(vec4<f32>(f32(q & 255u), byte(q, 1u), byte(q, 2u), byte(q, 3u)), direction) * scale;
}

// What leaves a voxel against `direction`: (rgb, opacity), in units of the values.
fn value(number: u32, direction: vec3<f32>) -> vec4<f32> {
    let storage = params.call.storage;
    if storage == ISOTROPIC {
        return four(number * 4u);
    }
    if storage == ANISOTROPIC {
        let first = number * 24u;
        let x = face(first, 0u, direction.x);
        let y = face(first, 1u, direction.y);
        let z = face(first, 2u, direction.z);
        return (x + y) + z;
    }
    if storage == HARMONICS {
        let first = number * 13u;
        let r = of_harmonics(first, 0u, direction);
        let g = of_harmonics(first, 1u, direction);
        let b = of_harmonics(first, 2u, direction);
        return vec4<f32>(r, g, b, f32(word(first, 0u)));
    }
    if storage != HARMONICS_8 {
        return vec4<f32>(0.0f);
    }
    let first = number * 4u;
    let head = word(first, 0u);
    // 2^e by its bits.
    let scale = bitcast<f32>((127u + ((head >> 24u) & 31u)) << 23u);
    let r = of_bytes(first, 0u, direction, scale);
    let g = of_bytes(first, 1u, direction, scale);
    let b = of_bytes(first, 2u, direction, scale);
    return vec4<f32>(r, g, b, f32(head & 0xffffffu));
}

// A value whose opacity is a mean over space, as that of a voxel of level `level`: 2^l such layers, one behind the other.
fn deepened(value: vec4<f32>, level: u32) -> vec4<f32> {
    let mean = value.w * (1.0f / f32(OPAQUE));
    if !(mean > 0.0f) {
        return value;
    }
    let open = squared(select(0.0f, 1.0f - mean, mean < 1.0f), level);
    return value * ((1.0f - open) / mean);
}

// `x` squared `times` times, at most 9, as many as there are levels above the first. No loop: those of `trace_cone` may take 65535 rounds
// in all on llvmpipe.
fn squared(x: f32, times: u32) -> f32 {
    var y = x;
    if times > 0u { y *= y; }
    if times > 1u { y *= y; }
    if times > 2u { y *= y; }
    if times > 3u { y *= y; }
    if times > 4u { y *= y; }
    if times > 5u { y *= y; }
    if times > 6u { y *= y; }
    if times > 7u { y *= y; }
    if times > 8u { y *= y; }
    return y;
}

// A voxel's value, or zeroes.
fn value_at(level: u32, voxel: vec3<u32>, direction: vec3<f32>) -> vec4<f32> {
    let number = value_of(level, voxel);
    if number == NONE {
        return vec4<f32>(0.0f);
    }
    let found = value(number, direction);
    if params.call.storage == ANISOTROPIC {
        return found;
    }
    return deepened(found, level);
}

// 2^-l.
fn scale_of(level: u32) -> f32 {
    return bitcast<f32>((127u - level) << 23u);
}

// `i` brought into 0 to `count` - 1.
fn inside(i: i32, count: u32) -> u32 {
    return u32(clamp(i, 0, i32(count) - 1));
}

// What is in front of a cone's surface.
struct HalfSpace {
    // 0 0 0 for all of space.
    normal: vec3<f32>,
    // normal.p of the points p of the surface, in voxels.
    offset: f32,
    // Half of what a voxel of width 1 spans along the normal.
    span: f32,
}

// Whether a voxel of a level is in front of the surface's plane as a whole.
fn is_in_front(space: HalfSpace, voxel: vec3<u32>, width: f32) -> bool {
    let centre = (vec3<f32>(voxel) + vec3<f32>(0.5f)) * width;
    let n = space.normal;
    let height = ((n.x * centre.x + n.y * centre.y) + n.z * centre.z) - space.offset;
    return height > space.span * width + PLANE_MARGIN || all(n == vec3<f32>(0.0f));
}

// The filtered value of a level at `p`, in voxels of level 0.
fn filtered(space: HalfSpace, level: u32, p: vec3<f32>, direction: vec3<f32>) -> vec4<f32> {
    let q = p * scale_of(level) - vec3<f32>(0.5f);
    let whole = floor(q);
    let g = q - whole;
    let first = vec3<i32>(whole);
    let dims = (params.dims + vec3<u32>((1u << level) - 1u)) >> vec3<u32>(level);
    let width = bitcast<f32>((127u + level) << 23u);
    var sum = vec4<f32>(0.0f);
    var weight = 0.0f;
    for (var corner = 0u; corner < 8u; corner++) {
        let bit = vec3<u32>(corner & 1u, (corner >> 1u) & 1u, corner >> 2u);
        let place = first + vec3<i32>(bit);
        let voxel = vec3<u32>(inside(place.x, dims.x), inside(place.y, dims.y), inside(place.z, dims.z));
        let along = select(vec3<f32>(1.0f) - g, g, bit == vec3<u32>(1u));
        if is_in_front(space, voxel, width) {
            let share = (along.x * along.y) * along.z;
            sum += value_at(level, voxel, direction) * share;
            weight += share;
        }
    }
    if weight > 0.0f {
        return sum * (1.0f / weight);
    }
    return vec4<f32>(0.0f);
}

// The value of a sphere of diameter `width` >= 1 at `p`.
fn sample(space: HalfSpace, p: vec3<f32>, width: f32, direction: vec3<f32>) -> vec4<f32> {
    let bits = bitcast<u32>(width);
    let last = params.level_count - 1u;
    let level = min((bits >> 23u) - 127u, last);
    let fine = filtered(space, level, p, direction);
    // m: the significand alone.
    let f = bitcast<f32>((bits & 0x7fffffu) | 0x3f800000u) - 1.0f;
    if level == last || !(f > 0.0f) {
        return fine;
    }
    return fine * (1.0f - f) + filtered(space, level + 1u, p, direction) * f;
}

// Whether `p` is in the grid.
fn is_in_grid(p: vec3<f32>) -> bool {
    let end = vec3<f32>(params.dims);
    return p.x >= 0.0f && p.x <= end.x && p.y >= 0.0f && p.y <= end.y && p.z >= 0.0f && p.z <= end.z;
}

// Whether a sphere of radius `r` at `p` has a part in the grid.
fn meets_grid(p: vec3<f32>, r: f32) -> bool {
    let end = vec3<f32>(params.dims) + vec3<f32>(r);
    return p.x > -r && p.x < end.x && p.y > -r && p.y < end.y && p.z > -r && p.z < end.z;
}

// The place in the grid next to `p`.
fn brought_in(p: vec3<f32>) -> vec3<f32> {
    let end = vec3<f32>(params.dims);
    return select(vec3<f32>(0.0f), select(end, p, p < end), p > vec3<f32>(0.0f));
}

// The least power of two that is at least `x` >= 1.
fn power_of_two(x: f32) -> f32 {
    return bitcast<f32>((bitcast<u32>(x) + 0x7fffffu) & 0x7f800000u);
}

// Half of the width at distance `d`.
fn radius(d: f32, s: f32, sixty: bool) -> f32 {
    if sixty {
        return d * 0.5f;
    }
    let wide = d * s;
    return select(0.5f, wide, wide > 0.5f);
}

// The distance of the next sphere, which touches that of radius `r` at `d`.
fn next_distance(d: f32, r: f32, s: f32, sixty: bool) -> f32 {
    if sixty {
        return d + d;
    }
    let touching = (d + r) / (1.0f - s);
    let beyond = d + (r + r);
    return select(beyond, touching, touching > beyond);
}

// What comes through a cone. Its loops take MAX_STEPS * (1 + 2 * 8) rounds at most, a quarter of what any driver allows.
fn trace_cone(cone: Cone) -> ConeLight {
    let frame = params.call.frame;
    let sixty = (params.call.flags & SIXTY_DEGREES) != 0u;
    let apex = (cone.origin - frame.corner) * frame.voxels_per_unit;
    let direction = cone.direction;
    let normal = cone.normal;
    let space = HalfSpace(
        normal,
        (normal.x * apex.x + normal.y * apex.y) + normal.z * apex.z,
        0.5f * ((abs(normal.x) + abs(normal.y)) + abs(normal.z)),
    );
    let reach = params.call.reach * frame.voxels_per_unit;
    let s = select(0.0f, select(MAX_SINE, cone.sine, cone.sine < MAX_SINE), cone.sine > 0.0f);
    var d = cone.start * frame.voxels_per_unit;
    if sixty {
        d = power_of_two(select(1.0f, d, d > 1.0f));
    }
    var rgb = vec3<f32>(0.0f);
    var t = 1.0f;
    var is_inside = is_in_grid(apex);
    for (var i = 0u; i < MAX_STEPS; i++) {
        let p = apex + direction * d;
        let r = radius(d, s, sixty);
        if !is_inside || !meets_grid(p, r) || !(d <= reach) || !(t > LEAST_TRANSMITTANCE) {
            break;
        }
        is_inside = is_in_grid(p);
        let found = sample(space, brought_in(p), r + r, direction);
        let opacity = found.w * (1.0f / f32(OPAQUE));
        rgb += found.xyz * t;
        t *= 1.0f - select(1.0f, opacity, opacity < 1.0f);
        d = next_distance(d, r, s, sixty);
    }
    return ConeLight(rgb * params.call.unit, t);
}
