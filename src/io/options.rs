//! How scenes are read.

use std::path::PathBuf;
use twinlight_core::scene::Limits;

/// How scenes are read, and what they may need at most.
#[derive(Debug, Clone)]
pub struct LoadOptions {
    /// Limits of the scene; [`Limits::max_bytes`] also bounds the bytes of all files read for one scene.
    pub limits: Limits,
    /// Largest single file, bytes.
    pub max_file_bytes: u64,
    /// Folders outside the scene's own whose files it may refer to.
    pub allow_paths: Vec<PathBuf>,
    /// Makes errors of what is otherwise a notice: unknown keys, missing material libraries and textures.
    pub strict: bool,
    /// Which animation of a glTF file is played: its name, or its number from 0. Without it, the first. Means nothing for
    /// files without animations.
    pub animation: Option<String>,
}

impl Default for LoadOptions {
    fn default() -> Self {
        Self {
            limits: Limits::default(),
            max_file_bytes: 4 << 30,
            allow_paths: Vec::new(),
            strict: false,
            animation: None,
        }
    }
}
