//! From a hit to what is shaded. Twin: `backend-gpu/src/shared/surface.wgsl`.

use super::SceneView;
use super::texture::sample_texture;
use crate::kernels::trace_paths::CameraRecord;
use crate::math::vector::normalized;
use crate::scene::{HAS_NORMALS, HAS_TEXCOORDS, NONE};
use glam::Vec3;

/// A point on a triangle, seen from one side. Normals face the viewer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Surface {
    /// The point.
    pub position: Vec3,
    /// How far along the normal rays start off the surface.
    pub offset: f32,
    /// Unit normal of the triangle.
    pub geometric_normal: Vec3,
    /// Unit interpolated normal, or the geometric one where that has the viewer behind it.
    pub shading_normal: Vec3,
    /// Diffuse albedo, texture included.
    pub albedo: Vec3,
    /// Index of the material.
    pub material: u32,
    /// Index of the light the triangle is, or [`NONE`].
    pub light: u32,
    /// Whether the front (counter-clockwise) face is seen.
    pub front: bool,
}

/// The unit direction of the camera ray through image point (x, y), in pixels from the top-left corner.
#[inline(always)]
pub fn camera_direction(camera: &CameraRecord, x: f32, y: f32) -> Vec3 {
    let corner = Vec3::from(camera.corner);
    normalized(corner + Vec3::from(camera.step_x) * x + Vec3::from(camera.step_y) * y)
}

/// The surface at barycentric (u, v) of the triangle in `slot`, met by a ray along the unit `direction`.
#[inline(always)]
pub fn surface_at(scene: &SceneView<'_>, slot: u32, u: f32, v: f32, direction: Vec3) -> Surface {
    let triangle = &scene.triangles[slot as usize];
    let attributes = &scene.attributes[slot as usize];
    let material = &scene.materials[triangle.material as usize];
    let w = (1.0 - u) - v;
    let a = Vec3::from(triangle.p0) * w;
    let b = Vec3::from(triangle.p1) * u;
    let c = Vec3::from(triangle.p2) * v;
    let position = (a + b) + c;
    let winding = Vec3::from(triangle.normal);
    let front = winding.dot(direction) < 0.0;
    let geometric_normal = if front { winding } else { -winding };
    let mut shading_normal = geometric_normal;
    if attributes.flags & HAS_NORMALS != 0 {
        let sum =
            (Vec3::from(attributes.n0) * w + Vec3::from(attributes.n1) * u) + Vec3::from(attributes.n2) * v;
        let unit = normalized(sum);
        let facing = if front { unit } else { -unit };
        if facing.dot(direction) < 0.0 && facing.dot(geometric_normal) > 0.0 {
            shading_normal = facing;
        }
    }
    let mut albedo = Vec3::from(material.albedo);
    if material.texture_offset != NONE && attributes.flags & HAS_TEXCOORDS != 0 {
        let s = (attributes.uv0[0] * w + attributes.uv1[0] * u) + attributes.uv2_u * v;
        let t = (attributes.uv0[1] * w + attributes.uv1[1] * u) + attributes.uv2_v * v;
        albedo *= sample_texture(scene.words, material, s, t);
    }
    Surface {
        position,
        offset: triangle.offset,
        geometric_normal,
        shading_normal,
        albedo,
        material: triangle.material,
        light: triangle.light,
        front,
    }
}
