//! One triangle of a compiled scene, and what is worked out once per triangle.
//!
//! Source of the error bounds: Pharr, Jakob, Humphreys, PBRT 4th ed. §6.8.

use super::compiled::NONE;
use bytemuck::{Pod, Zeroable};
use glam::{DVec3, Vec3};

/// γ(11) = 11u/(1 − 11u), u = 2⁻²⁴: barycentric interpolation makes 7 roundings (PBRT §6.8.5); the third weight,
/// 1 − u − v, is rounded twice more; moving the origin rounds each axis once more, by u of its coordinate, and the
/// product with the normal once more, by u of the distance. Counting them here is why the origin needs no step to the
/// next f32, unlike PBRT's.
const POSITION_ERROR: f32 = 6.556_516e-7;

/// 2⁻¹⁹ = 32u of the triangle's extent: more than the 16u from which on a ray counts as off the plane
/// ([`crate::transport::intersect::SIDE_ERROR`]) and the 9u by which rounding may move its height above it, so that a ray
/// that starts here and goes away is known to leave. Without it, walls in a coordinate plane (position and its error
/// exactly 0) meet themselves.
const PLANE_ERROR: f32 = 1.907_348_6e-6;

/// Positions of one triangle, world units relative to [`super::CompiledScene::origin`], in leaf order of the BVH.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct Triangle {
    /// First vertex.
    pub p0: [f32; 3],
    /// The triangle's number in the scene: instances in order, triangles of each mesh in order.
    pub id: u32,
    /// Second vertex.
    pub p1: [f32; 3],
    /// Index into [`super::CompiledScene::materials`].
    pub material: u32,
    /// Third vertex.
    pub p2: [f32; 3],
    /// Index into [`super::CompiledScene::lights`] when the triangle emits, else [`NONE`].
    pub light: u32,
    /// Unit normal of the side whose vertices run counter-clockwise; 0 for a triangle without area.
    pub normal: [f32; 3],
    /// How far along the normal rays start off the triangle: a bound of the errors of a point on it and of a later
    /// intersection with it.
    pub offset: f32,
}

impl Triangle {
    /// The record of a triangle that emits nothing.
    #[must_use]
    pub fn new(corners: [[f32; 3]; 3], id: u32, material: u32) -> Self {
        let [p0, p1, p2] = corners;
        let normal = normal(corners);
        Self {
            p0,
            id,
            p1,
            material,
            p2,
            light: NONE,
            normal: normal.to_array(),
            offset: leaving_distance(corners.map(Vec3::from), normal),
        }
    }
}

/// In f64, where differences and products of corners are all but exact: the normal of a needle is as good as any.
fn normal(corners: [[f32; 3]; 3]) -> Vec3 {
    let [p0, p1, p2] = corners.map(|p| Vec3::from(p).as_dvec3());
    (p1 - p0).cross(p2 - p0).normalize_or_zero().as_vec3()
}

/// How far along its normal a ray has to start off a triangle so that the true surface isn't met again: the bounds of
/// the position's error and of a later intersection's, added over the axes. The weighted corners whose sum a position is
/// are each bounded by the largest corner, so one number serves the whole triangle; it is worked out once, on the host.
fn leaving_distance(corners: [Vec3; 3], normal: Vec3) -> f32 {
    let [p0, p1, p2] = corners.map(|p| p.as_dvec3());
    let reach = p0.abs().max(p1.abs()).max(p2.abs());
    let extent = (p1 - p0).abs().max((p2 - p0).abs()).max_element();
    let error = reach * f64::from(POSITION_ERROR) + DVec3::splat(extent * f64::from(PLANE_ERROR));
    // Rounded up.
    (normal.abs().as_dvec3().dot(error) as f32).next_up()
}
