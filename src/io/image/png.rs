//! 8-bit PNG output.

use crate::io::atomic::write_file;
use ::image::codecs::png::PngEncoder;
use ::image::{ExtendedColorType, ImageEncoder};
use std::path::Path;
use twinlight_core::{Error, Result};

/// The bytes of an 8-bit RGB PNG; `pixels` are sRGB, row-major from the top.
///
/// # Errors
/// [`Error::InvalidInput`] when `pixels` are not `width * height`.
pub fn encode(width: u32, height: u32, pixels: &[[u8; 3]]) -> Result<Vec<u8>> {
    if width == 0 || height == 0 || pixels.len() != width as usize * height as usize {
        return Err(Error::invalid("image", format!("{} pixels for {width}x{height}", pixels.len())));
    }
    let mut bytes = Vec::new();
    PngEncoder::new(&mut bytes)
        .write_image(pixels.as_flattened(), width, height, ExtendedColorType::Rgb8)
        .map_err(|e| Error::Internal(format!("PNG encoder: {e}")))?;
    Ok(bytes)
}

/// Writes an 8-bit RGB PNG; the file at `path` is the old one or the whole new one.
///
/// # Errors
/// Those of [`encode`]; [`Error::Io`].
pub fn write(path: &Path, width: u32, height: u32, pixels: &[[u8; 3]]) -> Result<()> {
    write_file(path, &encode(width, height, pixels)?)
}
