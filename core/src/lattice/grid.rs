//! Grids of voxels over a lattice.

use super::REACH;
use crate::error::{Error, Result};
use bytemuck::{Pod, Zeroable};

/// Most voxels per axis.
pub const MAX_VOXELS: u32 = 512;

/// Bits of a coordinate within a grid: what a product of two differences of coordinates leaves of 32 bits.
pub const COORDINATE_BITS: u32 = 15;

/// Bits of fraction of [`VoxelGrid::scale`].
pub const SCALE_BITS: u32 = 14;

/// A box of nx × ny × nz cubic voxels over a lattice.
///
/// A lattice point p has the grid coordinates gₐ = ([`VoxelGrid::scale`]·pₐ + [`VoxelGrid::offset`]ₐ) >> [`SCALE_BITS`], clamped to
/// [0, nₐ·2ˢ − 1], in units of 2⁻ˢ voxels, s = [`VoxelGrid::subvoxel_bits`]; voxel i of an axis holds the coordinates from i·2ˢ up to
/// but not (i+1)·2ˢ.
///
/// *What that costs.* A vertex moves by at most half a unit, 2⁻⁷ voxels at 512 to an axis and 2⁻⁹ at 128. Points at one place stay at one
/// place. Points outside of the box are moved to its surface: choose a box that holds all there is.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
pub struct VoxelGrid {
    /// Voxels per axis, 1 to [`MAX_VOXELS`].
    pub dims: [u32; 3],
    /// Units per lattice step, times 2¹⁴; 0 to 2¹⁴.
    pub scale: i32,
    /// What puts the box's lower corner at 0, and half a unit for rounding, times 2¹⁴; within ±2³⁰.
    pub offset: [i32; 3],
    /// s, 6 to [`COORDINATE_BITS`].
    pub subvoxel_bits: u32,
}

impl VoxelGrid {
    /// The grid over the box from `low` to `high`, lattice points, whose longest axis has `resolution` voxels; the others have as many as
    /// they need. Where a voxel would have fewer lattice steps to a side than units there are fewer voxels: nothing is to be told apart within
    /// a step.
    ///
    /// # Errors
    /// [`Error::InvalidInput`] for a resolution of 0, a box that is empty or leaves the lattice; [`Error::LimitExceeded`] for more than
    /// [`MAX_VOXELS`].
    pub fn over(low: [i16; 3], high: [i16; 3], resolution: u32) -> Result<Self> {
        if resolution > MAX_VOXELS {
            return Err(Error::limit("voxels per axis", resolution.into(), MAX_VOXELS.into()));
        }
        if resolution == 0 {
            return Err(Error::invalid("resolution", "a grid of no voxels"));
        }
        for axis in 0..3 {
            let (a, b) = (i32::from(low[axis]), i32::from(high[axis]));
            if a > b || a < -REACH || b > REACH {
                let what = format!("{a} to {b} along axis {axis} is no part of the lattice");
                return Err(Error::invalid("voxel grid", what));
            }
        }
        let extents = [0, 1, 2].map(|axis| i64::from(high[axis]) - i64::from(low[axis]));
        // A point's box is one step wide.
        let longest = extents[0].max(extents[1]).max(extents[2]).max(1);
        let subvoxel_bits = COORDINATE_BITS - resolution.next_power_of_two().trailing_zeros();
        // Rounded down, and one unit less than there are: the upper corner is in the last voxel, and nothing in the box is clamped.
        let last = (i64::from(resolution) << subvoxel_bits) - 1;
        let scale = ((last << SCALE_BITS) / longest).min(1 << SCALE_BITS);
        let half = 1_i64 << (SCALE_BITS - 1);
        let dims =
            extents.map(|extent| (((extent * scale + half) >> SCALE_BITS >> subvoxel_bits) + 1) as u32);
        let offset = low.map(|c| (half - i64::from(c) * scale) as i32);
        Ok(Self { dims, scale: scale as i32, offset, subvoxel_bits })
    }

    /// Whether everything is in its range.
    ///
    /// # Errors
    /// [`Error::InvalidInput`] that names what isn't.
    pub fn check(&self) -> Result<()> {
        let Self { dims, scale, offset, subvoxel_bits } = *self;
        let longest = dims[0].max(dims[1]).max(dims[2]);
        let sound = dims.iter().all(|&n| (1..=MAX_VOXELS).contains(&n))
            && (6..=COORDINATE_BITS).contains(&subvoxel_bits)
            && longest << subvoxel_bits <= 1 << COORDINATE_BITS
            && (0..=1 << SCALE_BITS).contains(&scale)
            && offset.iter().all(|o| o.unsigned_abs() <= 1 << 30);
        if sound {
            Ok(())
        } else {
            Err(Error::invalid("voxel grid", format!("{self:?} is out of its budget")))
        }
    }

    /// Grid coordinates of a lattice point.
    #[inline(always)]
    pub fn place(&self, point: [i16; 3]) -> [i32; 3] {
        [0, 1, 2].map(|axis| {
            let sum = self.scale * i32::from(point[axis]) + self.offset[axis];
            (sum >> SCALE_BITS).clamp(0, ((self.dims[axis] << self.subvoxel_bits) as i32) - 1)
        })
    }

    /// Where a point in grid coordinates is, in lattice steps: the inverse of [`VoxelGrid::place`] without its rounding.
    pub fn lattice_point(&self, point: [f64; 3]) -> [f64; 3] {
        let half = f64::from(1 << (SCALE_BITS - 1));
        // No grid of `over`, but one that `check` accepts, has the scale 0: all of it is in one place.
        let scale = f64::from(self.scale.max(1));
        [0, 1, 2].map(|axis| {
            let units = point[axis] * f64::from(1 << SCALE_BITS);
            (units - (f64::from(self.offset[axis]) - half)) / scale
        })
    }

    /// P: the power of two not below the longest axis.
    pub fn padded(&self) -> u32 {
        self.dims[0].max(self.dims[1]).max(self.dims[2]).next_power_of_two()
    }

    /// Words of a mask of P³ bits.
    pub fn mask_words(&self) -> usize {
        mask_words(self.padded())
    }

    /// The grid of `level`, whose voxels are 2^`level` times as wide: its numbers of voxels.
    pub fn dims_at(&self, level: u32) -> [u32; 3] {
        self.dims.map(|n| n.div_ceil(1 << level))
    }

    /// Levels: 0 is the grid, the last one is one voxel.
    pub fn level_count(&self) -> u32 {
        self.padded().trailing_zeros() + 1
    }
}

/// Words of a mask of `padded`³ bits.
pub fn mask_words(padded: u32) -> usize {
    (padded as usize).pow(3).div_ceil(32)
}
