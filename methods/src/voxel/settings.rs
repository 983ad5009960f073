//! What the caller chooses.

use std::fmt;
use std::str::FromStr;
use twinlight_core::kernels::reduce_mips::{ANISOTROPIC, HARMONICS, HARMONICS_8, ISOTROPIC};
use twinlight_core::{Error, Result};

/// What a voxel stores of the light that leaves it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Storage {
    /// A colour.
    Isotropic,
    /// A colour per face.
    #[default]
    Anisotropic,
    /// Two bands of spherical harmonics per channel.
    Harmonics,
    /// Those in bytes.
    Harmonics8,
}

impl Storage {
    /// All, and their names.
    pub const NAMES: [(Self, &'static str); 4] = [
        (Self::Isotropic, "iso"),
        (Self::Anisotropic, "aniso"),
        (Self::Harmonics, "sh"),
        (Self::Harmonics8, "sh8"),
    ];

    /// For the kernels.
    pub fn code(self) -> u32 {
        match self {
            Self::Isotropic => ISOTROPIC,
            Self::Anisotropic => ANISOTROPIC,
            Self::Harmonics => HARMONICS,
            Self::Harmonics8 => HARMONICS_8,
        }
    }
}

impl fmt::Display for Storage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = Self::NAMES.iter().find(|(storage, _)| storage == self).map_or("", |(_, name)| name);
        f.write_str(name)
    }
}

impl FromStr for Storage {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self> {
        let found = Self::NAMES.iter().find(|(_, name)| *name == text).map(|(storage, _)| *storage);
        found.ok_or_else(|| Error::invalid("storage", format!("'{text}' is none of iso, aniso, sh, sh8")))
    }
}

/// Cones over a hemisphere.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cones {
    /// One along the normal and five around it, of 60° each, a sample per level.
    Six,
    /// So many, with samples that touch.
    Generic(u32),
}

/// Numbers of generic cones: fewer are no hemisphere.
const CONES: std::ops::RangeInclusive<u32> = 4..=256;

/// Most bounces: with an albedo of 0.9, a thousandth of the light is left after as many.
pub const MAX_BOUNCES: u32 = 64;

impl fmt::Display for Cones {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Six => f.write_str("6"),
            Self::Generic(count) => write!(f, "generic:{count}"),
        }
    }
}

impl FromStr for Cones {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self> {
        let invalid =
            || Error::invalid("cones", format!("'{text}' is neither 6 nor generic nor generic:4 to 256"));
        match text {
            "6" => return Ok(Self::Six),
            "generic" => return Ok(Self::Generic(16)),
            _ => {}
        }
        let count = text.strip_prefix("generic:").and_then(|count| count.parse().ok()).ok_or_else(invalid)?;
        if CONES.contains(&count) { Ok(Self::Generic(count)) } else { Err(invalid()) }
    }
}

/// What the accuracy of voxel cone tracing depends on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VoxelSettings {
    /// Voxels along the longest axis, 1 to 512.
    pub grid: u32,
    /// What voxels store.
    pub storage: Storage,
    /// Cones over the hemisphere of diffuse light.
    pub cones: Cones,
    /// Shadow rays per voxel.
    pub light_samples: u32,
    /// How often light is scattered, the camera's vertex and those in voxels together: 2 is light from lit voxels, every one more is
    /// gathered by the voxels themselves, up to [`MAX_BOUNCES`]. With 0 and 1 nothing is gathered.
    pub bounces: u32,
    /// Whether cones gather what lobes and mirrors reflect.
    pub shining: bool,
    /// Seed of the voxels' light samples.
    pub seed: u32,
}

impl Default for VoxelSettings {
    fn default() -> Self {
        Self {
            grid: 128,
            storage: Storage::default(),
            cones: Cones::Six,
            light_samples: 8,
            bounces: 3,
            shining: true,
            seed: 0,
        }
    }
}
