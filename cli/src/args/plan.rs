//! `plan`.

use super::PictureArgs;
use clap::Args;

const EXAMPLES: &str = "\
Examples:
  twinlight plan builtin:cornell
      what the reference tracer simulates of it, and what not
  twinlight plan room.toml --method voxel --explain
      with every kernel that is called, its work and its memory";

/// Decides what to simulate of a scene, as `render` does with the same flags, and says so: each effect with the reason, and with the
/// most radiance that a pixel can lack without it.
#[derive(Debug, Args)]
#[command(after_long_help = EXAMPLES, after_help = "`--help` shows examples and explains more.")]
pub struct PlanArgs {
    #[command(flatten)]
    pub picture: PictureArgs,
    /// Show the scene's properties and the calls of kernels too
    #[arg(long)]
    pub explain: bool,
    /// Print JSON; what is infinite is null
    #[arg(long)]
    pub json: bool,
    /// Of a scene that moves, this many seconds [default: 0]
    #[arg(long, value_name = "SECONDS", env = "TWINLIGHT_AT", value_parser = super::values::moment, allow_negative_numbers = true)]
    pub at: Option<f64>,
}
