//! The Rust twin of every twinlight kernel, on rayon.
//!
//! [`CpuBackend`] implements [`twinlight_core::Backend`]. The same input gives the same bits for any number of threads,
//! on any instruction set, inside a caller's thread pool and beside other calls: work is cut into chunks of fixed size,
//! results are written by index, and nothing is decided by which thread came first.
//!
//! ```
//! use twinlight_backend_cpu::CpuBackend;
//! use twinlight_core::Backend;
//!
//! # fn main() -> twinlight_core::Result<()> {
//! let backend = CpuBackend::new();
//! let counts = backend.upload(&[3_u32, 0, 5])?;
//! let mut offsets = backend.zeroed(3)?;
//! assert_eq!(backend.scan(&counts, &mut offsets)?, 8);
//! assert_eq!(backend.download(&offsets)?, [0, 3, 3]);
//! # Ok(())
//! # }
//! ```

mod backend;
mod buffer;
pub mod bvh8;
mod huge;
mod kernels;
mod mesh;
mod parallel;
mod path;
mod processor;
mod sampler;
mod scene;
mod scratch;
pub mod simd;
mod tracer;

pub use backend::CpuBackend;
pub use buffer::CpuBuffer;
pub use mesh::CpuMesh;
pub use scene::{CpuScene, SceneData};
