//! OBJ, PLY and TOML scene files: what they mean, what their errors say, what hostile ones can't do.
#![cfg(feature = "io")]

mod completion;
mod errors;
mod folders;
mod limits;
mod motion;
mod obj;
mod ply;
mod toml_scenes;

use twinlight::io::LoadOptions;
use twinlight::io::resolve::MemoryFiles;
use twinlight_core::Result;
use twinlight_core::scene::Scene;

/// Files in memory, from texts.
fn files(texts: &[(&str, &str)]) -> MemoryFiles {
    MemoryFiles::new(texts.iter().map(|(path, text)| ((*path).to_owned(), text.as_bytes().to_vec())))
}

/// Reads `text` as the file `name`, by its extension, beside `others`.
fn read(name: &str, text: &str, others: &[(&str, &str)], options: &LoadOptions) -> Result<Scene> {
    read_bytes(name, text.as_bytes(), &files(others), options)
}

fn read_bytes(name: &str, bytes: &[u8], files: &MemoryFiles, options: &LoadOptions) -> Result<Scene> {
    use twinlight::io::{obj, ply, toml_scene};
    let parse = match name.rsplit('.').next() {
        Some("obj") => obj::parse,
        Some("ply") => ply::parse,
        _ => toml_scene::parse,
    };
    parse(bytes, name, files, options)
}
