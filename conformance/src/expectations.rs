//! Known failures. One that stops failing, or fails for another reason, fails the run.

use crate::trial::Outcome;
use twinlight_core::BackendInfo;

/// A failure known on some adapters.
#[derive(Debug, Clone, Copy)]
pub struct Expectation {
    /// Part of the device's name, in lower case; empty for any.
    pub device: &'static str,
    /// Part of the driver's name and version, in lower case; empty for any.
    pub driver: &'static str,
    /// In strict or portable mode only; `None` for both.
    pub strict: Option<bool>,
    /// The trial's full name.
    pub trial: &'static str,
    /// Part of the evidence; a failure without it is a new one.
    pub message: &'static str,
    /// Why it fails, and where that is known from.
    pub because: &'static str,
}

/// Failures known today: none.
pub const KNOWN: &[Expectation] = &[];

/// An outcome after expectations were applied.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Verdict {
    /// As it should be.
    Passed,
    /// Wrong, with the evidence.
    Failed(String),
    /// Not run, with the reason.
    Skipped(String),
    /// Failed as expected: the expectation's reason.
    Expected(String),
}

impl Expectation {
    fn applies(&self, info: &BackendInfo, trial: &str) -> bool {
        self.trial == trial
            && info.device.to_lowercase().contains(self.device)
            && info.driver.to_lowercase().contains(self.driver)
            && self.strict.is_none_or(|strict| strict == info.strict)
    }
}

/// Judges one outcome.
pub fn judge(known: &[Expectation], info: &BackendInfo, trial: &str, outcome: Outcome) -> Verdict {
    let Some(expected) = known.iter().find(|e| e.applies(info, trial)) else {
        return match outcome {
            Outcome::Passed => Verdict::Passed,
            Outcome::Failed(evidence) => Verdict::Failed(evidence),
            Outcome::Skipped(reason) => Verdict::Skipped(reason),
        };
    };
    match outcome {
        Outcome::Failed(evidence) if evidence.contains(expected.message) => {
            Verdict::Expected(expected.because.to_owned())
        }
        Outcome::Failed(evidence) => Verdict::Failed(format!(
            "failed, but not as expected (with {:?}, {}): {evidence}",
            expected.message, expected.because
        )),
        Outcome::Passed => Verdict::Failed(format!(
            "passed, but is expected to fail ({}): remove the expectation",
            expected.because
        )),
        Outcome::Skipped(reason) => Verdict::Skipped(reason),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIST: &[Expectation] = &[Expectation {
        device: "llvmpipe",
        driver: "",
        strict: Some(false),
        trial: "trace.law",
        message: "t: got",
        because: "a known driver bug",
    }];

    fn info(device: &str, strict: bool) -> BackendInfo {
        BackendInfo { kind: "gpu", device: device.into(), driver: "Mesa 1".into(), strict }
    }

    fn verdict(device: &str, strict: bool, trial: &str, outcome: Outcome) -> Verdict {
        judge(LIST, &info(device, strict), trial, outcome)
    }

    #[test]
    fn an_expected_failure_is_expected_only_there_and_for_that_reason() {
        let failed = |text: &str| Outcome::Failed(text.into());
        let expected = Verdict::Expected("a known driver bug".into());
        assert_eq!(verdict("LLVMpipe 256", false, "trace.law", failed("[1] t: got 3")), expected);
        for (device, strict, trial, text) in [
            ("SwiftShader", false, "trace.law", "t: got"),
            ("llvmpipe", true, "trace.law", "t: got"),
            ("llvmpipe", false, "trace.other", "t: got"),
            ("llvmpipe", false, "trace.law", "panicked"),
        ] {
            let verdict = verdict(device, strict, trial, failed(text));
            assert!(matches!(verdict, Verdict::Failed(_)), "{device} {strict} {trial} {text}: {verdict:?}");
        }
    }

    #[test]
    fn an_expected_failure_that_passes_fails() {
        let verdict = verdict("llvmpipe", false, "trace.law", Outcome::Passed);
        assert!(
            matches!(&verdict, Verdict::Failed(text) if text.contains("remove the expectation")),
            "{verdict:?}"
        );
    }
}
