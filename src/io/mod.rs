//! Files: scenes and pictures in, pictures out.

mod atomic;
pub mod image;

pub use atomic::write_file;
