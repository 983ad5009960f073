//! Pictures: textures and environments in, renders out.
//!
//! Files are hostile: sizes in headers are checked against the limits and against what a file of that length can hold
//! before anything of that size is allocated; nothing panics.

pub mod exr;
mod guard;
mod layered;
pub mod png;
mod raster;

pub use exr::{read_environment as read_exr_environment, read_layers};
pub use layered::{Channel, LayeredImage, RgbImage, Samples};
pub use raster::decode_texture;

use twinlight_core::Result;
use twinlight_core::scene::Limits;

/// Longest side of a picture that is read or written, pixels.
pub const MAX_SIDE: u32 = 16384;

/// Reads linear RGB from an EXR (channels R, G, B of the first layer, or Y) or from a PNG or JPEG (sRGB, decoded).
/// The format is recognised by the first bytes, not by the name.
///
/// # Errors
/// [`twinlight_core::Error::InvalidInput`], [`twinlight_core::Error::Unsupported`] or
/// [`twinlight_core::Error::LimitExceeded`], naming `name`.
pub fn read_rgb(bytes: &[u8], name: &str, limits: &Limits) -> Result<RgbImage> {
    if bytes.starts_with(&exr::MAGIC) {
        exr::read_rgb(bytes, name, limits)
    } else {
        raster::decode_linear(bytes, name, limits)
    }
}
