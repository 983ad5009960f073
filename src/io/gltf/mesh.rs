//! Primitives to meshes.

use super::Document;
use super::texture::TextureUse;
use ::gltf::json;
use ::gltf::json::mesh::{Mode, Primitive, Semantic};
use ::gltf::json::validation::Checked;
use twinlight_core::Result;
use twinlight_core::scene::Mesh;

impl Document<'_> {
    /// The mesh of a primitive, or `None` when it has no triangles (points, lines). `texture` says which coordinates its
    /// material wants.
    pub fn primitive(
        &self,
        primitive: &Primitive,
        path: &str,
        material: u32,
        texture: Option<&TextureUse>,
    ) -> Result<Option<Mesh>> {
        let Checked::Valid(mode) = primitive.mode else {
            return Err(self.invalid(path, "has no valid mode"));
        };
        if !matches!(mode, Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan) {
            self.note("primitives of points or lines ignored", path);
            return Ok(None);
        }
        let attribute = |semantic| primitive.attributes.get(&Checked::Valid(semantic)).copied();
        let Some(positions) = attribute(Semantic::Positions) else {
            self.note("primitives without positions ignored", path);
            return Ok(None);
        };
        let positions = self.floats::<3>(positions, &format!("{path}.attributes.POSITION"))?;
        let normals = match attribute(Semantic::Normals) {
            Some(normals) => self.floats::<3>(normals, &format!("{path}.attributes.NORMAL"))?,
            None => Vec::new(),
        };
        let texcoords = match texture.and_then(|t| Some((t, attribute(Semantic::TexCoords(t.set))?))) {
            Some((texture, set)) => {
                let place = format!("{path}.attributes.TEXCOORD_{}", texture.set);
                let mut texcoords = self.floats::<2>(set, &place)?;
                texcoords.iter_mut().for_each(|uv| *uv = texture.transform.apply(*uv));
                texcoords
            }
            None => Vec::new(),
        };
        for (what, len) in [("normals", normals.len()), ("texture coordinates", texcoords.len())] {
            if len != 0 && len != positions.len() {
                return Err(self.invalid(path, format!("{len} {what} for {} positions", positions.len())));
            }
        }
        if primitive.targets.as_ref().is_some_and(|t| !t.is_empty()) {
            self.note("primitives shown without their morph targets", path);
        }
        if attribute(Semantic::Colors(0)).is_some() {
            self.note("primitives shown without their vertex colours", path);
        }
        let triangles = self.triangles(primitive, mode, positions.len(), path)?;
        let material_ids = vec![material; triangles.len()];
        let name = path.to_owned();
        Ok(Some(Mesh { name, positions, normals, texcoords, triangles, material_ids }))
    }

    fn triangles(
        &self,
        primitive: &Primitive,
        mode: Mode,
        vertices: usize,
        path: &str,
    ) -> Result<Vec<[u32; 3]>> {
        let indices: Option<Vec<u32>> = match primitive.indices {
            Some(indices) => Some(self.indices(indices, &format!("{path}.indices"))?),
            None => None,
        };
        let corners = indices.as_ref().map_or(vertices, Vec::len);
        if u32::try_from(vertices.max(corners)).is_err() {
            return Err(self.invalid(path, format!("{vertices} vertices, {corners} corners: more than 2^32")));
        }
        if let Some(bad) = indices.iter().flatten().find(|&&i| i as usize >= vertices) {
            return Err(self.invalid(&format!("{path}.indices"), format!("vertex {bad} of {vertices}")));
        }
        if mode == Mode::Triangles && !corners.is_multiple_of(3) {
            return Err(self.invalid(path, format!("{corners} corners are no whole number of triangles")));
        }
        let count = if mode == Mode::Triangles { corners / 3 } else { corners.saturating_sub(2) };
        let place = || format!("{}: {path}", self.name);
        // A triangle and its material.
        self.budget.spend(place, count as u64, 16)?;
        let vertex = |corner: usize| indices.as_ref().map_or(corner as u32, |list| list[corner]);
        let triangle = |i: usize| match mode {
            // Every second triangle of a strip is wound the other way.
            Mode::TriangleStrip => [i, i + 1 + i % 2, i + 2 - i % 2].map(vertex),
            Mode::TriangleFan => [i + 1, i + 2, 0].map(vertex),
            _ => [3 * i, 3 * i + 1, 3 * i + 2].map(vertex),
        };
        Ok((0..count).map(triangle).collect())
    }
}

/// The path of a primitive, for messages.
pub(super) fn primitive_path(mesh: json::Index<json::Mesh>, primitive: usize) -> String {
    format!("meshes[{}].primitives[{primitive}]", mesh.value())
}
