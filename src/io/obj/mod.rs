//! Wavefront OBJ with MTL materials.
//!
//! Three steps: `check` validates the text and passes on a plain form of it, `tobj` turns that into triangles, and
//! [`material`] gives the MTL keys a meaning. Each group of faces becomes a mesh.

mod check;
mod corner;
mod left_out;
mod library;
pub mod material;
mod mtl;

use super::LoadOptions;
use super::resolve::Files;
use library::Library;
use twinlight_core::scene::{Mesh, Scene};
use twinlight_core::{Error, Result};

/// Notices about single statements, at most: more would help nobody, and a file may ask for millions.
const MAX_NOTICES: usize = 20;

/// Reads an OBJ file; `name` is for messages, `files` gives the material libraries and textures.
///
/// # Errors
/// [`Error::InvalidInput`] with `file:line:column` and the value, [`Error::LimitExceeded`], and those of `files`.
pub fn parse(bytes: &[u8], name: &str, files: &dyn Files, options: &LoadOptions) -> Result<Scene> {
    let mut library = Library::new(files, options);
    let checked = check::check(bytes, name, options, &mut library)?;
    library.conclude(name);
    let models = triangulate(&checked.text, library.materials.len(), name)?;
    let mut scene = Scene {
        materials: library.materials,
        textures: library.textures,
        notices: library.notices,
        ..Scene::default()
    };
    for model in models {
        let group = model.name.parse::<usize>().ok().and_then(|i| checked.groups.get(i));
        let label = group.filter(|g| !g.is_empty()).map_or(name, String::as_str);
        if !model.mesh.indices.is_empty() {
            scene.add_mesh(mesh(label, &model.mesh));
        }
    }
    Ok(scene)
}

/// Runs tobj on checked text, whose materials are named by their numbers.
fn triangulate(text: &[u8], materials: usize, name: &str) -> Result<Vec<tobj::Model>> {
    let options =
        tobj::LoadOptions { single_index: true, triangulate: true, ignore_points: true, ignore_lines: true };
    let numbered = |_: &std::path::Path| {
        let named = |i: usize| tobj::Material { name: i.to_string(), ..tobj::Material::default() };
        Ok(((0..materials).map(named).collect(), (0..materials).map(|i| (i.to_string(), i)).collect()))
    };
    match tobj::load_obj_buf(&mut &*text, &options, numbered) {
        Ok((models, _)) => Ok(models),
        Err(e) => Err(Error::Internal(format!("{name} passed its checks, but tobj says: {e}"))),
    }
}

fn mesh(label: &str, model: &tobj::Mesh) -> Mesh {
    let triangles: Vec<[u32; 3]> = model.indices.as_chunks().0.to_vec();
    let material = model.material_id.unwrap_or_default() as u32;
    let mut mesh = Mesh::new(label, model.positions.as_chunks().0.to_vec(), triangles, material);
    mesh.normals = model.normals.as_chunks().0.to_vec();
    mesh.texcoords = model.texcoords.as_chunks().0.to_vec();
    mesh
}
