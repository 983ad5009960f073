// From a ray to a lookup in layered hit buffers, and from what it finds to a hit. Twin of core/src/transport/lhb.rs.

// 2^-14: a unit of a view's rows, and of a depth in steps.
const FINE: f32 = 6.1035156e-5f;
// 2^14.
const COARSE: f32 = 16384.0f;
// Steps across the lattice.
const ACROSS: f32 = 65536.0f;
const HALF_DIAGONAL: f32 = 0.70710677f;
const ROUNDING: f32 = 4.0f;
const LEAST_SLOPE: f32 = 4.0f;
const GREATEST_SLOPE: f32 = 64.0f;

struct WalkLhbBlock {
    centre: vec3<f32>,
    steps_per_unit: f32,
    unit_per_step: f32,
    row_scale: f32,
    lift: f32,
    size: u32,
    subpixel_bits: u32,
    map_resolution: u32,
    flags: u32,
    interleave: u32,
    gather_begin: u32,
    gather_count: u32,
    padding: vec2<u32>,
}

struct LhbHit {
    slot: u32,
    u: f32,
    v: f32,
    t: f32,
    // Whether the ray itself meets the triangle; else it passes beside.
    is_exact: bool,
}

// Unit direction of a view, or its opposite.
fn ray_direction(view: View, ray: u32) -> vec3<f32> {
    let forward = vec3<f32>(view.forward.xyz) * FINE;
    return select(forward, -forward, (ray & 1u) == 1u);
}

// The nearest lattice point.
fn lattice_point(block: WalkLhbBlock, position: vec3<f32>) -> vec3<i32> {
    let scaled = (position - block.centre) * block.steps_per_unit;
    return vec3<i32>(lattice_coordinate(scaled.x), lattice_coordinate(scaled.y), lattice_coordinate(scaled.z));
}

fn lattice_coordinate(c: f32) -> i32 {
    let low = select(-32760.0f, c, c > -32760.0f);
    let cut = select(32760.0f, low, low < 32760.0f);
    return i32(round(cut));
}

// How near in depth elements are judged by their planes, when lines are `distance` steps from the position that a surface
// with that cosine to the line is left at: what the slope explains.
fn depth_window(distance: f32, cosine: f32) -> u32 {
    let sine_squared = 1.0f - cosine * cosine;
    var sine = 0.0f;
    if sine_squared > 0.0f {
        sine = sqrt(sine_squared);
    }
    // Steep, edge-on and contrary surfaces take the greatest slope.
    var slope = GREATEST_SLOPE;
    if sine < cosine * GREATEST_SLOPE {
        slope = sine / cosine;
    }
    if slope < LEAST_SLOPE {
        slope = LEAST_SLOPE;
    }
    let depth = distance * slope;
    return u32(select(ACROSS, depth, depth < ACROSS) * COARSE);
}

// The lookup for a ray from `position` on a triangle with the unit `normal` on the ray's side, along the line of `ray`.
fn lhb_query(
    block: WalkLhbBlock,
    view: View,
    ray: u32,
    position: vec3<f32>,
    normal: vec3<f32>,
    leaves: u32,
) -> LhbQuery {
    let p = lattice_point(block, position);
    let cosine = dot_product(normal, ray_direction(view, ray));
    return LhbQuery(p, ray, vec2<i32>(0, 0), leaves, depth_window(aside_at_most(block), cosine));
}

// How far a pixel's line may be from a point that is looked up there, steps.
fn aside_at_most(block: WalkLhbBlock) -> f32 {
    return ACROSS * HALF_DIAGONAL / f32(block.size) + ROUNDING * block.row_scale;
}

// z of a lookup's position, as elements count it.
fn query_depth(view: View, query: LhbQuery) -> i32 {
    return along(view.forward, query.position) + i32(DEPTH_ORIGIN);
}

// Distance to an element along the lookup's line, steps; the lattice's radius where there is none.
fn element_distance(view: View, query: LhbQuery, element: LhbElement) -> f32 {
    if element.surface == NO_ELEMENT {
        return ACROSS * 0.5f;
    }
    let ahead = i32(element.depth) - query_depth(view, query);
    let distance = f32(ahead) * FINE;
    let forward = select(distance, -distance, (query.ray & 1u) == 1u);
    return select(0.0f, forward, forward > 0.0f);
}

// The lookup on the line that crosses the ray along `direction` where the first lookup met something, or at the ray's end, `reach`
// from its start, if that is nearer.
fn lhb_refined(
    block: WalkLhbBlock,
    view: View,
    query: LhbQuery,
    normal: vec3<f32>,
    direction: vec3<f32>,
    reach: f32,
    found: LhbElement,
) -> LhbQuery {
    let line = ray_direction(view, query.ray);
    // Coarse sets have directions at right angles to the ray.
    let along_line = dot_product(direction, line);
    let cosine = select(0.25f, along_line, along_line > 0.25f);
    let met = element_distance(view, query, found);
    // Not multiplied where it is no end: WGSL leaves overflow open.
    var end = FAR;
    if reach < FAR {
        end = reach * block.steps_per_unit * cosine;
    }
    let aside = direction * (1.0f / cosine) - line;
    let offset = aside * select(met, end, end < met);
    let distance = aside_at_most(block) + sqrt(dot_product(offset, offset));
    return LhbQuery(
        query.position,
        query.ray,
        vec2<i32>(screen_offset(view.right, offset), screen_offset(view.down, offset)),
        query.leaves,
        depth_window(distance, dot_product(normal, line)),
    );
}

fn screen_offset(row: vec4<i32>, offset: vec3<f32>) -> i32 {
    let axis = vec3<f32>(row.xyz);
    return lattice_coordinate(dot_product(axis, offset) * (FINE * 0.5f));
}

// The point where the centre line of a lookup's pixel meets an element, in the scene's coordinates.
fn element_position(block: WalkLhbBlock, view: View, query: LhbQuery, element: LhbElement) -> vec3<f32> {
    let bits = block.subpixel_bits;
    let edge = vec2<i32>(i32(block.size << bits) - 1);
    let at = project(view, query.position, block.size).xy + query.offset;
    let place = vec2<f32>(clamp(at, vec2<i32>(0), edge) >> vec2<u32>(bits));
    let pixel = ACROSS / f32(block.size);
    let across = (place.x + 0.5f) * pixel - ACROSS * 0.5f;
    let upright = (place.y + 0.5f) * pixel - ACROSS * 0.5f;
    let depth = f32(i32(element.depth) - i32(DEPTH_ORIGIN)) * FINE;
    // Rows are longer than 1 by the size over its power of two.
    let unit = FINE * block.row_scale;
    let right = vec3<f32>(view.right.xyz) * unit;
    let down = vec3<f32>(view.down.xyz) * unit;
    let forward = vec3<f32>(view.forward.xyz) * FINE;
    let offset = (right * across + down * upright) + forward * depth;
    return block.centre + offset * block.unit_per_step;
}

// What the ray from `position` along `direction` meets, by what its lookup found: where it meets the triangle's plane if that is
// on the triangle and `exact` holds, else the point of the triangle next to where the lookup's line does.
fn lhb_hit(
    block: WalkLhbBlock,
    view: View,
    query: LhbQuery,
    position: vec3<f32>,
    direction: vec3<f32>,
    element: LhbElement,
    exact: bool,
) -> LhbHit {
    if element.surface == NO_ELEMENT {
        return LhbHit(NO_ELEMENT, 0.0f, 0.0f, FAR, false);
    }
    let slot = element.surface >> 1u;
    let p0 = triangles[slot].p0;
    let e1 = triangles[slot].p1 - p0;
    let e2 = triangles[slot].p2 - p0;
    let normal = cross_product(e1, e2);
    let squared = dot_product(normal, normal);
    var inverse = 0.0f;
    if squared > 0.0f {
        inverse = 1.0f / squared;
    }
    if exact {
        let t = dot_product(normal, p0 - position) / dot_product(normal, direction);
        // False for a NaN: a ray within the plane.
        if t > 0.0f {
            let w = (position + direction * t) - p0;
            let u = dot_product(cross_product(w, e2), normal) * inverse;
            let v = dot_product(cross_product(e1, w), normal) * inverse;
            if u >= 0.0f && v >= 0.0f && u + v <= 1.0f {
                return LhbHit(slot, u, v, t, true);
            }
        }
    }
    let w = element_position(block, view, query, element) - p0;
    let outer_u = not_negative(dot_product(cross_product(w, e2), normal) * inverse);
    let outer_v = not_negative(dot_product(cross_product(e1, w), normal) * inverse);
    let sum = outer_u + outer_v;
    let scale = select(1.0f, 1.0f / sum, sum > 1.0f);
    let u = outer_u * scale;
    let v = outer_v * scale;
    let offset = (p0 + (e1 * u + e2 * v)) - position;
    return LhbHit(slot, u, v, not_negative(dot_product(offset, direction)), false);
}

// How much nearer than a light something may seem that carries it, world units.
fn shadow_margin(block: WalkLhbBlock) -> f32 {
    return aside_at_most(block) * LEAST_SLOPE * block.unit_per_step;
}

// Whether what the lookup of a shadow ray found is between its start and the light, which is `distance` away; FAR for infinitely.
fn lhb_shadows(block: WalkLhbBlock, hit: LhbHit, distance: f32) -> bool {
    if hit.slot == NO_ELEMENT {
        return false;
    }
    let end = select(distance - shadow_margin(block), distance * SHADOW_REACH, hit.is_exact);
    // What the ray passes beside may be behind its start.
    return hit.t > 0.0f && hit.t < end;
}

fn not_negative(x: f32) -> f32 {
    return select(0.0f, x, x > 0.0f);
}
