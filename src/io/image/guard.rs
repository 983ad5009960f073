//! What a header may promise.

use twinlight_core::scene::Limits;
use twinlight_core::{Error, Result};

/// Decoded bytes per file byte beyond which a file is a bomb. Deflate reaches 1032; a constant picture in PIZ or
/// JPEG's progressive mode can go further, which [`FREE_BYTES`] leaves room for.
const MAX_EXPANSION: u64 = 4096;

/// Decoded bytes that any file may ask for, however short.
const FREE_BYTES: u64 = 256 << 20;

/// Checks the size in a header before anything of that size is allocated: `width` × `height` pixels of
/// `bytes_per_pixel` decoded bytes, from a file of `file_bytes`.
pub(super) fn check_size(
    name: &str,
    (width, height): (u64, u64),
    bytes_per_pixel: u64,
    file_bytes: usize,
    limits: &Limits,
) -> Result<()> {
    let side = u64::from(super::MAX_SIDE);
    if width == 0 || height == 0 {
        return Err(Error::invalid(name, format!("size {width}x{height} has no pixels")));
    }
    if width.max(height) > side {
        return Err(Error::limit(format!("{name}: pixels of the longest side"), width.max(height), side));
    }
    // Both sides are at most 2^14, so only the bytes per pixel can make the product overflow.
    let needed = (width * height).saturating_mul(bytes_per_pixel);
    if needed > limits.max_bytes {
        return Err(Error::limit(format!("{name}: decoded bytes"), needed, limits.max_bytes));
    }
    let plausible = FREE_BYTES + (file_bytes as u64).saturating_mul(MAX_EXPANSION);
    if needed > plausible {
        let what = format!("{name}: decoded bytes of a file of {file_bytes} bytes");
        return Err(Error::limit(what, needed, plausible));
    }
    Ok(())
}
