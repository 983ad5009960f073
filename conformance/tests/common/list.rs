//! Tests whose number is known at run time only. A skip is a visible outcome: ignored, with its reason.

use libtest_mimic::{Arguments, Completion, Failed, Trial};
use std::process::ExitCode;
use twinlight_conformance::Verdict;

/// Tests to run.
pub struct List {
    arguments: Arguments,
    tests: Vec<Trial>,
}

impl List {
    /// Reads libtest's arguments (filters, `--list`, `--test-threads`).
    pub fn from_args() -> Self {
        Self { arguments: Arguments::from_args(), tests: Vec::new() }
    }

    /// Adds one test.
    pub fn add(&mut self, name: String, test: impl FnOnce() -> Verdict + Send + 'static) {
        self.tests.push(Trial::ignorable_test(name, move || match test() {
            Verdict::Passed => Ok(Completion::Completed),
            Verdict::Failed(evidence) => Err(Failed::from(evidence)),
            Verdict::Skipped(reason) => Ok(Completion::ignored_with(reason)),
            Verdict::Expected(because) => {
                Ok(Completion::ignored_with(format!("failed as expected: {because}")))
            }
        }));
    }

    /// Runs what the arguments select.
    pub fn run(self) -> ExitCode {
        libtest_mimic::run(&self.arguments, self.tests).exit_code()
    }
}
