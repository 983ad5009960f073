//! How a command ends: exit code, message, hint. The one place that maps errors to codes.

use std::fmt;
use twinlight::Error;
use twinlight::methods::post::PostError;

/// The exit codes, as `--help` prints them.
pub const TABLE: &str = "\
Exit codes:
    0  done
    1  defect of twinlight
    2  wrong command line
    3  bad scene or picture
    4  nothing was run
    5  a file can't be read or written
    6  memory or another limit exceeded
    7  backend not available
    8  device lost: worth a retry
   10  pictures differ, or conformance failed
  130  interrupted by Ctrl-C, 143 by SIGTERM; what was finished is saved";

/// What was being done when the library refused: the same error means something else elsewhere.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// Reading scenes.
    Input,
    /// Reading pictures.
    Pictures,
    /// Opening a backend and computing.
    Device,
    /// Writing results.
    Output,
}

/// Why a command does not end with 0.
#[derive(Debug)]
pub enum Failure {
    /// The library's error.
    Library(Stage, Error),
    /// A command line that clap can't judge.
    Usage(String),
    /// Pictures that can't be compared.
    Pictures(PostError),
    /// The suite found nothing to run.
    NothingRun(String),
    /// The suite failed, or a threshold was passed.
    Differs(String),
    /// A signal; what was finished is saved.
    Signal(i32),
    /// What ended a sequence, and at which frame.
    Frame(u32, Box<Failure>),
}

impl Failure {
    /// For `map_err`.
    pub fn at(stage: Stage) -> impl Fn(Error) -> Self {
        move |error| Self::Library(stage, error)
    }

    /// The process's exit code.
    pub fn code(&self) -> u8 {
        match self {
            Self::Library(stage, error) => library_code(*stage, error),
            Self::Usage(_) | Self::Pictures(PostError::OutOfRange { .. }) => 2,
            Self::Pictures(_) => 3,
            Self::NothingRun(_) => 4,
            Self::Differs(_) => 10,
            // 128 + signal, as shells count; signals are small.
            Self::Signal(signal) => (128 + signal) as u8,
            Self::Frame(_, failure) => failure.code(),
        }
    }

    /// What might help, as one sentence.
    pub fn hint(&self) -> Option<&'static str> {
        let (stage, error) = match self {
            Self::Library(stage, error) => (stage, error),
            Self::Frame(_, failure) => return failure.hint(),
            _ => return None,
        };
        Some(match error {
            Error::BackendUnavailable { .. } => {
                "`twinlight devices` lists what is here; `--backend cpu` runs everywhere"
            }
            Error::Unsupported(_) if *stage == Stage::Device => "`--backend cpu` can do everything",
            Error::LimitExceeded { .. } | Error::OutOfMemory { .. } => {
                "fewer pixels (--size) or a smaller scene; --max-memory sets the limit"
            }
            Error::DeviceLost { .. } => "often passing: run it again, or with `--backend cpu`",
            Error::Internal(_) => "please report it with the command line and the scene",
            Error::Io { source, .. } if source.kind() == std::io::ErrorKind::NotFound => match stage {
                Stage::Input => {
                    "the path is relative to the current folder; `twinlight scene list` names scenes without files"
                }
                Stage::Pictures => "the path is relative to the current folder",
                _ => return None,
            },
            _ => return None,
        })
    }
}

fn library_code(stage: Stage, error: &Error) -> u8 {
    match error {
        Error::InvalidInput { .. } => 3,
        Error::Unsupported(_) if matches!(stage, Stage::Input | Stage::Pictures) => 3,
        Error::Unsupported(_) | Error::BackendUnavailable { .. } => 7,
        Error::LimitExceeded { .. } | Error::OutOfMemory { .. } => 6,
        Error::DeviceLost { .. } => 8,
        Error::Cancelled { .. } => 130,
        Error::Io { .. } => 5,
        // `Error` may grow; what this command does not know is a defect of it.
        _ => 1,
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Library(_, error) => error.fmt(f),
            Self::Pictures(error) => error.fmt(f),
            Self::Usage(text) | Self::NothingRun(text) | Self::Differs(text) => f.write_str(text),
            Self::Signal(_) => f.write_str("interrupted; what was finished is saved"),
            Self::Frame(number, failure) => write!(f, "frame {number}: {failure}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::ErrorKind;

    #[test]
    fn every_error_has_its_code() {
        let io = || Error::Io { path: "a".into(), source: ErrorKind::NotFound.into() };
        let cases = [
            (Stage::Input, Error::invalid("a:1:2", "bad"), 3),
            (Stage::Input, Error::Unsupported("a.xyz".into()), 3),
            (Stage::Pictures, Error::Unsupported("a.xyz".into()), 3),
            (Stage::Device, Error::Unsupported("strict mode".into()), 7),
            (Stage::Device, Error::BackendUnavailable { tried: "gpu".into() }, 7),
            (Stage::Device, Error::limit("bytes", 2, 1), 6),
            (Stage::Device, Error::OutOfMemory { device: "host".into(), bytes: 1 }, 6),
            (Stage::Device, Error::DeviceLost { reason: "reset".into(), retryable: true }, 8),
            (Stage::Device, Error::Cancelled { saved: true }, 130),
            (Stage::Input, io(), 5),
            (Stage::Output, io(), 5),
            (Stage::Device, Error::Internal("bug".into()), 1),
        ];
        for (stage, error, code) in cases {
            let text = error.to_string();
            assert_eq!(Failure::Library(stage, error).code(), code, "{text}");
        }
    }

    #[test]
    fn own_failures_have_their_codes() {
        let different = PostError::SizeMismatch { left: (1, 1), right: (2, 1) };
        let range = PostError::OutOfRange { name: "exposure", range: "-64..=64 stops", value: 99.0 };
        assert_eq!(Failure::Usage(String::new()).code(), 2);
        assert_eq!(Failure::Pictures(range).code(), 2);
        assert_eq!(Failure::Pictures(different).code(), 3);
        assert_eq!(Failure::NothingRun(String::new()).code(), 4);
        assert_eq!(Failure::Differs(String::new()).code(), 10);
        assert_eq!(Failure::Signal(2).code(), 130);
        assert_eq!(Failure::Signal(15).code(), 143);
        let frame = Failure::Frame(7, Box::new(Failure::Signal(2)));
        assert_eq!((frame.code(), frame.to_string().starts_with("frame 7: interrupted")), (130, true));
    }
}
