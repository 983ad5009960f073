//! WGSL twin of every kernel, on wgpu.
//!
//! A [`GpuDevice`] is opened on one adapter in one [`Mode`]: strict, where float arithmetic is evaluated as written and
//! results are those of the CPU backend bit for bit, or portable, plain WGSL. Kernels are pairs of a `.wgsl` file and a
//! host-side `.rs` file under `kernels`.
//!
//! Nothing panics: a missing adapter, a limit, a lost device are [`twinlight_core::Error`]s, and no wait is unbounded.

pub mod adapter;
pub mod backend;
pub mod buffer;
pub mod device;
pub mod dispatch;
pub mod kernels;
pub mod mesh;
pub mod pipeline;
pub mod reflect;
pub mod scene;
pub mod shared;
pub mod source;
pub mod strict;

pub use adapter::{AdapterLimits, AdapterReport, AdapterSelector, adapters};
pub use backend::GpuBackend;
pub use buffer::GpuBuffer;
pub use device::{DeviceOptions, GpuDevice};
pub use mesh::GpuMesh;
pub use scene::GpuScene;
pub use strict::Mode;
