//! The command line.

mod compare;
mod conform;
mod cost;
mod device;
mod picture;
mod plan;
mod render;
mod scene;
mod values;
mod voxel;

pub use compare::CompareArgs;
pub use conform::ConformArgs;
pub use cost::CostArgs;
pub use device::DeviceArgs;
pub use picture::PictureArgs;
pub use plan::PlanArgs;
pub use render::{
    ConeName, GatherName, LoadArgs, MAX_MEMORY, MethodName, MissesName, ModeName, ProgressMode, RenderArgs,
    Show, SlhbArgs, ToneArgs,
};
pub use scene::{ConvertArgs, InspectArgs, SceneCommand};
pub use values::{BackendChoice, Bounces, FrameRange, Size};
pub use voxel::VoxelArgs;

use crate::exit;
use clap::{Parser, Subcommand};

/// Global illumination on a CPU or a GPU, with the same bits on both.
#[derive(Debug, Parser)]
#[command(name = "twinlight", version, max_term_width = 100, after_help = START, after_long_help = long_help())]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

const START: &str = "\
Start with:
  twinlight render builtin:cornell    writes cornell.png, cornell.exr and cornell.json here
  twinlight scene list                other scenes that need no file
  twinlight help render               every flag, with examples";

fn long_help() -> String {
    format!("{START}\n\n{}", exit::TABLE)
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Render a scene to PNG and EXR
    Render(Box<RenderArgs>),
    /// Say what a render would simulate, what it would leave out, and why
    Plan(Box<PlanArgs>),
    /// Measure what accuracy costs: which settings of which method are worth their time
    Cost(Box<CostArgs>),
    /// Compare two pictures: error metrics with their formulas
    Compare(CompareArgs),
    /// Show what kernels can run on: the CPU and GPU adapters
    Devices {
        /// Print JSON
        #[arg(long)]
        json: bool,
    },
    /// Look at scenes and convert them
    #[command(subcommand)]
    Scene(SceneCommand),
    /// Check every backend of this machine against the kernels' contracts
    Conform(ConformArgs),
    /// Print a completion script for a shell
    #[command(
        after_help = "Example:\n  twinlight completions bash > ~/.local/share/bash-completion/completions/twinlight"
    )]
    Completions {
        /// The shell
        shell: clap_complete::Shell,
    },
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::{Arg, CommandFactory};
    use twinlight::methods::cost::KNOBS;

    fn flags() -> Vec<Arg> {
        let cli = Cli::command();
        let render = cli.find_subcommand("render").unwrap();
        render.get_arguments().cloned().collect()
    }

    /// The table of knobs says what the command line does.
    #[test]
    fn every_knob_is_a_flag_with_its_default() {
        for knob in KNOBS {
            let flags = flags();
            let flag = flags.iter().find(|flag| flag.get_long() == knob.flag.strip_prefix("--"));
            let flag = flag.unwrap_or_else(|| panic!("render has no {}", knob.flag));
            let help = flag.get_help().unwrap().to_string();
            assert_eq!(help, knob.help, "{}", knob.flag);
            let defaults: Vec<_> =
                flag.get_default_values().iter().map(|value| value.to_str().unwrap()).collect();
            let said = ["default: ", "else "].map(|before| format!("{before}{}", knob.default));
            let is_said = defaults.is_empty() && said.iter().any(|text| help.contains(text));
            assert!(defaults == [knob.default] || is_said, "{}: {defaults:?}, {}", knob.flag, knob.default);
        }
    }

    #[test]
    fn every_flag_of_a_method_is_a_knob() {
        // It draws what a method works with, and trades nothing.
        let others = ["show"];
        for method in ["slhb", "voxel"] {
            let heading = format!("Method {method}");
            let flags = flags();
            let of_method = flags.iter().filter(|flag| flag.get_help_heading() == Some(heading.as_str()));
            let names: Vec<&str> =
                of_method.filter_map(Arg::get_long).filter(|name| !others.contains(name)).collect();
            let table = KNOBS.iter().filter(|knob| knob.method == method);
            let known: Vec<&str> = table.map(|knob| &knob.flag[2..]).collect();
            assert_eq!(names, known);
        }
    }
}
