//! Where kernels run.

use super::render::ModeName;
use super::values::BackendChoice;
use clap::Args;
use twinlight::methods::cost::knobs::{help, long_help};

/// Where kernels run.
#[derive(Debug, Clone, Args)]
pub struct DeviceArgs {
    /// Where kernels run: auto, cpu, gpu, or gpu:SELECTOR (see `twinlight devices`)
    ///
    /// auto takes a hardware GPU if there is one, else the CPU; software adapters (lavapipe, SwiftShader) only run when
    /// asked for by gpu or gpu:SELECTOR. SELECTOR is a number or part of a name.
    #[arg(
        long,
        value_name = "BACKEND",
        env = "TWINLIGHT_BACKEND",
        default_value = "auto",
        help_heading = "Device"
    )]
    pub backend: BackendChoice,
    #[arg(long, help = help("--mode"), long_help = long_help("--mode"), value_name = "MODE", env = "TWINLIGHT_MODE", help_heading = "Device")]
    pub mode: Option<ModeName>,
    /// Threads of the CPU backend; the picture is the same for any number [default: one per core]
    #[arg(long, value_name = "N", env = "TWINLIGHT_THREADS", help_heading = "Device", allow_negative_numbers = true,
          value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
}
