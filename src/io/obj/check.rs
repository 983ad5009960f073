//! From the text of a stranger's OBJ file to text that `tobj` can read without surprises.
//!
//! tobj gives errors without a position, accepts `nan`, panics on some index underflows, and misaligns vertex attributes
//! when faces with and without texture coordinates share a group. This pass checks every number and index against what
//! the file has defined so far, names line, column and value of the first bad one, and passes on only what tobj handles
//! well: three numbers per vertex, faces of one kind per group, groups and materials by number.

use super::corner::{self, push_integer};
use super::left_out::LeftOut;
use super::library::Library;
use crate::io::LoadOptions;
use crate::io::text::{self, Line, Token};
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

/// What a face costs while tobj holds it, beside its corners: the face itself, and an allocation for a polygon's.
const BYTES_PER_FACE: u64 = 128;
/// What a corner costs at most: its indices, a vertex with all attributes, and its entry in tobj's map.
const BYTES_PER_CORNER: u64 = 128;
/// What a group costs: its mesh and instance with their names.
const BYTES_PER_GROUP: u64 = 1024;

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
        bytes: 0,
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

struct Pass<'a> {
    name: &'a str,
    options: &'a LoadOptions,
    checked: Checked,
    /// Positions, texture coordinates and normals so far.
    counts: [usize; 3],
    recognised: bool,
    /// What tobj will need for the faces so far.
    bytes: u64,
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
                self.group = text::shown(label);
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
            corners.push(corner::parse(token, self.counts, self.name)?);
        }
        if corners.len() < 3 {
            self.left_out.small_faces += 1;
            return Ok(());
        }
        self.count(corners.len() as u64)?;
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

    /// Counts a face against the limits.
    fn count(&mut self, corners: u64) -> Result<()> {
        let (checked, limits) = (&mut self.checked, &self.options.limits);
        checked.triangles += corners - 2;
        if checked.triangles > limits.max_triangles {
            let what = format!("{}: triangles", self.name);
            return Err(Error::limit(what, checked.triangles, limits.max_triangles));
        }
        self.bytes += BYTES_PER_FACE + BYTES_PER_CORNER * corners;
        let needed = self.bytes + BYTES_PER_GROUP * checked.groups.len() as u64 + checked.text.len() as u64;
        if needed > limits.max_bytes {
            return Err(Error::limit(
                format!("{}: bytes to read the faces", self.name),
                needed,
                limits.max_bytes,
            ));
        }
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
        self.left_out.unknown_count += 1;
        // A file that is no OBJ at all has millions of them.
        if self.left_out.unknown_count > super::MAX_NOTICES {
            return Ok(());
        }
        let hint = text::did_you_mean(&key.shown(), USED);
        let what = format!("unknown statement '{}'{hint}", key.shown());
        if self.options.strict {
            return Err(key.error(self.name, what));
        }
        self.left_out.unknown.push(format!("{}: {what} ignored", key.place(self.name)));
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
            let first = self.left_out.unknown.first().map(|n| format!(" ({n})")).unwrap_or_default();
            return Err(Error::invalid(
                self.name,
                format!("holds no OBJ statement: is this an OBJ file?{first}"),
            ));
        }
        library.notices.extend(self.left_out.notices(self.name));
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
