//! The numbers of a PLY body, whatever their encoding.

use super::header::{Encoding, Header, ScalarType};
use crate::io::text;
use twinlight_core::{Error, Result};

/// A cursor over the body. Every value fits an f64 exactly.
pub(super) struct Body<'a> {
    bytes: &'a [u8],
    at: usize,
    encoding: Encoding,
    name: &'a str,
    line: usize,
    line_start: usize,
    /// First byte of the value read last.
    value_at: usize,
}

impl<'a> Body<'a> {
    pub fn new(bytes: &'a [u8], header: &Header, name: &'a str) -> Self {
        let Header { encoding, body, body_line, .. } = *header;
        Self { bytes, at: body, encoding, name, line: body_line, line_start: body, value_at: body }
    }

    /// Bytes not read yet.
    pub fn left(&self) -> u64 {
        (self.bytes.len() - self.at) as u64
    }

    /// `file:line:column` of what comes next in a text, `file: byte N` in a binary file.
    pub fn place(&self) -> String {
        self.place_of(self.at)
    }

    /// The place of the value read last.
    pub fn value_place(&self) -> String {
        self.place_of(self.value_at)
    }

    fn place_of(&self, at: usize) -> String {
        match self.encoding {
            Encoding::Ascii => format!("{}:{}:{}", self.name, self.line, at - self.line_start + 1),
            _ => format!("{}: byte {at}", self.name),
        }
    }

    /// The next value.
    pub fn scalar(&mut self, scalar: ScalarType) -> Result<f64> {
        match self.encoding {
            Encoding::Ascii => self.word(scalar),
            Encoding::LittleEndian => self.binary(scalar, false),
            Encoding::BigEndian => self.binary(scalar, true),
        }
    }

    /// The next value, which counts a list's items of type `item`.
    pub fn count(&mut self, count: ScalarType, item: ScalarType) -> Result<usize> {
        let value = self.scalar(count)?;
        let room = match self.encoding {
            // A separator and a digit each.
            Encoding::Ascii => self.left() / 2,
            _ => self.left() / item.size() as u64,
        };
        if value >= 0.0 && value <= room as f64 {
            return Ok(value as usize);
        }
        let what = format!("a list of {value} items, but the file holds at most {room} more");
        Err(Error::invalid(self.value_place(), what))
    }

    /// Skips `count` values.
    pub fn skip(&mut self, scalar: ScalarType, count: usize) -> Result<()> {
        if self.encoding == Encoding::Ascii {
            for _ in 0..count {
                self.word(scalar)?;
            }
            return Ok(());
        }
        match count.checked_mul(scalar.size()).filter(|&n| n as u64 <= self.left()) {
            Some(length) => {
                self.at += length;
                Ok(())
            }
            None => Err(self.cut_off()),
        }
    }

    fn cut_off(&self) -> Error {
        Error::invalid(self.place(), "the file ends here, before all elements its header promises")
    }

    fn binary(&mut self, scalar: ScalarType, big: bool) -> Result<f64> {
        match scalar {
            ScalarType::I8 => self.take().map(|b| f64::from(i8::from_le_bytes(b))),
            ScalarType::U8 => self.take().map(|b| f64::from(u8::from_le_bytes(b))),
            ScalarType::I16 => self.ordered(big).map(|b| f64::from(i16::from_le_bytes(b))),
            ScalarType::U16 => self.ordered(big).map(|b| f64::from(u16::from_le_bytes(b))),
            ScalarType::I32 => self.ordered(big).map(|b| f64::from(i32::from_le_bytes(b))),
            ScalarType::U32 => self.ordered(big).map(|b| f64::from(u32::from_le_bytes(b))),
            ScalarType::F32 => self.ordered(big).map(|b| f64::from(f32::from_le_bytes(b))),
            ScalarType::F64 => self.ordered(big).map(f64::from_le_bytes),
        }
    }

    #[inline]
    fn take<const N: usize>(&mut self) -> Result<[u8; N]> {
        match self.bytes[self.at..].first_chunk::<N>() {
            Some(&chunk) => {
                self.value_at = self.at;
                self.at += N;
                Ok(chunk)
            }
            None => Err(self.cut_off()),
        }
    }

    #[inline]
    fn ordered<const N: usize>(&mut self, big: bool) -> Result<[u8; N]> {
        let mut chunk = self.take::<N>()?;
        if big {
            chunk.reverse();
        }
        Ok(chunk)
    }

    fn word(&mut self, scalar: ScalarType) -> Result<f64> {
        while let Some(&b) = self.bytes.get(self.at).filter(|b| b.is_ascii_whitespace()) {
            self.at += 1;
            if b == b'\n' {
                self.line += 1;
                self.line_start = self.at;
            }
        }
        let rest = &self.bytes[self.at..];
        let length = rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len());
        if length == 0 {
            return Err(self.cut_off());
        }
        let word = &rest[..length];
        let value = std::str::from_utf8(word).ok().and_then(|t| t.parse::<f64>().ok());
        let Some(value) = value else {
            return Err(Error::invalid(self.place(), format!("'{}' is not a number", text::shown(word))));
        };
        if scalar.is_integer() && value.fract() != 0.0 {
            return Err(Error::invalid(self.place(), format!("'{}' is not an integer", text::shown(word))));
        }
        self.value_at = self.at;
        self.at += length;
        Ok(value)
    }
}
