// kernel family: trace_cones
// contract core/src/kernels/trace_cones.rs
// cpu backend-cpu/src/kernels/trace_cones.rs
// gpu backend-gpu/src/kernels/trace_cones.wgsl
// oracle conformance/src/oracle/trace_cones.rs
//! `trace_cones`: the light that comes through cones, and how much of them is open, from the levels of a grid of voxels.
//!
//! *Shapes.* [`VoxelLevels`] with their `values` in one of the storages of [`crate::kernels::reduce_mips`] that hold light, and `cones[n]` in;
//! `light[n]` out. *Units.* Positions and lengths in world units, relative to [`crate::scene::CompiledScene::origin`]; radiance in the values' unit
//! times [`TraceConesBlock::unit`].
//!
//! *Meaning.* All of it in f32, in the order written; a·b·c is (a·b)·c. Lengths below are in voxels.
//! 1. *Place.* P = (`origin` − [`VoxelFrame::corner`]) · [`VoxelFrame::voxels_per_unit`], d = `start` · `voxels_per_unit`, s = `sine`, brought into
//!    [0, [`MAX_SINE`]]; what is no number counts as 0.
//! 2. *March.* A sphere of radius r rolls along the axis, each touching the one before: r = max(d·s, ½); it is sampled at p = P + d·`direction`
//!    with the width w = 2r; then d becomes max(d + 2r, (d + r)/(1 − s)). With [`SIXTY_DEGREES`], s is not read: d is first the least power of two
//!    that is at least max(d, 1), r = d/2, and d doubles: every sample is on a level, and costs half.
//! 3. *End.* At [`MAX_STEPS`] samples; when the place before p (P before the first) is outside of the grid, that is a coordinate is below 0 or
//!    above the number of voxels, or is no number; when the sphere misses the grid, that is not every coordinate of p is above −r and below that
//!    number + r; when d is not at most `reach` · `voxels_per_unit`; when at most [`LEAST_TRANSMITTANCE`] is left. So the first sample beyond the border is
//!    the last. It is taken at the place in the grid next to p.
//! 4. *Level.* w ≥ 1 is m·2ˡ with 1 ≤ m < 2. Its sample is (1 − f)·S(l) + f·S(l + 1) with f = m − 1, where f > 0 and l is not the last level; from the last
//!    level on it is that of the last.
//! 5. *Filter.* S(l): q = p·2⁻ˡ − ½, i = ⌊q⌋, g = q − i; the eight voxels i, i + 1 of level l, brought into the ⌈n·2⁻ˡ⌉ voxels that the level has along an axis of n, weigh
//!    (1 − g) and g per axis, the products x·y·z. The sum runs over x first, then y, then z. A voxel that is not active is zero. With a `normal` n, voxels
//!    count only in front of the surface: their centre C is higher above the plane through P, n·C − n·P, than half of what they span along n,
//!    ½·(|nₓ|+|n_y|+|n_z|)·2ˡ, and [`PLANE_MARGIN`]. S(l) is the sum times 1 / the sum of the weights that count (which is near 1 where all do), and zero
//!    where that is not above zero.
//! 6. *Value.* What leaves a voxel against the cone's direction ω, (rgb, opacity) as f32 of its integers: isotropic as they are; anisotropic
//!    Σ over the axes of ω²·face, the face being the one that ω comes in by: + where ω < 0, else −; harmonics
//!    max(a₀ − ((aₓωₓ + a_yω_y) + a_zω_z), 0) per channel; in 8 bits the same of q times 2ᵉ. But for anisotropic ones, whose opacity
//!    is that of a way through, opacity o (over [`OPAQUE`](crate::kernels::reduce_mips::OPAQUE)) is a mean over the voxel's space, of which 2ˡ layers are behind each other: with u = 1 − o (0 where o ≥ 1), squared l
//!    times, the value is multiplied by (1 − u)/o where o > 0. Opacity is divided by `OPAQUE` in the end, which is exact.
//! 7. *Blend.* With t = 1 at first: `rgb` += t·sample, t ·= 1 − min(opacity, 1). In the end `rgb` · `unit`, and t.
//!
//! *Why in front.* A surface's own voxels, and those of coarser levels that they are in, are beside every cone that leaves it: it would
//! light and shadow itself on every level, by a third of its light in a room. A flat open floor sees nothing of itself.
//! *Why a sample beyond the border.* The walls of a room are the border of its grid. Where cones ended with their last centre in the grid, they
//! would miss walls that are nearer to the next one, and lose a tenth to a fifth of the light of a closed room. Within r of the border the last voxel
//! has all of its weight already, between levels at least 7/8: little is missed, and rays without aperture meet no voxel twice.
//! *Why layers.* A wall one voxel thick fills 2⁻ˡ of a voxel of level l, and is all that light through it meets. Taken as an opacity, the mean
//! would let light through on every level but the first: a room shows a tenth of its light.
//! *Why m − 1.* The weight of the coarser level is linear in the width, as filters are, and takes no logarithm.
//! *Edge cases.* No cones, no voxels: nothing, open cones. A cone whose apex is outside of the grid is open. `sine` 0 is a ray march with a sphere of one
//! voxel; from [`MAX_SINE`] on (140°) cones are that wide. A direction that is no unit vector, or has a zero in it, is as good as any: nothing is divided by
//! it.
//! *Errors.* Levels of other origin: some light, and nothing outside of the buffers is read.
//! *Source.* Crassin et al., "Interactive indirect illumination using voxel cone tracing", 2011; Rauwendaal, voxel cone tracing: spheres that touch,
//! the 60° cone, ambient cubes. Deviations: bounded from 140° on; in 60° cones spheres overlap, as there, so that what is on the axis counts by up to a
//! third twice.

use crate::accuracy::Accuracy;
use crate::error::{Error, Result};
use crate::kernels::reduce_mips::{HARMONICS_8, VoxelLevelBuffers, words_of};
use bytemuck::{Pod, Zeroable};

#[cfg(doc)]
use crate::kernels::reduce_mips::VoxelLevels;

/// Filters and blends floats.
pub const ACCURACY: Accuracy = Accuracy::Interval {
    because: "exact in strict mode; elsewhere a few ulp per sample, and a voxel's width where ⌊q⌋ or the end of a cone is decided by a rounding",
};

/// Most of [`Cone::sine`]: spheres grow thirty-one times then, and the next is beyond most scenes.
pub const MAX_SINE: f32 = 0.9375;
/// Most samples of a cone: a ray through the diagonal of the largest grid takes 887.
pub const MAX_STEPS: u32 = 1024;
/// What a voxel must be above a plane beyond its own span, voxels: vertices are moved by 2⁻⁶ at most in a grid of 512, and f32 by less.
pub const PLANE_MARGIN: f32 = 0.0625;
/// What is left of a cone that is done with, 2⁻⁸: less than a step of 8 bits.
pub const LEAST_TRANSMITTANCE: f32 = 0.003_906_25;

/// [`TraceConesBlock::flags`]: cones of 60°, a sample per level.
pub const SIXTY_DEGREES: u32 = 1;

/// A cone.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct Cone {
    /// Its apex.
    pub origin: [f32; 3],
    /// Sine of half its aperture.
    pub sine: f32,
    /// Unit direction.
    pub direction: [f32; 3],
    /// Distance to the first sample's centre.
    pub start: f32,
    /// Unit normal of a surface, or 0 0 0 for none: what isn't above the plane through the apex is not seen. An apex above its surface hides
    /// as much more.
    pub normal: [f32; 3],
    /// Unused, 0.
    pub padding: u32,
}

/// What comes through a cone.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct ConeLight {
    /// Mean radiance over the cone.
    pub rgb: [f32; 3],
    /// What is left of light from beyond.
    pub transmittance: f32,
}

/// Where a grid is in the world.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct VoxelFrame {
    /// Its lower corner.
    pub corner: [f32; 3],
    /// 1 / width of a voxel.
    pub voxels_per_unit: f32,
}

/// Parameters of one call.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct TraceConesBlock {
    /// Where the grid is.
    pub frame: VoxelFrame,
    /// Radiance of a unit of the values.
    pub unit: f32,
    /// Farthest sample.
    pub reach: f32,
    /// One of the storages that hold light.
    pub storage: u32,
    /// [`SIXTY_DEGREES`].
    pub flags: u32,
}

impl TraceConesBlock {
    /// Whether the call is sound; `len` gives the length of a buffer of `levels`, and there are so many words of values.
    ///
    /// # Errors
    /// [`Error::InvalidInput`] for a storage that holds no light, other than a value per active voxel, other than a result per cone, a frame that is
    /// not finite, and as [`VoxelLevelBuffers::check`].
    pub fn check<U>(
        &self,
        levels: &VoxelLevelBuffers<U>,
        len: impl Fn(&U) -> usize,
        values: usize,
        cones: [usize; 2],
    ) -> Result<()> {
        if self.storage > HARMONICS_8 {
            return Err(Error::invalid("storage", format!("{} holds no light", self.storage)));
        }
        levels.check(len)?;
        let wanted = words_of(self.storage)? * levels.starts[levels.starts.len() - 1] as usize;
        if values != wanted {
            return Err(Error::invalid(
                "trace_cones values",
                format!("{values} words where {wanted} are needed"),
            ));
        }
        if cones[0] != cones[1] {
            let what = format!("has {} elements where {} are needed", cones[1], cones[0]);
            return Err(Error::invalid("trace_cones light", what));
        }
        let VoxelFrame { corner: [x, y, z], voxels_per_unit } = self.frame;
        if ![x, y, z, voxels_per_unit, self.unit].iter().all(|v| v.is_finite()) || !(voxels_per_unit > 0.0) {
            return Err(Error::invalid("trace_cones", format!("{:?}, unit {}", self.frame, self.unit)));
        }
        Ok(())
    }
}
