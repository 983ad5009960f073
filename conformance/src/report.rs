//! What the suite found, as a table for people and JSON for machines.

use crate::expectations::{Expectation, Verdict, judge};
use crate::trial::Trial;
use serde::Serialize;
use std::fmt::Write as _;
use std::time::Instant;
use twinlight_core::BackendInfo;

/// One trial's line.
#[derive(Debug, Clone, Serialize)]
pub struct Row {
    /// Stem of the kernel.
    pub kernel: &'static str,
    /// Name of the trial.
    pub trial: String,
    /// `passed`, `failed`, `skipped` or `expected`.
    pub verdict: &'static str,
    /// Evidence or reason; empty when passed.
    pub detail: String,
    /// Wall-clock seconds.
    pub seconds: f64,
}

/// How many trials ended how.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub struct Counts {
    /// Everything held.
    pub passed: usize,
    /// Something did not.
    pub failed: usize,
    /// Could not run.
    pub skipped: usize,
    /// Failed as the list of known failures says.
    pub expected: usize,
}

/// The whole run of one backend.
#[derive(Debug, Clone, Serialize)]
pub struct Report {
    /// As given by the caller.
    pub date: String,
    /// `cpu` or `gpu`.
    pub kind: &'static str,
    /// Processor or adapter.
    pub device: String,
    /// Driver and version, or instruction set.
    pub driver: String,
    /// Whether float results were held to bit equality.
    pub strict: bool,
    /// Totals of `rows`.
    pub counts: Counts,
    /// In the order they ran.
    pub rows: Vec<Row>,
    #[serde(skip)]
    info: BackendInfo,
}

impl Report {
    /// An empty report about the backend that `info` describes.
    pub fn new(info: BackendInfo, date: &str) -> Self {
        Self {
            date: date.to_owned(),
            kind: info.kind,
            device: info.device.clone(),
            driver: info.driver.clone(),
            strict: info.strict,
            counts: Counts::default(),
            rows: Vec::new(),
            info,
        }
    }

    /// Runs one trial and writes its line.
    pub fn run(&mut self, trial: &Trial<'_>, known: &[Expectation]) -> &Row {
        let start = Instant::now();
        let verdict = judge(known, &self.info, &trial.name, trial.run());
        self.push(trial.kernel, trial.name.clone(), verdict, start.elapsed().as_secs_f64())
    }

    /// Writes a line.
    pub fn push(&mut self, kernel: &'static str, trial: String, verdict: Verdict, seconds: f64) -> &Row {
        let (counter, verdict, detail) = match verdict {
            Verdict::Passed => (&mut self.counts.passed, "passed", String::new()),
            Verdict::Failed(text) => (&mut self.counts.failed, "failed", text),
            Verdict::Skipped(text) => (&mut self.counts.skipped, "skipped", text),
            Verdict::Expected(text) => (&mut self.counts.expected, "expected", text),
        };
        *counter += 1;
        let at = self.rows.len();
        self.rows.push(Row { kernel, trial, verdict, detail, seconds });
        &self.rows[at]
    }

    /// Whether something ran and nothing failed. A run without a single pass shows nothing, so it is not a success.
    pub fn is_ok(&self) -> bool {
        self.counts.failed == 0 && self.counts.passed > 0
    }

    /// A line per trial, evidence below it, totals last.
    pub fn table(&self) -> String {
        let mode = if self.strict { "strict" } else { "portable" };
        let mut text =
            format!("{} · {} · {} · {mode} · {}\n", self.kind, self.device, self.driver, self.date);
        let width = self.rows.iter().map(|row| row.trial.len()).max().unwrap_or(0);
        for row in &self.rows {
            let _ = write!(text, "  {:width$}  {:8}  {:8.3} s", row.trial, row.verdict, row.seconds);
            if !row.detail.is_empty() {
                let _ = write!(text, "  {}", row.detail.replace('\n', "\n    "));
            }
            text.push('\n');
        }
        let c = self.counts;
        let _ = writeln!(
            text,
            "{} passed, {} failed, {} skipped, {} failed as expected",
            c.passed, c.failed, c.skipped, c.expected
        );
        text
    }

    /// The report as JSON.
    ///
    /// # Errors
    /// Those of serde_json.
    pub fn json(&self) -> serde_json::Result<String> {
        serde_json::to_string_pretty(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn report() -> Report {
        let info = BackendInfo { kind: "gpu", device: "dev".into(), driver: "drv 1".into(), strict: true };
        Report::new(info, "2026-01-31")
    }

    #[test]
    fn counts_and_texts_follow_the_verdicts() {
        let mut report = report();
        assert!(!report.is_ok(), "nothing ran");
        report.push("scan", "scan.a".into(), Verdict::Skipped("no device".into()), 0.0);
        assert!(!report.is_ok(), "nothing but skips");
        report.push("scan", "scan.b".into(), Verdict::Passed, 0.5);
        report.push("scan", "scan.c".into(), Verdict::Expected("known".into()), 0.0);
        assert!(report.is_ok());
        report.push("scan", "scan.d".into(), Verdict::Failed("3 of 4\nfirst".into()), 0.0);
        assert!(!report.is_ok());
        assert_eq!(report.counts, Counts { passed: 1, failed: 1, skipped: 1, expected: 1 });
        let (table, json) = (report.table(), report.json().unwrap());
        for part in
            ["dev", "drv 1", "strict", "2026-01-31", "no device", "first", "1 passed, 1 failed, 1 skipped"]
        {
            assert!(table.contains(part), "{part} is missing in {table}");
        }
        let value: serde_json::Value = serde_json::from_str(&json).unwrap();
        assert_eq!(value["counts"]["failed"], 1);
        assert_eq!(value["rows"][0]["detail"], "no device");
        assert_eq!(value["driver"], "drv 1");
    }
}
