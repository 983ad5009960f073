//! Files: scenes and pictures in, pictures out.
//!
//! Scene files are hostile until read: nothing outside the scene's folder is opened ([`resolve`]), nothing larger than
//! the limits is allocated, nothing panics, and errors name file, line, column and value. Every reader has an entry
//! `parse(bytes, name, files, options)` that needs no file system.

mod atomic;
pub mod builtin;
mod complete;
pub mod gltf;
pub mod image;
mod load;
pub mod obj;
mod options;
pub mod ply;
pub mod resolve;
mod text;
pub mod toml_scene;

pub use atomic::write_file;
pub use complete::complete;
pub use load::{load, load_with_settings};
pub use options::LoadOptions;
