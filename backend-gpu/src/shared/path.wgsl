// What the kernels that follow paths share: light that is added to a path, the way on, the film. They have a
// TracePathsParams in params.call, an EnvironmentHeader in params.environment, and say by
//     const DENSER_COUNTS: bool
// how the light of emissive triangles is shared between points sampled on them and scattered rays that meet them: the denser
// technique counts all of it (the maximum heuristic), or both by the balance heuristic.

const SAMPLER_SOBOL: u32 = 0u;
const PAIRS_PER_VERTEX: u32 = 5u;
const MAX_SURVIVAL: f32 = 0.95f;

struct TracePathsParams {
    camera: CameraRecord,
    width: u32,
    height: u32,
    pixel_begin: u32,
    pixel_count: u32,
    sample_begin: u32,
    sample_count: u32,
    seed: u32,
    max_bounces: u32,
    roulette_begin: u32,
    sampler_kind: u32,
    film_exponent: i32,
    moment_exponent: i32,
}

// A path under construction.
struct PathState {
    origin: vec3<f32>,
    // Density of the last scattering direction; 0 after the camera, mirrors and glass.
    pdf: f32,
    direction: vec3<f32>,
    // Scattering vertices so far.
    vertices: u32,
    throughput: vec3<f32>,
    alive: u32,
    // Light scattered at most once.
    direct: vec3<f32>,
    // The pixel whose numbers it draws.
    numbers_of: u32,
    // Light scattered more often.
    indirect: vec3<f32>,
    padding_b: u32,
}

struct FilmTexel {
    direct: array<vec2<u32>, 3>,
    indirect: array<vec2<u32>, 3>,
    luminance_squared: vec2<u32>,
    samples: u32,
    rejected: u32,
}

@group(0) @binding(9) var<storage, read_write> film: array<FilmTexel>;

// What the vertices of a path share.
struct Draws {
    stream: u32,
    // That of the direction it scatters along.
    direction_stream: u32,
    sample: u32,
}

fn draw_pair(draws: Draws, pair: u32) -> vec2<u32> {
    if params.call.sampler_kind == SAMPLER_SOBOL {
        return sobol_pair(draws.stream, draws.sample, pair);
    }
    return independent_pair(draws.stream, draws.sample, pair);
}

// A path from the camera through a random point of the pixel.
fn start_path(draws: Draws, pixel: u32) -> PathState {
    let jitter = draw_pair(draws, 0u);
    let x = f32(pixel % params.call.width) + to_unit(jitter.x);
    let y = f32(pixel / params.call.width) + to_unit(jitter.y);
    let direction = camera_direction(params.call.camera, x, y);
    let zero = vec3<f32>(0.0f);
    let one = vec3<f32>(1.0f);
    return PathState(params.call.camera.position, 0.0f, direction, 0u, one, 1u, zero, pixel, zero, 0u);
}

// Light from one point of a light, which arrives unless something shadows it.
struct DirectLight {
    is_any: bool,
    radiance: vec3<f32>,
    // How often it has been scattered before the camera.
    order: u32,
    origin: vec3<f32>,
    // To the point; of unit length to infinity.
    direction: vec3<f32>,
    // Whether there is no point, but infinity.
    infinite: bool,
    // Index of the light.
    light: u32,
}

// The surface that a visit was to, and what it leaves to be done.
struct Left {
    // Whether the path does.
    goes_on: bool,
    // Whether the surface scatters in all directions, not as a mirror or glass.
    is_opaque: bool,
    front: bool,
    normal: vec3<f32>,
    // To be added if it arrives, before the path is visited again.
    direct: DirectLight,
}

// The direction that a path goes on along, whatever its numbers say, and what f·cos is multiplied by.
struct Aim {
    is_given: bool,
    direction: vec3<f32>,
    scale: f32,
}

// Adds the light of what the ray meets, samples what shines on it, and sends the path on.
fn visit(path: ptr<function, PathState>, hit: SlotHit, draws: Draws, aim: Aim) -> Left {
    var left = Left(false, false, false, vec3<f32>(0.0f), no_direct_light());
    let direction_in = (*path).direction;
    let ball = nearest_sphere((*path).origin, direction_in, hit.t);
    if ball.light != NONE {
        if !ball.inside {
            add_sphere_emission(path, ball.light);
        }
        return left;
    }
    if hit.slot == NONE {
        add_environment(path);
        return left;
    }
    let surface = surface_at(hit.slot, hit.u, hit.v, direction_in);
    let material = materials[surface.material];
    add_surface_emission(path, surface, material, hit.t);
    if (*path).vertices == params.call.max_bounces {
        return left;
    }
    left.is_opaque = material.kind == MATERIAL_OPAQUE;
    left.front = surface.front;
    left.normal = surface.geometric_normal;
    let base = 1u + (*path).vertices * PAIRS_PER_VERTEX;
    let frame = basis(surface.shading_normal);
    let to_viewer = -direction_in;
    let wo = vec3<f32>(
        dot_product(to_viewer, frame.tangent),
        dot_product(to_viewer, frame.bitangent),
        dot_product(to_viewer, surface.shading_normal),
    );
    // Not drawn where there is nothing to choose between.
    var choice = vec2<u32>(0u, 0u);
    if params.environment.light_count > 1u
        || material.specular_f90 > 0.0f
        || material.kind != MATERIAL_OPAQUE {
        choice = draw_pair(draws, base + 2u);
    }
    if material.kind == MATERIAL_OPAQUE && params.environment.light_count > 0u {
        left.direct = direct_light(path, surface, material, frame, wo, draws, base, choice.x);
    }
    var scattered: BsdfSample;
    if aim.is_given && material.kind == MATERIAL_OPAQUE {
        scattered = aimed(material, surface.albedo, frame, surface.shading_normal, wo, aim);
    } else {
        let uv = draw_pair(Draws(draws.direction_stream, draws.direction_stream, draws.sample), base);
        scattered = scatter(material, surface, wo, to_unit(choice.y), to_unit(uv.x), to_unit(uv.y));
    }
    if all(scattered.direction == vec3<f32>(0.0f)) {
        return left;
    }
    let direction = to_world(frame.tangent, frame.bitangent, surface.shading_normal, scattered.direction);
    let leaves = dot_product(direction, surface.geometric_normal);
    if material.kind != MATERIAL_DIELECTRIC && !(leaves > 0.0f) {
        return left;
    }
    (*path).origin = offset_origin(surface.position, surface.offset, surface.geometric_normal, direction);
    (*path).direction = direction;
    (*path).throughput *= scattered.weight;
    (*path).pdf = scattered.pdf;
    (*path).vertices += 1u;
    left.goes_on = survives(path, draws, base + 4u);
    return left;
}

fn no_direct_light() -> DirectLight {
    let zero = vec3<f32>(0.0f);
    return DirectLight(false, zero, 0u, zero, zero, false, NONE);
}

// End of a shadow ray, in lengths of its direction.
fn shadow_reach(infinite: bool) -> f32 {
    return select(SHADOW_REACH, FAR, infinite);
}

// Whether a sphere light is in between.
fn is_behind_spheres(direct: DirectLight) -> bool {
    return spheres_occlude(direct.origin, direct.direction, shadow_reach(direct.infinite), direct.light);
}

// Whether no triangle hides a light.
fn nothing_hides() -> bool {
    return (params.environment.flags & NOTHING_HIDES) != 0u;
}

// Adds light unless a shadow ray finds something in between.
fn add_direct_light(path: ptr<function, PathState>, direct: DirectLight) {
    if direct.is_any
        && (nothing_hides() || !occluded(direct.origin, direct.direction, 0.0f, shadow_reach(direct.infinite)))
        && !is_behind_spheres(direct) {
        add_light(path, direct.order, direct.radiance);
    }
}

// Adds light that has been scattered `order` times.
fn add_light(path: ptr<function, PathState>, order: u32, radiance: vec3<f32>) {
    if order <= 1u {
        (*path).direct += radiance;
    } else {
        (*path).indirect += radiance;
    }
}

// Balance-heuristic weight of a technique with density `own` against one with density `other`.
fn balance(own: f32, other: f32) -> f32 {
    return own / (own + other);
}

fn add_sphere_emission(path: ptr<function, PathState>, index: u32) {
    let light = lights[index];
    var weight = 1.0f;
    if (*path).pdf > 0.0f {
        weight = balance((*path).pdf, sphere_light_pdf(light, (*path).origin));
    }
    add_light(path, (*path).vertices, (*path).throughput * light.emission * weight);
}

fn add_environment(path: ptr<function, PathState>) {
    if params.environment.light == NONE {
        return;
    }
    let value = environment_from((*path).direction);
    var weight = 1.0f;
    if (*path).pdf > 0.0f {
        weight = balance((*path).pdf, lights[params.environment.light].select_pdf * value.pdf);
    }
    add_light(path, (*path).vertices, (*path).throughput * value.radiance * weight);
}

fn add_surface_emission(
    path: ptr<function, PathState>,
    surface: Surface,
    material: MaterialRecord,
    distance: f32,
) {
    if surface.light == NONE || !(surface.front || (material.flags & EMITS_BOTH_SIDES) != 0u) {
        return;
    }
    var weight = 1.0f;
    if (*path).pdf > 0.0f {
        let cosine = -dot_product(surface.geometric_normal, (*path).direction);
        if cosine > 0.0f {
            let pdf = triangle_light_pdf(lights[surface.light], distance, cosine);
            weight = select(balance((*path).pdf, pdf), select(0.0f, 1.0f, (*path).pdf > pdf), DENSER_COUNTS);
        }
    }
    add_light(path, (*path).vertices, (*path).throughput * material.emission * weight);
}

// One light and one point on it.
fn direct_light(
    path: ptr<function, PathState>,
    surface: Surface,
    material: MaterialRecord,
    frame: Basis,
    wo: vec3<f32>,
    draws: Draws,
    base: u32,
    choose_light: u32,
) -> DirectLight {
    let index = select_light(choose_light);
    var texel_draw = vec2<u32>(0u, 0u);
    if index == params.environment.light {
        texel_draw = draw_pair(draws, base + 3u);
    }
    let uv = draw_pair(draws, base + 1u);
    let light = sample_light(index, surface.position, to_unit(uv.x), to_unit(uv.y), texel_draw);
    if !(light.pdf > 0.0f) || !(dot_product(light.direction, surface.geometric_normal) > 0.0f) {
        return no_direct_light();
    }
    let wi = vec3<f32>(
        dot_product(light.direction, frame.tangent),
        dot_product(light.direction, frame.bitangent),
        dot_product(light.direction, surface.shading_normal),
    );
    let value = evaluate(material, surface.albedo, wo, wi);
    let unshadowed = (*path).throughput * value.f_cos * light.emission;
    if !(unshadowed.x > 0.0f || unshadowed.y > 0.0f || unshadowed.z > 0.0f) {
        return no_direct_light();
    }
    let is_denser = DENSER_COUNTS && lights[index].kind == LIGHT_TRIANGLE;
    if is_denser && value.pdf > light.pdf {
        return no_direct_light();
    }
    let origin =
        offset_origin(surface.position, surface.offset, surface.geometric_normal, light.direction);
    var direction = light.direction;
    if !light.infinite {
        direction = light.point - origin;
    }
    var weight = 1.0f / light.pdf;
    if !light.delta && !is_denser {
        weight = 1.0f / (light.pdf + value.pdf);
    }
    let order = (*path).vertices + 1u;
    return DirectLight(true, unshadowed * weight, order, origin, direction, light.infinite, light.light);
}

// What an opaque surface scatters along a direction that is given.
fn aimed(
    material: MaterialRecord,
    albedo: vec3<f32>,
    frame: Basis,
    normal: vec3<f32>,
    wo: vec3<f32>,
    aim: Aim,
) -> BsdfSample {
    let d = aim.direction;
    let wi = vec3<f32>(
        dot_product(d, frame.tangent),
        dot_product(d, frame.bitangent),
        dot_product(d, normal),
    );
    let value = evaluate(material, albedo, wo, wi);
    return BsdfSample(wi, value.f_cos * aim.scale, value.pdf);
}

fn scatter(
    material: MaterialRecord,
    surface: Surface,
    wo: vec3<f32>,
    lobe: f32,
    u: f32,
    v: f32,
) -> BsdfSample {
    if material.kind == MATERIAL_MIRROR {
        return sample_mirror(material, wo);
    }
    if material.kind == MATERIAL_DIELECTRIC {
        return sample_dielectric(material, surface.front, wo, lobe);
    }
    return sample_opaque(material, surface.albedo, wo, lobe, u, v);
}

// Whether the path goes on; dims its throughput by the survival probability.
fn survives(path: ptr<function, PathState>, draws: Draws, pair: u32) -> bool {
    let t = (*path).throughput;
    let xy = select(t.y, t.x, t.x > t.y);
    let largest = select(t.z, xy, xy > t.z);
    if !(largest > 0.0f) {
        return false;
    }
    if (*path).vertices < params.call.roulette_begin {
        return true;
    }
    let survival = select(MAX_SURVIVAL, largest, largest < MAX_SURVIVAL);
    if !(to_unit(draw_pair(draws, pair).x) < survival) {
        return false;
    }
    let inverse = 1.0f / survival;
    (*path).throughput = t * inverse;
    return true;
}

// Adds one sample to a pixel's sums, or counts it as rejected.
fn add_sample(texel: ptr<function, FilmTexel>, direct: vec3<f32>, indirect: vec3<f32>) {
    let exponent = params.call.film_exponent;
    var quanta: array<vec2<u32>, 6>;
    var rejected = false;
    for (var c = 0u; c < 3u; c++) {
        quanta[c] = from_float(direct[c], exponent);
        quanta[c + 3u] = from_float(indirect[c], exponent);
        rejected = rejected || all(quanta[c] == OUT_OF_RANGE) || all(quanta[c + 3u] == OUT_OF_RANGE);
    }
    if rejected {
        (*texel).rejected += 1u;
        return;
    }
    let sum = direct + indirect;
    let luminance = (0.2126f * sum.x + 0.7152f * sum.y) + 0.0722f * sum.z;
    let squared = from_float(luminance * luminance, params.call.moment_exponent);
    for (var c = 0u; c < 3u; c++) {
        (*texel).direct[c] = add_saturating((*texel).direct[c], quanta[c]);
        (*texel).indirect[c] = add_saturating((*texel).indirect[c], quanta[c + 3u]);
    }
    (*texel).luminance_squared = add_saturating((*texel).luminance_squared, squared);
    (*texel).samples += 1u;
}
