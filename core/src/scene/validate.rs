//! Checks made once, before anything is compiled or uploaded.

use super::{Environment, Light, Material, MaterialKind, Mesh, Scene, Texture};
use crate::error::{Error, Result};

/// Largest magnitude of a world coordinate, 2⁴⁰ (10¹²): products of three coordinates, as the sheared triangle test
/// forms them, then stay below the largest f32.
pub const COORDINATE_LIMIT: f64 = 1_099_511_627_776.0;

/// What a scene may need at most, and how strictly it is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Limits {
    /// Triangles over all instances.
    pub max_triangles: u64,
    /// Bytes of the compiled scene.
    pub max_bytes: u64,
    /// Drop triangles with non-finite or too large vertices, and count them, instead of refusing the scene.
    pub lenient: bool,
}

impl Default for Limits {
    fn default() -> Self {
        Self { max_triangles: 1 << 26, max_bytes: 16 << 30, lenient: false }
    }
}

impl Scene {
    /// Checks indices, lengths, ranges and limits. Vertex values are checked by [`super::compile`], which knows the
    /// transforms.
    ///
    /// # Errors
    /// [`Error::InvalidInput`] naming the element and value, [`Error::LimitExceeded`].
    pub fn validate(&self, limits: &Limits) -> Result<()> {
        let triangles = self.triangle_count() as u64;
        if triangles > limits.max_triangles {
            return Err(Error::limit("triangles of the scene", triangles, limits.max_triangles));
        }
        for (i, mesh) in self.meshes.iter().enumerate() {
            check_mesh(&format!("mesh {i} '{}'", mesh.name), mesh, self.materials.len())?;
        }
        for (i, instance) in self.instances.iter().enumerate() {
            let place = format!("instance {i} '{}'", instance.name);
            if instance.mesh as usize >= self.meshes.len() {
                let what = format!("mesh index {} of {} meshes", instance.mesh, self.meshes.len());
                return Err(Error::invalid(place, what));
            }
            if let Some(id) = instance.material.filter(|&id| id as usize >= self.materials.len()) {
                return Err(Error::invalid(
                    place,
                    format!("material index {id} of {}", self.materials.len()),
                ));
            }
            let (t, d) = (&instance.transform, instance.transform.determinant());
            if !(t.linear.is_finite() && t.translation.is_finite() && d.is_finite()) || d == 0.0 {
                return Err(Error::invalid(
                    place,
                    format!("transform is singular or not finite (determinant {d})"),
                ));
            }
        }
        for (i, m) in self.materials.iter().enumerate() {
            check_material(&format!("material {i} '{}'", m.name), m, self.textures.len())?;
        }
        for (i, t) in self.textures.iter().enumerate() {
            check_texture(&format!("texture {i} '{}'", t.name), t)?;
        }
        for (i, l) in self.lights.iter().enumerate() {
            check_light(&format!("light {i}"), l)?;
        }
        self.motion.check(self)?;
        self.environment.as_ref().map_or(Ok(()), check_environment)
    }
}

fn check_mesh(place: &str, mesh: &Mesh, materials: usize) -> Result<()> {
    let vertices = mesh.positions.len();
    let invalid = |what: String| Err(Error::invalid(place, what));
    if mesh.material_ids.len() != mesh.triangles.len() {
        return invalid(format!(
            "{} material ids for {} triangles",
            mesh.material_ids.len(),
            mesh.triangles.len()
        ));
    }
    for (what, len) in [("normals", mesh.normals.len()), ("texture coordinates", mesh.texcoords.len())] {
        if len != 0 && len != vertices {
            return invalid(format!("{len} {what} for {vertices} positions"));
        }
    }
    for (i, t) in mesh.triangles.iter().enumerate() {
        if let Some(bad) = t.iter().find(|&&v| v as usize >= vertices) {
            return invalid(format!("triangle {i} refers to vertex {bad} of {vertices}"));
        }
    }
    match mesh.material_ids.iter().position(|&m| m as usize >= materials) {
        Some(i) => {
            invalid(format!("triangle {i} refers to material {} of {materials}", mesh.material_ids[i]))
        }
        None => Ok(()),
    }
}

fn in_unit(place: &str, name: &str, values: &[f32]) -> Result<()> {
    match values.iter().find(|v| !(0.0..=1.0).contains(*v)) {
        Some(v) => Err(Error::invalid(place, format!("{name} {v} is not within 0 and 1"))),
        None => Ok(()),
    }
}

/// Brightest value accepted: 2⁶⁰, far above any physical scene and far below overflow.
const BRIGHTEST: f32 = 1.152_921_5e18;

fn non_negative(place: &str, name: &str, values: &[f32]) -> Result<()> {
    match values.iter().find(|v| !(0.0..=BRIGHTEST).contains(*v)) {
        Some(v) => Err(Error::invalid(place, format!("{name} {v} is negative, too large or not a number"))),
        None => Ok(()),
    }
}

fn check_material(place: &str, m: &Material, textures: usize) -> Result<()> {
    in_unit(place, "albedo", &m.albedo)?;
    in_unit(place, "specular reflectance", &m.specular_f0)?;
    in_unit(place, "roughness", &[m.roughness])?;
    non_negative(place, "emission", &m.emission)?;
    if let Some(t) = m.albedo_texture.filter(|&t| t as usize >= textures) {
        return Err(Error::invalid(place, format!("texture index {t} of {textures}")));
    }
    match m.kind {
        MaterialKind::Dielectric { ior } if !(0.25..=4.0).contains(&ior) => {
            Err(Error::invalid(place, format!("index of refraction {ior} is not within 0.25 and 4")))
        }
        _ => Ok(()),
    }
}

fn check_texture(place: &str, t: &Texture) -> Result<()> {
    if !(1..=16384).contains(&t.width) || !(1..=16384).contains(&t.height) {
        return Err(Error::invalid(
            place,
            format!("size {}x{} is not within 1 and 16384", t.width, t.height),
        ));
    }
    let expected = t.width as usize * t.height as usize;
    if t.texels.len() != expected {
        return Err(Error::invalid(place, format!("{} texels for {}x{}", t.texels.len(), t.width, t.height)));
    }
    Ok(())
}

fn finite(place: &str, name: &str, v: &[f32]) -> Result<()> {
    match v.iter().find(|x| !(f64::from(x.abs()) <= COORDINATE_LIMIT)) {
        Some(x) => Err(Error::invalid(place, format!("{name} {x} is not a number within ±2^40"))),
        None => Ok(()),
    }
}

fn not_zero(place: &str, name: &str, v: [f32; 3]) -> Result<()> {
    finite(place, name, &v)?;
    if glam::Vec3::from(v).as_dvec3().length() < 1e-18 {
        return Err(Error::invalid(place, format!("{name} {v:?} has no length")));
    }
    Ok(())
}

fn check_light(place: &str, light: &Light) -> Result<()> {
    match *light {
        Light::Point { position, intensity } => {
            finite(place, "position", &position)?;
            non_negative(place, "intensity", &intensity)
        }
        Light::Spot { position, direction, intensity, inner_angle, outer_angle } => {
            finite(place, "position", &position)?;
            not_zero(place, "direction", direction)?;
            non_negative(place, "intensity", &intensity)?;
            if !(inner_angle >= 0.0 && inner_angle < outer_angle && outer_angle <= 1.570_796_4) {
                let what =
                    format!("cone angles {inner_angle}, {outer_angle} don't satisfy 0 ≤ inner < outer ≤ π/2");
                return Err(Error::invalid(place, what));
            }
            Ok(())
        }
        Light::Directional { direction, irradiance } => {
            not_zero(place, "direction", direction)?;
            non_negative(place, "irradiance", &irradiance)
        }
        Light::Rectangle { corner, edge_u, edge_v, radiance } => {
            finite(place, "corner", &corner)?;
            not_zero(place, "edge_u", edge_u)?;
            not_zero(place, "edge_v", edge_v)?;
            non_negative(place, "radiance", &radiance)
        }
        Light::Sphere { center, radius, radiance } => {
            finite(place, "center", &center)?;
            finite(place, "radius", &[radius])?;
            if radius < 1e-12 {
                return Err(Error::invalid(place, format!("radius {radius} is not at least 1e-12")));
            }
            non_negative(place, "radiance", &radiance)
        }
    }
}

fn check_environment(e: &Environment) -> Result<()> {
    let place = "environment";
    if !(1..=16384).contains(&e.width) || !(1..=8192).contains(&e.height) {
        return Err(Error::invalid(
            place,
            format!("size {}x{} is not within 1 and 16384x8192", e.width, e.height),
        ));
    }
    if e.texels.len() != e.width as usize * e.height as usize {
        return Err(Error::invalid(place, format!("{} texels for {}x{}", e.texels.len(), e.width, e.height)));
    }
    if !e.rotation.is_finite() || (e.rotation.determinant() - 1.0).abs() > 1e-6 {
        return Err(Error::invalid(place, "rotation is not a proper rotation"));
    }
    non_negative(place, "scale", &[e.scale])?;
    for (i, texel) in e.texels.iter().enumerate() {
        non_negative(&format!("environment texel {i}"), "radiance", texel)?;
    }
    Ok(())
}
