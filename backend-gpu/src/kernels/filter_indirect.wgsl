// kernel family: filter_indirect
// contract core/src/kernels/filter_indirect.rs
// cpu backend-cpu/src/kernels/filter_indirect.rs
// gpu backend-gpu/src/kernels/filter_indirect.wgsl
// oracle conformance/src/oracle/filter_indirect.rs
//
// One pixel per invocation.

const WORKGROUP_SIZE: u32 = 64u;

const LEAST_ALBEDO: f32 = 0.0009765625f;

const NO_HIT: u32 = 0xffffffffu;

struct FilterIndirectBlock {
    // The contract's parameters.
    width: u32,
    height: u32,
    window: u32,
    least_cosine: f32,
    footprint: f32,
    // Elements of `diffuse`.
    diffuse_count: u32,
    // The pixels of this dispatch; `output` begins with the first of them.
    pixel_begin: u32,
    pixel_count: u32,
    // The pixel that `gbuffer` and `input` begin with.
    neighbour_begin: u32,
    // For loops_run.
    loop_rounds: u32,
    padding: vec2<u32>,
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

struct RadianceTexel {
    rgb: vec3<f32>,
    padding: u32,
}

@group(0) @binding(0) var<uniform> params: FilterIndirectBlock;
@group(0) @binding(1) var<storage, read> gbuffer: array<GBufferTexel>;
@group(0) @binding(2) var<storage, read> diffuse: array<u32>;
@group(0) @binding(3) var<storage, read> input: array<RadianceTexel>;
@group(0) @binding(4) var<storage, read_write> output: array<RadianceTexel>;
@group(0) @binding(5) var<storage, read_write> status: array<atomic<u32>>;

// Sums over joined neighbours, per channel.
struct Sums {
    light: vec3<f32>,
    weight: vec3<f32>,
}

@compute @workgroup_size(64)
fn filter_indirect(
    @builtin(workgroup_id) workgroup: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = invocation_index(workgroup, workgroups, lane, WORKGROUP_SIZE);
    if index >= params.pixel_count {
        return;
    }
    output[index] = RadianceTexel(filter_pixels(params.pixel_begin + index), 0u);
    if !loops_run(params.loop_rounds) {
        atomicStore(&status[0], 1u);
    }
}

fn filter_pixels(pixel: u32) -> vec3<f32> {
    let centre = gbuffer[pixel - params.neighbour_begin];
    var rgb = input[pixel - params.neighbour_begin].rgb;
    // [2] pixels that show no diffuse surface
    if !is_diffuse(centre) {
        return rgb;
    }
    let sums = sum_neighbours(centre, pixel / params.width, pixel % params.width);
    // [4] light of the pixel
    for (var c = 0u; c < 3u; c++) {
        if centre.albedo[c] >= LEAST_ALBEDO && sums.weight[c] > 0.0f {
            rgb[c] = centre.albedo[c] * sums.light[c] / sums.weight[c];
        }
    }
    return rgb;
}

// Whether a pixel shows a diffuse surface.
fn is_diffuse(texel: GBufferTexel) -> bool {
    if texel.triangle == NO_HIT || texel.material >= params.diffuse_count {
        return false;
    }
    return diffuse[texel.material] != 0u;
}

fn sum_neighbours(centre: GBufferTexel, row: u32, column: u32) -> Sums {
    var sums = Sums(vec3<f32>(0.0f), vec3<f32>(0.0f));
    // [3] sums over joined neighbours
    let reach = i32(params.window / 2u);
    for (var j = -reach; j <= reach; j++) {
        // Beyond the first row or column these wrap, and are beyond the last.
        let other_row = row + u32(j);
        if other_row >= params.height {
            continue;
        }
        for (var i = -reach; i <= reach; i++) {
            let other_column = column + u32(i);
            if other_column >= params.width {
                continue;
            }
            let index = other_row * params.width + other_column - params.neighbour_begin;
            let other = gbuffer[index];
            if !is_joined(centre, other) {
                continue;
            }
            let weight = window_weight(j) * window_weight(i);
            let light = input[index].rgb;
            for (var c = 0u; c < 3u; c++) {
                if other.albedo[c] >= LEAST_ALBEDO {
                    // [1] light by albedo
                    sums.light[c] = sums.light[c] + weight * (light[c] / other.albedo[c]);
                    sums.weight[c] = sums.weight[c] + weight;
                }
            }
        }
    }
    return sums;
}

// Whether a pixel shows the surface of the centre.
fn is_joined(centre: GBufferTexel, other: GBufferTexel) -> bool {
    if other.triangle == NO_HIT || other.material != centre.material {
        return false;
    }
    let distance = abs(dot_product(centre.geometric_normal, other.position - centre.position));
    let reach = params.footprint * f32(params.window) * centre.depth;
    return dot_product(centre.shading_normal, other.shading_normal) >= params.least_cosine && distance <= reach;
}

// Weight of a neighbour's row or column.
fn window_weight(offset: i32) -> f32 {
    return select(0.5f, 1.0f, 2u * u32(abs(offset)) < params.window);
}
