//! From a name to a scene.

use super::resolve::{Files, Resolver, read_limited};
use super::toml_scene::{self, RenderSettings};
use super::{LoadOptions, builtin, text};
use std::path::Path;
use twinlight_core::scene::Scene;
use twinlight_core::{Error, Result};

/// A reader's entry: bytes, name for messages, files beside it, options.
pub(super) type Parse = fn(&[u8], &str, &dyn Files, &LoadOptions) -> Result<Scene>;

/// How a file is read.
#[derive(Clone, Copy)]
pub(super) enum Reader {
    /// As a mesh or scene that stands alone.
    Scene(Parse),
    /// As a scene file, which may name others and render settings.
    Toml,
}

/// Extensions and their readers.
const READERS: [(&str, Reader); 5] = [
    ("obj", Reader::Scene(super::obj::parse)),
    ("ply", Reader::Scene(super::ply::parse)),
    ("gltf", Reader::Scene(super::gltf::parse)),
    ("glb", Reader::Scene(super::gltf::parse)),
    ("toml", Reader::Toml),
];

/// Loads `builtin:NAME`, or a scene file by its extension. What a file leaves open stays open: see
/// [`super::complete`].
///
/// # Errors
/// [`Error::InvalidInput`] for an unknown builtin name, [`Error::Unsupported`] for an unknown extension, [`Error::Io`],
/// and those of the reader.
pub fn load(source: &str, options: &LoadOptions) -> Result<Scene> {
    load_with_settings(source, options).map(|(scene, _)| scene)
}

/// Like [`load`], with the render settings of a TOML scene file (of other sources: none).
///
/// # Errors
/// As [`load`].
pub fn load_with_settings(source: &str, options: &LoadOptions) -> Result<(Scene, RenderSettings)> {
    if let Some(name) = source.strip_prefix(builtin::PREFIX) {
        return builtin::load(name).map(without_settings);
    }
    let path = Path::new(source);
    let reader = reader_of(source)?;
    let bytes = read_limited(path, options.max_file_bytes)?;
    let files = Resolver::new(path, options)?;
    let name = path.file_name().map_or_else(|| source.into(), |n| n.to_string_lossy());
    match reader {
        Reader::Scene(parse) => parse(&bytes, &name, &files, options).map(without_settings),
        Reader::Toml => toml_scene::parse_with_settings(&bytes, &name, &files, options),
    }
}

fn without_settings(scene: Scene) -> (Scene, RenderSettings) {
    (scene, RenderSettings::default())
}

/// The reader for a file name.
pub(super) fn reader_of(name: &str) -> Result<Reader> {
    let extension =
        Path::new(name).extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
    if let Some((_, reader)) = READERS.iter().find(|(known, _)| *known == extension) {
        return Ok(*reader);
    }
    let known = READERS.map(|(e, _)| e);
    let hint = if extension.is_empty() {
        builtin::did_you_mean(name)
    } else {
        text::did_you_mean(&extension, known)
    };
    Err(Error::Unsupported(format!("'{name}': scene files end in .{}{hint}", known.join(", ."))))
}
