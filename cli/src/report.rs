//! What the command says: results on stdout, everything else on stderr.

use crate::exit::{Failure, Stage};
use std::io::{ErrorKind, Write, stderr, stdout};
use twinlight::Error;

/// Writes bytes to stdout. A reader that has seen enough (`| head`) is no error.
///
/// # Errors
/// [`Error::Io`] for any other reason.
pub fn print_bytes(bytes: &[u8]) -> Result<(), Failure> {
    let mut out = stdout().lock();
    match out.write_all(bytes).and_then(|()| out.flush()) {
        Err(source) if source.kind() != ErrorKind::BrokenPipe => {
            Err(Failure::Library(Stage::Output, Error::Io { path: "standard output".into(), source }))
        }
        _ => Ok(()),
    }
}

/// Writes text to stdout.
///
/// # Errors
/// As [`print_bytes`].
pub fn print(text: &str) -> Result<(), Failure> {
    print_bytes(text.as_bytes())
}

/// Says on stderr what a person should know; nobody reading is no error.
pub fn notice(text: &str) {
    let _ = writeln!(stderr(), "notice: {text}");
}

/// Says on stderr how it went; nobody reading is no error.
pub fn status(text: &str) {
    let _ = writeln!(stderr(), "{text}");
}

/// Says on stderr why the command failed and what might help.
pub fn failure(failure: &Failure) {
    let mut err = stderr().lock();
    let _ = writeln!(err, "error: {failure}");
    if let Some(hint) = failure.hint() {
        let _ = writeln!(err, " hint: {hint}");
    }
}

/// Bytes in the unit a person would use.
pub fn bytes(n: u64) -> String {
    let units = ["B", "KiB", "MiB", "GiB", "TiB", "PiB", "EiB"];
    let power = (n.max(1).ilog2() / 10) as usize;
    match power {
        0 => format!("{n} B"),
        _ => format!("{:.1} {}", n as f64 / (1_u64 << (10 * power)) as f64, units[power]),
    }
}

#[cfg(test)]
mod tests {
    use super::bytes;

    #[test]
    fn byte_units() {
        let cases = [
            (0, "0 B"),
            (1023, "1023 B"),
            (1024, "1.0 KiB"),
            (1536 << 10, "1.5 MiB"),
            (u64::MAX, "16.0 EiB"),
        ];
        for (n, text) in cases {
            assert_eq!(bytes(n), text);
        }
    }
}
