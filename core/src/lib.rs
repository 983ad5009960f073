//! The contracts of twinlight: scenes, kernels, the [`Backend`] trait, and the mathematics that both twins of every
//! kernel share. No I/O, no threads, no GPU.

pub mod accuracy;
pub mod backend;
pub mod bvh;
pub mod circle;
pub mod directions;
pub mod error;
pub mod kernels;
pub mod lattice;
pub mod math;
pub mod scene;
pub mod srgb;
pub mod transport;

pub use accuracy::Accuracy;
pub use backend::{Backend, BackendInfo};
pub use error::{Error, Result};
