// Light on voxels. Twin of core/src/transport/voxel_light.rs. Kernels that include this file have a LightVoxelsBlock in params.call and
// an EnvironmentHeader in params.environment.

const LIFT: f32 = 0.625f;
const MAX_RADIANCE: u32 = 4194304u;
const OPAQUE: u32 = 65536u;
const INV_PI: f32 = 0.31830987f;

struct VoxelFrame {
    corner: vec3<f32>,
    voxels_per_unit: f32,
}

struct LightVoxelsBlock {
    frame: VoxelFrame,
    seed: u32,
    samples: u32,
    scale: f32,
    emission_unit: f32,
}

struct VoxelSums {
    albedo: vec3<u32>,
    count: u32,
    normal: vec3<i32>,
    padding: u32,
    emission: vec3<u32>,
    padding_too: u32,
}

struct VoxelLight {
    rgb: vec3<u32>,
    opacity: u32,
}

// A voxel's surface.
struct VoxelPoint {
    centre: vec3<f32>,
    // Of a voxel.
    width: f32,
    // Unit normal, or 0 0 0.
    normal: vec3<f32>,
    // Albedo over pi.
    reflectance: vec3<f32>,
    // Exitant radiance.
    emission: vec3<f32>,
}

// Light that may arrive at a voxel.
struct VoxelSample {
    // Start of the shadow ray.
    origin: vec3<f32>,
    // To its end; of unit length to infinity.
    direction: vec3<f32>,
    // End, in lengths of `direction`.
    reach: f32,
    // Index of the light.
    light: u32,
    // What arrives without a shadow; 0 0 0 where nothing does.
    irradiance: vec3<f32>,
}

// The surface of the voxel of `code`, whose sums have a count.
fn voxel_point(code: u32, sums: VoxelSums) -> VoxelPoint {
    let place = vec3<f32>(morton_voxel(code)) + vec3<f32>(0.5f);
    let width = 1.0f / params.call.frame.voxels_per_unit;
    let count = f32(sums.count);
    let share = 1.0f / (count * 4095.0f);
    var normal = vec3<f32>(0.0f);
    if any(sums.normal != vec3<i32>(0i)) {
        normal = normalized(vec3<f32>(sums.normal));
    }
    return VoxelPoint(
        params.call.frame.corner + place * width,
        width,
        normal,
        vec3<f32>(sums.albedo) * (share * INV_PI),
        vec3<f32>(sums.emission) * (params.call.emission_unit / count),
    );
}

// Light of one sample.
fn voxel_sample(point: VoxelPoint, code: u32, sample: u32) -> VoxelSample {
    let stream = mix_pair(params.call.seed, code);
    let uv = sobol_pair(stream, sample, 0u);
    let light = select_light(sobol_pair(stream, sample, 1u).x);
    let texel_draw = sobol_pair(stream, sample, 2u);
    let found = sample_light(light, point.centre, to_unit(uv.x), to_unit(uv.y), texel_draw);
    let facing = dot_product(point.normal, found.direction);
    let has_normal = any(point.normal != vec3<f32>(0.0f));
    let cosine = select(0.5f, select(facing, -facing, facing < 0.0f), has_normal);
    let lift = select(LIFT, -LIFT, facing < 0.0f);
    let origin = point.centre + point.normal * (lift * point.width);
    var direction = found.direction;
    if !found.infinite {
        direction = found.point - origin;
    }
    var irradiance = vec3<f32>(0.0f);
    if found.pdf > 0.0f {
        irradiance = found.emission * (cosine / found.pdf);
    }
    return VoxelSample(origin, direction, select(SHADOW_REACH, FAR, found.infinite), light, irradiance);
}

// An integer of radiance.
fn quantized(radiance: f32) -> u32 {
    let units = radiance * params.call.scale + 0.5f;
    if !(units >= 1.0f) {
        return 0u;
    }
    if units < f32(MAX_RADIANCE) {
        return u32(units);
    }
    return MAX_RADIANCE;
}

// The leaf of a voxel on which `irradiance` falls.
fn voxel_leaf(point: VoxelPoint, irradiance: vec3<f32>) -> VoxelLight {
    let radiance = point.reflectance * irradiance + point.emission;
    return VoxelLight(vec3<u32>(quantized(radiance.x), quantized(radiance.y), quantized(radiance.z)), OPAQUE);
}
