//! WGSL sources: kernels are files joined in order, and an error in the joined text is reported at its own file and line.

use twinlight_core::{Error, Result};

/// One WGSL file of this crate.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct WgslFile {
    /// Path from the repository's root.
    pub path: &'static str,
    /// Its text.
    pub text: &'static str,
}

/// The source of one kernel: shared files first, the kernel's own file last.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct KernelSource {
    /// Name of the kernel and of its files.
    pub stem: &'static str,
    /// Files in the order in which they are joined.
    pub files: &'static [WgslFile],
}

/// A parsed and validated kernel.
#[derive(Debug)]
pub struct CheckedModule {
    /// naga's representation.
    pub module: naga::Module,
    /// What validation found out: types, uniformity, which entry point uses which global.
    pub info: naga::valid::ModuleInfo,
    /// The joined text.
    pub text: String,
}

impl KernelSource {
    /// The joined text.
    pub fn join(&self) -> String {
        let mut text = String::new();
        for file in self.files {
            text.push_str(file.text);
            if !file.text.ends_with('\n') {
                text.push('\n');
            }
        }
        text
    }

    /// File, line and column (from 1) of a byte of the joined text.
    pub fn locate(&self, byte: usize) -> String {
        let mut start = 0;
        for file in self.files {
            let length = file.text.len() + usize::from(!file.text.ends_with('\n'));
            if byte < start + length {
                let before = file.text.get(..byte - start).unwrap_or(file.text);
                let line = before.matches('\n').count() + 1;
                let column = before.len() - before.rfind('\n').map_or(0, |newline| newline + 1) + 1;
                return format!("{}:{line}:{column}", file.path);
            }
            start += length;
        }
        format!("{} (end)", self.stem)
    }

    /// Parses and validates the joined text.
    ///
    /// # Errors
    /// [`Error::Internal`] with file, line and column: the sources are part of this crate, so a bad one is its defect.
    pub fn check(&self) -> Result<CheckedModule> {
        let text = self.join();
        let place = |range: Option<std::ops::Range<usize>>| {
            range.map_or_else(|| self.stem.to_owned(), |range| self.locate(range.start))
        };
        let module = naga::front::wgsl::parse_str(&text).map_err(|error| {
            let place = place(error.labels().find_map(|(span, _)| span.to_range()));
            Error::Internal(format!("{place}: {}", error.message()))
        })?;
        // No capability beyond WGSL's core: the sources must run on every adapter.
        let mut validator = naga::valid::Validator::new(
            naga::valid::ValidationFlags::all(),
            naga::valid::Capabilities::empty(),
        );
        let info = validator.validate(&module).map_err(|error| {
            let place = place(error.spans().find_map(|(span, _)| span.to_range()));
            Error::Internal(format!("{place}: {}", chain(error.as_inner())))
        })?;
        Ok(CheckedModule { module, info, text })
    }
}

/// An error with its causes, outermost first.
fn chain(error: &dyn std::error::Error) -> String {
    let mut text = error.to_string();
    let mut cause = error.source();
    while let Some(error) = cause {
        text.push_str(": ");
        text.push_str(&error.to_string());
        cause = error.source();
    }
    text
}
