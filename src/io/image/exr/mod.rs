//! OpenEXR: environments and renders.

mod canonical;
mod read;
mod write;

pub use read::{read_attributes, read_environment, read_layers, read_rgb};
pub use write::{encode, write};

/// The first bytes of every EXR file.
pub const MAGIC: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];

/// Begins the names of the attributes written here: the format keeps `version`, `type`, `name` and others for itself.
pub const NAMESPACE: &str = "twinlight.";
