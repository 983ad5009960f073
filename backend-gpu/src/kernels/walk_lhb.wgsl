// kernel family: walk_lhb
// contract core/src/kernels/walk_lhb.rs
// cpu backend-cpu/src/kernels/walk_lhb.rs
// gpu backend-gpu/src/kernels/walk_lhb.wgsl
// oracle conformance/src/oracle/walk_lhb.rs
//
// One path per invocation, two or three dispatches per vertex: extend_paths reads the scene, look_up_shadows and look_up_rays
// the layered hit buffers, because together they are more than the eight buffers that every adapter binds. Between them a path
// rests in `paths`, with the light that waits for its shadow ray.
// When all have ended, add_samples adds them to the film, one pixel per invocation.

const WORKGROUP_SIZE: u32 = 64u;

const DENSER_COUNTS: bool = true;

const CONE: u32 = 1u;
const TRACE_MISSES: u32 = 2u;
const GATHER: u32 = 4u;
const SHADOW_LOOKUPS: u32 = 8u;
const SHADOW_LOOKUPS_FIRST: u32 = 16u;

// Walker.leaves of a ray from the camera, a mirror or glass.
const TRACED: u32 = 0xffffffffu;

struct WalkLhbParams {
    // The pixels and samples of this dispatch.
    call: TracePathsParams,
    lookup: WalkLhbBlock,
    environment: EnvironmentHeader,
    lhb: LhbHeader,
    // 0 starts the paths, others go on.
    segment: u32,
    // Word of `status` that counts the paths still alive after this dispatch.
    alive_word: u32,
    // For loops_run.
    loop_rounds: u32,
    // The pixel that `film` begins with.
    film_begin: u32,
}

// A path and what a lookup for it needs and finds.
struct Walker {
    path: PathState,
    // Unit normal of what it leaves, on its side.
    normal: vec3<f32>,
    // Twice the triangle that it leaves, plus 1 on its front; or TRACED.
    leaves: u32,
    // What its ray meets, if that is looked up.
    slot: u32,
    u: f32,
    v: f32,
    t: f32,
    // Light that arrives where the path is if the lookup of its shadow ray finds nothing before it.
    light: vec3<f32>,
    // How often that has been scattered; 0 where no light waits.
    order: u32,
    // Unit direction of the shadow ray, which starts where the path's does.
    to_light: vec3<f32>,
    // FAR for infinitely.
    light_distance: f32,
}

@group(0) @binding(0) var<uniform> params: WalkLhbParams;
@group(0) @binding(8) var<storage, read_write> paths: array<Walker>;
@group(0) @binding(14) var<storage, read> nearest_map: array<u32>;

// Where the first vertex of each path sends it, if directions are gathered.
@compute @workgroup_size(64)
fn aim_paths(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = invocation_index(workgroup, workgroups, lane, WORKGROUP_SIZE);
    if index >= params.call.pixel_count * params.call.sample_count {
        return;
    }
    let sample = params.call.sample_begin + index / params.call.pixel_count;
    let entry = params.lookup.gather_begin + 2u * (sample % params.lookup.gather_count);
    let ray = nearest_map[entry];
    let scale = bitcast<f32>(nearest_map[entry + 1u]) * f32(params.lookup.gather_count);
    paths[index].normal = ray_direction(views[ray >> 1u], ray);
    paths[index].t = scale;
}

@compute @workgroup_size(64)
fn extend_paths(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = invocation_index(workgroup, workgroups, lane, WORKGROUP_SIZE);
    if index >= params.call.pixel_count * params.call.sample_count {
        return;
    }
    if params.segment > 0u && paths[index].path.alive == 0u {
        return;
    }
    let pixel = params.call.pixel_begin + index % params.call.pixel_count;
    let sample = params.call.sample_begin + index / params.call.pixel_count;
    var path: PathState;
    var hit = SlotHit(FAR, 0.0f, 0.0f, NONE);
    var is_traced = true;
    var aim = Aim(false, vec3<f32>(0.0f), 0.0f);
    if params.segment == 0u {
        // [1] sample: a point of the pixel
        let stream = mix_pair(params.call.seed, pixel);
        path = start_path(Draws(stream, stream, sample), pixel);
        // Left here by aim_paths.
        aim = Aim((params.lookup.flags & GATHER) != 0u, paths[index].normal, paths[index].t);
    } else {
        path = paths[index].path;
        if paths[index].leaves != TRACED {
            hit = SlotHit(paths[index].t, paths[index].u, paths[index].v, paths[index].slot);
            is_traced = (params.lookup.flags & TRACE_MISSES) != 0u && is_doubtful(hit.slot);
        }
    }
    // [2] vertex: what the ray meets, and its emission
    if is_traced {
        hit = closest(path.origin, path.direction, 0.0f, FAR);
    }
    let stream = mix_pair(params.call.seed, path.numbers_of);
    if path.vertices == 0u && is_interleaved(hit.slot) {
        path.numbers_of = pattern_pixel(path.numbers_of);
    }
    let draws = Draws(stream, mix_pair(params.call.seed, path.numbers_of), sample);
    // [3] direct light
    // [4] scatter
    // [5] roulette
    let shadows_wait = shadows_are_looked_up(path.vertices);
    let left = visit(&path, hit, draws, aim);
    path.alive = select(0u, 1u, left.goes_on);
    let waits = shadows_wait && leave_direct_light(index, left.direct);
    if waits {
        // An opaque surface is left on one side: where the path goes on, it is there already.
        path.origin = left.direct.origin;
    } else {
        add_direct_light(&path, left.direct);
    }
    paths[index].path = path;
    if left.goes_on || waits {
        paths[index].normal = left.normal;
        paths[index].leaves = select(TRACED, (hit.slot << 1u) | select(0u, 1u, left.front), left.is_opaque);
    }
    if left.goes_on {
        atomicAdd(&status[params.alive_word], 1u);
    }
    if !loops_run(params.loop_rounds) {
        atomicStore(&status[0], 1u);
    }
}

// Whether a path goes on from a triangle, its first vertex, by the numbers of another pixel.
fn is_interleaved(slot: u32) -> bool {
    if params.lookup.interleave <= 1u || slot == NONE {
        return false;
    }
    let material = materials[triangles[slot].material];
    return material.kind == MATERIAL_OPAQUE && material.specular_f90 == 0.0f;
}

// The pixel of the first tile whose numbers a pixel draws from its first vertex on.
fn pattern_pixel(pixel: u32) -> u32 {
    let n = params.lookup.interleave;
    let width = params.call.width;
    return ((pixel / width) % n) * width + (pixel % width) % n;
}

// Whether the shadow rays of a vertex are looked up.
fn shadows_are_looked_up(vertex: u32) -> bool {
    let flags = params.lookup.flags;
    return !nothing_hides() && (flags & SHADOW_LOOKUPS) != 0u && (vertex > 0u || (flags & SHADOW_LOOKUPS_FIRST) != 0u);
}

// Leaves light for look_up_shadows. False where there is no direction to look up, which the tracer sees to.
fn leave_direct_light(index: u32, direct: DirectLight) -> bool {
    let squared = dot_product(direct.direction, direct.direction);
    if !direct.is_any || !(squared > 0.0f) {
        return false;
    }
    let distance = sqrt(squared);
    paths[index].light = direct.radiance;
    // Sphere lights are with the scene, and a ray meets them whatever it looks up.
    paths[index].order = select(direct.order, 0u, is_behind_spheres(direct));
    paths[index].to_light = select(direct.direction * (1.0f / distance), direct.direction, direct.infinite);
    paths[index].light_distance = select(distance, FAR, direct.infinite);
    return true;
}

// Whether a lookup found nothing, or a lamp.
fn is_doubtful(slot: u32) -> bool {
    if slot == NONE {
        return true;
    }
    return triangles[slot].light != NONE;
}

@compute @workgroup_size(64)
fn look_up_rays(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = invocation_index(workgroup, workgroups, lane, WORKGROUP_SIZE);
    if index >= params.call.pixel_count * params.call.sample_count {
        return;
    }
    let leaves = paths[index].leaves;
    if paths[index].path.alive == 0u || leaves == TRACED {
        return;
    }
    let direction = paths[index].path.direction;
    let normal = paths[index].normal;
    let hit = met_along(paths[index].path.origin, direction, FAR, normal, leaves, nearest_ray(normal, direction));
    paths[index].slot = hit.slot;
    paths[index].u = hit.u;
    paths[index].v = hit.v;
    paths[index].t = hit.t;
    if !loops_run(params.loop_rounds) {
        atomicStore(&status[0], 1u);
    }
}

// [6] direction: the nearest that leaves the surface
fn nearest_ray(normal: vec3<f32>, direction: vec3<f32>) -> u32 {
    let ray = nearest_direction(params.lookup.map_resolution, direction);
    if dot_product(normal, ray_direction(views[ray >> 1u], ray)) > 0.0f {
        return ray;
    }
    let lifted = direction + normal * params.lookup.lift;
    return nearest_direction(params.lookup.map_resolution, lifted);
}

// [7] lookup: along the line through the start, then through the hit
fn met_along(
    origin: vec3<f32>,
    direction: vec3<f32>,
    reach: f32,
    normal: vec3<f32>,
    leaves: u32,
    ray: u32,
) -> LhbHit {
    let view = views[ray >> 1u];
    let cone = (params.lookup.flags & CONE) != 0u;
    var query = lhb_query(params.lookup, view, ray, origin, normal, leaves);
    var found = look_up(query);
    if cone {
        query = lhb_refined(params.lookup, view, query, normal, direction, reach, found);
        found = look_up(query);
    }
    return lhb_hit(params.lookup, view, query, origin, direction, found, cone);
}

// [8] shadow: adds the light that waits unless the lookup of its ray finds something before it
@compute @workgroup_size(64)
fn look_up_shadows(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = invocation_index(workgroup, workgroups, lane, WORKGROUP_SIZE);
    if index >= params.call.pixel_count * params.call.sample_count {
        return;
    }
    let order = paths[index].order;
    if order == 0u {
        return;
    }
    paths[index].order = 0u;
    let direction = paths[index].to_light;
    let normal = paths[index].normal;
    let ray = nearest_ray(normal, direction);
    let reach = paths[index].light_distance;
    let hit = met_along(paths[index].path.origin, direction, reach, normal, paths[index].leaves, ray);
    if !lhb_shadows(params.lookup, hit, reach) {
        if order == 1u {
            paths[index].path.direct += paths[index].light;
        } else {
            paths[index].path.indirect += paths[index].light;
        }
    }
    if !loops_run(params.loop_rounds) {
        atomicStore(&status[0], 1u);
    }
}

// Adds the samples of this dispatch to their pixels' sums, or counts them as rejected.
@compute @workgroup_size(64)
fn add_samples(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = invocation_index(workgroup, workgroups, lane, WORKGROUP_SIZE);
    if index >= params.call.pixel_count {
        return;
    }
    let at_film = params.call.pixel_begin + index - params.film_begin;
    var texel = film[at_film];
    for (var sample = 0u; sample < params.call.sample_count; sample++) {
        let at = sample * params.call.pixel_count + index;
        add_sample(&texel, paths[at].path.direct, paths[at].path.indirect);
    }
    film[at_film] = texel;
}
