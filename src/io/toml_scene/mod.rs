//! TOML scene files: what mesh files can't say, and how to put several of them together.
//!
//! ```toml
//! [render]
//! size = [640, 480]
//! spp = 256
//!
//! [camera]
//! position = [0, 1, 3.4]
//! target = [0, 1, 0]
//!
//! [[mesh]]
//! name = "dragon"
//! path = "dragon.obj"
//!
//! [[instance]]
//! mesh = "dragon"
//! scale = 0.1
//! rotate = { axis = [0, 1, 0], angle = 30 }
//!
//! [[light]]
//! type = "rectangle"
//! corner = [-1, 3, -1]
//! edge_u = [2, 0, 0]
//! edge_v = [0, 0, 2]
//! radiance = 10
//! ```
//!
//! An instance with keyframes moves, in straight lines and turns between them:
//!
//! ```toml
//! [[instance]]
//! mesh = "dragon"
//! scale = 0.1
//!
//! [[instance.motion]]
//! time = 0
//! rotate = { axis = [0, 1, 0], angle = 0 }
//!
//! [[instance.motion]]
//! time = 4
//! rotate = { axis = [0, 1, 0], angle = 360 }
//! ```
//!
//! All tables and keys are in the JSON Schema ([`json_schema`]), which editors use for completion.

mod adopt;
mod build;
mod document;
mod held;
mod light;
mod material;
mod motion;
mod nesting;
mod place;
mod source;
mod value;
mod view;

use super::LoadOptions;
use super::resolve::Files;
use document::Document;
use twinlight_core::Result;
use twinlight_core::scene::Scene;

/// How a scene file asks to be rendered; a caller's own wishes come first.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct RenderSettings {
    /// Width and height of the picture, pixels.
    pub size: Option<[u32; 2]>,
    /// Samples per pixel.
    pub spp: Option<u32>,
    /// Most scattering events of a path.
    pub bounces: Option<u32>,
    /// Seed of the sampling pattern.
    pub seed: Option<u32>,
    /// Rendering method.
    pub method: Option<String>,
}

/// Reads a TOML scene file and the files it names.
///
/// # Errors
/// [`twinlight_core::Error::InvalidInput`] with `file:line:column` and the value, and those of the other readers.
pub fn parse(bytes: &[u8], name: &str, files: &dyn Files, options: &LoadOptions) -> Result<Scene> {
    parse_with_settings(bytes, name, files, options).map(|(scene, _)| scene)
}

/// Like [`parse`], with the file's `[render]` table.
///
/// # Errors
/// As [`parse`].
pub fn parse_with_settings(
    bytes: &[u8],
    name: &str,
    files: &dyn Files,
    options: &LoadOptions,
) -> Result<(Scene, RenderSettings)> {
    build::scene(bytes, name, files, options, &mut nesting::Nesting::default())
}

/// The JSON Schema of scene files.
pub fn json_schema() -> String {
    let schema = schemars::schema_for!(Document);
    // A schema holds no map with keys other than strings, so that writing it can't fail.
    serde_json::to_string_pretty(&schema).unwrap_or_default() + "\n"
}
