//! Files that are either the old ones or the new ones, never half of each.

use std::ffi::OsString;
use std::fs::{File, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};
use twinlight_core::{Error, Result};

/// Writes `bytes` to `path`: into a temporary file in the same folder, flushed to the disk, then renamed. An
/// interrupted or failed write leaves whatever was at `path` before.
///
/// # Errors
/// [`Error::Io`] with the system's reason; [`Error::InvalidInput`] when `path` names no file.
pub fn write_file(path: &Path, bytes: &[u8]) -> Result<()> {
    let temporary = temporary_beside(path)?;
    let io = |source| Error::Io { path: path.to_path_buf(), source };
    let written = write_synced(&temporary, bytes).and_then(|()| std::fs::rename(&temporary, path));
    if let Err(error) = written {
        // The first error is the one that matters; a left-over temporary file is only untidy.
        let _ = std::fs::remove_file(&temporary);
        return Err(io(error));
    }
    sync_folder(path);
    Ok(())
}

fn write_synced(path: &Path, bytes: &[u8]) -> std::io::Result<()> {
    // `create_new` refuses to follow a link that someone else placed under our name.
    let mut file = OpenOptions::new().write(true).create_new(true).open(path)?;
    file.write_all(bytes)?;
    file.sync_all()
}

/// Makes the rename itself durable. Not every system can open a folder, and the file is valid without it.
fn sync_folder(path: &Path) {
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if let Ok(folder) = File::open(folder) {
        let _ = folder.sync_all();
    }
}

/// A name no other writer uses: process id and a counter, hidden on Unix.
fn temporary_beside(path: &Path) -> Result<PathBuf> {
    static COUNTER: AtomicU32 = AtomicU32::new(0);
    let Some(file_name) = path.file_name() else {
        return Err(Error::invalid(path.display().to_string(), "is not the name of a file"));
    };
    let mut name = OsString::from(".");
    name.push(file_name);
    name.push(format!(".{}-{}.tmp", std::process::id(), COUNTER.fetch_add(1, Ordering::Relaxed)));
    Ok(path.with_file_name(name))
}
