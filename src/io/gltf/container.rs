//! From bytes to JSON records and the binary chunk.

use ::gltf::json::Root;
use twinlight_core::{Error, Result};

/// A file taken apart.
pub(super) struct Container<'a> {
    pub root: Root,
    /// The BIN chunk of a GLB.
    pub binary: Option<&'a [u8]>,
}

/// Splits a GLB (or takes the whole as JSON) and parses the JSON.
pub(super) fn open<'a>(bytes: &'a [u8], name: &str, max_bytes: u64) -> Result<Container<'a>> {
    let (text, binary) = if bytes.starts_with(b"glTF") { split(bytes, name)? } else { (bytes, None) };
    check_records(text, name, max_bytes)?;
    let root = Root::from_slice(strip_bom(text)).map_err(|e| {
        let place = format!("{name}:{}:{}", e.line(), e.column());
        Error::invalid(place, format!("JSON: {e}"))
    })?;
    if root.asset.version.split('.').next() != Some("2") {
        let version: String = root.asset.version.chars().take(20).collect();
        return Err(Error::Unsupported(format!("{name}: glTF version '{version}', only 2.x is read")));
    }
    Ok(Container { root, binary })
}

fn strip_bom(text: &[u8]) -> &[u8] {
    text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(text)
}

/// Two bytes of text, `{}`, become a record of some hundred bytes; two bytes of an array become a value of 32. The text
/// is held against the limit as if it were as bad as that.
fn check_records(text: &[u8], name: &str, max_bytes: u64) -> Result<()> {
    const RECORD_BYTES: u64 = 1024;
    const VALUE_BYTES: u64 = 16;
    let records = text.iter().filter(|&&b| b == b'{').count() as u64;
    let needed = records * RECORD_BYTES + text.len() as u64 * VALUE_BYTES;
    if needed > max_bytes {
        return Err(Error::limit(format!("{name}: bytes of the parsed JSON"), needed, max_bytes));
    }
    Ok(())
}

type Chunks<'a> = (&'a [u8], Option<&'a [u8]>);

/// The JSON chunk and the BIN chunk. Lengths that reach beyond the file are errors.
fn split<'a>(bytes: &'a [u8], name: &str) -> Result<Chunks<'a>> {
    let word =
        |at: usize| -> Option<u32> { Some(u32::from_le_bytes(bytes.get(at..at + 4)?.try_into().ok()?)) };
    let broken = |what: String| Error::invalid(name, format!("GLB: {what}"));
    let (Some(version), Some(length)) = (word(4), word(8)) else {
        return Err(broken(format!("{} bytes, the header alone has 12", bytes.len())));
    };
    if version != 2 {
        return Err(Error::Unsupported(format!("{name}: GLB version {version}, only 2 is read")));
    }
    if length as usize > bytes.len() {
        return Err(broken(format!("claims {length} bytes, has {}", bytes.len())));
    }
    let (mut json, mut binary) = (None, None);
    let mut at = 12_usize;
    while at < length as usize {
        let (Some(size), Some(kind)) = (word(at), word(at + 4)) else {
            return Err(broken(format!("chunk header at byte {at} is cut off")));
        };
        let Some(data) = bytes.get(at + 8..).and_then(|rest| rest.get(..size as usize)) else {
            return Err(broken(format!("chunk at byte {at} claims {size} bytes beyond the end")));
        };
        match &kind.to_le_bytes() {
            b"JSON" if json.is_none() => json = Some(data),
            b"BIN\0" if binary.is_none() => binary = Some(data),
            // The format asks readers to skip chunks they don't know.
            _ => {}
        }
        at += 8 + size as usize;
    }
    json.map(|json| (json, binary)).ok_or_else(|| broken("no JSON chunk".into()))
}
