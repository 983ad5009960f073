//! The text of a scene file, for errors that point into it.

use super::document::Document;
use crate::io::text;
use std::ops::Range;
use twinlight_core::scene::{Limits, Scene};
use twinlight_core::{Error, Result};

/// A scene file's text and name.
#[derive(Clone, Copy)]
pub(super) struct Source<'a> {
    pub name: &'a str,
    pub text: &'a str,
}

impl<'a> Source<'a> {
    pub fn new(bytes: &'a [u8], name: &'a str) -> Result<Self> {
        let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        match std::str::from_utf8(bytes) {
            Ok(text) => Ok(Self { name, text }),
            Err(e) => {
                let valid = std::str::from_utf8(&bytes[..e.valid_up_to()]).unwrap_or_default();
                let place = Source { name, text: valid }.place(&(valid.len()..valid.len()));
                Err(Error::invalid(place, "the text is not UTF-8"))
            }
        }
    }

    /// Reads the tables.
    pub fn document(&self) -> Result<Document> {
        toml::from_str(self.text).map_err(|e| {
            let span = e.span().unwrap_or(0..0);
            let written = self.text.get(span.clone()).unwrap_or_default();
            let place = self.place(&span);
            Error::invalid(place, explained(e.message(), written))
        })
    }

    /// `file:line:column` of a span's start; columns count bytes from 1.
    pub fn place(&self, span: &Range<usize>) -> String {
        let before = &self.text.as_bytes()[..span.start.min(self.text.len())];
        let line = before.iter().filter(|&&b| b == b'\n').count() + 1;
        let column = before.iter().rev().take_while(|&&b| b != b'\n').count() + 1;
        format!("{}:{line}:{column}", self.name)
    }

    /// An error at a span.
    pub fn error(&self, span: &Range<usize>, what: impl Into<String>) -> Error {
        Error::invalid(self.place(span), what)
    }

    /// Checks a scene that holds only the element at `span`, so that its error has a position.
    pub fn check(&self, span: &Range<usize>, element: Scene) -> Result<()> {
        match element.validate(&Limits::default()) {
            Err(Error::InvalidInput { what, .. }) => Err(self.error(span, what)),
            other => other,
        }
    }
}

/// The parser's message with the value, and a suggestion where it lists what it expected.
fn explained(message: &str, written: &str) -> String {
    let message = message.trim_end().replace('\n', "; ").replace('`', "'");
    let words: Vec<&str> = message.split('\'').collect();
    // "unknown field 'x', expected one of 'a', 'b'": odd parts are what was quoted.
    let mut quoted = words.iter().skip(1).step_by(2);
    if message.starts_with("unknown") {
        let word = quoted.next().copied().unwrap_or_default();
        return format!("{message}{}", text::did_you_mean(word, quoted.copied()));
    }
    let short = !written.is_empty() && written.len() <= 40 && !written.contains('\n');
    if short && !message.contains(written) { format!("{message}, in '{written}'") } else { message }
}
