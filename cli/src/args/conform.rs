//! `conform`.

use clap::Args;
use std::path::PathBuf;

/// Runs the conformance suite on the CPU backend and on every GPU adapter, in strict and in portable mode, and prints what
/// held.
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  twinlight conform --quick\n  twinlight conform --adapter llvmpipe --filter scan --json \
                        report.json\n\nExit codes: 0 everything held, 4 nothing ran, 10 something failed."
)]
pub struct ConformArgs {
    /// Only this: cpu, or an adapter's number or part of its name (see `twinlight devices`)
    #[arg(long, value_name = "ADAPTER", env = "TWINLIGHT_ADAPTER")]
    pub adapter: Vec<String>,
    /// Only trials whose name contains this, such as scan or trace.
    #[arg(long, value_name = "TEXT")]
    pub filter: Vec<String>,
    /// Small inputs only: seconds
    #[arg(long)]
    pub quick: bool,
    /// Write the report here as JSON
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
    /// Write mismatching buffers to this folder
    #[arg(long, value_name = "DIR")]
    pub dump: Option<PathBuf>,
}
