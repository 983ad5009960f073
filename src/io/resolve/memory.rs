//! Files without a file system.

use super::{Files, checked};
use std::collections::BTreeMap;
use std::path::{Component, PathBuf};
use std::sync::Arc;
use twinlight_core::{Error, Result};

/// Files kept in memory, for tests, fuzzing and embedders: path to bytes, `/` as separator.
#[derive(Debug, Clone, Default)]
pub struct MemoryFiles {
    files: Arc<BTreeMap<String, Vec<u8>>>,
    base: String,
}

impl MemoryFiles {
    /// The files by path.
    pub fn new(files: impl IntoIterator<Item = (String, Vec<u8>)>) -> Self {
        Self { files: Arc::new(files.into_iter().collect()), base: String::new() }
    }

    fn locate(&self, path: &str) -> Result<String> {
        let refuse = |what: &str| Err(Error::invalid(format!("reference '{path}'"), what));
        let relative = checked(path)?;
        let mut parts: Vec<String> =
            self.base.split('/').filter(|p| !p.is_empty()).map(String::from).collect();
        for component in relative.components() {
            match component {
                Component::Normal(part) => parts.push(part.to_string_lossy().into_owned()),
                Component::CurDir => {}
                Component::ParentDir if parts.pop().is_some() => {}
                _ => return refuse("lies outside the scene's folder"),
            }
        }
        Ok(parts.join("/"))
    }
}

impl Files for MemoryFiles {
    fn read_path(&self, path: &str) -> Result<Vec<u8>> {
        let key = self.locate(path)?;
        let missing = || Error::Io { path: PathBuf::from(&key), source: std::io::ErrorKind::NotFound.into() };
        self.files.get(&key).cloned().ok_or_else(missing)
    }

    fn beside(&self, path: &str) -> Result<Box<dyn Files>> {
        let file = self.locate(path)?;
        let base = file.rsplit_once('/').map_or("", |(folder, _)| folder).to_owned();
        Ok(Box::new(Self { files: self.files.clone(), base }))
    }

    fn identity(&self, path: &str) -> Result<String> {
        self.locate(path)
    }
}
