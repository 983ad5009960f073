//! Where the bytes are: buffers, views, `data:` URIs.

use super::Document;
use crate::io::resolve::refused;
use ::gltf::json::{self, validation::USize64};
use std::borrow::Cow;
use std::cell::OnceCell;
use std::rc::Rc;
use twinlight_core::{Error, Result};

/// The file's buffers, each read when first needed and kept.
pub(super) struct Buffers<'a> {
    binary: Option<&'a [u8]>,
    loaded: Vec<OnceCell<Rc<Cow<'a, [u8]>>>>,
}

impl<'a> Buffers<'a> {
    pub fn new(binary: Option<&'a [u8]>, count: usize) -> Self {
        Self { binary, loaded: (0..count).map(|_| OnceCell::new()).collect() }
    }
}

/// A range of a buffer.
pub(super) struct ViewBytes<'a> {
    buffer: Rc<Cow<'a, [u8]>>,
    range: std::ops::Range<usize>,
    /// Bytes from one element to the next, when the file says so.
    pub stride: Option<usize>,
}

impl ViewBytes<'_> {
    pub fn bytes(&self) -> &[u8] {
        &self.buffer[self.range.clone()]
    }
}

impl<'a> Document<'a> {
    /// The bytes of a buffer view, checked to lie within its buffer.
    pub fn view(&self, index: json::Index<json::buffer::View>, path: &str) -> Result<ViewBytes<'a>> {
        let view = self.get(&self.root.buffer_views, index, "buffer view", path)?;
        let path = format!("bufferViews[{}]", index.value());
        let buffer = self.buffer(view.buffer, &path)?;
        let (offset, length) = (view.byte_offset.unwrap_or_default(), view.byte_length);
        let Some(range) = range_within(offset, length, buffer.len()) else {
            let what = format!("{} bytes from {} of a buffer of {}", length.0, offset.0, buffer.len());
            return Err(self.invalid(&path, what));
        };
        Ok(ViewBytes { buffer, range, stride: view.byte_stride.map(|s| s.0) })
    }

    fn buffer(&self, index: json::Index<json::Buffer>, path: &str) -> Result<Rc<Cow<'a, [u8]>>> {
        let buffer = self.get(&self.root.buffers, index, "buffer", path)?;
        let slot = &self.buffers.loaded[index.value()];
        if let Some(loaded) = slot.get() {
            return Ok(loaded.clone());
        }
        let path = format!("buffers[{}]", index.value());
        let bytes = match (&buffer.uri, self.buffers.binary) {
            (Some(uri), _) => Cow::Owned(self.uri_bytes(uri, &path).map_err(|e| self.unread(e, uri, &path))?),
            (None, Some(binary)) if index.value() == 0 => Cow::Borrowed(binary),
            (None, _) => return Err(self.invalid(&path, "has no URI and is not the binary chunk of a GLB")),
        };
        if (bytes.len() as u64) < buffer.byte_length.0 {
            let what = format!("claims {} bytes, has {}", buffer.byte_length.0, bytes.len());
            return Err(self.invalid(&path, what));
        }
        Ok(slot.get_or_init(|| Rc::new(bytes)).clone())
    }

    /// The bytes behind a URI: in the URI itself, or in a file beside the scene.
    pub fn uri_bytes(&self, uri: &str, path: &str) -> Result<Vec<u8>> {
        let Some(data) = uri.strip_prefix("data:") else { return self.files.read(uri) };
        let Some((kind, text)) = data.split_once(',') else {
            return Err(self.invalid(path, "data URI without a comma"));
        };
        if !kind.ends_with(";base64") {
            let kind: String = kind.chars().take(60).collect();
            return Err(Error::Unsupported(format!(
                "{}: {path}: data URI '{kind}' is not base64",
                self.name
            )));
        }
        self.budget.spend(|| format!("{}: {path}", self.name), text.len() as u64, 1)?;
        base64(text.as_bytes()).map_err(|what| self.invalid(path, what))
    }

    /// An error of [`Self::uri_bytes`] as seen from the element at `path`; those about data URIs say already where they are.
    pub fn unread(&self, error: Error, uri: &str, path: &str) -> Error {
        if uri.starts_with("data:") {
            return error;
        }
        refused(error, &format!("{}: {path}", self.name), "file", uri)
    }
}

/// `offset..offset + length` when it lies within `total` bytes.
fn range_within(offset: USize64, length: USize64, total: usize) -> Option<std::ops::Range<usize>> {
    let end = offset.0.checked_add(length.0).filter(|&end| end <= total as u64)?;
    Some(offset.0 as usize..end as usize)
}

/// Decodes RFC 4648 base64, with or without padding.
fn base64(text: &[u8]) -> std::result::Result<Vec<u8>, String> {
    let unpadded = text.len() - text.iter().rev().take(2).take_while(|&&b| b == b'=').count();
    let text = &text[..unpadded];
    if text.len() % 4 == 1 {
        return Err(format!("base64 of {} characters, which no number of bytes gives", text.len()));
    }
    let mut bytes = Vec::with_capacity(text.len() / 4 * 3 + 2);
    for (i, group) in text.chunks(4).enumerate() {
        let mut bits = 0_u32;
        for (j, &character) in group.iter().enumerate() {
            let Some(value) = sextet(character) else {
                return Err(format!("character {} of the base64 is not one of its alphabet", 4 * i + j + 1));
            };
            bits |= value << (18 - 6 * j);
        }
        bytes.extend_from_slice(&bits.to_be_bytes()[1..group.len()]);
    }
    Ok(bytes)
}

fn sextet(character: u8) -> Option<u32> {
    let value = match character {
        b'A'..=b'Z' => character - b'A',
        b'a'..=b'z' => character - b'a' + 26,
        b'0'..=b'9' => character - b'0' + 52,
        b'+' | b'-' => 62,
        b'/' | b'_' => 63,
        _ => return None,
    };
    Some(u32::from(value))
}

#[cfg(test)]
mod tests {
    use super::{base64, range_within};
    use ::gltf::json::validation::USize64;

    #[test]
    fn base64_of_rfc_4648() {
        let pairs = [
            ("", ""),
            ("Zg==", "f"),
            ("Zm8=", "fo"),
            ("Zm9v", "foo"),
            ("Zm9vYg==", "foob"),
            ("Zm9vYmE=", "fooba"),
            ("Zm9vYmFy", "foobar"),
            ("Zm8", "fo"),
        ];
        for (text, bytes) in pairs {
            assert_eq!(base64(text.as_bytes()), Ok(bytes.as_bytes().to_vec()), "{text}");
        }
        assert_eq!(base64(b"-_+/"), Ok(vec![0xfb, 0xff, 0xbf]));
        for bad in ["Z", "Zg=v", "Zm9v!", "====", "Zm 9"] {
            assert!(base64(bad.as_bytes()).is_err(), "{bad}");
        }
    }

    #[test]
    fn ranges_near_the_largest_number_are_refused() {
        let within = |o, l| range_within(USize64(o), USize64(l), 10);
        assert_eq!(within(4, 6), Some(4..10));
        assert_eq!(within(10, 0), Some(10..10));
        assert_eq!(within(5, 6), None);
        assert_eq!(within(u64::MAX, 1), None);
        assert_eq!(within(1, u64::MAX), None);
        assert_eq!(within(u64::MAX - 2, 4), None);
    }
}
