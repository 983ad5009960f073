// kernel family: light_voxels
// contract core/src/kernels/light_voxels.rs
// cpu backend-cpu/src/kernels/light_voxels.rs
// gpu backend-gpu/src/kernels/light_voxels.wgsl
// oracle conformance/src/oracle/light_voxels.rs
//! `light_voxels`: the light that leaves active voxels: what lights shine on them, what they emit, and what was gathered for them.
//!
//! *Shapes.* A scene; `active[A]`, codes; `sums[A]` of [`crate::kernels::sum_voxels`]; `gathered[A]` of irradiance, or none; `leaves[A]` out, for
//! [`crate::kernels::reduce_mips`]. *Units.* Radiance · [`LightVoxelsBlock::scale`] in the leaves, rounded; lengths in world units.
//!
//! *Meaning.* For the voxel (i, j, k) of each code, in f32, in the order written:
//! 1. *Surface.* Its centre c = [`VoxelFrame::corner`] + ((i, j, k) + ½)·(1/[`VoxelFrame::voxels_per_unit`]), its albedo ρ = `albedo` / (`count` · 4095) per channel,
//!    its normal n along `normal`, of unit length; where that is 0 0 0 there is none. Without fragments the leaf is all zeroes.
//! 2. *Samples.* For s from 0 to [`LightVoxelsBlock::samples`] − 1: a light and a point on it as `trace_paths` choose them, seen from c, from the pairs 0 (point), 1 (light)
//!    and 2 (texel) of the Sobol sequence of stream `mix_pair(seed, code)`, sample s.
//! 3. *Shadow.* The ray begins at o = c + n·(±[`LIFT`] voxels), on the light's side of the surface, or at c without a normal, and ends at the light as shadow
//!    rays of `trace_paths` do; none is sent where the scene says so ([`crate::scene::NOTHING_HIDES`]).
//! 4. *Irradiance.* E += emission · |n·ω| / pdf where nothing is in between; ω is the direction from c. Without a normal ½ stands for the
//!    cosine, its mean over all normals.
//! 5. *Leaf.* L = (`albedo`·((1/(`count`·4095))·(1/π)))·(E·(1/samples) + `gathered`) + `emission`·([`LightVoxelsBlock::emission_unit`]/`count`), in this
//!    order, that is ρ/π times irradiance, and emission; without lights or samples E·(1/samples) is 0. r, g, b are ⌊L·scale + ½⌋, at most
//!    [`MAX_RADIANCE`]; 0 where that is no number or below 0. The opacity is [`OPAQUE`].
//!
//! *Why both sides.* A voxel knows no side: triangles face either way, and a thin wall is lit from either. What shines on both adds up.
//! *Why lifted.* A thin voxel's surface crosses its dominant axis within it, ½ a voxel from the centre at most: from [`LIFT`] on a ray no longer meets
//! the plane it starts on.
//! *Edge cases.* No lights, no samples: emission and what was gathered. No active voxels: nothing.
//! *Cost.* A shadow ray per sample: 200 k voxels and 4 samples are 0.8 M rays. Nothing is voxelized again when lights change.
//! *Errors.* Sums and codes of other origin: some light.
//! *Source.* Rauwendaal, voxel cone tracing (7.1): light is put in as voxels are made; here from the active list, so that lights may
//! change. Rays instead of a shadow map, from the voxel as there.

use crate::accuracy::Accuracy;
use crate::error::{Error, Result};
use crate::kernels::trace_cones::VoxelFrame;
use bytemuck::{Pod, Zeroable};

#[cfg(doc)]
use crate::kernels::reduce_mips::{MAX_RADIANCE, OPAQUE};

/// Chooses lights and shades by floats.
pub const ACCURACY: Accuracy = Accuracy::Interval {
    because: "exact in strict mode; elsewhere a few ulp per sample, a shadow ray that grazes an edge, and one unit where a half is rounded",
};

/// How far from a voxel's centre rays start, voxels.
pub const LIFT: f32 = 0.625;

/// Most samples per voxel.
pub const MAX_SAMPLES: u32 = 4096;

/// Parameters of one call.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct LightVoxelsBlock {
    /// Where the grid is.
    pub frame: VoxelFrame,
    /// Seed of the samples.
    pub seed: u32,
    /// Samples per voxel.
    pub samples: u32,
    /// Integers per unit of radiance.
    pub scale: f32,
    /// Radiance per unit of the sums' emission; 0 leaves it out.
    pub emission_unit: f32,
}

impl LightVoxelsBlock {
    /// The number of voxels, if the call is sound; lengths are those of `active`, `sums`, `gathered` and `leaves`.
    ///
    /// # Errors
    /// [`Error::InvalidInput`] for lengths that differ (`gathered` may be empty) and parameters that are not finite,
    /// [`Error::LimitExceeded`] beyond [`MAX_SAMPLES`].
    pub fn check(&self, lengths: [usize; 4]) -> Result<usize> {
        let [active, sums, gathered, leaves] = lengths;
        if sums != active || leaves != active || (gathered != active && gathered != 0) {
            let what = format!("{active} codes, {sums} sums, {gathered} gathered, {leaves} leaves");
            return Err(Error::invalid("light_voxels", what));
        }
        if self.samples > MAX_SAMPLES {
            return Err(Error::limit("samples per voxel", self.samples.into(), MAX_SAMPLES.into()));
        }
        let VoxelFrame { corner: [x, y, z], voxels_per_unit } = self.frame;
        let finite = [x, y, z, voxels_per_unit, self.scale, self.emission_unit].iter().all(|v| v.is_finite());
        if !finite || !(voxels_per_unit > 0.0) {
            return Err(Error::invalid("light_voxels", format!("{self:?} is not finite")));
        }
        Ok(active)
    }
}
