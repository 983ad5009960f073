//! The one error type of the library.

use std::path::PathBuf;

/// What can go wrong, sorted by what a caller can do about it.
///
/// Bad input is found before anything runs; a lost device is [`Error::DeviceLost`], never a panic. Messages name the
/// file, line and value where there is one.
#[non_exhaustive]
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The caller's data is wrong: `what` names the value, `place` where it stands (file:line:column, field, index).
    #[error("{place}: {what}")]
    InvalidInput {
        /// What is wrong, with the offending value.
        what: String,
        /// Where it is: `file:line:column`, a field's path or an element's index.
        place: String,
    },
    /// The request is meaningful, but this build or device can't serve it.
    #[error("unsupported: {0}")]
    Unsupported(String),
    /// More of something than a documented limit allows. Raised before anything is allocated.
    #[error("{what}: needs {needed}, the limit is {limit}")]
    LimitExceeded {
        /// The limited quantity and its unit.
        what: String,
        /// How much the request needs.
        needed: u64,
        /// How much is allowed.
        limit: u64,
    },
    /// An allocation failed.
    #[error(
        "out of memory on {device}: {bytes} bytes could not be had; try fewer pixels per tile or a smaller scene"
    )]
    OutOfMemory {
        /// Host or adapter name.
        device: String,
        /// Size of the allocation that failed.
        bytes: u64,
    },
    /// The device stopped answering. Finished results stay valid; the backend handle is dead.
    #[error("device lost: {reason}")]
    DeviceLost {
        /// The driver's words.
        reason: String,
        /// Whether a new backend on the same adapter may succeed.
        retryable: bool,
    },
    /// No backend of the kind asked for can run here.
    #[error("no backend available (tried {tried})")]
    BackendUnavailable {
        /// What was tried, and why each failed.
        tried: String,
    },
    /// The caller's cancel token was set.
    #[error("cancelled{}", if *.saved { "; what was finished is kept" } else { "" })]
    Cancelled {
        /// Whether a valid partial result exists.
        saved: bool,
    },
    /// Reading or writing a file failed.
    #[error("{}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: std::io::Error,
    },
    /// A defect of this library. The text is what a bug report should hold.
    #[error("internal error, please report it: {0}")]
    Internal(String),
}

/// `Result` with [`Error`].
pub type Result<T> = std::result::Result<T, Error>;

impl Error {
    /// Shorthand for [`Error::InvalidInput`].
    pub fn invalid(place: impl Into<String>, what: impl Into<String>) -> Self {
        Self::InvalidInput { what: what.into(), place: place.into() }
    }

    /// Shorthand for [`Error::LimitExceeded`].
    pub fn limit(what: impl Into<String>, needed: u64, limit: u64) -> Self {
        Self::LimitExceeded { what: what.into(), needed, limit }
    }
}
