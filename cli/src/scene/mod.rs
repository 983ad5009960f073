//! `scene`: look at scenes and convert them.

mod convert;
mod inspect;
mod ply;
mod toml;

use crate::args::SceneCommand;
use crate::exit::Failure;
use crate::report;
use serde_json::{Value, json};
use twinlight::io::{builtin, toml_scene};

/// Runs the command.
///
/// # Errors
/// Those of reading and writing.
pub fn run(command: &SceneCommand) -> Result<(), Failure> {
    match command {
        SceneCommand::Inspect(args) => inspect::run(args),
        SceneCommand::Convert(args) => convert::run(args),
        SceneCommand::List { json } => report::print(&list(*json)),
        SceneCommand::Schema => report::print(&toml_scene::json_schema()),
    }
}

fn list(as_json: bool) -> String {
    let names = builtin::names();
    if as_json {
        let rows: Value = names
            .iter()
            .map(|(name, about)| json!({ "name": format!("builtin:{name}"), "about": about }))
            .collect();
        return format!("{rows:#}\n");
    }
    names.iter().map(|(name, about)| format!("{:20} {about}\n", format!("builtin:{name}"))).collect()
}
