//! Evidence files: both buffers, raw and little-endian.

use bytemuck::Pod;
use std::path::Path;

/// Writes `<name>.<what>.{got,want}.bin`; returns what to add to the message.
pub(super) fn pair<T: Pod>(folder: &Path, name: &str, what: &str, got: &[T], want: &[T]) -> String {
    let stem: String = format!("{name}.{what}")
        .chars()
        .map(|c| if c.is_ascii_alphanumeric() || c == '.' { c } else { '_' })
        .collect();
    let write = |role: &str, data: &[T]| {
        let path = folder.join(format!("{stem}.{role}.bin"));
        std::fs::write(&path, bytemuck::cast_slice::<T, u8>(data)).map(|()| path)
    };
    let written =
        std::fs::create_dir_all(folder).and_then(|()| Ok((write("got", got)?, write("want", want)?)));
    match written {
        Ok((got, want)) => format!("\n  buffers: {} and {}", got.display(), want.display()),
        // The evidence in the message still stands; a full disk must not hide it.
        Err(error) => format!("\n  buffers not written to {}: {error}", folder.display()),
    }
}
