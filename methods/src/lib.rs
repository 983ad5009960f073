//! Light transport methods, each generic over the backend, and what happens to their images afterwards.
//!
//! [`post`] compares, tone-maps and colours finished images; it knows no backend. [`cost`] measures what accuracy takes.

pub mod budget;
pub mod cost;
mod gbuffer;
mod meter;
pub mod plan;
pub mod post;
pub mod reference;
mod run;
pub mod slhb;
pub mod voxel;

pub use gbuffer::gbuffer;
pub use meter::{Calls, Metered};
pub use run::{Built, Made, Picture, Surfaces};
