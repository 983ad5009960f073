//! Trials: a name, a reason to exist, and something that passes, fails with evidence or is skipped with a reason.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use twinlight_core::{Backend, Error};

/// How much is run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub enum Effort {
    /// Small inputs: seconds. Every planted fault must be caught at this effort.
    Quick,
    /// Large inputs beside the small ones.
    #[default]
    Full,
}

/// What to run and where failures leave their evidence.
#[derive(Debug, Clone, Default)]
pub struct Options {
    /// Sizes.
    pub effort: Effort,
    /// Added to every seed; 0 gives the same inputs on every machine, every day.
    pub seed: u64,
    /// Where mismatching buffers are written, raw and little-endian; `None` writes nothing.
    pub dump_dir: Option<PathBuf>,
    /// Only these kernels' trials; empty for all.
    pub kernels: Vec<String>,
    /// Whether the first evidence will do: properties then name the input that broke them, and look for no smaller one.
    pub first_evidence: bool,
}

/// How a trial ended.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Outcome {
    /// Everything held.
    Passed,
    /// Something did not: the evidence.
    Failed(String),
    /// It could not run: the reason.
    Skipped(String),
}

/// Why a check did not pass.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Failure {
    /// The backend is wrong: the evidence.
    Mismatch(String),
    /// The backend does not claim this: the reason.
    Skip(String),
}

/// What the body of a trial returns.
pub type Check = Result<(), Failure>;

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        match error {
            Error::Unsupported(what) => Self::Skip(what),
            other => Self::Mismatch(format!("unexpected error: {other}")),
        }
    }
}

impl Failure {
    /// A mismatch, or the same skip, with what was being done put before it.
    pub fn within(self, place: &str) -> Self {
        match self {
            Self::Mismatch(text) => Self::Mismatch(format!("{place}: {text}")),
            skip => skip,
        }
    }
}

/// Fails with `text` unless `holds`.
///
/// # Errors
/// [`Failure::Mismatch`] when it does not hold.
pub fn ensure(holds: bool, text: impl FnOnce() -> String) -> Check {
    if holds { Ok(()) } else { Err(Failure::Mismatch(text())) }
}

/// What the body of a trial is given.
#[derive(Debug, Clone, Copy)]
pub struct Context<'a, B> {
    /// The backend under test.
    pub backend: &'a B,
    /// The caller's options.
    pub options: &'a Options,
    /// `kernel.trial`, for evidence files.
    pub name: &'a str,
}

impl<B> Context<'_, B> {
    /// Whether large inputs are wanted.
    pub fn full(&self) -> bool {
        self.options.effort == Effort::Full
    }
}

type Body<'a> = Box<dyn Fn() -> Check + Send + Sync + 'a>;

/// One named check of one backend.
pub struct Trial<'a> {
    /// Stem of the kernel.
    pub kernel: &'static str,
    /// `kernel.function`: the function of that name in `conformance/src/kernels` is the check.
    pub name: String,
    body: Body<'a>,
}

impl Trial<'_> {
    /// Runs the check. A panic below is a failure with the panic's message.
    pub fn run(&self) -> Outcome {
        match catch_unwind(AssertUnwindSafe(|| (self.body)())) {
            Ok(Ok(())) => Outcome::Passed,
            Ok(Err(Failure::Mismatch(evidence))) => Outcome::Failed(evidence),
            Ok(Err(Failure::Skip(reason))) => Outcome::Skipped(reason),
            Err(payload) => {
                let text = payload.downcast_ref::<String>().map(String::as_str);
                let text = text.or_else(|| payload.downcast_ref::<&str>().copied());
                Outcome::Failed(format!("panicked: {}", text.unwrap_or("without a message")))
            }
        }
    }
}

/// Collects the trials of one backend.
pub struct Listing<'a, B> {
    backend: &'a B,
    options: &'a Options,
    trials: Vec<Trial<'a>>,
}

impl<'a, B: Backend + Sync> Listing<'a, B> {
    /// An empty list.
    pub fn new(backend: &'a B, options: &'a Options) -> Self {
        Self { backend, options, trials: Vec::new() }
    }

    /// Appends a check, if its kernel was asked for.
    pub fn add(&mut self, kernel: &'static str, function: &str, check: fn(&Context<'_, B>) -> Check) {
        let wanted = &self.options.kernels;
        if !wanted.is_empty() && !wanted.iter().any(|k| k == kernel) {
            return;
        }
        let (backend, options) = (self.backend, self.options);
        let name = format!("{kernel}.{function}");
        let own_name = name.clone();
        let body = Box::new(move || check(&Context { backend, options, name: &own_name }));
        self.trials.push(Trial { kernel, name, body });
    }

    /// The trials in the order they were added.
    pub fn finish(self) -> Vec<Trial<'a>> {
        self.trials
    }
}

/// Adds functions to a [`Listing`] under their own names, so that a trial's name can be searched for.
macro_rules! list_trials {
    ($list:expr, $kernel:literal: $($function:ident),+ $(,)?) => {
        $($list.add($kernel, stringify!($function), $function);)+
    };
}
pub(crate) use list_trials;
