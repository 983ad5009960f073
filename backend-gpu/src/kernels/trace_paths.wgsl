// kernel family: trace_paths
// contract core/src/kernels/trace_paths.rs
// cpu backend-cpu/src/kernels/trace_paths.rs
// gpu backend-gpu/src/kernels/trace_paths.wgsl
// oracle conformance/src/oracle/trace_paths.rs
//
// One path per invocation, VERTICES_PER_DISPATCH vertices at a time: between dispatches a path rests in `paths`, so
// that no dispatch is long and no invocation takes many loop rounds, however long the paths grow. When all have ended,
// add_samples adds them to the film, one pixel per invocation.

const WORKGROUP_SIZE: u32 = 64u;
const VERTICES_PER_DISPATCH: u32 = 8u;

const DENSER_COUNTS: bool = false;

struct TracePathsBlock {
    // The pixels and samples of this dispatch.
    call: TracePathsParams,
    environment: EnvironmentHeader,
    // 0 starts the paths, others go on.
    segment: u32,
    // Word of `status` that counts the paths still alive after this dispatch.
    alive_word: u32,
    // For loops_run.
    loop_rounds: u32,
    // The pixel that `film` begins with.
    film_begin: u32,
}

@group(0) @binding(0) var<uniform> params: TracePathsBlock;
@group(0) @binding(8) var<storage, read_write> paths: array<PathState>;

@compute @workgroup_size(64)
fn trace_segment(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = invocation_index(workgroup, workgroups, lane, WORKGROUP_SIZE);
    if index >= params.call.pixel_count * params.call.sample_count {
        return;
    }
    let pixel = params.call.pixel_begin + index % params.call.pixel_count;
    let sample = params.call.sample_begin + index / params.call.pixel_count;
    let stream = mix_pair(params.call.seed, pixel);
    let draws = Draws(stream, stream, sample);
    var path: PathState;
    if params.segment == 0u {
        // [1] sample: a point of the pixel
        path = start_path(draws, pixel);
    } else {
        path = paths[index];
    }
    for (var i = 0u; i < VERTICES_PER_DISPATCH && path.alive == 1u; i++) {
        visit_vertex(&path, draws);
    }
    paths[index] = path;
    if path.alive == 1u {
        atomicAdd(&status[params.alive_word], 1u);
    }
    if !loops_run(params.loop_rounds) {
        atomicStore(&status[0], 1u);
    }
}

// One ray, what it meets, and the next ray; ends the path by `alive`.
fn visit_vertex(path: ptr<function, PathState>, draws: Draws) {
    // [2] vertex: what the ray meets, and its emission
    let hit = closest((*path).origin, (*path).direction, 0.0f, FAR);
    // [3] direct light
    // [4] scatter
    // [5] roulette
    let left = visit(path, hit, draws, Aim(false, vec3<f32>(0.0f), 0.0f));
    add_direct_light(path, left.direct);
    (*path).alive = select(0u, 1u, left.goes_on);
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
        add_sample(&texel, paths[at].direct, paths[at].indirect);
    }
    film[at_film] = texel;
}
