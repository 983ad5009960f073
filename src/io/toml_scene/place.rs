//! Placing meshes, and what comes with them, in the world.

use super::document::InstanceTable;
use super::source::Source;
use glam::{DMat3, DVec3, Vec3};
use std::ops::Range;
use twinlight_core::Result;
use twinlight_core::scene::{Camera, Light, Transform};

/// The transform an instance table describes.
pub(super) fn transform(table: &InstanceTable, source: &Source<'_>) -> Result<Transform> {
    let at = table.mesh.span();
    let transform = match &table.matrix {
        Some(matrix) => {
            let others = table.translate.is_some() || table.euler.is_some() || table.scale.is_some();
            if others || table.rotate.is_some() {
                let what = "matrix stands for translate, rotate, euler and scale together: leave those out";
                return Err(source.error(&matrix.span(), what));
            }
            let rows = matrix.get_ref();
            let column = |i: usize| DVec3::new(rows[0][i], rows[1][i], rows[2][i]);
            Transform { linear: DMat3::from_cols(column(0), column(1), column(2)), translation: column(3) }
        }
        None => {
            let scale = table.scale.map_or(DVec3::ONE, |s| DVec3::from(s.0));
            let linear = rotation(table, source)? * DMat3::from_diagonal(scale);
            Transform { linear, translation: table.translate.map_or(DVec3::ZERO, DVec3::from) }
        }
    };
    let determinant = transform.determinant();
    let finite = transform.linear.is_finite() && transform.translation.is_finite() && determinant.is_finite();
    if !finite || determinant == 0.0 {
        let what = format!("the placement flattens the mesh or is not finite (determinant {determinant})");
        return Err(source.error(&at, what));
    }
    Ok(transform)
}

/// The rotation that an instance table describes.
pub(super) fn rotation(table: &InstanceTable, source: &Source<'_>) -> Result<DMat3> {
    match (&table.rotate, table.euler) {
        (Some(rotate), Some(_)) => Err(source.error(&rotate.span(), "rotate and euler exclude each other")),
        (Some(rotate), None) => {
            let axis = DVec3::from(rotate.get_ref().axis);
            let Some(axis) = axis.try_normalize() else {
                return Err(source
                    .error(&rotate.span(), format!("axis {:?} has no direction", rotate.get_ref().axis)));
            };
            Ok(DMat3::from_axis_angle(axis, rotate.get_ref().angle.to_radians()))
        }
        (None, Some([x, y, z])) => {
            let [x, y, z] = [x, y, z].map(f64::to_radians);
            Ok(DMat3::from_rotation_z(z) * DMat3::from_rotation_y(y) * DMat3::from_rotation_x(x))
        }
        (None, None) => Ok(DMat3::IDENTITY),
    }
}

/// A light of a mesh file where the mesh is placed. Radiance and intensity stay as they are.
pub(super) fn light(
    light: Light,
    to_world: &Transform,
    source: &Source<'_>,
    at: &Range<usize>,
) -> Result<Light> {
    let point = |p: [f32; 3]| to_world.point(p).as_vec3().to_array();
    let vector = |v: [f32; 3]| (to_world.linear * Vec3::from(v).as_dvec3()).as_vec3().to_array();
    Ok(match light {
        Light::Point { position, intensity } => Light::Point { position: point(position), intensity },
        Light::Spot { position, direction, intensity, inner_angle, outer_angle } => {
            let (position, direction) = (point(position), vector(direction));
            Light::Spot { position, direction, intensity, inner_angle, outer_angle }
        }
        Light::Directional { direction, irradiance } => {
            Light::Directional { direction: vector(direction), irradiance }
        }
        Light::Rectangle { corner, edge_u, edge_v, radiance } => {
            let (mut edge_u, mut edge_v) = (vector(edge_u), vector(edge_v));
            // A mirroring placement would turn the emitting side round.
            if to_world.determinant() < 0.0 {
                (edge_u, edge_v) = (edge_v, edge_u);
            }
            Light::Rectangle { corner: point(corner), edge_u, edge_v, radiance }
        }
        Light::Sphere { center, radius, radiance } => {
            let Some(factor) = uniform_scale(to_world) else {
                return Err(source.error(at, "a sphere light of the mesh file can't be scaled unevenly"));
            };
            Light::Sphere { center: point(center), radius: (f64::from(radius) * factor) as f32, radiance }
        }
    })
}

/// The factor of a transform that scales evenly.
fn uniform_scale(transform: &Transform) -> Option<f64> {
    let [x, y, z] = [transform.linear.x_axis, transform.linear.y_axis, transform.linear.z_axis];
    let factor = x.length();
    let tolerance = 1e-9 * factor;
    let even = (y.length() - factor).abs() <= tolerance && (z.length() - factor).abs() <= tolerance;
    let square = [x.dot(y), y.dot(z), z.dot(x)].iter().all(|d| d.abs() <= tolerance * factor);
    (even && square).then_some(factor)
}

/// A camera of a mesh file where the mesh is placed.
pub(super) fn camera(camera: Camera, to_world: &Transform) -> Camera {
    let point = |p: [f64; 3]| (to_world.linear * DVec3::from(p) + to_world.translation).to_array();
    let up = (to_world.linear * DVec3::from(camera.up)).to_array();
    Camera { position: point(camera.position), target: point(camera.target), up, ..camera }
}
