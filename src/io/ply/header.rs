//! The header of a PLY file: what its body holds, in which order.

use crate::io::text::{self, Line, Token};
use twinlight_core::{Error, Result};

/// Longest header, bytes: none in use comes near, and a file without `end_header` is told apart early.
const MAX_HEADER: usize = 1 << 16;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Encoding {
    Ascii,
    LittleEndian,
    BigEndian,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ScalarType {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl ScalarType {
    fn named(name: &[u8]) -> Option<Self> {
        Some(match name {
            b"char" | b"int8" => Self::I8,
            b"uchar" | b"uint8" => Self::U8,
            b"short" | b"int16" => Self::I16,
            b"ushort" | b"uint16" => Self::U16,
            b"int" | b"int32" => Self::I32,
            b"uint" | b"uint32" => Self::U32,
            b"float" | b"float32" => Self::F32,
            b"double" | b"float64" => Self::F64,
            _ => return None,
        })
    }

    pub fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    pub fn is_integer(self) -> bool {
        !matches!(self, Self::F32 | Self::F64)
    }
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Property {
    pub name: String,
    pub scalar: ScalarType,
    /// The type of the count, for a list.
    pub count: Option<ScalarType>,
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Element {
    pub name: String,
    pub count: u64,
    pub properties: Vec<Property>,
}

impl Element {
    /// Fewest bytes one of these takes in the body.
    pub fn least_bytes(&self, encoding: Encoding) -> u64 {
        let of = |p: &Property| match encoding {
            // A digit and a separator.
            Encoding::Ascii => 2,
            _ => p.count.unwrap_or(p.scalar).size() as u64,
        };
        self.properties.iter().map(of).sum()
    }
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Header {
    pub encoding: Encoding,
    pub elements: Vec<Element>,
    /// First byte of the body.
    pub body: usize,
    /// Number of the body's first line.
    pub body_line: usize,
}

/// Reads the header.
pub(super) fn parse(bytes: &[u8], name: &str) -> Result<Header> {
    let mut encoding = None;
    let mut elements: Vec<Element> = Vec::new();
    let mut at = 0;
    for number in 1.. {
        let rest = &bytes[at.min(bytes.len())..];
        if rest.is_empty() || at > MAX_HEADER {
            return Err(Error::invalid(format!("{name}:{number}:1"), "the header has no 'end_header'"));
        }
        let length = rest.iter().position(|&b| b == b'\n').unwrap_or(rest.len());
        at += length + 1;
        let line = Line { bytes: &rest[..length], number };
        let mut tokens = line.tokens();
        let first = tokens.next();
        if number == 1 {
            if first.is_none_or(|t| t.bytes != b"ply") {
                let what = format!("a PLY file begins with 'ply', not with '{}'", text::shown(line.bytes));
                return Err(Error::invalid(format!("{name}:1:1"), what));
            }
            continue;
        }
        let Some(key) = first else { continue };
        match key.bytes {
            b"comment" | b"obj_info" => {}
            b"format" => encoding = Some(format(key, tokens, name)?),
            b"element" => elements.push(element(key, tokens, &elements, name)?),
            b"property" => {
                let Some(element) = elements.last_mut() else {
                    return Err(key.error(name, "a property before the first element"));
                };
                let property = property(key, tokens, name)?;
                if element.properties.iter().any(|p| p.name == property.name) {
                    let what =
                        format!("property '{}' of element '{}' is there twice", property.name, element.name);
                    return Err(key.error(name, what));
                }
                element.properties.push(property);
            }
            b"end_header" => {
                let Some(encoding) = encoding else {
                    return Err(key.error(name, "the header has no 'format' line"));
                };
                return Ok(Header { encoding, elements, body: at.min(bytes.len()), body_line: number + 1 });
            }
            _ => {
                let known = ["format", "element", "property", "comment", "end_header"];
                let hint = text::did_you_mean(&key.shown(), known);
                return Err(key.error(name, format!("unknown header line '{}'{hint}", key.shown())));
            }
        }
    }
    Err(Error::invalid(name, "the header does not end"))
}

fn needed<'t>(
    tokens: &mut impl Iterator<Item = Token<'t>>,
    key: Token<'t>,
    what: &str,
    name: &str,
) -> Result<Token<'t>> {
    tokens.next().ok_or_else(|| key.error(name, format!("'{}' without its {what}", key.shown())))
}

fn format<'t>(key: Token<'t>, mut tokens: impl Iterator<Item = Token<'t>>, name: &str) -> Result<Encoding> {
    let word = needed(&mut tokens, key, "encoding", name)?;
    match word.bytes {
        b"ascii" => Ok(Encoding::Ascii),
        b"binary_little_endian" => Ok(Encoding::LittleEndian),
        b"binary_big_endian" => Ok(Encoding::BigEndian),
        _ => {
            let known = ["ascii", "binary_little_endian", "binary_big_endian"];
            let hint = text::did_you_mean(&word.shown(), known);
            Err(word.error(name, format!("unknown encoding '{}'{hint}", word.shown())))
        }
    }
}

fn element<'t>(
    key: Token<'t>,
    mut tokens: impl Iterator<Item = Token<'t>>,
    earlier: &[Element],
    name: &str,
) -> Result<Element> {
    let label = needed(&mut tokens, key, "name", name)?;
    let count = needed(&mut tokens, key, "count", name)?;
    let parsed = std::str::from_utf8(count.bytes).ok().and_then(|t| t.parse::<u64>().ok());
    let Some(number) = parsed else {
        return Err(count.error(name, format!("'{}' is not a count of elements", count.shown())));
    };
    if earlier.iter().any(|e| e.name.as_bytes() == label.bytes) {
        return Err(label.error(name, format!("element '{}' is there twice", label.shown())));
    }
    Ok(Element {
        name: String::from_utf8_lossy(label.bytes).into_owned(),
        count: number,
        properties: Vec::new(),
    })
}

fn property<'t>(key: Token<'t>, mut tokens: impl Iterator<Item = Token<'t>>, name: &str) -> Result<Property> {
    let scalar = |token: Token<'t>| {
        ScalarType::named(token.bytes)
            .ok_or_else(|| token.error(name, format!("unknown scalar type '{}'", token.shown())))
    };
    let first = needed(&mut tokens, key, "type", name)?;
    let (count, first) = if first.bytes == b"list" {
        let token = needed(&mut tokens, key, "count type", name)?;
        let count = scalar(token)?;
        if !count.is_integer() {
            return Err(token.error(name, format!("a list can't be counted in '{}'", token.shown())));
        }
        (Some(count), needed(&mut tokens, key, "item type", name)?)
    } else {
        (None, first)
    };
    let label = needed(&mut tokens, key, "name", name)?;
    Ok(Property { name: String::from_utf8_lossy(label.bytes).into_owned(), scalar: scalar(first)?, count })
}
