//! From the text of a stranger's OBJ file to text that `tobj` can read without surprises.
//!
//! tobj gives errors without a position, accepts `nan`, panics on some index underflows, and misaligns vertex attributes
//! when faces with and without texture coordinates share a group. This pass checks every number and index against what
//! the file has defined so far, names line, column and value of the first bad one, and passes on only what tobj handles
//! well: three numbers per vertex, faces of one kind per group, groups and materials by number.

use super::library::Library;
use crate::io::LoadOptions;
use crate::io::text::{self, Line, Token};
use std::collections::BTreeMap;
use twinlight_core::{Error, Result};

/// Statements that draw something other than faces.
const NOT_DRAWN: [&str; 16] = [
    "l", "p", "vp", "curv", "curv2", "surf", "cstype", "deg", "bmat", "step", "parm", "trim", "hole", "scrv",
    "sp", "end",
];
/// Statements without effect here.
const WITHOUT_EFFECT: [&str; 17] = [
    "s",
    "mg",
    "con",
    "bevel",
    "c_interp",
    "d_interp",
    "lod",
    "usemap",
    "maplib",
    "shadow_obj",
    "trace_obj",
    "ctech",
    "stech",
    "call",
    "csh",
    "res",
    "cdc",
];
const USED: [&str; 8] = ["v", "vt", "vn", "f", "o", "g", "mtllib", "usemtl"];

/// Text for tobj, and what its numbers stand for.
#[derive(Debug, Default)]
pub(super) struct Checked {
    pub text: Vec<u8>,
    /// Names of the groups `g 0`, `g 1`, …
    pub groups: Vec<String>,
    pub triangles: u64,
}

/// Which of texture coordinates and normals all corners of a face have.
type FaceKind = (bool, bool);

/// Checks the whole text; material libraries are read on the way.
pub(super) fn check(
    bytes: &[u8],
    name: &str,
    options: &LoadOptions,
    library: &mut Library<'_>,
) -> Result<Checked> {
    if bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff") {
        return Err(Error::invalid(format!("{name}:1:1"), "the file is UTF-16; save it as UTF-8"));
    }
    let mut pass = Pass {
        name,
        options,
        checked: Checked::default(),
        counts: [0; 3],
        recognised: false,
        left_out: LeftOut::default(),
        group: String::new(),
        kind: None,
        material: None,
        written_material: None,
    };
    pass.checked
        .text
        .try_reserve(bytes.len() + bytes.len() / 8)
        .map_err(|_| Error::OutOfMemory { device: "host".into(), bytes: bytes.len() as u64 })?;
    pass.checked.text.extend_from_slice(b"mtllib numbered\n");
    let mut joined = Vec::new();
    for line in text::lines(bytes) {
        // A backslash continues the statement on the next line; columns then count along the joined line.
        if let Some(part) = line.bytes.trim_ascii_end().strip_suffix(b"\\") {
            joined.extend_from_slice(part);
            joined.push(b' ');
        } else if joined.is_empty() {
            pass.statement(line, library)?;
        } else {
            joined.extend_from_slice(line.bytes);
            pass.statement(Line { bytes: &joined, ..line }, library)?;
            joined.clear();
        }
    }
    if !joined.is_empty() {
        return Err(Error::invalid(name, "the last line ends with a backslash: its statement is cut off"));
    }
    pass.finish(library)
}

/// What is left out, and how often.
#[derive(Default)]
struct LeftOut {
    colors: usize,
    small_faces: usize,
    partial_faces: usize,
    statements: BTreeMap<&'static str, usize>,
    unknown: Vec<String>,
    unknown_count: usize,
}

struct Pass<'a> {
    name: &'a str,
    options: &'a LoadOptions,
    checked: Checked,
    /// Positions, texture coordinates and normals so far.
    counts: [usize; 3],
    recognised: bool,
    left_out: LeftOut,
    group: String,
    /// Attributes of the faces of the group that is being written; `None` before its first face.
    kind: Option<FaceKind>,
    material: Option<u32>,
    written_material: Option<u32>,
}

impl Pass<'_> {
    fn statement(&mut self, line: Line<'_>, library: &mut Library<'_>) -> Result<()> {
        let mut tokens = line.tokens();
        let Some(key) = tokens.next() else { return Ok(()) };
        match key.bytes {
            b"v" => self.vertex(key, tokens)?,
            b"vt" => self.texture_coordinate(key, tokens)?,
            b"vn" => self.normal(key, tokens)?,
            b"f" | b"fo" => self.face(tokens, library)?,
            b"o" | b"g" => {
                let label = tokens.next().map(|t| line.rest_from(t).bytes).unwrap_or_default();
                self.group = String::from_utf8_lossy(label).into_owned();
                self.kind = None;
            }
            b"mtllib" => library.load(name_after(line, key, tokens, self.name)?, self.name)?,
            b"usemtl" => {
                let label = name_after(line, key, tokens, self.name)?;
                self.material = Some(library.index_of(label, self.name)?);
            }
            _ => return self.other(key),
        }
        self.recognised = true;
        Ok(())
    }

    fn vertex<'t>(&mut self, key: Token<'t>, mut tokens: impl Iterator<Item = Token<'t>>) -> Result<()> {
        self.checked.text.extend_from_slice(b"v");
        self.numbers(key, &mut tokens, ["x", "y", "z"])?;
        let extra: Vec<Token<'_>> = tokens.take(5).collect();
        match extra[..] {
            [] => {}
            [w] | [w, _, _, _] => {
                let weight = text::number(w, "weight", self.name, false)?;
                if weight == 0.0 {
                    return Err(w.error(self.name, "weight 0 puts the vertex at infinity"));
                }
                self.pass_on(w);
                self.left_out.colors += usize::from(extra.len() > 1);
            }
            [_, _, _] => self.left_out.colors += 1,
            _ => {
                let what = "a vertex has 3 coordinates, or 4, either with 3 colours or without";
                return Err(extra[extra.len() - 1].error(self.name, what));
            }
        }
        self.end_line();
        self.counts[0] += 1;
        Ok(())
    }

    fn texture_coordinate<'t>(
        &mut self,
        key: Token<'t>,
        mut tokens: impl Iterator<Item = Token<'t>>,
    ) -> Result<()> {
        self.checked.text.extend_from_slice(b"vt");
        self.numbers(key, &mut tokens, ["u"])?;
        match tokens.next() {
            Some(v) => {
                text::number(v, "v", self.name, self.options.limits.lenient)?;
                self.pass_on(v);
            }
            None => self.checked.text.extend_from_slice(b" 0"),
        }
        self.end_line();
        self.counts[1] += 1;
        Ok(())
    }

    fn normal<'t>(&mut self, key: Token<'t>, mut tokens: impl Iterator<Item = Token<'t>>) -> Result<()> {
        self.checked.text.extend_from_slice(b"vn");
        self.numbers(key, &mut tokens, ["x", "y", "z"])?;
        self.end_line();
        self.counts[2] += 1;
        Ok(())
    }

    fn face<'t>(&mut self, tokens: impl Iterator<Item = Token<'t>>, library: &mut Library<'_>) -> Result<()> {
        // The line is written last: what precedes it depends on all its corners.
        let mut corners: Vec<[Option<usize>; 3]> = Vec::with_capacity(4);
        for token in tokens {
            corners.push(corner(token, self.counts, self.name)?);
        }
        if corners.len() < 3 {
            self.left_out.small_faces += 1;
            return Ok(());
        }
        self.checked.triangles += corners.len() as u64 - 2;
        let limit = self.options.limits.max_triangles;
        if self.checked.triangles > limit {
            return Err(Error::limit(format!("{}: triangles", self.name), self.checked.triangles, limit));
        }
        let has = |attribute: usize| corners.iter().all(|c| c[attribute].is_some());
        let kind = (has(1), has(2));
        let partly = |attribute: usize| !has(attribute) && corners.iter().any(|c| c[attribute].is_some());
        self.left_out.partial_faces += usize::from(partly(1) || partly(2));
        self.begin_face(kind, library);
        self.checked.text.extend_from_slice(b"f");
        for c in &corners {
            self.write_corner(c, kind);
        }
        self.end_line();
        Ok(())
    }

    /// Begins a group when the name or the kind of faces changed, and states the material when that changed.
    fn begin_face(&mut self, kind: FaceKind, library: &mut Library<'_>) {
        if self.kind != Some(kind) {
            self.kind = Some(kind);
            let line = format!("g {}\n", self.checked.groups.len());
            self.checked.text.extend_from_slice(line.as_bytes());
            self.checked.groups.push(self.group.clone());
        }
        let material = *self.material.get_or_insert_with(|| library.default_index());
        if self.written_material != Some(material) {
            self.written_material = Some(material);
            self.checked.text.extend_from_slice(format!("usemtl {material}\n").as_bytes());
        }
    }

    /// Writes `v`, `v/vt`, `v//vn` or `v/vt/vn`, counting from 1.
    fn write_corner(&mut self, corner: &[Option<usize>; 3], kind: FaceKind) {
        let [v, vt, vn] = corner.map(|index| index.unwrap_or_default());
        let text = &mut self.checked.text;
        text.push(b' ');
        push_integer(text, v);
        if kind.0 || kind.1 {
            text.push(b'/');
        }
        if kind.0 {
            push_integer(text, vt);
        }
        if kind.1 {
            text.push(b'/');
            push_integer(text, vn);
        }
    }

    fn other(&mut self, key: Token<'_>) -> Result<()> {
        let word = String::from_utf8_lossy(key.bytes);
        if let Some(known) = NOT_DRAWN.into_iter().find(|&k| k == word) {
            *self.left_out.statements.entry(known).or_default() += 1;
            self.recognised = true;
            return Ok(());
        }
        if WITHOUT_EFFECT.contains(&&*word) {
            self.recognised = true;
            return Ok(());
        }
        let hint = text::did_you_mean(&key.shown(), USED);
        let what = format!("unknown statement '{}'{hint}", key.shown());
        if self.options.strict {
            return Err(key.error(self.name, what));
        }
        self.left_out.unknown_count += 1;
        if self.left_out.unknown.len() < super::MAX_NOTICES {
            self.left_out.unknown.push(format!("{}: {what} ignored", key.place(self.name)));
        }
        Ok(())
    }

    fn numbers<'t, const N: usize>(
        &mut self,
        key: Token<'t>,
        tokens: &mut impl Iterator<Item = Token<'t>>,
        labels: [&str; N],
    ) -> Result<()> {
        for label in labels {
            let Some(token) = tokens.next() else {
                let what =
                    format!("'{}' needs {} numbers: its {label} is missing", key.shown(), labels.len());
                return Err(key.error(self.name, what));
            };
            text::number(token, label, self.name, self.options.limits.lenient)?;
            self.pass_on(token);
        }
        Ok(())
    }

    fn pass_on(&mut self, token: Token<'_>) {
        self.checked.text.push(b' ');
        self.checked.text.extend_from_slice(token.bytes);
    }

    fn end_line(&mut self) {
        self.checked.text.push(b'\n');
    }

    fn finish(mut self, library: &mut Library<'_>) -> Result<Checked> {
        if !self.recognised {
            let hint =
                self.left_out.unknown.into_iter().next().map(|n| format!(" ({n})")).unwrap_or_default();
            return Err(Error::invalid(
                self.name,
                format!("holds no OBJ statement: is this an OBJ file?{hint}"),
            ));
        }
        let LeftOut { colors, small_faces, partial_faces, statements, unknown, unknown_count } =
            self.left_out;
        let mut counted = |count: usize, what: &str| {
            if count > 0 {
                library.notices.push(format!("{}: {count} {what}", self.name));
            }
        };
        counted(colors, "vertex colours ignored");
        counted(small_faces, "faces with fewer than 3 corners left out");
        counted(
            partial_faces,
            "faces whose corners don't all have texture coordinates or normals: those dropped",
        );
        for (statement, count) in statements {
            counted(count, &format!("'{statement}' statements left out: only faces are drawn"));
        }
        counted(unknown_count.saturating_sub(unknown.len()), "more unknown statements ignored");
        library.notices.extend(unknown);
        if self.checked.triangles == 0 {
            library.notices.push(format!("{}: holds no faces", self.name));
        }
        self.checked.groups.shrink_to_fit();
        Ok(self.checked)
    }
}

fn name_after<'t>(
    line: Line<'t>,
    key: Token<'t>,
    mut tokens: impl Iterator<Item = Token<'t>>,
    name: &str,
) -> Result<Token<'t>> {
    match tokens.next() {
        Some(first) => Ok(line.rest_from(first)),
        None => Err(key.error(name, format!("{} without a name", key.shown()))),
    }
}

/// The indices of `v/vt/vn` from 1; negative ones, which count back from the last, resolved.
fn corner(token: Token<'_>, counts: [usize; 3], name: &str) -> Result<[Option<usize>; 3]> {
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

fn push_integer(text: &mut Vec<u8>, mut value: usize) {
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
