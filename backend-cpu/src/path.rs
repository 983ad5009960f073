//! What the kernels that follow paths share: light that is added to a path, the way on, the film.

use crate::sampler::{Sampler, VertexNumbers};
use crate::simd::Width;
use crate::tracer::WideTracer;
use glam::Vec3;
use twinlight_core::kernels::trace_paths::{FilmTexel, MAX_SURVIVAL, TracePathsParams};
use twinlight_core::math::fixed::{OUT_OF_RANGE, Words, add_saturating, from_float};
use twinlight_core::math::vector::{basis, to_world};
use twinlight_core::scene::{
    EMITS_BOTH_SIDES, LIGHT_TRIANGLE, MATERIAL_DIELECTRIC, MATERIAL_MIRROR, MATERIAL_OPAQUE, MaterialRecord,
    NONE, NOTHING_HIDES,
};
use twinlight_core::transport::SceneView;
use twinlight_core::transport::bsdf::{
    BsdfSample, evaluate, sample_dielectric, sample_mirror, sample_opaque,
};
use twinlight_core::transport::environment::environment_from;
use twinlight_core::transport::light::{
    FAR, SHADOW_REACH, nearest_sphere, sample_light, select_light, sphere_light_pdf, spheres_occlude,
    triangle_light_pdf,
};
use twinlight_core::transport::offset::offset_origin;
use twinlight_core::transport::surface::{Surface, camera_direction, surface_at};

/// Light of one sample: scattered at most once, and more often. Indexed, because a branch on the number of vertices
/// would be mispredicted at every other vertex.
pub(crate) type PathLight = [Vec3; 2];

/// A path under construction.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Path {
    pub(crate) origin: Vec3,
    pub(crate) direction: Vec3,
    pub(crate) throughput: Vec3,
    /// Density of the last scattering direction; 0 after the camera, mirrors and glass.
    pub(crate) pdf: f32,
    /// Scattering vertices so far.
    pub(crate) vertices: u32,
    pub(crate) light: PathLight,
}

/// What a path's ray meets: as a hit of the hierarchy; [`NONE`] at [`FAR`] for no triangle.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Met {
    pub(crate) slot: u32,
    pub(crate) u: f32,
    pub(crate) v: f32,
    pub(crate) t: f32,
}

/// The surface that a path goes on from.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Left {
    pub(crate) surface: Surface,
    /// Whether it scatters in all directions, not as a mirror or glass.
    pub(crate) is_opaque: bool,
}

/// Light from one point of a light, which arrives unless something shadows it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct DirectLight {
    pub(crate) radiance: Vec3,
    /// How often it has been scattered before the camera.
    pub(crate) order: u32,
    pub(crate) origin: Vec3,
    /// To the point; of unit length to infinity.
    pub(crate) direction: Vec3,
    /// Whether there is no point, but infinity.
    pub(crate) infinite: bool,
    /// Index of the light.
    light: u32,
    /// Unit normal of the surface that scatters it, on its side.
    pub(crate) normal: Vec3,
    /// Whether that side is the front.
    pub(crate) front: bool,
}

impl DirectLight {
    /// End of the shadow ray, in lengths of its direction.
    #[inline(always)]
    fn reach(&self) -> f32 {
        if self.infinite { FAR } else { SHADOW_REACH }
    }

    /// Whether a sphere light is in between.
    #[inline(always)]
    pub(crate) fn is_behind_spheres(&self, scene: &SceneView<'_>) -> bool {
        spheres_occlude(scene, self.origin, self.direction, self.reach(), self.light)
    }
}

/// What a visit of a vertex leaves to be done.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Visited {
    /// The surface that the path goes on from; `None` ends it.
    pub(crate) left: Option<Left>,
    /// Light to be added if it arrives, before the path is visited again.
    pub(crate) direct: Option<DirectLight>,
}

/// A path ends, and no light waits for its shadow ray.
const ENDED: Visited = Visited { left: None, direct: None };

/// How the light of emissive triangles is shared between points sampled on them and scattered rays that meet them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Emitters {
    /// By the balance heuristic.
    Balanced,
    /// By the maximum heuristic: the denser technique counts all of it.
    Denser,
}

/// The direction that a path goes on along, whatever its numbers say.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Aim {
    /// Unit direction in the scene's space.
    pub(crate) direction: Vec3,
    /// What f·cos is multiplied by.
    pub(crate) scale: f32,
}

/// A path from the camera through a random point of the pixel.
#[inline(always)]
pub(crate) fn start<W: Width>(width: W, params: &TracePathsParams, pixel: u32, sampler: &Sampler) -> Path {
    // Pair 0, with others that aren't needed: one vector of pairs takes fewer instructions than a pair by itself.
    let [jx, jy] = sampler.vertex(width, 0).direction;
    let x = (pixel % params.width) as f32 + jx;
    let y = (pixel / params.width) as f32 + jy;
    Path {
        origin: Vec3::from(params.camera.position),
        direction: camera_direction(&params.camera, x, y),
        throughput: Vec3::ONE,
        pdf: 0.0,
        vertices: 0,
        light: [Vec3::ZERO; 2],
    }
}

/// Adds the light of what the ray meets, samples what shines on it, and sends the path on.
#[inline(always)]
pub(crate) fn visit(
    path: &mut Path,
    scene: &SceneView<'_>,
    params: &TracePathsParams,
    hit: &Met,
    sampler: &Sampler,
    base: u32,
    numbers: &VertexNumbers,
    emitters: Emitters,
    aim: Option<Aim>,
) -> Visited {
    let sphere = nearest_sphere(scene, path.origin, path.direction, hit.t);
    if sphere.light != NONE {
        if !sphere.inside {
            add_sphere_emission(path, scene, sphere.light);
        }
        return ENDED;
    }
    if hit.slot == NONE {
        add_environment(path, scene);
        return ENDED;
    }
    let surface = surface_at(scene, hit.slot, hit.u, hit.v, path.direction);
    let material = &scene.materials[surface.material as usize];
    add_surface_emission(path, scene, &surface, material, hit.t, emitters);
    if path.vertices == params.max_bounces {
        return ENDED;
    }
    let (tangent, bitangent) = basis(surface.shading_normal);
    let to_viewer = -path.direction;
    let wo =
        Vec3::new(to_viewer.dot(tangent), to_viewer.dot(bitangent), to_viewer.dot(surface.shading_normal));
    // The way on is worked out before the shadow ray is sent: the processor overlaps the two.
    let frame = (tangent, bitangent, surface.shading_normal);
    let scattered = match aim {
        Some(aim) if material.kind == MATERIAL_OPAQUE => aimed(material, surface.albedo, frame, wo, aim),
        _ => scatter(material, &surface, wo, numbers),
    };
    let direction = to_world(tangent, bitangent, surface.shading_normal, scattered.direction);
    let leaves = direction.dot(surface.geometric_normal);
    let origin = offset_origin(surface.position, surface.offset, surface.geometric_normal, direction);
    let mut direct = None;
    if material.kind == MATERIAL_OPAQUE && scene.environment.light_count > 0 {
        direct = direct_light(path, scene, &surface, frame, wo, sampler, base, numbers, emitters);
    }
    let end = Visited { left: None, direct };
    if scattered.direction == Vec3::ZERO || (material.kind != MATERIAL_DIELECTRIC && !(leaves > 0.0)) {
        return end;
    }
    path.origin = origin;
    path.direction = direction;
    path.throughput *= scattered.weight;
    path.pdf = scattered.pdf;
    path.vertices += 1;
    if !survives(path, params, numbers.roulette) {
        return end;
    }
    Visited { left: Some(Left { surface, is_opaque: material.kind == MATERIAL_OPAQUE }), direct }
}

/// Whether no triangle hides a light.
#[inline(always)]
pub(crate) fn nothing_hides(scene: &SceneView<'_>) -> bool {
    scene.environment.flags & NOTHING_HIDES != 0
}

/// Adds light unless a shadow ray finds something in between.
#[inline(always)]
pub(crate) fn add_direct_light<W: Width>(
    light: &mut PathLight,
    tracer: &WideTracer<'_, W>,
    scene: &SceneView<'_>,
    direct: &DirectLight,
) {
    if (nothing_hides(scene) || !tracer.occluded(direct.origin, direct.direction, 0.0, direct.reach()))
        && !direct.is_behind_spheres(scene)
    {
        add_light(light, direct.order, direct.radiance);
    }
}

/// Adds light that has been scattered `order` times.
#[inline(always)]
pub(crate) fn add_light(light: &mut PathLight, order: u32, radiance: Vec3) {
    light[usize::from(order > 1)] += radiance;
}

/// Balance-heuristic weight of a technique with density `own` against one with density `other`.
#[inline(always)]
fn balance(own: f32, other: f32) -> f32 {
    own / (own + other)
}

#[inline(always)]
fn add_sphere_emission(path: &mut Path, scene: &SceneView<'_>, index: u32) {
    let record = &scene.lights[index as usize];
    let mut weight = 1.0;
    if path.pdf > 0.0 {
        weight = balance(path.pdf, sphere_light_pdf(record, path.origin));
    }
    let radiance = path.throughput * Vec3::from(record.emission) * weight;
    add_light(&mut path.light, path.vertices, radiance);
}

#[inline(always)]
fn add_environment(path: &mut Path, scene: &SceneView<'_>) {
    if scene.environment.light == NONE {
        return;
    }
    let value = environment_from(scene, path.direction);
    let mut weight = 1.0;
    if path.pdf > 0.0 {
        let select = scene.lights[scene.environment.light as usize].select_pdf;
        weight = balance(path.pdf, select * value.pdf);
    }
    let radiance = path.throughput * value.radiance * weight;
    add_light(&mut path.light, path.vertices, radiance);
}

#[inline(always)]
fn add_surface_emission(
    path: &mut Path,
    scene: &SceneView<'_>,
    surface: &Surface,
    material: &MaterialRecord,
    distance: f32,
    emitters: Emitters,
) {
    if surface.light == NONE || !(surface.front || material.flags & EMITS_BOTH_SIDES != 0) {
        return;
    }
    let mut weight = 1.0;
    if path.pdf > 0.0 {
        let cosine = -(surface.geometric_normal.dot(path.direction));
        let record = &scene.lights[surface.light as usize];
        if cosine > 0.0 {
            let pdf = triangle_light_pdf(record, distance, cosine);
            weight = match emitters {
                Emitters::Balanced => balance(path.pdf, pdf),
                Emitters::Denser => f32::from(path.pdf > pdf),
            };
        }
    }
    let radiance = path.throughput * Vec3::from(material.emission) * weight;
    add_light(&mut path.light, path.vertices, radiance);
}

/// One light and one point on it.
#[inline(always)]
fn direct_light(
    path: &Path,
    scene: &SceneView<'_>,
    surface: &Surface,
    frame: (Vec3, Vec3, Vec3),
    wo: Vec3,
    sampler: &Sampler,
    base: u32,
    numbers: &VertexNumbers,
    emitters: Emitters,
) -> Option<DirectLight> {
    let index = select_light(scene, numbers.light_choice);
    let mut texel = [0, 0];
    if index == scene.environment.light {
        texel = sampler.pair(base + 3);
    }
    let [u, v] = numbers.light_point;
    let light = sample_light(scene, index, surface.position, u, v, texel);
    if !(light.pdf > 0.0) || !(light.direction.dot(surface.geometric_normal) > 0.0) {
        return None;
    }
    let wi =
        Vec3::new(light.direction.dot(frame.0), light.direction.dot(frame.1), light.direction.dot(frame.2));
    let material = &scene.materials[surface.material as usize];
    let value = evaluate(material, surface.albedo, wo, wi);
    let unshadowed = path.throughput * value.f_cos * light.emission;
    if !(unshadowed.x > 0.0 || unshadowed.y > 0.0 || unshadowed.z > 0.0) {
        return None;
    }
    let is_denser = emitters == Emitters::Denser && scene.lights[index as usize].kind == LIGHT_TRIANGLE;
    if is_denser && value.pdf > light.pdf {
        return None;
    }
    let origin = offset_origin(surface.position, surface.offset, surface.geometric_normal, light.direction);
    let direction = if light.infinite { light.direction } else { light.target - origin };
    let mut weight = 1.0 / light.pdf;
    if !light.delta && !is_denser {
        weight = 1.0 / (light.pdf + value.pdf);
    }
    Some(DirectLight {
        radiance: unshadowed * weight,
        order: path.vertices + 1,
        origin,
        direction,
        infinite: light.infinite,
        light: light.light,
        normal: surface.geometric_normal,
        front: surface.front,
    })
}

#[inline(always)]
fn scatter(material: &MaterialRecord, surface: &Surface, wo: Vec3, numbers: &VertexNumbers) -> BsdfSample {
    if material.kind == MATERIAL_MIRROR {
        return sample_mirror(material, wo);
    }
    if material.kind == MATERIAL_DIELECTRIC {
        return sample_dielectric(material, surface.front, wo, numbers.lobe);
    }
    let [u, v] = numbers.direction;
    sample_opaque(material, surface.albedo, wo, numbers.lobe, u, v)
}

/// What an opaque surface scatters along a direction that is given.
#[inline(always)]
fn aimed(
    material: &MaterialRecord,
    albedo: Vec3,
    frame: (Vec3, Vec3, Vec3),
    wo: Vec3,
    aim: Aim,
) -> BsdfSample {
    let d = aim.direction;
    let wi = Vec3::new(d.dot(frame.0), d.dot(frame.1), d.dot(frame.2));
    let value = evaluate(material, albedo, wo, wi);
    BsdfSample { direction: wi, weight: value.f_cos * aim.scale, pdf: value.pdf }
}

/// Whether the path goes on; dims its throughput by the survival probability.
#[inline(always)]
fn survives(path: &mut Path, params: &TracePathsParams, number: f32) -> bool {
    let t = path.throughput;
    let xy = if t.x > t.y { t.x } else { t.y };
    let largest = if xy > t.z { xy } else { t.z };
    if !(largest > 0.0) {
        return false;
    }
    if path.vertices < params.roulette_begin {
        return true;
    }
    let survival = if largest < MAX_SURVIVAL { largest } else { MAX_SURVIVAL };
    if !(number < survival) {
        return false;
    }
    let inverse = 1.0 / survival;
    path.throughput = t * inverse;
    true
}

/// Adds one sample to a pixel's sums, or counts it as rejected.
#[inline(always)]
pub(crate) fn add_sample(texel: &mut FilmTexel, [direct, indirect]: PathLight, params: &TracePathsParams) {
    let exponent = params.film_exponent;
    let sum = direct + indirect;
    let direct = direct.to_array().map(|x| from_float(x, exponent));
    let indirect = indirect.to_array().map(|x| from_float(x, exponent));
    let luminance = (0.2126 * sum.x + 0.7152 * sum.y) + 0.0722 * sum.z;
    let squared = from_float(luminance * luminance, params.moment_exponent);
    let out_of_range = |w: &Words| *w == OUT_OF_RANGE;
    if direct.iter().chain(&indirect).any(out_of_range) {
        texel.rejected += 1;
        return;
    }
    for c in 0..3 {
        texel.direct[c] = add_saturating(texel.direct[c], direct[c]);
        texel.indirect[c] = add_saturating(texel.indirect[c], indirect[c]);
    }
    texel.luminance_squared = add_saturating(texel.luminance_squared, squared);
    texel.samples += 1;
}
