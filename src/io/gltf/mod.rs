//! glTF 2.0 and GLB.
//!
//! The `gltf` crate turns JSON into records; everything those records point at is resolved and checked here, because its
//! own importer reads files outside the scene's folder and its validation and accessors panic on hostile numbers.
//!
//! What is read: the default scene's nodes, triangles of any mode, normals, one set of texture coordinates, metallic-rough
//! materials (with emissive strength, ior, specular, transmission, texture transform), the first perspective camera,
//! punctual lights; one animation of nodes, and skins, as a [`Motion`](twinlight_core::scene::Motion). What the surface model
//! has no place for is averaged or left out, with a notice. Where nothing moves, skinned meshes are bent as their joints
//! stand.

mod accessor;
mod animation;
mod budget;
mod buffer;
mod camera;
mod container;
mod light;
mod material;
mod mesh;
mod node;
mod notices;
mod skeleton;
mod skin;
mod texture;

use super::LoadOptions;
use super::resolve::Files;
use ::gltf::json;
use budget::Budget;
use buffer::Buffers;
use notices::Notices;
use std::cell::RefCell;
use twinlight_core::scene::Scene;
use twinlight_core::{Error, Result};

/// Extensions whose meaning is kept, or whose specification allows to leave them out.
const EXTENSIONS: [&str; 8] = [
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
];

/// Reads a `.gltf` or `.glb` file; which of the two is decided by its first bytes. Buffers and pictures come from the
/// file itself (`data:` URIs, the binary chunk) or from `files`.
///
/// # Errors
/// [`Error::InvalidInput`] naming `name` and the element's path in the JSON (or line and column of a syntax error),
/// [`Error::Unsupported`] for a required extension that is not known, [`Error::LimitExceeded`], and those of `files`.
pub fn parse(bytes: &[u8], name: &str, files: &dyn Files, options: &LoadOptions) -> Result<Scene> {
    let container = container::open(bytes, name, options.limits.max_bytes)?;
    let document = Document {
        root: &container.root,
        name,
        files,
        options,
        buffers: Buffers::new(container.binary, container.root.buffers.len()),
        budget: Budget::new(options.limits),
        notices: RefCell::default(),
    };
    document.check_extensions()?;
    let mut scene = node::read(&document)?;
    scene.notices = document.notices.into_inner().into_messages();
    Ok(scene)
}

/// A parsed file and what reading it needs.
struct Document<'a> {
    root: &'a json::Root,
    name: &'a str,
    files: &'a dyn Files,
    options: &'a LoadOptions,
    buffers: Buffers<'a>,
    budget: Budget,
    notices: RefCell<Notices>,
}

impl Document<'_> {
    /// An error about the element at `path`, such as `meshes[3].primitives[0]`.
    fn invalid(&self, path: &str, what: impl Into<String>) -> Error {
        Error::invalid(format!("{}: {path}", self.name), what)
    }

    /// The element of a list that a reference at `path` points at.
    fn get<'l, T>(&self, list: &'l [T], index: json::Index<T>, kind: &str, path: &str) -> Result<&'l T> {
        let missing = || self.invalid(path, format!("refers to {kind} {} of {}", index.value(), list.len()));
        list.get(index.value()).ok_or_else(missing)
    }

    /// Counts something a person should know.
    fn note(&self, kind: impl Into<String>, element: impl Into<String>) {
        self.notices.borrow_mut().add(kind.into(), element.into());
    }

    fn check_extensions(&self) -> Result<()> {
        let unknown = |e: &&String| !EXTENSIONS.contains(&e.as_str());
        if let Some(extension) = self.root.extensions_required.iter().find(unknown) {
            let known = EXTENSIONS.join(", ");
            let what = format!("{}: required extension '{extension}' (known: {known})", self.name);
            return Err(Error::Unsupported(what));
        }
        for extension in self.root.extensions_used.iter().filter(unknown) {
            if self.options.strict {
                return Err(Error::Unsupported(format!("{}: extension '{extension}'", self.name)));
            }
            self.note("extensions ignored", extension);
        }
        Ok(())
    }
}
