//! Tests whose number is known at run time only. A skip is a visible outcome: ignored, with its reason.
//!
//! With `TWINLIGHT_TRIAL_TIMES` set, the seconds that each took go to stderr; `--test-threads=1` makes them comparable.

use libtest_mimic::{Arguments, Completion, Failed, Trial};
use std::process::ExitCode;
use std::time::Instant;
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
        let timed = std::env::var_os("TWINLIGHT_TRIAL_TIMES").map(|_| name.clone());
        let test = move || {
            let (start, verdict) = (Instant::now(), test());
            if let Some(name) = timed {
                eprintln!("{:9.3} s {name}", start.elapsed().as_secs_f64());
            }
            verdict
        };
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
