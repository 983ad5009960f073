// kernel family: sum_voxels
// contract core/src/kernels/sum_voxels.rs
// cpu backend-cpu/src/kernels/sum_voxels.rs
// gpu backend-gpu/src/kernels/sum_voxels.wgsl
// oracle conformance/src/oracle/sum_voxels.rs
//! `sum_voxels`: sums of albedo, normal and emission over the triangles that meet a voxel.
//!
//! *Shapes.* The mesh of T triangles and the parameters that [`crate::kernels::voxelize`] was called with, its [`Voxels`] with A active ones,
//! `surfaces[T]` of [`VoxelSurface`], `texels`; out, `sums[A]` of [`VoxelSums`], in the order of `active`.
//! *Units.* Albedo in 1/[`ALBEDO_ONE`], normals in 1/[`NORMAL_ONE`], emission in whatever unit [`VoxelSurface::emission`] has.
//!
//! *Meaning.* Each pair of a triangle and a voxel that it meets is a *fragment*, which adds 1 to the voxel's `count` and what the surface is
//! at the point of the triangle that the voxel's centre is projected to, along the triangle's dominant axis:
//! 1. *Weights.* Eᵢ is the edge function, in that projection and at the centre, of the edge opposite to corner i, and aᵢ = max(Eᵢ, 0): a centre
//!    beside the triangle counts as the next one in it, in that sense. With t = max(0, bits of (a₀+a₁+a₂) − 17), aᵢ' = ⌊aᵢ / 2ᵗ⌋ and
//!    W = max(a₀'+a₁'+a₂', 1): wᵢ = ⌊2¹⁴·aᵢ' / W⌋ for i = 1, 2, and w₀ = 2¹⁴ − w₁ − w₂.
//! 2. *Normal.* Per axis (Σ wᵢ·nᵢ + 2¹³) >> 14, nᵢ being the signed bytes of [`VoxelSurface::normals`].
//! 3. *Texel.* u = (Σ wᵢ·uᵢ) >> 20 and v likewise: whole texels, rounded down. Then modulo width and height, or clamped to
//!    them with [`CLAMP`]; texel v·width + u from [`VoxelSurface::texture`] on. There is none where it is [`NONE`]: 1023 in each channel.
//! 4. *Albedo.* Per channel (tint·texel + 511) div 1023.
//! 5. *Emission* as it is.
//!
//! *How 32 bits suffice.* a₀+a₁+a₂ < 2³² and 2¹⁴·aᵢ' < 2³¹; |uᵢ| is at most 2¹⁶ and Σ wᵢ·uᵢ at most 2³⁰; tint·texel is below 2²². Sums of
//! [`MAX_FRAGMENTS`] albedos or emissions of 12 bits fill 32 bits.
//! *Accuracy.* Weights are rounded down to 2⁻¹⁴ and thus within 2⁻¹³ of their exact values, where the projected area has more than 17 bits
//! by 2⁻¹⁵ more: u and v are within 2⁻² texels of 1000 texels' span, normals within half a unit.
//! *Edge cases.* No active voxels: no sums. Opposite normals may add up to 0: there is no normal then. Triangles without area
//! (conservative only) are weighed as others are: points, whose Eᵢ are all 0, count as their corner 0.
//! *Limits.* [`MAX_FRAGMENTS`] fragments per voxel: more are an error, and nothing wraps.
//! *Errors.* Texels beyond the buffer, and buffers that are no result of `voxelize` with these arguments, are the caller's error: some sums, or an
//! error; nothing outside the buffers is read. Triangles of the classes that the mesh hasn't are left out.
//! *Source.* Rauwendaal, voxel cone tracing, which averages as it writes. Deviation: sums, which depend on no order, and end in an
//! error where an average would saturate.

use crate::accuracy::Accuracy;
use crate::error::{Error, Result};
use crate::kernels::voxelize::{VoxelBuffers, VoxelizeParams};
use bytemuck::{Pod, Zeroable};

pub use crate::scene::NONE;

#[cfg(doc)]
use crate::kernels::voxelize::Voxels;

/// Integers are added.
pub const ACCURACY: Accuracy = Accuracy::Exact { because: "sums of integers, in any order" };

/// Albedo 1.
pub const ALBEDO_ONE: u32 = 4095;
/// Length of a unit normal.
pub const NORMAL_ONE: i32 = 127;
/// Most fragments of a voxel.
pub const MAX_FRAGMENTS: u32 = 1 << 20;

/// [`VoxelSurface::flags`]: texture coordinates beyond the texture are its border's.
pub const CLAMP: u32 = 1;

/// What a triangle's surface is.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
pub struct VoxelSurface {
    /// Per corner, x in the first byte, then y and z: −127 to 127.
    pub normals: [u32; 3],
    /// First texel, or [`NONE`].
    pub texture: u32,
    /// Per corner u and v, 2⁻⁶ texels, within ±2¹⁶.
    pub texcoords: [[i32; 2]; 3],
    /// Texels per row, in the lower half, and rows in the upper; at least 1 each.
    pub texture_size: u32,
    /// [`CLAMP`].
    pub flags: u32,
    /// Red in the lower half, green in the upper; then blue. At most [`ALBEDO_ONE`] each.
    pub tint: [u32; 2],
    /// As `tint`.
    pub emission: [u32; 2],
}

/// Sums over a voxel's fragments.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Pod, Zeroable)]
pub struct VoxelSums {
    /// RGB.
    pub albedo: [u32; 3],
    /// Fragments.
    pub count: u32,
    /// x, y, z.
    pub normal: [i32; 3],
    /// Unused, 0.
    pub padding: u32,
    /// RGB.
    pub emission: [u32; 3],
    /// Unused, 0.
    pub padding_too: u32,
}

/// Packs a texel, 0 to 1023 per channel: red lowest.
pub fn texel_word([r, g, b]: [u32; 3]) -> u32 {
    r | (g << 10) | (b << 20)
}

/// The number of active voxels, if the call is sound for a mesh of `triangles`; `len` gives the length of a buffer of `voxels`.
///
/// # Errors
/// As [`VoxelizeParams::check`]; [`Error::InvalidInput`] for other than one surface per triangle, and for buffers whose
/// lengths don't fit the grid.
pub fn check<U>(
    params: &VoxelizeParams,
    voxels: &VoxelBuffers<U>,
    len: impl Fn(&U) -> usize,
    triangles: usize,
    surfaces: usize,
) -> Result<usize> {
    params.check(&voxels.grid, triangles)?;
    if triangles != surfaces {
        let what = format!("{surfaces} surfaces of {triangles} triangles");
        return Err(Error::invalid("sum_voxels surfaces", what));
    }
    let words = voxels.grid.mask_words();
    let found = [&voxels.mask, &voxels.ranks].map(&len);
    if found != [words, words + 1] {
        let what =
            format!("{} words and {} ranks, where {words} and one more are needed", found[0], found[1]);
        return Err(Error::invalid("sum_voxels voxels", what));
    }
    Ok(len(&voxels.active))
}

/// Refuses a voxel of more than [`MAX_FRAGMENTS`].
///
/// # Errors
/// [`Error::LimitExceeded`] if `most` is more.
pub fn check_fragments(most: u32) -> Result<()> {
    if most > MAX_FRAGMENTS {
        return Err(Error::limit("fragments of a voxel", most.into(), MAX_FRAGMENTS.into()));
    }
    Ok(())
}
