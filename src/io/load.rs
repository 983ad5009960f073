//! From a name to a scene.

use super::resolve::{Files, Resolver, read_limited};
use super::{LoadOptions, builtin, text};
use std::path::Path;
use twinlight_core::scene::Scene;
use twinlight_core::{Error, Result};

/// A reader's entry: bytes, name for messages, files beside it, options.
type Parse = fn(&[u8], &str, &dyn Files, &LoadOptions) -> Result<Scene>;

/// Extensions and their readers.
const READERS: [(&str, Parse); 4] = [
    ("obj", super::obj::parse),
    ("ply", super::ply::parse),
    ("gltf", super::gltf::parse),
    ("glb", super::gltf::parse),
];

/// Loads `builtin:NAME`, or a scene file by its extension. What a file leaves open stays open: see
/// [`super::complete`].
///
/// # Errors
/// [`Error::InvalidInput`] for an unknown builtin name, [`Error::Unsupported`] for an unknown extension, [`Error::Io`], and those of the reader.
pub fn load(source: &str, options: &LoadOptions) -> Result<Scene> {
    if let Some(name) = source.strip_prefix(builtin::PREFIX) {
        return builtin::load(name);
    }
    let path = Path::new(source);
    let parse = reader_of(source)?;
    let bytes = read_limited(path, options.max_file_bytes)?;
    let files = Resolver::new(path, options)?;
    let name = path.file_name().map_or_else(|| source.into(), |n| n.to_string_lossy().into_owned());
    parse(&bytes, &name, &files, options)
}

/// The reader for a file name.
fn reader_of(name: &str) -> Result<Parse> {
    let extension =
        Path::new(name).extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
    if let Some((_, parse)) = READERS.iter().find(|(known, _)| *known == extension) {
        return Ok(*parse);
    }
    let known = READERS.map(|(e, _)| e);
    let hint = text::did_you_mean(&extension, known);
    Err(Error::Unsupported(format!("'{name}': scene files end in .{}{hint}", known.join(", ."))))
}
