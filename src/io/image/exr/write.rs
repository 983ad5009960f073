//! Writing EXR files: one part, all channels, floats and integers as they are.

use super::NAMESPACE;
use super::canonical::sort_attributes;
use crate::io::atomic::write_file;
use crate::io::image::{LayeredImage, Samples};
use ::exr::compression::Compression;
use ::exr::image::write::WritableImage;
use ::exr::image::{AnyChannel, AnyChannels, Blocks, Encoding, FlatSamples, Image, Layer};
use ::exr::meta::attribute::{AttributeValue, LineOrder, Text};
use ::exr::meta::header::LayerAttributes;
use std::io::Cursor;
use std::path::Path;
use twinlight_core::{Error, Result};

/// The bytes of an EXR file: every channel of `image` (ZIP over 16 lines, lossless) and `metadata` as text attributes
/// of the header, their names behind [`NAMESPACE`]. The same input gives the same bytes.
///
/// # Errors
/// [`Error::InvalidInput`] for an inconsistent image, an empty or too long name or one that occurs twice.
pub fn encode(image: &LayeredImage, metadata: &[(&str, &str)]) -> Result<Vec<u8>> {
    image.validate()?;
    let mut attributes = LayerAttributes::default();
    for &(key, value) in metadata {
        check_key(key)?;
        let previous =
            attributes.other.insert(text(&format!("{NAMESPACE}{key}")), AttributeValue::Text(text(value)));
        if previous.is_some() {
            return Err(Error::invalid(format!("attribute '{key}'"), "occurs twice"));
        }
    }
    let channels = image.channels.iter().map(|channel| {
        let samples = match &channel.samples {
            Samples::F32(v) => FlatSamples::F32(v.clone()),
            Samples::U32(v) => FlatSamples::U32(v.clone()),
        };
        AnyChannel::new(text(&channel.name), samples)
    });
    let encoding = Encoding {
        compression: Compression::ZIP16,
        blocks: Blocks::ScanLines,
        line_order: LineOrder::Increasing,
    };
    let size = (image.width as usize, image.height as usize);
    let layer = Layer::new(size, attributes, encoding, AnyChannels::sort(channels.collect()));
    let mut bytes = Cursor::new(Vec::new());
    Image::from_layer(layer)
        .write()
        .to_buffered(&mut bytes)
        .map_err(|e| Error::invalid("image", format!("EXR: {e}")))?;
    let mut bytes = bytes.into_inner();
    sort_attributes(&mut bytes)?;
    Ok(bytes)
}

/// Writes what [`encode`] returns; the file at `path` is the old one or the whole new one.
///
/// # Errors
/// Those of [`encode`]; [`Error::Io`].
pub fn write(path: &Path, image: &LayeredImage, metadata: &[(&str, &str)]) -> Result<()> {
    write_file(path, &encode(image, metadata)?)
}

fn check_key(key: &str) -> Result<()> {
    let place = format!("attribute '{key}'");
    if key.is_empty() || key.len() > 200 || key.contains('\0') {
        return Err(Error::invalid(place, "a name has 1 to 200 bytes and no zero"));
    }
    Ok(())
}

/// The format leaves the encoding open; other readers take UTF-8.
fn text(text: &str) -> Text {
    Text::from_slice_unchecked(text.as_bytes())
}
