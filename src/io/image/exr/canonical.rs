//! One order of attributes. The encoder keeps them in a hash map whose order changes from run to run; files that should
//! be the same would differ.

use std::ops::Range;
use twinlight_core::{Error, Result};

/// Magic number and version.
const PREAMBLE: usize = 8;

/// Sorts the attributes of a single-part file's header by name. Sizes don't change, so the chunk offsets stay right.
pub(super) fn sort_attributes(file: &mut [u8]) -> Result<()> {
    let broken = || Error::Internal("the EXR encoder wrote a header without an end".into());
    let (mut attributes, end) = attributes(file).ok_or_else(broken)?;
    attributes.sort_by(|a, b| file[a.clone()].cmp(&file[b.clone()]));
    let sorted: Vec<u8> = attributes.into_iter().flat_map(|a| file[a].iter().copied()).collect();
    file[PREAMBLE..end].copy_from_slice(&sorted);
    Ok(())
}

/// The byte ranges of the attributes (name, zero, type, zero, length, value) and the end of the last.
fn attributes(file: &[u8]) -> Option<(Vec<Range<usize>>, usize)> {
    let mut ranges = Vec::new();
    let mut start = PREAMBLE;
    while *file.get(start)? != 0 {
        let after_name = start + text_length(file.get(start..)?)? + 1;
        let after_type = after_name + text_length(file.get(after_name..)?)? + 1;
        let length = file.get(after_type..after_type + 4)?.try_into().ok()?;
        let end = after_type + 4 + u32::from_le_bytes(length) as usize;
        ranges.push(start..end);
        start = end;
    }
    Some((ranges, start))
}

fn text_length(bytes: &[u8]) -> Option<usize> {
    bytes.iter().position(|&b| b == 0)
}
