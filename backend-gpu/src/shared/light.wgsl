// Choosing a light, a point on it, and the density with which that happens. Twin of core/src/transport/light.rs.

const FAR: f32 = 3.0e38f;
const SHADOW_REACH: f32 = 0.99999905f;
const PI: f32 = 3.1415926535897932f;

struct LightSample {
    direction: vec3<f32>,
    // `target` is a word that WGSL keeps for itself.
    point: vec3<f32>,
    emission: vec3<f32>,
    pdf: f32,
    infinite: bool,
    delta: bool,
    light: u32,
}

// Picks a light with the alias table from one 32-bit draw.
fn select_light(bits: u32) -> u32 {
    let draw = to_index(bits, params.environment.light_count);
    if draw.y < lights[draw.x].alias_threshold {
        return draw.x;
    }
    return lights[draw.x].alias_light;
}

// Density of the sphere-light sampler at a point, without selection; 0 inside.
fn sphere_pdf(center: vec3<f32>, radius: f32, receiver: vec3<f32>) -> f32 {
    let to_center = center - receiver;
    let distance_squared = dot_product(to_center, to_center);
    let radius_squared = radius * radius;
    if !(distance_squared > radius_squared) {
        return 0.0f;
    }
    let sine_squared = radius_squared / distance_squared;
    let one_minus_cosine = sine_squared / (1.0f + sqrt(1.0f - sine_squared));
    // Rust writes 2.0 * PI * x: the constant product first.
    return 1.0f / (2.0f * PI * one_minus_cosine);
}

fn sphere_light_pdf(light: LightRecord, receiver: vec3<f32>) -> f32 {
    return light.select_pdf * sphere_pdf(light.position, light.radius, receiver);
}

fn triangle_light_pdf(light: LightRecord, distance: f32, cosine: f32) -> f32 {
    return light.select_pdf * ((distance * distance) / (light.area * cosine));
}

struct SphereHit {
    // Index of the light, or NONE.
    light: u32,
    t: f32,
    // The inside is black.
    inside: bool,
}

// The nearest sphere light in 0 < t < t_max.
fn nearest_sphere(origin: vec3<f32>, direction: vec3<f32>, t_max: f32) -> SphereHit {
    var nearest = SphereHit(NONE, t_max, false);
    for (var index = 0u; index < params.environment.sphere_count; index++) {
        let roots = sphere(origin, direction, lights[index].position, lights[index].radius);
        if roots.met {
            let inside = !(roots.near > 0.0f);
            let t = select(roots.near, roots.far, inside);
            if t > 0.0f && t < nearest.t {
                nearest = SphereHit(index, t, inside);
            }
        }
    }
    return nearest;
}

// Whether a sphere light other than `skip` lies in 0 < t < t_max.
fn spheres_occlude(origin: vec3<f32>, direction: vec3<f32>, t_max: f32, skip: u32) -> bool {
    var blocked = false;
    for (var index = 0u; index < params.environment.sphere_count; index++) {
        let roots = sphere(origin, direction, lights[index].position, lights[index].radius);
        if index != skip && roots.met {
            let t = select(roots.far, roots.near, roots.near > 0.0f);
            blocked = blocked || (t > 0.0f && t < t_max);
        }
    }
    return blocked;
}

fn no_light(light: u32) -> LightSample {
    let zero = vec3<f32>(0.0f);
    return LightSample(zero, zero, zero, 0.0f, false, false, light);
}

fn sample_triangle(index: u32, receiver: vec3<f32>, u: f32, v: f32) -> LightSample {
    let light = lights[index];
    // Heitz 2019: a low-distortion map from the square to the triangle.
    let halved = smaller(u, v) * 0.5f;
    let b0 = u - halved;
    let b1 = v - halved;
    let a = triangles[light.triangle].p0 * ((1.0f - b0) - b1);
    let b = triangles[light.triangle].p1 * b0;
    let c = triangles[light.triangle].p2 * b1;
    let point = (a + b) + c;
    let to_light = point - receiver;
    let squared = dot_product(to_light, to_light);
    let direction = normalized(to_light);
    let normal = light.direction;
    let facing = -dot_product(normal, direction);
    let both = (light.flags & EMITS_BOTH_SIDES) != 0u;
    let cosine = select(facing, -facing, both && facing < 0.0f);
    if !(cosine > 0.0f && squared > 0.0f) {
        return no_light(index);
    }
    return LightSample(
        direction,
        offset_origin(point, triangles[light.triangle].offset, normal, -direction),
        light.emission,
        light.select_pdf * (squared / (light.area * cosine)),
        false,
        false,
        index,
    );
}

fn sample_sphere(light: LightRecord, index: u32, receiver: vec3<f32>, u: f32, v: f32) -> LightSample {
    let center = light.position;
    let to_center = center - receiver;
    let distance_squared = dot_product(to_center, to_center);
    let pdf = sphere_light_pdf(light, receiver);
    if !(pdf > 0.0f) {
        return no_light(index);
    }
    let sine_squared = (light.radius * light.radius) / distance_squared;
    let one_minus_cosine = sine_squared / (1.0f + sqrt(1.0f - sine_squared));
    let down = v * one_minus_cosine;
    let sine = sqrt(down * (2.0f - down));
    let sc = sin_cos_turns(u);
    let axis = normalized(to_center);
    let frame = basis(axis);
    let local = vec3<f32>(sine * sc.y, sine * sc.x, 1.0f - down);
    let direction = normalized(to_world(frame.tangent, frame.bitangent, axis, local));
    // A direction on the silhouette may miss by rounding: then the tangent point's distance serves.
    let roots = sphere(receiver, direction, center, light.radius);
    var distance = roots.near;
    if !roots.met {
        distance = sqrt(distance_squared - light.radius * light.radius);
    }
    return LightSample(direction, receiver + direction * distance, light.emission, pdf, false, false, index);
}

fn sample_point(light: LightRecord, index: u32, receiver: vec3<f32>) -> LightSample {
    let to_light = light.position - receiver;
    let squared = dot_product(to_light, to_light);
    let direction = normalized(to_light);
    if !(squared > 0.0f) {
        return no_light(index);
    }
    var emission = light.emission * (1.0f / squared);
    if light.kind == LIGHT_SPOT {
        let cosine = -dot_product(direction, light.direction);
        let ramp = cosine * light.spot_scale + light.spot_offset;
        let low = select(0.0f, ramp, ramp > 0.0f);
        let clamped = select(1.0f, low, low < 1.0f);
        emission *= clamped * clamped;
    }
    return LightSample(direction, light.position, emission, light.select_pdf, false, true, index);
}

// A point of light `index` for a receiver; (u, v) place it, `texel_draw` picks an environment texel.
fn sample_light(index: u32, receiver: vec3<f32>, u: f32, v: f32, texel_draw: vec2<u32>) -> LightSample {
    let light = lights[index];
    if light.kind == LIGHT_TRIANGLE {
        return sample_triangle(index, receiver, u, v);
    }
    if light.kind == LIGHT_SPHERE {
        return sample_sphere(light, index, receiver, u, v);
    }
    if light.kind == LIGHT_POINT || light.kind == LIGHT_SPOT {
        return sample_point(light, index, receiver);
    }
    let zero = vec3<f32>(0.0f);
    if light.kind == LIGHT_DIRECTIONAL {
        return LightSample(-light.direction, zero, light.emission, light.select_pdf, true, true, index);
    }
    if light.kind != LIGHT_ENVIRONMENT {
        return no_light(index);
    }
    let sky = sample_environment(texel_draw, u, v);
    let pdf = light.select_pdf * sky.value.pdf;
    return LightSample(sky.direction, zero, sky.value.radiance, pdf, true, false, index);
}
