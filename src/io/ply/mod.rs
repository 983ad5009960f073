//! PLY, in ASCII and in both binary orders.
//!
//! Read: `x y z`, `nx ny nz` and `s t` (or `u v`, `texture_u texture_v`) of `vertex`, and the index list of `face`, fanned
//! into triangles. Everything else is skipped. Hand-written rather than taken from a crate: a header may promise more
//! than the file holds, and a million triangles should take tens of milliseconds.

mod body;
mod header;

use super::LoadOptions;
use super::resolve::Files;
use body::Body;
use header::{Element, Property};
use twinlight_core::scene::{Material, Mesh, Scene};
use twinlight_core::{Error, Result};

/// Reads a PLY file; `name` is for messages. PLY refers to no other files.
///
/// # Errors
/// [`Error::InvalidInput`] with line and column (byte, in binary files) and the value, [`Error::LimitExceeded`].
pub fn parse(bytes: &[u8], name: &str, _files: &dyn Files, options: &LoadOptions) -> Result<Scene> {
    let header = header::parse(bytes, name)?;
    let mut body = Body::new(bytes, &header, name);
    let vertices = header.elements.iter().find(|e| e.name == "vertex").map_or(0, |e| e.count);
    if vertices > u64::from(u32::MAX) {
        return Err(Error::limit(format!("{name}: vertices"), vertices, u32::MAX.into()));
    }
    let mut reader =
        Reader { name, options, vertices, mesh: Mesh::new(name, Vec::new(), Vec::new(), 0), small_faces: 0 };
    let mut scene = Scene::default();
    for element in &header.elements {
        let needed = element.count.saturating_mul(element.least_bytes(header.encoding));
        // The last value of a text needs no separator.
        if needed > body.left() + 1 {
            let (count, label) = (element.count, &element.name);
            let what = format!(
                "the header promises {count} '{label}' elements of at least {} bytes, but {} bytes are left",
                element.least_bytes(header.encoding),
                body.left()
            );
            return Err(Error::invalid(body.place(), what));
        }
        match element.name.as_str() {
            "vertex" => reader.vertices(element, &mut body, &mut scene.notices)?,
            "face" => reader.faces(element, &mut body, &mut scene.notices)?,
            _ => skip(element, &mut body, name, &mut scene.notices)?,
        }
    }
    if reader.small_faces > 0 {
        scene
            .notices
            .push(format!("{name}: {} faces with fewer than 3 corners left out", reader.small_faces));
    }
    let mut mesh = reader.mesh;
    mesh.material_ids = vec![0; mesh.triangles.len()];
    if mesh.triangles.is_empty() {
        scene.notices.push(format!("{name}: holds no faces"));
        return Ok(scene);
    }
    scene.add_material(Material::default());
    scene.add_mesh(mesh);
    Ok(scene)
}

fn skip(element: &Element, body: &mut Body<'_>, name: &str, notices: &mut Vec<String>) -> Result<()> {
    notices.push(format!("{name}: {} '{}' elements ignored", element.count, element.name));
    // Elements without properties have no bytes, however many there are.
    if element.properties.is_empty() {
        return Ok(());
    }
    for _ in 0..element.count {
        for property in &element.properties {
            skip_property(property, body)?;
        }
    }
    Ok(())
}

fn skip_property(property: &Property, body: &mut Body<'_>) -> Result<()> {
    let count = match property.count {
        Some(count) => body.count(count, property.scalar)?,
        None => 1,
    };
    body.skip(property.scalar, count)
}

/// What a vertex property is, as an index into the values of a vertex.
fn slot(name: &str) -> Option<usize> {
    Some(match name {
        "x" => 0,
        "y" => 1,
        "z" => 2,
        "nx" => 3,
        "ny" => 4,
        "nz" => 5,
        "s" | "u" | "texture_u" => 6,
        "t" | "v" | "texture_v" => 7,
        _ => return None,
    })
}

struct Reader<'a> {
    name: &'a str,
    options: &'a LoadOptions,
    /// Vertices the header promises.
    vertices: u64,
    mesh: Mesh,
    small_faces: usize,
}

impl Reader<'_> {
    fn vertices(&mut self, element: &Element, body: &mut Body<'_>, notices: &mut Vec<String>) -> Result<()> {
        let slots: Vec<Option<usize>> =
            element.properties.iter().map(|p| slot(&p.name).filter(|_| p.count.is_none())).collect();
        let has = |wanted: std::ops::Range<usize>| wanted.into_iter().all(|s| slots.contains(&Some(s)));
        if !has(0..3) {
            let names: Vec<&str> = element.properties.iter().map(|p| p.name.as_str()).collect();
            let what = format!("vertices need x, y and z; their properties are: {}", names.join(", "));
            return Err(Error::invalid(self.name, what));
        }
        let (normals, texcoords) = (has(3..6), has(6..8));
        let ignored: Vec<&str> = element
            .properties
            .iter()
            .zip(&slots)
            .filter(|(_, s)| s.is_none())
            .map(|(p, _)| p.name.as_str())
            .collect();
        if !ignored.is_empty() {
            notices.push(format!("{}: vertex properties ignored: {}", self.name, ignored.join(", ")));
        }
        let count = element.count as usize;
        reserve(&mut self.mesh.positions, count)?;
        reserve(&mut self.mesh.normals, if normals { count } else { 0 })?;
        reserve(&mut self.mesh.texcoords, if texcoords { count } else { 0 })?;
        for _ in 0..count {
            let mut values = [0.0_f32; 8];
            for (property, slot) in element.properties.iter().zip(&slots) {
                match slot {
                    Some(slot) => values[*slot] = self.value(property, body)?,
                    None => skip_property(property, body)?,
                }
            }
            let [x, y, z, nx, ny, nz, s, t] = values;
            self.mesh.positions.push([x, y, z]);
            if normals {
                self.mesh.normals.push([nx, ny, nz]);
            }
            if texcoords {
                self.mesh.texcoords.push([s, t]);
            }
        }
        Ok(())
    }

    fn value(&self, property: &Property, body: &mut Body<'_>) -> Result<f32> {
        let value = body.scalar(property.scalar)? as f32;
        if value.is_finite() || self.options.limits.lenient {
            return Ok(value);
        }
        let vertex = self.mesh.positions.len();
        let what = format!("{} of vertex {vertex} is {value}, not a finite 32-bit number", property.name);
        Err(Error::invalid(body.value_place(), what))
    }

    fn faces(&mut self, element: &Element, body: &mut Body<'_>, notices: &mut Vec<String>) -> Result<()> {
        let is_indices = |p: &Property| p.name == "vertex_indices" || p.name == "vertex_index";
        let indices = element.properties.iter().find(|p| is_indices(p));
        match indices {
            Some(p) if p.count.is_some() && p.scalar.is_integer() => {}
            Some(p) => {
                return Err(Error::invalid(self.name, format!("'{}' is not a list of integers", p.name)));
            }
            None if element.count == 0 => return Ok(()),
            None => return Err(Error::invalid(self.name, "faces need a list 'vertex_indices'")),
        }
        let ignored: Vec<&str> =
            element.properties.iter().filter(|p| !is_indices(p)).map(|p| p.name.as_str()).collect();
        if !ignored.is_empty() {
            notices.push(format!("{}: face properties ignored: {}", self.name, ignored.join(", ")));
        }
        reserve(&mut self.mesh.triangles, element.count as usize)?;
        for face in 0..element.count {
            for property in &element.properties {
                if is_indices(property) {
                    self.fan(property, face, body)?;
                } else {
                    skip_property(property, body)?;
                }
            }
        }
        Ok(())
    }

    /// Reads one polygon as a fan around its first corner.
    fn fan(&mut self, property: &Property, face: u64, body: &mut Body<'_>) -> Result<()> {
        let Some(count) = property.count else { return skip_property(property, body) };
        let corners = body.count(count, property.scalar)?;
        self.small_faces += usize::from(corners < 3);
        let (mut first, mut previous) = (0, 0);
        for i in 0..corners {
            let value = body.scalar(property.scalar)?;
            if !(value >= 0.0 && value < self.vertices as f64) {
                let vertices = self.vertices;
                let what =
                    format!("corner {i} of face {face} is vertex {value}, but there are {vertices} vertices");
                return Err(Error::invalid(body.value_place(), what));
            }
            let vertex = value as u32;
            match i {
                0 => first = vertex,
                1 => {}
                _ => self.mesh.triangles.push([first, previous, vertex]),
            }
            previous = vertex;
        }
        let (triangles, limit) = (self.mesh.triangles.len() as u64, self.options.limits.max_triangles);
        if triangles > limit {
            return Err(Error::limit(format!("{}: triangles", self.name), triangles, limit));
        }
        Ok(())
    }
}

/// Makes room without aborting when there is none.
fn reserve<T>(vector: &mut Vec<T>, count: usize) -> Result<()> {
    let bytes = count.saturating_mul(size_of::<T>()) as u64;
    vector.try_reserve_exact(count).map_err(|_| Error::OutOfMemory { device: "host".into(), bytes })
}
