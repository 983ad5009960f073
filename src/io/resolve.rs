//! Which files a scene may read: those in its own folder, and no others unless the caller says so.
//!
//! Scene files come from strangers. A reference that leaves the folder (by `..`, an absolute path, a symbolic link or a
//! URL) is an error that names the reference; sizes are checked before anything is read.

mod memory;
mod uri;

pub use memory::MemoryFiles;
pub use uri::percent_decoded;

use super::LoadOptions;
use std::io::Read;
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use twinlight_core::{Error, Result};

/// Where a reader gets the files that a scene file refers to.
pub trait Files: Sync {
    /// The bytes of the file at `path`, relative to the referring file's folder. `/` and `\` separate folders.
    ///
    /// # Errors
    /// [`Error::InvalidInput`] for a path that may not be read, [`Error::Io`], [`Error::LimitExceeded`].
    fn read_path(&self, path: &str) -> Result<Vec<u8>>;

    /// The files as seen from the folder of `path`; what may be read stays the same.
    ///
    /// # Errors
    /// [`Error::InvalidInput`] for a path that may not be read.
    fn beside(&self, path: &str) -> Result<Box<dyn Files>>;

    /// A text that is the same for two paths of the same file, to find cycles and to read a file once.
    ///
    /// # Errors
    /// As [`Files::read_path`].
    fn identity(&self, path: &str) -> Result<String>;

    /// Like [`Files::read_path`], for a URI reference: `%20` and the like are decoded first.
    ///
    /// # Errors
    /// As [`Files::read_path`], and [`Error::InvalidInput`] for bad percent-encoding.
    fn read(&self, uri: &str) -> Result<Vec<u8>> {
        self.read_path(&percent_decoded(uri)?)
    }
}

/// Files of a scene's folder.
#[derive(Debug, Clone)]
pub struct Resolver {
    /// Canonical folders whose files may be read; the first is the scene's.
    roots: Vec<PathBuf>,
    /// Canonical folder that paths are relative to.
    base: PathBuf,
    max_file_bytes: u64,
    /// Bytes that may still be read, shared by all views of the same scene.
    budget: Arc<AtomicU64>,
}

impl Resolver {
    /// Files beside `scene_file`, in its folder or below, and in the folders of [`LoadOptions::allow_paths`].
    ///
    /// # Errors
    /// [`Error::Io`] when a folder does not exist.
    pub fn new(scene_file: &Path, options: &LoadOptions) -> Result<Self> {
        let folder = match scene_file.parent() {
            Some(p) if !p.as_os_str().is_empty() => p,
            _ => Path::new("."),
        };
        let base = canonical(folder)?;
        let mut roots = vec![base.clone()];
        for path in &options.allow_paths {
            roots.push(canonical(path)?);
        }
        let budget = Arc::new(AtomicU64::new(options.limits.max_bytes));
        Ok(Self { roots, base, max_file_bytes: options.max_file_bytes, budget })
    }

    /// See [`Files::read`].
    ///
    /// # Errors
    /// As [`Files::read`].
    pub fn read(&self, uri: &str) -> Result<Vec<u8>> {
        Files::read(self, uri)
    }

    fn locate(&self, path: &str) -> Result<PathBuf> {
        let relative = checked(path)?;
        let outside = || {
            let folder = self.roots[0].display();
            let what = format!(
                "lies outside the scene's folder {folder} (--allow-path or LoadOptions::allow_paths lets other folders be read)"
            );
            Err(Error::invalid(format!("reference '{path}'"), what))
        };
        let plain = lexical(&self.base.join(relative));
        // Checked before the file system is asked: whether a file outside exists is none of a scene's business.
        if !self.allows(&plain) {
            return outside();
        }
        let real = canonical(&plain)?;
        // Checked again: a symbolic link may have led outside.
        if self.allows(&real) { Ok(real) } else { outside() }
    }

    fn allows(&self, path: &Path) -> bool {
        self.roots.iter().any(|root| path.starts_with(root))
    }

    fn spend(&self, bytes: u64) -> Result<()> {
        let spent = self.budget.fetch_update(Ordering::Relaxed, Ordering::Relaxed, |b| b.checked_sub(bytes));
        spent.map(drop).map_err(|left| Error::limit("bytes of the scene's files", bytes, left))
    }
}

impl Files for Resolver {
    fn read_path(&self, path: &str) -> Result<Vec<u8>> {
        let file = self.locate(path)?;
        let bytes = read_limited(&file, self.max_file_bytes)?;
        self.spend(bytes.len() as u64)?;
        Ok(bytes)
    }

    fn beside(&self, path: &str) -> Result<Box<dyn Files>> {
        let file = self.locate(path)?;
        let base = file.parent().map_or_else(|| self.base.clone(), Path::to_path_buf);
        Ok(Box::new(Self { base, ..self.clone() }))
    }

    fn identity(&self, path: &str) -> Result<String> {
        Ok(self.locate(path)?.to_string_lossy().into_owned())
    }
}

/// Reads a regular file of at most `limit` bytes, without trusting its size twice.
///
/// # Errors
/// [`Error::Io`], [`Error::LimitExceeded`], [`Error::InvalidInput`] for what is not a regular file.
pub fn read_limited(path: &Path, limit: u64) -> Result<Vec<u8>> {
    let io = |source| Error::Io { path: path.to_path_buf(), source };
    // Asked before opening: opening a pipe would wait for a writer that may never come.
    let metadata = std::fs::metadata(path).map_err(io)?;
    let place = path.display().to_string();
    if !metadata.is_file() {
        return Err(Error::invalid(place, "is not a regular file"));
    }
    if metadata.len() > limit {
        return Err(Error::limit(format!("{place}: bytes of the file"), metadata.len(), limit));
    }
    let mut bytes = Vec::new();
    let size = metadata.len() as usize;
    let full = |_| Error::OutOfMemory { device: "host".into(), bytes: metadata.len() };
    bytes.try_reserve_exact(size).map_err(full)?;
    let file = std::fs::File::open(path).map_err(io)?;
    // The file may have grown meanwhile; one byte more than allowed tells.
    file.take(limit.saturating_add(1)).read_to_end(&mut bytes).map_err(io)?;
    if bytes.len() as u64 > limit {
        return Err(Error::limit(format!("{place}: bytes of the file"), bytes.len() as u64, limit));
    }
    Ok(bytes)
}

/// The error of reading `path`, as seen from the `place` that refers to it.
pub(crate) fn refused(error: Error, place: &str, what: &str, path: &str) -> Error {
    let path = super::text::shown(path.as_bytes());
    match error {
        Error::Io { source, .. } => Error::invalid(place, format!("{what} '{path}' can't be read: {source}")),
        Error::InvalidInput { place: reference, what } => {
            Error::invalid(place, format!("{reference}: {what}"))
        }
        Error::Unsupported(what) => Error::Unsupported(format!("{place}: {what}")),
        other => other,
    }
}

fn canonical(path: &Path) -> Result<PathBuf> {
    path.canonicalize().map_err(|source| Error::Io { path: path.to_path_buf(), source })
}

/// Refuses URLs, and turns Windows separators into `/`.
fn checked(path: &str) -> Result<PathBuf> {
    let refuse = |what: &str| {
        Err(Error::invalid(format!("reference '{}'", super::text::shown(path.as_bytes())), what))
    };
    if path.is_empty() {
        return refuse("names no file");
    }
    if path.contains('\0') {
        return refuse("holds a zero byte");
    }
    let scheme = path.split(['/', '\\']).next().and_then(|first| first.split_once(':')).map(|(s, _)| s);
    match scheme {
        Some(s) if s.len() == 1 => refuse("is an absolute path with a drive letter; use a relative one"),
        Some(s) if !s.is_empty() && s.bytes().all(|b| b.is_ascii_alphanumeric() || b"+-.".contains(&b)) => {
            refuse("is a URL; only files in the scene's folder are read")
        }
        _ => Ok(PathBuf::from(path.replace('\\', "/"))),
    }
}

/// `path` without `.` and `..`, by its text alone.
fn lexical(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for component in path.components() {
        match component {
            Component::CurDir => {}
            Component::ParentDir => {
                plain.pop();
            }
            other => plain.push(other),
        }
    }
    plain
}
