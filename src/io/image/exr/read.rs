//! Reading EXR files: headers are checked before the pixels' memory is allocated.

use crate::io::image::{Channel, LayeredImage, RgbImage, Samples, guard};
use ::exr::block::reader::Reader;
use ::exr::compression::Compression;
use ::exr::image::read::image::ReadLayers;
use ::exr::image::read::layers::ReadChannels;
use ::exr::image::{FlatImage, FlatSamples};
use ::exr::meta::attribute::{AttributeValue, Text};
use ::exr::meta::compute_chunk_count;
use ::exr::meta::header::Header;
use glam::DMat3;
use std::io::Cursor;
use twinlight_core::scene::{Environment, Limits};
use twinlight_core::{Error, Result};

/// Channels over all layers; more is a broken file, and each has a cost of its own.
const MAX_CHANNELS: usize = 1024;

/// Reads all channels of all layers at full resolution. Halves become floats, integers stay. In a file of several
/// parts a channel is called `part.channel`, which is also what files of one part call it.
///
/// # Errors
/// [`Error::InvalidInput`], [`Error::Unsupported`] (deep data, subsampled channels) or [`Error::LimitExceeded`], naming
/// `name`.
pub fn read_layers(bytes: &[u8], name: &str, limits: &Limits) -> Result<LayeredImage> {
    let reader = open(bytes, name, limits)?;
    let multipart = reader.headers().len() > 1;
    let image: FlatImage = ::exr::image::read::read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .all_layers()
        .all_attributes()
        .non_parallel()
        .from_chunks(reader)
        .map_err(|e| refusal(name, &e))?;
    let size = image.layer_data.first().map_or((0, 0), |l| (l.size.0, l.size.1));
    let mut layered = LayeredImage::new(size.0 as u32, size.1 as u32);
    for layer in image.layer_data {
        let prefix = layer.attributes.layer_name.filter(|_| multipart);
        for channel in layer.channel_data.list {
            let name = match &prefix {
                Some(prefix) => format!("{}.{}", utf8(prefix), utf8(&channel.name)),
                None => utf8(&channel.name),
            };
            let samples = match channel.sample_data {
                FlatSamples::F16(v) => Samples::F32(v.into_iter().map(|h| h.to_f32()).collect()),
                FlatSamples::F32(v) => Samples::F32(v),
                FlatSamples::U32(v) => Samples::U32(v),
            };
            layered.channels.push(Channel { name, samples });
        }
    }
    layered.validate().map_err(|e| Error::invalid(name, e.to_string()))?;
    Ok(layered)
}

/// The metadata that [`super::write`] put into the first part's header, sorted by name. Empty for other programs' files.
///
/// # Errors
/// As [`read_layers`].
pub fn read_attributes(bytes: &[u8], name: &str, limits: &Limits) -> Result<Vec<(String, String)>> {
    let reader = open(bytes, name, limits)?;
    let Some(header) = reader.headers().first() else { return Ok(Vec::new()) };
    let all = header.own_attributes.other.iter().chain(&header.shared_attributes.other);
    let mut pairs: Vec<(String, String)> = all
        .filter_map(|(key, value)| match value {
            AttributeValue::Text(text) => {
                Some((utf8(key).strip_prefix(super::NAMESPACE)?.to_owned(), utf8(text)))
            }
            _ => None,
        })
        .collect();
    pairs.sort();
    Ok(pairs)
}

/// Reads the RGB (or Y) channels of the top level, else of the first layer that has them.
///
/// # Errors
/// As [`read_layers`]; [`Error::InvalidInput`] without such channels, listing those there are.
pub fn read_rgb(bytes: &[u8], name: &str, limits: &Limits) -> Result<RgbImage> {
    let image = read_layers(bytes, name, limits)?;
    let grey = || image.f32_channel("Y").map(|y| y.iter().map(|&v| [v; 3]).collect());
    let first_layer = || {
        let layers = image.channels.iter().filter_map(|c| c.name.strip_suffix(".R"));
        layers.into_iter().find_map(|layer| image.rgb(layer))
    };
    match image.rgb("").or_else(grey).or_else(first_layer) {
        Some(pixels) => Ok(RgbImage { width: image.width, height: image.height, pixels }),
        None => {
            let names: Vec<&str> = image.channels.iter().take(16).map(|c| c.name.as_str()).collect();
            Err(Error::invalid(name, format!("no float channels R, G, B or Y among {}", names.join(", "))))
        }
    }
}

/// Reads a latitude-longitude map. With [`Limits::lenient`] negative and NaN texels become 0 and infinite ones the
/// largest half, 65504; else they are refused.
///
/// # Errors
/// As [`read_rgb`]; [`Error::InvalidInput`] naming the texel that is negative or not finite.
pub fn read_environment(bytes: &[u8], name: &str, limits: &Limits) -> Result<Environment> {
    let mut image = read_rgb(bytes, name, limits)?;
    for (i, texel) in image.pixels.iter_mut().enumerate() {
        for value in texel {
            if value.is_finite() && *value >= 0.0 {
                continue;
            }
            if !limits.lenient {
                let (x, y) = (i % image.width as usize, i / image.width as usize);
                let what = format!("texel ({x}, {y}): radiance {value} is negative or not a number");
                return Err(Error::invalid(name, what));
            }
            *value = if *value == f32::INFINITY { 65504.0 } else { 0.0 };
        }
    }
    if image.height > 8192 {
        return Err(Error::limit(format!("{name}: rows of an environment"), image.height.into(), 8192));
    }
    Ok(Environment {
        width: image.width,
        height: image.height,
        texels: image.pixels,
        scale: 1.0,
        rotation: DMat3::IDENTITY,
    })
}

fn utf8(text: &Text) -> String {
    String::from_utf8_lossy(text.as_slice()).into_owned()
}

type Bytes<'a> = Cursor<&'a [u8]>;

fn open<'a>(bytes: &'a [u8], name: &str, limits: &Limits) -> Result<Reader<Bytes<'a>>> {
    let reader = ::exr::block::read(Cursor::new(bytes), false).map_err(|e| refusal(name, &e))?;
    let headers = reader.headers();
    let channels: usize = headers.iter().map(|h| h.channels.list.len()).sum();
    if channels > MAX_CHANNELS {
        return Err(Error::limit(format!("{name}: channels"), channels as u64, MAX_CHANNELS as u64));
    }
    for header in headers {
        check_header(header, headers, channels, bytes.len(), name, limits)?;
    }
    Ok(reader)
}

fn check_header(
    header: &Header,
    all: &[Header],
    channels: usize,
    file_bytes: usize,
    name: &str,
    limits: &Limits,
) -> Result<()> {
    let (width, height) = (header.layer_size.0, header.layer_size.1);
    // Decoded samples of all channels, at four bytes, beside their copy as they are handed on.
    let per_pixel = channels as u64 * 8;
    guard::check_size(name, (width as u64, height as u64), per_pixel, file_bytes, limits)?;
    if header.layer_size != all[0].layer_size {
        let first = all[0].layer_size;
        let what = format!("layers of different sizes: {}x{} and {width}x{height}", first.0, first.1);
        return Err(Error::invalid(name, what));
    }
    check_compression(header.compression, name)?;
    if let Some(c) = header.channels.list.iter().find(|c| c.sampling.0 != 1 || c.sampling.1 != 1) {
        return Err(Error::Unsupported(format!("{name}: subsampled channel '{}'", c.name)));
    }
    // The reader's tables have as many entries as the header claims, and are indexed by the number computed from the
    // size. Every entry takes 8 bytes, and its chunk's own header at least 8 more.
    let chunks = compute_chunk_count(header.compression, header.layer_size, header.blocks);
    if chunks != header.chunk_count || chunks > file_bytes / 16 {
        let what = format!(
            "{} chunks claimed, {chunks} needed for {width}x{height}, in {file_bytes} bytes",
            header.chunk_count
        );
        return Err(Error::invalid(name, what));
    }
    Ok(())
}

/// The decoders of the other, lossy, methods panic on damaged data (B44 subtracts below zero), and few environments come
/// in them.
fn check_compression(compression: Compression, name: &str) -> Result<()> {
    use Compression::{PIZ, PXR24, RLE, Uncompressed, ZIP1, ZIP16};
    match compression {
        Uncompressed | RLE | ZIP1 | ZIP16 | PIZ | PXR24 => Ok(()),
        other => Err(Error::Unsupported(format!(
            "{name}: {other} compression; none, RLE, ZIP, PIZ and PXR24 are read"
        ))),
    }
}

fn refusal(name: &str, error: &::exr::error::Error) -> Error {
    match error {
        ::exr::error::Error::NotSupported(what) => Error::Unsupported(format!("{name}: {what}")),
        other => Error::invalid(name, format!("EXR: {other}")),
    }
}
