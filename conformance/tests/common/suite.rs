//! The suite as tests: one per trial and backend.

use crate::list::List;
use twinlight_conformance::expectations::{KNOWN, judge};
use twinlight_conformance::{Effort, Options, Trial};
use twinlight_core::Backend;

/// Adds the trials that `suite` lists of `kernels` (all for none) on `backend` under `label`.
pub fn add<B: Backend + Send + Sync>(
    list: &mut List,
    label: &str,
    backend: &'static B,
    suite: fn(&'static B, &'static Options) -> Vec<Trial<'static>>,
    effort: Effort,
    kernels: Vec<String>,
) {
    let dump_dir = Some(std::env::temp_dir().join("twinlight-conformance").join(label.replace(' ', "_")));
    // Tests outlive this call, and a process has few backends.
    let options: &'static Options =
        Box::leak(Box::new(Options { effort, dump_dir, kernels, ..Options::default() }));
    for trial in suite(backend, options) {
        list.add(format!("{label} {}", trial.name), move || {
            judge(KNOWN, &backend.info(), &trial.name, trial.run())
        });
    }
}
