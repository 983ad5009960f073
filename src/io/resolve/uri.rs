//! URI references.

use crate::io::text;
use twinlight_core::{Error, Result};

/// Decodes `%XX`.
///
/// # Errors
/// [`Error::InvalidInput`] naming the URI when a `%` is not followed by two hexadecimal digits, or the decoded bytes
/// are not UTF-8.
pub fn percent_decoded(uri: &str) -> Result<String> {
    let place = || format!("URI '{}'", text::shown(uri.as_bytes()));
    let mut bytes = Vec::with_capacity(uri.len());
    let mut rest = uri.as_bytes();
    while let [first, tail @ ..] = rest {
        rest = tail;
        if *first != b'%' {
            bytes.push(*first);
            continue;
        }
        let digits = tail.first_chunk::<2>().map(|d| d.map(|b| char::from(b).to_digit(16)));
        let Some([Some(high), Some(low)]) = digits else {
            let at = uri.len() - tail.len() - 1;
            return Err(Error::invalid(
                place(),
                format!("'%' at byte {at} is not followed by two hexadecimal digits"),
            ));
        };
        bytes.push((high * 16 + low) as u8);
        rest = &tail[2..];
    }
    String::from_utf8(bytes).map_err(|_| Error::invalid(place(), "its percent-encoding is not UTF-8"))
}
