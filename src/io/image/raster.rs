//! PNG and JPEG.

use super::{RgbImage, guard};
use ::image::{DynamicImage, ImageDecoder, ImageError, ImageReader};
use std::io::Cursor;
use twinlight_core::scene::{Limits, Texture, Wrap};
use twinlight_core::{Error, Result, srgb};

/// Decodes a PNG or JPEG into an 8-bit sRGB texture (grey is spread over RGB, missing alpha is opaque, 16 bits are
/// rounded to 8) that repeats. The format is recognised by the first bytes.
///
/// # Errors
/// [`Error::InvalidInput`], [`Error::Unsupported`] or [`Error::LimitExceeded`] (longest side [`super::MAX_SIDE`]),
/// naming `name`.
pub fn decode_texture(bytes: &[u8], name: &str, limits: &Limits) -> Result<Texture> {
    let rgba = decode(bytes, name, limits)?.into_rgba8();
    let (width, height) = rgba.dimensions();
    let texels = rgba.pixels().map(|p| p.0).collect();
    Ok(Texture { name: name.to_owned(), width, height, texels, wrap: Wrap::Repeat })
}

/// Linear RGB of a PNG or JPEG, with all the bits the file has.
pub(super) fn decode_linear(bytes: &[u8], name: &str, limits: &Limits) -> Result<RgbImage> {
    let encoded = decode(bytes, name, limits)?.into_rgb32f();
    let (width, height) = encoded.dimensions();
    let pixels = encoded.pixels().map(|p| p.0.map(|c| srgb::decode(f64::from(c)) as f32)).collect();
    Ok(RgbImage { width, height, pixels })
}

fn decode(bytes: &[u8], name: &str, limits: &Limits) -> Result<DynamicImage> {
    let mut reader = ImageReader::new(Cursor::new(bytes))
        .with_guessed_format()
        .map_err(|e| Error::invalid(name, format!("unreadable picture: {e}")))?;
    if reader.format().is_none() {
        let what =
            format!("{name}: neither PNG nor JPEG (first bytes {:02x?})", &bytes[..bytes.len().min(8)]);
        return Err(Error::Unsupported(what));
    }
    let mut decoder_limits = ::image::Limits::default();
    decoder_limits.max_image_width = Some(super::MAX_SIDE);
    decoder_limits.max_image_height = Some(super::MAX_SIDE);
    decoder_limits.max_alloc = Some(limits.max_bytes);
    reader.limits(decoder_limits);
    let decoder = reader.into_decoder().map_err(|e| refusal(name, &e))?;
    let (width, height) = decoder.dimensions();
    // The decoded picture and its conversion (to RGBA8, or to three floats) exist side by side.
    let per_pixel = u64::from(decoder.color_type().bytes_per_pixel()) + 12;
    guard::check_size(name, (width.into(), height.into()), per_pixel, bytes.len(), limits)?;
    DynamicImage::from_decoder(decoder).map_err(|e| refusal(name, &e))
}

fn refusal(name: &str, error: &ImageError) -> Error {
    match error {
        ImageError::Unsupported(e) => Error::Unsupported(format!("{name}: {e}")),
        other => Error::invalid(name, other.to_string()),
    }
}
