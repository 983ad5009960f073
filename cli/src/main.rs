//! The `twinlight` command.

mod args;
mod budget;
mod compare;
mod conform;
mod cost;
mod device;
mod devices;
mod exit;
mod interrupt;
mod plan;
mod render;
mod report;
mod scene;
mod source;

use args::{Cli, Command};
use clap::{CommandFactory, Parser};
use exit::Failure;
use std::process::ExitCode;

fn main() -> ExitCode {
    quiet_drivers();
    let cli = Cli::parse();
    match run(cli.command) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            report::failure(&failure);
            ExitCode::from(failure.code())
        }
    }
}

/// Without a desktop session, Mesa's device selection layer prints "error: XDG_RUNTIME_DIR is invalid" whenever adapters
/// are listed: it looks for a compositor that this command has no use for.
fn quiet_drivers() {
    if std::env::var_os("XDG_RUNTIME_DIR").is_none() && std::env::var_os("NODEVICE_SELECT").is_none() {
        // SAFETY: the process has one thread still.
        unsafe { std::env::set_var("NODEVICE_SELECT", "1") };
    }
}

fn run(command: Command) -> Result<(), Failure> {
    match command {
        Command::Render(args) => render::run(&args),
        Command::Plan(args) => plan::run(&args),
        Command::Cost(args) => cost::run(&args),
        Command::Compare(args) => compare::run(&args),
        Command::Devices { json } => devices::run(json),
        Command::Scene(command) => scene::run(&command),
        Command::Conform(args) => conform::run(&args),
        Command::Completions { shell } => {
            let mut script = Vec::new();
            clap_complete::generate(shell, &mut Cli::command(), "twinlight", &mut script);
            report::print_bytes(&script)
        }
    }
}
