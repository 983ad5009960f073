//! Light transport methods, each generic over the backend, and what happens to their images afterwards.
//!
//! [`post`] compares, tone-maps and colours finished images; it knows no backend.

mod gbuffer;
pub mod post;
pub mod reference;
pub mod slhb;
pub mod voxel;

pub use gbuffer::gbuffer;
