// kernel family: trace_cones
// contract core/src/kernels/trace_cones.rs
// cpu backend-cpu/src/kernels/trace_cones.rs
// gpu backend-gpu/src/kernels/trace_cones.wgsl
// oracle conformance/src/oracle/trace_cones.rs
//
// One cone per invocation; what comes through it is in shared/cone.wgsl.

const WORKGROUP_SIZE: u32 = 64u;
const ISOTROPIC: u32 = 0u;
const ANISOTROPIC: u32 = 1u;
const HARMONICS: u32 = 2u;
const HARMONICS_8: u32 = 3u;
const OPAQUE: u32 = 65536u;
const MAX_SINE: f32 = 0.9375f;
const MAX_STEPS: u32 = 1024u;
const PLANE_MARGIN: f32 = 0.0625f;
const LEAST_TRANSMITTANCE: f32 = 0.00390625f;
const SIXTY_DEGREES: u32 = 1u;

struct Cone {
    origin: vec3<f32>,
    sine: f32,
    direction: vec3<f32>,
    start: f32,
    normal: vec3<f32>,
    padding: u32,
}

struct ConeLight {
    rgb: vec3<f32>,
    transmittance: f32,
}

struct VoxelFrame {
    corner: vec3<f32>,
    voxels_per_unit: f32,
}

struct TraceConesBlock {
    frame: VoxelFrame,
    unit: f32,
    reach: f32,
    storage: u32,
    flags: u32,
}

struct TraceConesCall {
    call: TraceConesBlock,
    dims: vec3<u32>,
    level_count: u32,
    // Four to an element: uniform arrays have a stride of 16 bytes.
    word_starts: array<vec4<u32>, 3>,
    value_words: u32,
    cone_count: u32,
    padding: vec2<u32>,
}

@group(0) @binding(0) var<uniform> params: TraceConesCall;
@group(0) @binding(1) var<storage, read> mask: array<u32>;
@group(0) @binding(2) var<storage, read> ranks: array<u32>;
@group(0) @binding(3) var<storage, read> values: array<u32>;
@group(0) @binding(4) var<storage, read> cones: array<Cone>;
@group(0) @binding(5) var<storage, read_write> light: array<ConeLight>;

// [1] trace
@compute @workgroup_size(64)
fn trace_cones(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = invocation_index(workgroup, workgroups, lane, WORKGROUP_SIZE);
    if index >= params.cone_count {
        return;
    }
    light[index] = trace_cone(cones[index]);
}
