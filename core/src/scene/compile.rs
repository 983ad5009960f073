//! From a [`Scene`] to the flat records of a [`CompiledScene`].

use super::compiled::*;
use super::{
    COORDINATE_LIMIT, Instance, Light, Limits, Material, MaterialKind, Mesh, Scene, Texture, Triangle, Wrap,
};
use crate::bvh;
use crate::error::{Error, Result};
use crate::srgb;
use bytemuck::Zeroable;
use glam::{DMat3, DVec3, Vec3};

mod coincident;
mod environment;
mod lights;

/// Magnitudes below this are stored as 0: adapters disagree about subnormals, and products of such coordinates would
/// be subnormal.
const SMALLEST: f32 = 1e-30;

/// Validates `scene`, moves it to world space around its middle, builds its hierarchy and lists its lights. What may move
/// ([`Instance::moves`]) comes behind what stays, with a hierarchy of its own, so that what stays is compiled to the same bits in every
/// frame.
///
/// # Errors
/// Those of [`Scene::validate`]; [`Error::InvalidInput`] for vertices that are not finite or beyond
/// [`COORDINATE_LIMIT`] (with [`Limits::lenient`] such triangles are dropped and counted in the notices), and for scenes
/// less than 2⁻³⁰ units across.
pub fn compile(scene: &Scene, limits: &Limits) -> Result<CompiledScene> {
    scene.validate(limits)?;
    check_memory(scene, limits)?;
    let moving = scene.moving();
    let origin = middle(scene, &moving);
    let mut flat = Flat { origin, lenient: limits.lenient, ..Flat::default() };
    for (instance, &moves) in scene.instances.iter().zip(&moving) {
        flat.add(scene, instance, moves)?;
    }
    let mut materials: Vec<MaterialRecord> = Vec::with_capacity(scene.materials.len() + 1);
    let (mut words, texture_offsets) = texture_words(&scene.textures);
    for material in &scene.materials {
        materials.push(material_record(material, &scene.textures, &texture_offsets));
    }
    for light in &scene.lights {
        flat.add_rectangle(light, &mut materials);
    }
    if materials.is_empty() {
        materials.push(material_record(&Material::default(), &[], &[]));
    }

    check_size(&flat.corners)?;
    flat.coincident = coincident::leave_out(&mut flat, &mut materials);

    let moving_from = flat.moves.iter().filter(|moves| !*moves).count() as u32;
    let (bvh, order) = bvh::build_parts(&flat.corners, &flat.moves);
    let pick = |s: &u32| *s as usize;
    let mut triangles: Vec<Triangle> = order.iter().map(|s| flat.triangle(pick(s))).collect();
    let attributes = order.iter().map(|s| flat.attributes[pick(s)]).collect();
    let bounds = bounds_of(&flat.corners);
    let mut listed = lights::list(scene, origin, &mut triangles, &materials, bounds);
    let environment = environment::append(scene, bounds, &mut words, &mut listed);
    let exponents = listed.film_exponents();
    let mut notices = flat.notices();
    notices.extend(listed.dim());
    notices.append(&mut listed.notices);
    Ok(CompiledScene {
        triangles,
        moving_from,
        attributes,
        materials,
        environment,
        lights: listed.finish(),
        words,
        bvh,
        origin: origin.to_array(),
        bounds: (bounds.0.to_array(), bounds.1.to_array()),
        film_exponent: exponents.0,
        moment_exponent: exponents.1,
        notices,
    })
}

/// Least extent of a scene as a whole, 2⁻³⁰. Edge functions and areas are products of two lengths, depths of three: far below this
/// size they leave the range of normal numbers, where adapters flush them and triangles are missed.
const SMALLEST_EXTENT: f32 = 9.313_226e-10;

fn check_size(corners: &[[[f32; 3]; 3]]) -> Result<()> {
    let (low, high) = bounds_of(corners);
    let extent = (high - low).max_element();
    if extent > 0.0 && extent < SMALLEST_EXTENT {
        let what =
            format!("is {extent:e} units across, less than {SMALLEST_EXTENT:e}: choose a smaller unit");
        return Err(Error::invalid("the scene", what));
    }
    Ok(())
}

fn check_memory(scene: &Scene, limits: &Limits) -> Result<()> {
    let per_triangle =
        size_of::<Triangle>() + size_of::<TriangleAttributes>() + 2 * size_of::<bvh::BvhNode>();
    let texels: u64 = scene.textures.iter().map(|t| u64::from(t.width) * u64::from(t.height) * 4).sum();
    let needed = scene.triangle_count() as u64 * per_triangle as u64 + texels;
    if needed > limits.max_bytes {
        return Err(Error::limit("bytes of the compiled scene", needed, limits.max_bytes));
    }
    Ok(())
}

/// The point that becomes the origin: the middle of the bounds, on a grid coarser than the scene, so that scenes
/// around the origin stay put and exact shifts by the grid step give identical records. The bounds are those of what stays, if it
/// has any, so that its records have the same bits in every frame.
fn middle(scene: &Scene, moving: &[bool]) -> DVec3 {
    let extent = |(lo, hi): (DVec3, DVec3)| (hi - lo).max_element();
    let usable = |bounds: &(DVec3, DVec3)| {
        let extent = extent(*bounds);
        extent.is_finite() && bounds.0.is_finite() && bounds.1.is_finite() && extent != 0.0
    };
    let stays = scene.bounds_of(|instance| !moving[instance]).filter(usable);
    let Some((lo, hi)) = stays.or_else(|| scene.bounds().filter(usable)) else { return DVec3::ZERO };
    let step = (2.0 * extent((lo, hi))).log2().ceil().exp2();
    ((lo + hi) * 0.5 / step).round() * step
}

#[derive(Default)]
struct Flat {
    origin: DVec3,
    lenient: bool,
    corners: Vec<[[f32; 3]; 3]>,
    attributes: Vec<TriangleAttributes>,
    materials: Vec<u32>,
    ids: Vec<u32>,
    /// Whether each may move.
    moves: Vec<bool>,
    next_id: u32,
    dropped: usize,
    unusable_normals: usize,
    contrary_normals: usize,
    coincident: coincident::LeftOut,
}

fn narrow(v: DVec3) -> [f32; 3] {
    v.as_vec3().to_array().map(|x| if x.abs() < SMALLEST { 0.0 } else { x })
}

impl Flat {
    fn add(&mut self, scene: &Scene, instance: &Instance, moves: bool) -> Result<()> {
        let mesh = &scene.meshes[instance.mesh as usize];
        let transform = &instance.transform;
        let mirrored = transform.determinant() < 0.0;
        let positions: Vec<DVec3> = mesh.positions.iter().map(|&p| transform.point(p)).collect();
        let to_normal = transform.linear.inverse().transpose();
        let normals = world_normals(mesh, to_normal);
        for (i, &[a, b, c]) in mesh.triangles.iter().enumerate() {
            let id = self.next_id;
            self.next_id += 1;
            // A mirroring transform turns triangles inside out; exchanging two vertices turns them back.
            let vertices = if mirrored { [a, c, b] } else { [a, b, c] }.map(|v| v as usize);
            if let Some(&v) = vertices.iter().find(|&&v| !in_range(positions[v])) {
                if self.lenient {
                    self.dropped += 1;
                    continue;
                }
                let place = format!("mesh '{}' triangle {i} vertex {v}", mesh.name);
                let what = format!("position {:?} is not a number within ±2^40", mesh.positions[v]);
                return Err(Error::invalid(place, what));
            }
            let corners = vertices.map(|v| narrow(positions[v] - self.origin));
            let attributes = self.attributes_of(mesh, &normals, vertices, corners);
            self.corners.push(corners);
            self.attributes.push(attributes);
            self.materials.push(instance.material.unwrap_or(mesh.material_ids[i]));
            self.ids.push(id);
            self.moves.push(moves);
        }
        Ok(())
    }

    fn attributes_of(
        &mut self,
        mesh: &Mesh,
        normals: &[Vec3],
        vertices: [usize; 3],
        corners: [[f32; 3]; 3],
    ) -> TriangleAttributes {
        let mut record = TriangleAttributes::zeroed();
        if !normals.is_empty() {
            let [n0, n1, n2] = vertices.map(|v| normals[v]);
            let [p0, p1, p2] = corners.map(|p| Vec3::from(p).as_dvec3());
            let face = (p1 - p0).cross(p2 - p0);
            let sum = (n0 + n1 + n2).as_dvec3();
            if [n0, n1, n2].contains(&Vec3::ZERO) || sum.length() < 0.1 {
                self.unusable_normals += 1;
            } else {
                self.contrary_normals += usize::from(face.dot(sum) < 0.0);
                // Winding decides which side is the front; contrary vertex normals are turned to it.
                let side = if face.dot(sum) < 0.0 { -1.0 } else { 1.0 };
                record.flags |= HAS_NORMALS;
                record.n0 = (n0 * side).to_array();
                record.n1 = (n1 * side).to_array();
                record.n2 = (n2 * side).to_array();
            }
        }
        if !mesh.texcoords.is_empty() {
            let [t0, t1, t2] = vertices.map(|v| mesh.texcoords[v]);
            if t0.iter().chain(&t1).chain(&t2).all(|x| x.abs() < 1e6) {
                record.flags |= HAS_TEXCOORDS;
                record.uv0 = [t0[0], 1.0 - t0[1]];
                record.uv1 = [t1[0], 1.0 - t1[1]];
                (record.uv2_u, record.uv2_v) = (t2[0], 1.0 - t2[1]);
            }
        }
        record
    }

    /// A rectangle light is two triangles of a black emitter, after the scene's own.
    fn add_rectangle(&mut self, light: &Light, materials: &mut Vec<MaterialRecord>) {
        let Light::Rectangle { corner, edge_u, edge_v, radiance } = *light else { return };
        let material = materials.len() as u32;
        materials.push(material_record(&Material::emitter("rectangle light", radiance), &[], &[]));
        let wide = |v: [f32; 3]| Vec3::from(v).as_dvec3();
        let (p, u, v) = (wide(corner) - self.origin, wide(edge_u), wide(edge_v));
        for corners in [[p, p + u, p + u + v], [p, p + u + v, p + v]] {
            self.corners.push(corners.map(narrow));
            self.attributes.push(TriangleAttributes::zeroed());
            self.materials.push(material);
            self.ids.push(self.next_id);
            self.moves.push(false);
            self.next_id += 1;
        }
    }

    /// Keeps the triangles that `keep` says.
    fn retain(&mut self, keep: &[bool]) {
        fn retain<T: Copy>(values: &mut Vec<T>, keep: &[bool]) {
            *values = values.iter().zip(keep).filter_map(|(&value, &keep)| keep.then_some(value)).collect();
        }
        retain(&mut self.corners, keep);
        retain(&mut self.attributes, keep);
        retain(&mut self.materials, keep);
        retain(&mut self.ids, keep);
        retain(&mut self.moves, keep);
    }

    fn triangle(&self, i: usize) -> Triangle {
        Triangle::new(self.corners[i], self.ids[i], self.materials[i])
    }

    fn notices(&self) -> Vec<String> {
        let mut notices = Vec::new();
        if self.dropped > 0 {
            notices.push(format!(
                "{} triangles with vertices that are not numbers within ±2^40 dropped",
                self.dropped
            ));
        }
        let coincident::LeftOut { triangles, other_lights } = self.coincident;
        if triangles > 0 {
            notices.push(format!(
                "{triangles} triangles with the corners of an emissive one left out: rays meet only that one"
            ));
        }
        if other_lights > 0 {
            notices.push(format!(
                "of these, {other_lights} emit otherwise than the one that stays: that is lost"
            ));
        }
        if self.unusable_normals > 0 {
            let n = self.unusable_normals;
            notices.push(format!("{n} triangles with zero or cancelling vertex normals shaded flat"));
        }
        if self.contrary_normals > 0 {
            let n = self.contrary_normals;
            notices.push(format!("{n} triangles with vertex normals against their winding: normals turned"));
        }
        notices
    }
}

fn in_range(p: DVec3) -> bool {
    p.abs().max_element() <= COORDINATE_LIMIT && !p.is_nan()
}

fn world_normals(mesh: &Mesh, to_normal: DMat3) -> Vec<Vec3> {
    let unit = |n: &[f32; 3]| {
        let n = to_normal * Vec3::from(*n).as_dvec3();
        let length = n.length();
        if length.is_finite() && length > 1e-30 { (n / length).as_vec3() } else { Vec3::ZERO }
    };
    mesh.normals.iter().map(unit).collect()
}

fn bounds_of(corners: &[[[f32; 3]; 3]]) -> (Vec3, Vec3) {
    let mut points = corners.iter().flatten().map(|&p| Vec3::from(p));
    let Some(first) = points.next() else { return (Vec3::ZERO, Vec3::ZERO) };
    points.fold((first, first), |(lo, hi), p| (lo.min(p), hi.max(p)))
}

/// Least GGX α: 2⁻¹⁰, so that 1/α² stays far from overflow and a roughness of 0 is the limit of small ones.
const MIN_ALPHA: f32 = 0.000_976_562_5;

fn material_record(m: &Material, textures: &[Texture], offsets: &[u32]) -> MaterialRecord {
    let alpha = m.roughness * m.roughness;
    let f0 = m.specular_f0.iter().fold(0.0_f32, |a, &b| a.max(b));
    let texture = m.albedo_texture.map(|t| t as usize);
    let (kind, ior) = match m.kind {
        MaterialKind::Opaque => (MATERIAL_OPAQUE, 1.0),
        MaterialKind::Mirror => (MATERIAL_MIRROR, 1.0),
        MaterialKind::Dielectric { ior } => (MATERIAL_DIELECTRIC, ior),
    };
    MaterialRecord {
        albedo: m.albedo,
        kind,
        specular_f0: m.specular_f0,
        alpha: alpha.max(MIN_ALPHA),
        emission: m.emission,
        flags: if m.emits_both_sides { EMITS_BOTH_SIDES } else { 0 },
        specular_f90: (50.0 * f0).min(1.0),
        ior,
        smith_k: (m.roughness + 1.0) * (m.roughness + 1.0) / 8.0,
        texture_offset: texture.map_or(NONE, |t| offsets[t]),
        texture_width: texture.map_or(0, |t| textures[t].width),
        texture_height: texture.map_or(0, |t| textures[t].height),
        texture_wrap: texture.map_or(0, |t| u32::from(textures[t].wrap == Wrap::Clamp)),
        padding: 0,
    }
}

/// The sRGB table, then the textures' texels, R in the low byte. Returns the words and each texture's first word.
fn texture_words(textures: &[Texture]) -> (Vec<u32>, Vec<u32>) {
    let linear = |byte: u32| srgb::decode(f64::from(byte) / 255.0) as f32;
    let mut words: Vec<u32> = (0..SRGB_TABLE_LEN).map(|byte| linear(byte).to_bits()).collect();
    let mut offsets = Vec::with_capacity(textures.len());
    for texture in textures {
        offsets.push(words.len() as u32);
        words.extend(texture.texels.iter().map(|&t| u32::from_le_bytes(t)));
    }
    (words, offsets)
}
