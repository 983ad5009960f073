//! The corners of a face: `v`, `v/vt`, `v//vn`, `v/vt/vn`.

use crate::io::text::{self, Token};
use twinlight_core::Result;

/// The indices of `v/vt/vn` from 1; negative ones, which count back from the last, resolved.
pub(super) fn parse(token: Token<'_>, counts: [usize; 3], name: &str) -> Result<[Option<usize>; 3]> {
    const OF: [&str; 3] = ["vertex", "texture coordinate", "normal"];
    let mut indices = [None; 3];
    if token.bytes.iter().filter(|&&b| b == b'/').count() > 2 {
        return Err(token.error(name, format!("'{}' is not of the form v/vt/vn", token.shown())));
    }
    for (i, part) in token.bytes.split(|&b| b == b'/').enumerate() {
        if part.is_empty() {
            continue;
        }
        let Some(index) = integer(part) else {
            let (part, of) = (text::shown(part), OF[i]);
            return Err(
                token.error(name, format!("{of} index '{part}' in '{}' is not an integer", token.shown()))
            );
        };
        let count = counts[i] as i64;
        let resolved = if index < 0 { count + 1 + index } else { index };
        if !(1..=count).contains(&resolved) {
            let reason = if index == 0 {
                "indices count from 1".into()
            } else {
                format!("{count} are defined so far")
            };
            return Err(
                token.error(name, format!("{} index {index} in '{}': {reason}", OF[i], token.shown()))
            );
        }
        indices[i] = Some(resolved as usize);
    }
    if indices[0].is_none() {
        return Err(token.error(name, format!("'{}' has no vertex index", token.shown())));
    }
    Ok(indices)
}

/// A decimal integer of at most 15 digits.
fn integer(text: &[u8]) -> Option<i64> {
    let (negative, digits) = match text {
        [b'-', digits @ ..] => (true, digits),
        [b'+', digits @ ..] => (false, digits),
        digits => (false, digits),
    };
    if digits.is_empty() || digits.len() > 15 || !digits.iter().all(u8::is_ascii_digit) {
        return None;
    }
    let value = digits.iter().fold(0, |n, d| n * 10 + i64::from(d - b'0'));
    Some(if negative { -value } else { value })
}

pub(super) fn push_integer(text: &mut Vec<u8>, mut value: usize) {
    let mut digits = [0; 20];
    let mut at = digits.len();
    loop {
        at -= 1;
        digits[at] = b'0' + (value % 10) as u8;
        value /= 10;
        if value == 0 {
            break;
        }
    }
    text.extend_from_slice(&digits[at..]);
}
