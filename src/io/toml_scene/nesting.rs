//! Scene files inside scene files.

use twinlight_core::{Error, Result};

/// Scene files inside scene files, at most.
const MAX_DEPTH: usize = 8;
/// Mesh files of one scene, those of nested scene files included: eight levels of a few references each could
/// otherwise ask for billions.
const MAX_MESH_FILES: u32 = 4096;

/// The scene files that are being read.
#[derive(Default)]
pub(super) struct Nesting {
    /// Identities of the open scene files, outermost first.
    open: Vec<String>,
    /// Mesh files read so far.
    mesh_files: u32,
}

impl Nesting {
    /// A scene file begins.
    pub fn enter(&mut self, identity: String) {
        self.open.push(identity);
    }

    /// The innermost scene file ends.
    pub fn leave(&mut self) {
        self.open.pop();
    }

    /// Counts a mesh file.
    pub fn count_mesh_file(&mut self) -> Result<()> {
        self.mesh_files += 1;
        if self.mesh_files > MAX_MESH_FILES {
            let count = self.mesh_files.into();
            return Err(Error::limit("mesh files of the scene", count, MAX_MESH_FILES.into()));
        }
        Ok(())
    }

    /// Whether the scene file at `path` may be entered from `place`.
    pub fn check(&self, identity: &String, path: &str, place: &str) -> Result<()> {
        if self.open.contains(identity) {
            return Err(Error::invalid(place, format!("'{path}' includes itself")));
        }
        if self.open.len() >= MAX_DEPTH {
            let what = format!("{place}: scene files inside each other");
            return Err(Error::limit(what, self.open.len() as u64 + 1, MAX_DEPTH as u64));
        }
        Ok(())
    }
}
