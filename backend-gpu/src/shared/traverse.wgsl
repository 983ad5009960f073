// Hits by the binary hierarchy. What a hit is does not depend on the order of the visits (core/src/kernels/trace.rs).

// One sibling per level waits; core's MAX_DEPTH is 64.
const STACK: u32 = 65u;

struct SlotHit {
    t: f32,
    u: f32,
    v: f32,
    // Index of the triangle in leaf order, or NONE.
    slot: u32,
}

// Entry parameter of a node, at least 0, and its exit.
fn node_range(frame: RayFrame, index: u32) -> vec2<f32> {
    let range = slab(frame, nodes[index].min, nodes[index].max);
    return vec2<f32>(larger(range.x, 0.0f), range.y);
}

fn triangle_in(slot: u32, frame: RayFrame, t_min: f32, t_max: f32) -> TriangleHit {
    let record = triangles[slot];
    return triangle(frame, record.normal, record.p0, record.p1, record.p2, t_min, t_max);
}

// The hit with the least (t, id) in t_min < t <= t_max.
fn closest(origin: vec3<f32>, direction: vec3<f32>, t_min: f32, t_max: f32) -> SlotHit {
    let frame = ray_frame(origin, direction);
    var best = SlotHit(t_max, 0.0f, 0.0f, NONE);
    var best_id = NONE;
    var waiting_near: array<f32, STACK>;
    var waiting_node: array<u32, STACK>;
    var waiting = 0u;
    var index = 0u;
    let root = node_range(frame, 0u);
    var visiting = root.x <= root.y && root.x <= t_max;
    loop {
        if !visiting {
            if waiting == 0u {
                break;
            }
            waiting -= 1u;
            index = waiting_node[waiting];
            // An entry equal to the reach is visited: a lower id may lie at the same distance.
            visiting = waiting_near[waiting] <= best.t;
        }
        if visiting {
            visiting = false;
            let first = nodes[index].first;
            let count = nodes[index].count;
            for (var slot = first; slot < first + count; slot++) {
                let hit = triangle_in(slot, frame, t_min, best.t);
                let id = triangles[slot].id;
                if hit.met && (hit.t < best.t || id < best_id) {
                    best = SlotHit(hit.t, hit.u, hit.v, slot);
                    best_id = id;
                }
            }
            if count == 0u {
                let a = node_range(frame, first);
                let b = node_range(frame, first + 1u);
                let meets_a = a.x <= a.y && a.x <= best.t;
                let meets_b = b.x <= b.y && b.x <= best.t;
                let nearer = select(0u, 1u, meets_b && (!meets_a || b.x < a.x));
                index = first + nearer;
                visiting = meets_a || meets_b;
                if meets_a && meets_b {
                    waiting_near[waiting] = select(b.x, a.x, nearer == 1u);
                    waiting_node[waiting] = first + 1u - nearer;
                    waiting += 1u;
                }
            }
        }
    }
    return best;
}

// Whether there is any hit in t_min < t <= t_max.
fn occluded(origin: vec3<f32>, direction: vec3<f32>, t_min: f32, t_max: f32) -> bool {
    let frame = ray_frame(origin, direction);
    var found = false;
    var waiting_node: array<u32, STACK>;
    var waiting = 0u;
    var index = 0u;
    let root = node_range(frame, 0u);
    var visiting = root.x <= root.y && root.x <= t_max;
    loop {
        if !visiting {
            if waiting == 0u {
                break;
            }
            waiting -= 1u;
            index = waiting_node[waiting];
        }
        visiting = false;
        let first = nodes[index].first;
        let count = nodes[index].count;
        for (var slot = first; slot < first + count; slot++) {
            let hit = triangle_in(slot, frame, t_min, t_max);
            found = found || hit.met;
        }
        if found {
            break;
        }
        if count == 0u {
            let a = node_range(frame, first);
            let b = node_range(frame, first + 1u);
            let meets_a = a.x <= a.y && a.x <= t_max;
            let meets_b = b.x <= b.y && b.x <= t_max;
            index = select(first + 1u, first, meets_a);
            visiting = meets_a || meets_b;
            if meets_a && meets_b {
                waiting_node[waiting] = first + 1u;
                waiting += 1u;
            }
        }
    }
    return found;
}
