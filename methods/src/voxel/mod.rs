//! Voxel cone tracing: indirect light gathered through a few wide cones from a pyramid of lit voxels.
//!
//! [`build()`] voxelizes a scene, lights its voxels and reduces them to coarser levels; [`gather()`] sends cones from what the camera sees.
//! The direct light of a picture is that of [`crate::reference`] with one bounce. No noise from pixel to pixel but that of direct light (voxels' own light is sampled), and a bias that falls with the
//! size of voxels: light leaks through walls that are thinner than they are. *Source.* Rauwendaal, voxel cone tracing; Crassin et
//! al. 2011.

mod bright;
mod build;
mod cones;
mod gather;
mod light;
mod settings;
mod surfaces;

pub use build::{Lit, build};
pub(crate) use gather::CONES_AT_ONCE;
pub use gather::{Gathered, gather};
pub use settings::{Cones, MAX_BOUNCES, Storage, VoxelSettings};
pub use surfaces::{VoxelSurfaces, surfaces};
