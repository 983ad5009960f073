//! `scene`.

use super::LoadArgs;
use clap::{Args, Subcommand};
use std::path::PathBuf;

/// What can be done with scenes.
#[derive(Debug, Subcommand)]
pub enum SceneCommand {
    /// Say what is in a scene: meshes, materials, lights, camera, bounds, memory
    Inspect(InspectArgs),
    /// Write a scene as PLY (geometry) or as TOML with PLY meshes
    Convert(ConvertArgs),
    /// List the builtin scenes
    List {
        /// Print JSON
        #[arg(long)]
        json: bool,
    },
    /// Print the JSON Schema of TOML scene files
    #[command(
        after_help = "Example:\n  twinlight scene schema > scene.schema.json\n  and in a scene file, as its first \
                            line:  \"$schema\" = \"scene.schema.json\""
    )]
    Schema,
}

/// Reads a scene as `render` would and says what is in it.
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  twinlight scene inspect builtin:cornell\n  twinlight scene inspect bunny.obj --json"
)]
pub struct InspectArgs {
    /// A scene file or builtin:NAME
    #[arg(value_name = "SCENE")]
    pub scene: String,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
    #[command(flatten)]
    pub load: LoadArgs,
}

/// Writes a scene in another format. TOML keeps everything a scene file can say, with a PLY file per mesh and material
/// in a folder beside it; PLY keeps geometry only.
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  twinlight scene convert room.glb room.toml    room.toml and room-files/\n  twinlight \
                        scene convert room.obj room.ply     one binary PLY, world space, geometry only"
)]
pub struct ConvertArgs {
    /// A scene file or builtin:NAME
    #[arg(value_name = "IN")]
    pub scene: String,
    /// The file to write, .toml or .ply
    #[arg(value_name = "OUT")]
    pub output: PathBuf,
    #[command(flatten)]
    pub load: LoadArgs,
}
