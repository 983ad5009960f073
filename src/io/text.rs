//! Positions, excerpts and suggestions for messages about text files.

use twinlight_core::Error;

/// Longest excerpt of a file in a message, characters: a value, not a megabyte of it.
const EXCERPT: usize = 40;

/// `bytes` as printable text of at most [`EXCERPT`] characters, for messages.
pub(crate) fn shown(bytes: &[u8]) -> String {
    // A character is at most 4 bytes, so this prefix always holds the excerpt.
    let text = String::from_utf8_lossy(&bytes[..bytes.len().min(4 * EXCERPT + 4)]);
    let mut characters = text.chars().map(|c| if c.is_control() { '\u{fffd}' } else { c });
    let excerpt: String = characters.by_ref().take(EXCERPT).collect();
    if characters.next().is_some() { format!("{excerpt}…") } else { excerpt }
}

/// ` (did you mean 'x'?)` for the candidate nearest to `word`, or nothing when none is near.
pub(crate) fn did_you_mean<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> String {
    nearest(word, candidates).map_or_else(String::new, |near| format!(" (did you mean '{near}'?)"))
}

/// The candidate nearest to `word`, when one is near.
pub(crate) fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let word: Vec<char> = word.chars().take(EXCERPT).collect();
    let (d, near) = candidates.into_iter().map(|c| (distance(&word, c), c)).min()?;
    (d <= 1 + word.len() / 4).then_some(near)
}

/// Levenshtein distance, case ignored.
fn distance(a: &[char], b: &str) -> usize {
    let b: Vec<char> = b.chars().take(EXCERPT).collect();
    let same = |x: char, y: char| x.eq_ignore_ascii_case(&y);
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, &x) in a.iter().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, &y) in b.iter().enumerate() {
            let substituted = diagonal + usize::from(!same(x, y));
            diagonal = row[j + 1];
            row[j + 1] = substituted.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
}

/// A line of a text file without its end, and its number from 1.
#[derive(Clone, Copy)]
pub(crate) struct Line<'a> {
    pub bytes: &'a [u8],
    pub number: usize,
}

/// A word of a line and its column from 1, in bytes.
#[derive(Clone, Copy)]
pub(crate) struct Token<'a> {
    pub bytes: &'a [u8],
    pub line: usize,
    pub column: usize,
}

impl<'a> Token<'a> {
    /// The error about this token: `name:line:column: what`.
    pub fn error(&self, name: &str, what: impl Into<String>) -> Error {
        Error::invalid(self.place(name), what)
    }

    /// `name:line:column`.
    pub fn place(&self, name: &str) -> String {
        format!("{name}:{}:{}", self.line, self.column)
    }

    /// The token as text for messages.
    pub fn shown(&self) -> String {
        shown(self.bytes)
    }
}

/// The lines of `bytes`, without a byte-order mark.
pub(crate) fn lines(bytes: &[u8]) -> impl Iterator<Item = Line<'_>> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    bytes.split(|&b| b == b'\n').enumerate().map(|(i, bytes)| Line { bytes, number: i + 1 })
}

impl<'a> Line<'a> {
    /// The words of the line up to a word that begins with `#`.
    pub fn tokens(self) -> impl Iterator<Item = Token<'a>> {
        let mut at = 0;
        let Line { bytes, number } = self;
        std::iter::from_fn(move || {
            while at < bytes.len() && bytes[at].is_ascii_whitespace() {
                at += 1;
            }
            let start = at;
            while at < bytes.len() && !bytes[at].is_ascii_whitespace() {
                at += 1;
            }
            let word = &bytes[start..at];
            if word.is_empty() || word[0] == b'#' {
                at = bytes.len();
                return None;
            }
            Some(Token { bytes: word, line: number, column: start + 1 })
        })
    }

    /// The rest of the line from a token on, without surrounding white space: a name may hold blanks.
    pub fn rest_from(self, token: Token<'a>) -> Token<'a> {
        Token { bytes: self.bytes[token.column - 1..].trim_ascii_end(), ..token }
    }
}

/// Parses a number; with `lenient`, values that are not finite pass.
pub(crate) fn number(token: Token<'_>, what: &str, name: &str, lenient: bool) -> Result<f32, Error> {
    let parsed = std::str::from_utf8(token.bytes).ok().and_then(|t| t.parse::<f32>().ok());
    match parsed {
        Some(x) if x.is_finite() || lenient => Ok(x),
        Some(_) => {
            Err(token.error(name, format!("{what} '{}' is not a finite 32-bit number", token.shown())))
        }
        None => {
            let comma = if token.bytes.contains(&b',') { "; the decimal mark is a point" } else { "" };
            Err(token.error(name, format!("{what} '{}' is not a number{comma}", token.shown())))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn suggestions_are_near() {
        let keys = ["Kd", "Ks", "map_Kd", "illum"];
        assert_eq!(did_you_mean("ilum", keys), " (did you mean 'illum'?)");
        assert_eq!(did_you_mean("kd", keys), " (did you mean 'Kd'?)");
        assert_eq!(did_you_mean("velocity", keys), "");
    }

    #[test]
    fn excerpts_are_short_and_printable() {
        assert_eq!(shown(b"a\x07b"), "a\u{fffd}b");
        assert_eq!(shown(&[b'x'; 1000]).chars().count(), EXCERPT + 1);
    }

    #[test]
    fn tokens_know_their_columns() {
        let line = Line { bytes: b"  v 1\t2 # note\r", number: 7 };
        let columns: Vec<_> = line.tokens().map(|t| (t.shown(), t.column)).collect();
        assert_eq!(columns, [("v".into(), 3), ("1".into(), 5), ("2".into(), 7)]);
    }
}
