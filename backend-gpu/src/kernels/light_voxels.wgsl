// kernel family: light_voxels
// contract core/src/kernels/light_voxels.rs
// cpu backend-cpu/src/kernels/light_voxels.rs
// gpu backend-gpu/src/kernels/light_voxels.wgsl
// oracle conformance/src/oracle/light_voxels.rs
//
// One voxel per invocation, SAMPLES_PER_DISPATCH samples at a time: between dispatches a leaf holds the bits of the irradiance so far, so that
// no dispatch is long, no invocation takes many loop rounds and no ninth buffer is bound. When all samples are in, write_leaves
// makes leaves of them.

const WORKGROUP_SIZE: u32 = 64u;

struct LightVoxelsParams {
    call: LightVoxelsBlock,
    environment: EnvironmentHeader,
    // The voxels of this dispatch, with which `active`, `sums`, `gathered` and `leaves` begin.
    voxel_count: u32,
    // Its samples.
    sample_begin: u32,
    sample_end: u32,
    // Whether leaves hold irradiance.
    is_lit: u32,
    // Whether there is any in `gathered`.
    has_gathered: u32,
    // For loops_run.
    loop_rounds: u32,
    padding: vec2<u32>,
}

struct RadianceTexel {
    rgb: vec3<f32>,
    padding: u32,
}

@group(0) @binding(0) var<uniform> params: LightVoxelsParams;
@group(0) @binding(8) var<storage, read> active_codes: array<u32>;
@group(0) @binding(9) var<storage, read> sums: array<VoxelSums>;
@group(0) @binding(10) var<storage, read> gathered: array<RadianceTexel>;
@group(0) @binding(11) var<storage, read_write> leaves: array<VoxelLight>;

// Adds samples to the irradiance that leaves hold. The scene has lights.
@compute @workgroup_size(64)
fn add_samples(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = invocation_index(workgroup, workgroups, lane, WORKGROUP_SIZE);
    if index >= params.voxel_count || sums[index].count == 0u {
        return;
    }
    let code = active_codes[index];
    // [1] surface
    let point = voxel_point(code, sums[index]);
    var irradiance = vec3<f32>(0.0f);
    if params.sample_begin > 0u {
        irradiance = bitcast<vec3<f32>>(leaves[index].rgb);
    }
    for (var sample = params.sample_begin; sample < params.sample_end; sample++) {
        // [2] sample
        let light = voxel_sample(point, code, sample);
        // [3] shadow
        if any(light.irradiance != vec3<f32>(0.0f)) && !is_shadowed(light) {
            irradiance += light.irradiance;
        }
    }
    leaves[index].rgb = bitcast<vec3<u32>>(irradiance);
    if !loops_run(params.loop_rounds) {
        atomicStore(&status[0], 1u);
    }
}

fn is_shadowed(light: VoxelSample) -> bool {
    let nothing_hides = (params.environment.flags & NOTHING_HIDES) != 0u;
    return (!nothing_hides && occluded(light.origin, light.direction, 0.0f, light.reach))
        || spheres_occlude(light.origin, light.direction, light.reach, light.light);
}

// Leaves of what shines on voxels.
@compute @workgroup_size(64)
fn write_leaves(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = invocation_index(workgroup, workgroups, lane, WORKGROUP_SIZE);
    if index >= params.voxel_count {
        return;
    }
    if sums[index].count == 0u {
        leaves[index] = VoxelLight(vec3<u32>(0u), 0u);
        return;
    }
    var irradiance = vec3<f32>(0.0f);
    if params.is_lit != 0u {
        irradiance = bitcast<vec3<f32>>(leaves[index].rgb) * (1.0f / f32(params.call.samples));
    }
    // [4] leaf
    if params.has_gathered != 0u {
        irradiance += gathered[index].rgb;
    }
    leaves[index] = voxel_leaf(voxel_point(active_codes[index], sums[index]), irradiance);
}
