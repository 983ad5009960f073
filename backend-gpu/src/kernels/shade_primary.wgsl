// kernel family: shade_primary
// contract core/src/kernels/shade_primary.rs
// cpu backend-cpu/src/kernels/shade_primary.rs
// gpu backend-gpu/src/kernels/shade_primary.wgsl
// oracle conformance/src/oracle/shade_primary.rs
//
// One pixel per invocation.

const WORKGROUP_SIZE: u32 = 64u;

struct ShadePrimaryParams {
    camera: CameraRecord,
    width: u32,
    height: u32,
    padding: vec2<u32>,
}

struct ShadePrimaryBlock {
    call: ShadePrimaryParams,
    environment: EnvironmentHeader,
    // For loops_run.
    loop_rounds: u32,
    // The pixels of this dispatch; `gbuffer` begins with the first of them.
    pixel_begin: u32,
    pixel_count: u32,
    padding: u32,
}

struct GBufferTexel {
    position: vec3<f32>,
    depth: f32,
    geometric_normal: vec3<f32>,
    triangle: u32,
    shading_normal: vec3<f32>,
    material: u32,
    albedo: vec3<f32>,
    padding: u32,
}

@group(0) @binding(0) var<uniform> params: ShadePrimaryBlock;
@group(0) @binding(8) var<storage, read_write> gbuffer: array<GBufferTexel>;

@compute @workgroup_size(64)
fn shade_primary(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = invocation_index(workgroup, workgroups, lane, WORKGROUP_SIZE);
    if index >= params.pixel_count {
        return;
    }
    let pixel = params.pixel_begin + index;
    gbuffer[index] = shade_pixel(pixel % params.call.width, pixel / params.call.width);
    if !loops_run(params.loop_rounds) {
        atomicStore(&status[0], 1u);
    }
}

fn shade_pixel(column: u32, row: u32) -> GBufferTexel {
    // [1] ray through the pixel's centre
    let origin = params.call.camera.position;
    let direction = camera_direction(params.call.camera, f32(column) + 0.5f, f32(row) + 0.5f);
    // [2] what it meets first; a sphere light is no surface, and hides what is behind it
    let hit = closest(origin, direction, 0.0f, FAR);
    if hit.slot == NONE || nearest_sphere(origin, direction, hit.t).light != NONE {
        let zero = vec3<f32>(0.0f);
        return GBufferTexel(zero, 0.0f, zero, NONE, zero, 0u, zero, 0u);
    }
    // [3] the surface
    let surface = surface_at(hit.slot, hit.u, hit.v, direction);
    return GBufferTexel(
        surface.position,
        dot_product(surface.position - origin, params.call.camera.forward),
        surface.geometric_normal,
        triangles[hit.slot].id,
        surface.shading_normal,
        surface.material,
        surface.albedo,
        0u,
    );
}
