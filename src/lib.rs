//! Global illumination on machines with or without a GPU: every kernel exists twice, in Rust on rayon and in WGSL on
//! wgpu, and gives the same bits wherever decisions are made.
//!
//! This crate puts the parts together. A [`scene`] is described or read ([`io`]), compiled once, made resident on a
//! [`Backend`] ([`cpu`] or `gpu`) and rendered by one of the [`methods`], none of which knows which backend it runs on.
//!
//! ```
//! # #[cfg(all(feature = "cpu", feature = "io", feature = "methods"))]
//! fn main() -> twinlight::Result<()> {
//!     use twinlight::cpu::CpuBackend;
//!     use twinlight::methods::reference::{Control, Settings, render};
//!     use twinlight::{Backend, io, scene};
//!
//!     let mut room = io::load("builtin:cornell", &io::LoadOptions::default())?;
//!     io::complete(&mut room);
//!     let compiled = scene::compile(&room, &scene::Limits::default())?;
//!     let backend = CpuBackend::new();
//!     let resident = backend.upload_scene(&compiled)?;
//!     let camera = scene::Camera::of_scene(&room).expect("complete() gave it one");
//!     let settings = Settings { width: 8, height: 8, samples: 4, ..Settings::default() };
//!     let rendered = render(&backend, &resident, &compiled, &camera, &settings, |_| Control::Continue)?;
//!     assert!(rendered.film.radiance().iter().flatten().any(|&radiance| radiance > 0.0));
//!     Ok(())
//! }
//! # #[cfg(not(all(feature = "cpu", feature = "io", feature = "methods")))]
//! # fn main() {}
//! ```
//!
//! | feature | gives | default |
//! |---|---|---|
//! | `cpu` | [`cpu`]: the kernels on rayon | yes |
//! | `gpu` | `gpu`: the kernels on wgpu | no |
//! | `io` | [`io`]: scene files, pictures, builtin scenes; [`fixtures`] | yes |
//! | `methods` | [`methods`]: the reference path tracer, metrics, tone mapping | yes |

#[cfg(feature = "io")]
pub mod io;

#[cfg(feature = "cpu")]
pub use twinlight_backend_cpu as cpu;
#[cfg(feature = "gpu")]
pub use twinlight_backend_gpu as gpu;
#[cfg(feature = "io")]
pub use twinlight_fixtures as fixtures;
#[cfg(feature = "methods")]
pub use twinlight_methods as methods;

pub use twinlight_core::{
    Accuracy, Backend, BackendInfo, Error, Result, accuracy, backend, bvh, directions, error, kernels,
    lattice, math, scene, transport,
};

// README's example, compiled and run with the documentation's.
#[cfg(all(doctest, feature = "cpu", feature = "io", feature = "methods"))]
#[doc = include_str!("../README.md")]
struct Readme;
