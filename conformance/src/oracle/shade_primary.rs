// kernel family: shade_primary
// contract core/src/kernels/shade_primary.rs
// cpu backend-cpu/src/kernels/shade_primary.rs
// gpu backend-gpu/src/kernels/shade_primary.wgsl
// oracle conformance/src/oracle/shade_primary.rs
//! Oracle of `shade_primary`: every pixel's ray against every triangle, twice.
//!
//! [`as_written`] puts the contract's f32 formulas together without a hierarchy: what strict mode must give bit for
//! bit. [`possible`] is the third road: the camera ray, the hit, its position, normals and albedo in f64, each with the
//! interval that WGSL's accuracy leaves to f32.

use super::trace::{Aim, Interval, Possible, closest_along, closest_as_written, wide};
use bytemuck::Zeroable;
use glam::{DVec3, Vec3};
use twinlight_core::kernels::shade_primary::{GBufferTexel, ShadePrimaryParams};
use twinlight_core::kernels::trace::{NO_HIT, Ray};
use twinlight_core::scene::{CompiledScene, HAS_NORMALS, HAS_TEXCOORDS, NONE};
use twinlight_core::transport::SceneView;
use twinlight_core::transport::light::{FAR, nearest_sphere};
use twinlight_core::transport::surface::{camera_direction, surface_at};

mod texture;

/// One ulp.
const ETA: f64 = 1.0 / 8_388_608.0;

/// The contract's formulas without a hierarchy.
pub fn as_written(scene: &CompiledScene, params: &ShadePrimaryParams, column: u32, row: u32) -> GBufferTexel {
    let view = SceneView::from(scene);
    let origin = Vec3::from(params.camera.position);
    let direction = camera_direction(&params.camera, column as f32 + 0.5, row as f32 + 0.5);
    let ray = Ray { origin: origin.to_array(), t_min: 0.0, direction: direction.to_array(), t_max: FAR };
    let hit = closest_as_written(&scene.triangles, &ray);
    let slot = scene.triangles.iter().position(|t| t.id == hit.triangle);
    let (Some(slot), NONE) = (slot, nearest_sphere(&view, origin, direction, hit.t).light) else {
        return GBufferTexel { triangle: NO_HIT, ..GBufferTexel::zeroed() };
    };
    let surface = surface_at(&view, slot as u32, hit.u, hit.v, direction);
    GBufferTexel {
        position: surface.position.to_array(),
        depth: (surface.position - origin).dot(Vec3::from(params.camera.forward)),
        geometric_normal: surface.geometric_normal.to_array(),
        triangle: hit.triangle,
        shading_normal: surface.shading_normal.to_array(),
        material: surface.material,
        albedo: surface.albedo.to_array(),
        padding: 0,
    }
}

/// What one pixel may hold.
#[derive(Debug, Clone)]
pub struct Pixel {
    /// For each triangle that may be seen, what goes with it.
    pub surfaces: Vec<Surface>,
    /// Whether nothing may be seen.
    pub nothing: bool,
}

/// Values and absolute errors of one surface.
#[derive(Debug, Clone)]
pub struct Surface {
    /// Triangle id.
    pub triangle: u32,
    /// Material index.
    pub material: u32,
    /// Position relative to the scene's origin, and its error per axis.
    pub position: (DVec3, f64),
    /// Distance along the view axis, and its error.
    pub depth: (f64, f64),
    /// Unit normals that may be given (one, or both sides when the triangle is seen edge-on), and their error.
    pub geometric_normals: (Vec<DVec3>, f64),
    /// Unit shading normals that may be given, and their error; the geometric normal too where it may stand in.
    pub shading_normals: (Vec<DVec3>, f64),
    /// Diffuse albedo and its error.
    pub albedo: (DVec3, f64),
}

/// What f64 and the intervals leave open for one pixel. Scenes with sphere lights get them as certain or possible
/// cover.
pub fn possible(scene: &CompiledScene, params: &ShadePrimaryParams, column: u32, row: u32) -> Pixel {
    let camera = &params.camera;
    let (x, y) = (f64::from(column) + 0.5, f64::from(row) + 0.5);
    let target = wide(camera.corner) + wide(camera.step_x) * x + wide(camera.step_y) * y;
    let length = target.length();
    let direction = target / length;
    // Two products and two sums: 4 roundings of the terms' magnitudes. Normalising: a dot product of 5 roundings halved
    // by the square root, the root itself (2.5 for WGSL's, inherited from 1/inverseSqrt: 4.5), a division of 2.5.
    let terms = wide(camera.corner).abs() + wide(camera.step_x).abs() * x + wide(camera.step_y).abs() * y;
    let error = ETA * (4.0 * terms.max_element() / length * 2.0 + 9.5);
    let origin = wide(camera.position);
    let aim = Aim { origin, direction, error, t_min: 0.0, t_max: f64::from(FAR) };
    let allowed = closest_along(&scene.triangles, &aim);
    let mut pixel = Pixel { surfaces: Vec::new(), nothing: allowed.miss };
    for (id, hit) in &allowed.hits {
        match cover(scene, &aim, hit.t) {
            Cover::Certain => pixel.nothing = true,
            Cover::Possible => {
                pixel.nothing = true;
                pixel.surfaces.extend(surface(scene, params, &aim, *id, hit));
            }
            Cover::None => pixel.surfaces.extend(surface(scene, params, &aim, *id, hit)),
        }
    }
    pixel
}

enum Cover {
    Certain,
    Possible,
    None,
}

/// Whether a sphere light stands before t, or the ray starts in one, by the distance of its centre from the ray.
fn cover(scene: &CompiledScene, aim: &Aim, t: Interval) -> Cover {
    let mut found = Cover::None;
    for light in &scene.lights[..scene.environment.sphere_count as usize] {
        let radius = f64::from(light.radius);
        let center = wide(light.position) - aim.origin;
        let along = center.dot(aim.direction);
        let beside = (center - aim.direction * along).length();
        // Errors of the direction grow with the distance; 16 roundings of the squared terms.
        let slack = (aim.error * 4.0 + 16.0 * ETA) * (center.length() + radius);
        if beside > radius + slack || along + radius + slack < 0.0 || along - radius - slack > t.high {
            continue;
        }
        let half_chord = (radius * radius - beside * beside).max(0.0).sqrt();
        let near = along - half_chord;
        if beside < radius - slack && near > slack && near < t.low - slack {
            return Cover::Certain;
        }
        found = Cover::Possible;
    }
    found
}

fn surface(
    scene: &CompiledScene,
    params: &ShadePrimaryParams,
    aim: &Aim,
    id: u32,
    hit: &Possible,
) -> Option<Surface> {
    let slot = scene.triangles.iter().position(|t| t.id == id)?;
    let (triangle, attributes) = (&scene.triangles[slot], &scene.attributes[slot]);
    let corners = [wide(triangle.p0), wide(triangle.p1), wide(triangle.p2)];
    let middle = |i: Interval| ((i.low + i.high) * 0.5, (i.high - i.low) * 0.5);
    let ((u, du), (v, dv)) = (middle(hit.u), middle(hit.v));
    let blend = |a: [DVec3; 3]| a[0] * (1.0 - u - v) + a[1] * u + a[2] * v;
    // Five products and sums of weighted corners.
    let reach = corners.iter().fold(0.0_f64, |m, p| m.max(p.abs().max_element()));
    let (e1, e2) = (corners[1] - corners[0], corners[2] - corners[0]);
    let moved = |a: DVec3, b: DVec3| a.abs().max_element() * du + b.abs().max_element() * dv;
    let position = (blend(corners), moved(e1, e2) + 8.0 * ETA * reach);
    let forward = wide(params.camera.forward);
    let offset = position.0 - aim.origin;
    let depth_error =
        3.0 * position.1 + 6.0 * ETA * (offset.abs().max_element() + aim.origin.abs().max_element());

    let cross = e1.cross(e2);
    // The record's normal comes from f64 and is rounded once.
    let normal_error = 2.0 * ETA;
    let winding = cross.normalize();
    let facing = winding.dot(aim.direction);
    let edge_on = facing.abs() <= 3.0 * normal_error + 2.0 * aim.error;
    let side = if facing < 0.0 { winding } else { -winding };
    let geometric = if edge_on { vec![side, -side] } else { vec![side] };

    let mut shading = (geometric.clone(), normal_error);
    if attributes.flags & HAS_NORMALS != 0 {
        let normals = [wide(attributes.n0), wide(attributes.n1), wide(attributes.n2)];
        let sum = blend(normals);
        let error = (moved(normals[1] - normals[0], normals[2] - normals[0]) + 6.0 * ETA) * 2.0
            / sum.length()
            + 10.0 * ETA;
        let unit = sum.normalize();
        let turned = if facing < 0.0 { unit } else { -unit };
        let doubt = 3.0 * (error + normal_error) + 2.0 * aim.error;
        let usable = |limit: f64| turned.dot(aim.direction) < -limit && turned.dot(side) > limit;
        if usable(doubt) && !edge_on {
            shading = (vec![turned], error);
        } else if edge_on || usable(-doubt) {
            shading.0.extend([turned, -turned]);
            shading.1 = error.max(normal_error);
        }
    }
    let material = &scene.materials[triangle.material as usize];
    let mut albedo = (wide(material.albedo), 0.0);
    if material.texture_offset != NONE && attributes.flags & HAS_TEXCOORDS != 0 {
        let at = |i: usize| {
            blend(
                [attributes.uv0[i], attributes.uv1[i], [attributes.uv2_u, attributes.uv2_v][i]]
                    .map(|c| DVec3::splat(f64::from(c))),
            )
            .x
        };
        let span = |i: usize| {
            [attributes.uv0[i], attributes.uv1[i], [attributes.uv2_u, attributes.uv2_v][i]]
                .iter()
                .fold(0.0_f64, |m, c| m.max(f64::from(c.abs())))
        };
        let error = |i: usize| 2.0 * span(i) * (du + dv) + 8.0 * ETA * span(i);
        let (texel, change) = texture::bilinear(&scene.words, material, [at(0), at(1)], [error(0), error(1)]);
        albedo = (albedo.0 * texel, change + 8.0 * ETA);
    }
    Some(Surface {
        triangle: id,
        material: triangle.material,
        position,
        depth: (offset.dot(forward), depth_error),
        geometric_normals: (geometric, normal_error),
        shading_normals: shading,
        albedo,
    })
}
