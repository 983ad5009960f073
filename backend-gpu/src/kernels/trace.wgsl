// kernel family: trace
// contract core/src/kernels/trace.rs
// cpu backend-cpu/src/kernels/trace.rs
// gpu backend-gpu/src/kernels/trace.wgsl
// oracle conformance/src/oracle/trace.rs
//
// One ray per invocation; the traversal is in shared/traverse.wgsl.

const WORKGROUP_SIZE: u32 = 64u;

struct TraceParams {
    ray_count: u32,
    // For loops_run.
    loop_rounds: u32,
}

struct Ray {
    origin: vec3<f32>,
    t_min: f32,
    direction: vec3<f32>,
    t_max: f32,
}

struct Hit {
    t: f32,
    triangle: u32,
    u: f32,
    v: f32,
}

@group(0) @binding(0) var<uniform> params: TraceParams;
@group(0) @binding(8) var<storage, read> rays: array<Ray>;
@group(0) @binding(9) var<storage, read_write> hits: array<Hit>;
@group(0) @binding(10) var<storage, read_write> blocked: array<u32>;

@compute @workgroup_size(64)
fn trace_closest(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = invocation_index(workgroup, workgroups, lane, WORKGROUP_SIZE);
    if index >= params.ray_count {
        return;
    }
    let ray = rays[index];
    let met = closest(ray.origin, ray.direction, ray.t_min, ray.t_max);
    var id = NONE;
    if met.slot != NONE {
        id = triangles[met.slot].id;
    }
    hits[index] = Hit(met.t, id, met.u, met.v);
    if !loops_run(params.loop_rounds) {
        atomicStore(&status[0], 1u);
    }
}

@compute @workgroup_size(64)
fn trace_any(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = invocation_index(workgroup, workgroups, lane, WORKGROUP_SIZE);
    if index >= params.ray_count {
        return;
    }
    let ray = rays[index];
    blocked[index] = select(0u, 1u, occluded(ray.origin, ray.direction, ray.t_min, ray.t_max));
    if !loops_run(params.loop_rounds) {
        atomicStore(&status[0], 1u);
    }
}
