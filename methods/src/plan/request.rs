//! What is asked for.

use super::Effects;
use crate::reference::Settings;
use crate::slhb::LookupSettings;
use crate::voxel::VoxelSettings;

/// A method, and what its accuracy depends on.
#[derive(Debug, Clone, PartialEq)]
pub enum Method {
    /// [`crate::reference`].
    Reference,
    /// [`crate::slhb`].
    Slhb {
        /// Of the hit buffers and the lookups.
        lookups: LookupSettings,
        /// Pixels per row and column of the window over which indirect light is averaged; 1 averages nothing.
        filter: u32,
    },
    /// [`crate::voxel`]. Its bounces and its seed are those of the picture.
    Voxel(VoxelSettings),
}

impl Method {
    /// As it is written on the command line.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Reference => "reference",
            Self::Slhb { .. } => "slhb",
            Self::Voxel(_) => "voxel",
        }
    }
}

/// A picture that is asked for.
#[derive(Debug, Clone, PartialEq)]
pub struct Request {
    /// How.
    pub method: Method,
    /// Size, samples and bounces.
    pub picture: Settings,
    /// Which effects are wanted.
    pub effects: Effects,
    /// Most radiance that a pixel may lack because of what is left out; 0 leaves out only what isn't there.
    pub tolerance: f64,
}
