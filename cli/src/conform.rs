//! `conform`: the suite on this machine's backends.

use crate::args::ConformArgs;
use crate::exit::{Failure, Stage};
use crate::report;
use std::time::{Duration, SystemTime, UNIX_EPOCH};
use twinlight::cpu::CpuBackend;
use twinlight::io::write_file;
use twinlight::{Backend, Error};
use twinlight_conformance::report::Report;
use twinlight_conformance::{Effort, Options, Trial, expectations, own};

/// Runs the command.
///
/// # Errors
/// [`Failure::NothingRun`], [`Failure::Differs`], a report that can't be written.
pub fn run(args: &ConformArgs) -> Result<(), Failure> {
    let effort = if args.quick { Effort::Quick } else { Effort::Full };
    let options = Options { effort, dump_dir: args.dump.clone(), ..Options::default() };
    let date = date(SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or(Duration::ZERO));
    let mut runs = Runs { args, options, date, reports: Vec::new() };
    if runs.wants(&["cpu"]) {
        let found = runs.trials(&CpuBackend::new(), own::cpu_suite);
        runs.keep(found)?;
    }
    gpus(&mut runs)?;
    let Runs { reports, .. } = runs;
    if let Some(path) = &args.json {
        let text = serde_json::to_string_pretty(&reports)
            .map_err(|e| Failure::Library(Stage::Output, Error::Internal(format!("report: {e}"))))?;
        write_file(path, (text + "\n").as_bytes()).map_err(Failure::at(Stage::Output))?;
    }
    verdict(&reports)
}

fn verdict(reports: &[Report]) -> Result<(), Failure> {
    let sum = |pick: fn(&Report) -> usize| reports.iter().map(pick).sum::<usize>();
    let failed = sum(|r| r.counts.failed);
    if failed > 0 {
        return Err(Failure::Differs(format!("{failed} trials failed")));
    }
    if sum(|r| r.counts.passed + r.counts.expected) == 0 {
        let what = "nothing was run: no adapter and no trial fits --adapter and --filter";
        return Err(Failure::NothingRun(what.into()));
    }
    Ok(())
}

/// The reports so far, and what is wanted.
struct Runs<'a> {
    args: &'a ConformArgs,
    options: Options,
    date: String,
    reports: Vec<Report>,
}

impl Runs<'_> {
    /// Whether a backend with these names is asked for.
    fn wants(&self, names: &[&str]) -> bool {
        let fits = |wanted: &String| {
            let wanted = wanted.to_lowercase();
            let is_number = wanted.parse::<usize>().is_ok();
            names.iter().any(|n| *n == wanted || (!is_number && n.to_lowercase().contains(&wanted)))
        };
        self.args.adapter.is_empty() || self.args.adapter.iter().any(fits)
    }

    /// Whether a trial of this name is asked for.
    fn includes(&self, trial: &str) -> bool {
        let filter = &self.args.filter;
        filter.is_empty() || filter.iter().any(|part| trial.contains(part.as_str()))
    }

    /// Runs the trials that are asked for.
    fn trials<'a, B: Backend>(
        &'a self,
        backend: &'a B,
        suite: fn(&'a B, &'a Options) -> Vec<Trial<'a>>,
    ) -> Report {
        let mut found = Report::new(backend.info(), &self.date);
        for trial in suite(backend, &self.options).iter().filter(|trial| self.includes(&trial.name)) {
            found.run(trial, expectations::KNOWN);
        }
        found
    }

    /// Prints and keeps a report, unless nothing ran.
    fn keep(&mut self, found: Report) -> Result<(), Failure> {
        if !found.rows.is_empty() {
            report::print(&format!("{}\n", found.table()))?;
            self.reports.push(found);
        }
        Ok(())
    }
}

#[cfg(feature = "gpu")]
fn gpus(runs: &mut Runs<'_>) -> Result<(), Failure> {
    use twinlight::gpu::{AdapterSelector, DeviceOptions, GpuBackend, Mode, adapters};
    for (index, adapter) in adapters().iter().enumerate() {
        let number = index.to_string();
        if !runs.wants(&[&number, &adapter.name, &adapter.driver, &adapter.backend]) {
            continue;
        }
        if let Some(why) = &adapter.unusable {
            report::notice(&format!("{adapter} skipped: {why}"));
            continue;
        }
        let modes: &[Mode] = if adapter.strict { &[Mode::Strict, Mode::Portable] } else { &[Mode::Portable] };
        for &mode in modes {
            let selector = AdapterSelector::Index(index);
            let options = DeviceOptions { adapter: selector, mode: Some(mode), ..DeviceOptions::default() };
            let backend = GpuBackend::open(&options).map_err(Failure::at(Stage::Device))?;
            let mut found = runs.trials(&backend, own::gpu_suite);
            against_cpu(runs, &backend, &mut found);
            runs.keep(found)?;
        }
    }
    Ok(())
}

/// Whole scenes on both backends, compared.
#[cfg(feature = "gpu")]
fn against_cpu(runs: &Runs<'_>, backend: &twinlight::gpu::GpuBackend, found: &mut Report) {
    use std::time::Instant;
    use twinlight_conformance::cross;
    let cpu = CpuBackend::new();
    for (kernel, check) in own::gpu_checks() {
        let name = format!("{kernel}.against_cpu");
        if runs.includes(&name) {
            let start = Instant::now();
            let verdict = cross::judge(check(&cpu, backend));
            found.push(kernel, name, verdict, start.elapsed().as_secs_f64());
        }
    }
}

#[cfg(not(feature = "gpu"))]
fn gpus(_: &mut Runs<'_>) -> Result<(), Failure> {
    report::notice("built without GPU support: only the CPU backend is checked");
    Ok(())
}

/// The UTC date, `YYYY-MM-DD`, of a time since 1970 (Hinnant, "chrono-compatible low-level date algorithms").
fn date(since_epoch: Duration) -> String {
    let days = since_epoch.as_secs() / 86_400 + 719_468;
    let (era, day_of_era) = (days / 146_097, days % 146_097);
    let year_of_era = (day_of_era - day_of_era / 1460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    // Years begin in March here, so that a leap day is the last of its year.
    let month_from_march = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * month_from_march + 2) / 5 + 1;
    let month = if month_from_march < 10 { month_from_march + 3 } else { month_from_march - 9 };
    let year = year_of_era + era * 400 + u64::from(month <= 2);
    format!("{year:04}-{month:02}-{day:02}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dates() {
        let of = |seconds| date(Duration::from_secs(seconds));
        assert_eq!(of(0), "1970-01-01");
        assert_eq!(of(951_782_399), "2000-02-28");
        assert_eq!(of(951_782_400), "2000-02-29");
        assert_eq!(of(1_709_251_200), "2024-03-01");
        assert_eq!(of(1_798_761_599), "2026-12-31");
    }
}
