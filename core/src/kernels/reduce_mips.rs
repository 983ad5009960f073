// kernel family: reduce_mips
// contract core/src/kernels/reduce_mips.rs
// cpu backend-cpu/src/kernels/reduce_mips.rs
// gpu backend-gpu/src/kernels/reduce_mips.wgsl
// oracle conformance/src/oracle/reduce_mips.rs
//! `reduce_mips`: the levels above a grid of voxels, and what each of their voxels stores of the light in it.
//!
//! *Shapes.* `voxel_levels`: [`Voxels`] in; [`VoxelLevelBuffers`] out. `reduce_mips`: those and `leaves[A]`, a [`VoxelLight`] for each active
//! voxel of level 0 in the order of its codes, in; `values[words · V]` out, V being the number of active voxels of all levels and `words`
//! [`words_of`] the storage: value i is `values[words·i..][..words]`.
//! *Units.* Radiance in whatever unit the leaves have, opacity in 1/[`OPAQUE`].
//!
//! *Levels.* Level 0 is the grid, with a side of P = [`crate::lattice::VoxelGrid::padded`] voxels; level l has the side P/2ˡ, the last is one
//! voxel. A voxel of a level is active when one of the 8 of the level below whose code div 8 is its own is: those are its *children*, and
//! code mod 8 a child's *octant*. `mask` is that of level 0, then that of level 1 and so on, each in max(1, ⌈side³/32⌉) words;
//! `ranks[i]` is the number of bits set in all words before word i, whatever their level, and has one entry more, V; `active` has the
//! codes of level 0, ascending, then those of level 1 and so on. So bit b of word i is the value
//! `ranks[i]` + bits set in word i below b.
//!
//! *Storages.* A missing child is all zeroes. All divisions and shifts round down, unless said otherwise.
//! * [`ISOTROPIC`], 4 words: r, g, b, opacity; premultiplied. A leaf is itself. A parent: per word (Σ + 4) >> 3 over the 8 children.
//! * [`ANISOTROPIC`], 24 words: for each of +x −x +y −y +z −z, the light that leaves in that direction and the opacity to it, as above. A leaf is itself six
//!   times. A parent, in a direction: for each of the 4 columns of 2 children along it, f being the child on that side and b the other,
//!   per word f + ⌊(2¹⁶ − f's opacity)·b / 2¹⁶⌋; then (Σ + 2) >> 2 over the columns.
//! * [`HARMONICS`], 13 words: opacity, then for each channel four signed words a₀ aₓ a_y a_z, which mean the radiance
//!   L(ω) = a₀ + aₓωₓ + a_yω_y + a_zω_z, premultiplied. A leaf has its r, g, b as a₀ and no more. A parent: opacity as isotropic; with σ the signs of a
//!   child's place in its parent (+1 in the upper half of an axis, else −1), and m(k, x) = sign(x)·⌊k·|x| / 2¹⁴⌋,
//!   A₀ = Σ over the children of a₀ + Σᵢ σᵢ·m(K, aᵢ), Aᵢ = Σ over the children of σᵢ·m(2K, a₀) + m([`TWO_THIRDS`], aᵢ), K = [`NEAR_LESS_FAR`]; then each
//!   is sign(A)·((|A| + 4) >> 3).
//! * [`HARMONICS_8`], 4 words: the harmonics of that voxel, which are reduced as above, in 8 bits each. The first word is opacity + (e << 24); then for each
//!   channel the bytes q₀ qₓ q_y q_z, lowest first. e is the least number from 0 on for which all of r(a₀) ≤ 255, r(a₀) ≥ 0 and |r(aᵢ)| ≤ 127
//!   hold, r(a) = sign(a)·((|a| + (2ᵉ >> 1)) >> e); a₀ < 0 counts as 0. q₀ is r(a₀), the others are r(aᵢ) in two's complement.
//!   *Its error.* Where a₀ ≥ 0, at most half of 2ᵉ per coefficient, that is 1/127 of the greatest one where e is not 0.
//! * [`SUMS`], 2 words: low and high word of Σ (r + g + b) over the leaves below, premultiplied; modulo 2⁶⁴.
//! * [`RANGES`], 2 words: the least and the greatest r + g + b of the leaves below, premultiplied.
//!
//! *Where the matrix is from.* A child's function is seen through the 6 faces of its parent, which it sees under the solid angles
//! 3.1140 (a near one) and 1.0748 (a far one), and each face emits what passes it as a cosine lobe, divided by π. In the basis above a cosine
//! lobe is ¼ + ½ω·n, so that A₀ = a₀ + κΣσᵢaᵢ and Aᵢ = 2κσᵢa₀ + ⅔aᵢ with κ = (3.1140 − 1.0748)/4π; K is 2¹⁴·κ.
//! *Promises.* Where all 8 children are the same and opaque, isotropic and anisotropic parents are what they are; constant harmonics (aᵢ = 0) stay
//! constant; all to the bit, on every level. Σ value·volume of isotropic values is kept up to the rounding, ½ per word and voxel. Opacity stays in
//! 0 to [`OPAQUE`].
//! *How 32 bits suffice.* A leaf's opacity o is at most [`OPAQUE`], its r, g and b are at most [`MAX_RADIANCE`]·o/[`OPAQUE`]: so is every column
//! f + (1 − f's opacity)·b, but for roundings, and sums of 8 are below 2²⁶. Products with opacities and m(k, ·) are taken by splitting a
//! factor at 16 and 14 bits. Harmonics grow by at most 1 + 3·κ per level, 36 times up to the last of ten: below 2²⁸, and the sums
//! that they are eighths of below 2³¹.
//! *Edge cases.* Nothing active: no values, levels of zeroes. One voxel: one level.
//! *Errors.* Leaves beyond their limits: some values. Buffers that are no result of `voxelize`: some levels, or an error; nothing outside
//! the buffers is read.
//! *Source.* Rauwendaal, voxel cone tracing, and its errata: near and far solid angles change places there, and lobes are not divided by
//! π, which brightens every level by it. Crassin et al., "Interactive indirect illumination using voxel cone tracing", 2011 (anisotropic). Deviation:
//! harmonics are premultiplied like the others and divided by 8, not by the children that there are, so that light is weighed
//! by what covers a voxel.

use crate::accuracy::Accuracy;
use crate::backend::Backend;
use crate::error::{Error, Result};
use crate::kernels::voxelize::VoxelBuffers;
use crate::lattice::{VoxelGrid, mask_words};
use bytemuck::{Pod, Zeroable};
use std::fmt;

#[cfg(doc)]
use crate::kernels::voxelize::Voxels;

/// Integers in, integers out.
pub const ACCURACY: Accuracy =
    Accuracy::Exact { because: "integer sums and products, rounded as written, in lists ordered by code" };

/// [`ReduceMipsParams::storage`]: one colour for all directions.
pub const ISOTROPIC: u32 = 0;
/// [`ReduceMipsParams::storage`]: a colour per face.
pub const ANISOTROPIC: u32 = 1;
/// [`ReduceMipsParams::storage`]: 2 bands of spherical harmonics per channel.
pub const HARMONICS: u32 = 2;
/// [`ReduceMipsParams::storage`]: those in a byte each.
pub const HARMONICS_8: u32 = 3;
/// [`ReduceMipsParams::storage`]: a sum, for importance sampling.
pub const SUMS: u32 = 4;
/// [`ReduceMipsParams::storage`]: least and greatest.
pub const RANGES: u32 = 5;

/// Opacity 1.
pub const OPAQUE: u32 = 1 << 16;
/// Most of a leaf's channel.
pub const MAX_RADIANCE: u32 = 1 << 22;
/// κ, 2⁻¹⁴.
pub const NEAR_LESS_FAR: u32 = 2659;
/// ⅔, 2⁻¹⁴.
pub const TWO_THIRDS: u32 = 10923;

/// Parameters of one call.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
pub struct ReduceMipsParams {
    /// One of the storages.
    pub storage: u32,
}

/// The light that leaves an active voxel.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Pod, Zeroable)]
pub struct VoxelLight {
    /// Premultiplied radiance, at most [`MAX_RADIANCE`]·opacity/[`OPAQUE`].
    pub rgb: [u32; 3],
    /// At most [`OPAQUE`].
    pub opacity: u32,
}

/// The levels of a grid, on a device: `U` holds `u32`.
#[derive(Clone)]
pub struct VoxelLevelBuffers<U> {
    /// The grid.
    pub grid: VoxelGrid,
    /// First value of each level, and V.
    pub starts: Vec<u32>,
    /// Occupancy of all levels.
    pub mask: U,
    /// Bits set before each word.
    pub ranks: U,
    /// Codes of active voxels of all levels.
    pub active: U,
}

impl<U> fmt::Debug for VoxelLevelBuffers<U> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y, z] = self.grid.dims;
        write!(f, "VoxelLevelBuffers({x}x{y}x{z}, {:?})", self.starts)
    }
}

/// [`VoxelLevelBuffers`] in a backend's buffers.
pub type VoxelLevels<B> = VoxelLevelBuffers<<B as Backend>::Buffer<u32>>;

/// Words of a value.
///
/// # Errors
/// [`Error::InvalidInput`] for an unknown storage.
pub fn words_of(storage: u32) -> Result<usize> {
    match storage {
        ISOTROPIC | HARMONICS_8 => Ok(4),
        ANISOTROPIC => Ok(24),
        HARMONICS => Ok(13),
        SUMS | RANGES => Ok(2),
        _ => Err(Error::invalid("storage", format!("{storage} is none of 0 to {RANGES}"))),
    }
}

/// First word of each level's mask, and their number, for a grid whose longest axis is padded to `padded` voxels.
pub fn word_starts(padded: u32) -> Vec<usize> {
    let levels = padded.trailing_zeros() + 1;
    let mut starts = vec![0];
    for level in 0..levels {
        starts.push(starts[level as usize] + mask_words(padded >> level));
    }
    starts
}

/// Whether `voxels` have the lengths that their grid asks for; `len` gives the length of a buffer.
///
/// # Errors
/// [`Error::InvalidInput`] where they haven't, or for a grid out of its budget.
pub fn check_voxels<U>(voxels: &VoxelBuffers<U>, len: impl Fn(&U) -> usize) -> Result<()> {
    voxels.grid.check()?;
    let words = voxels.grid.mask_words();
    let found = [&voxels.mask, &voxels.ranks].map(&len);
    if found != [words, words + 1] {
        let what =
            format!("{} words and {} ranks, where {words} and one more are needed", found[0], found[1]);
        return Err(Error::invalid("voxel_levels", what));
    }
    Ok(())
}

impl ReduceMipsParams {
    /// The words of a value, if the call is sound; `len` gives the length of a buffer of `levels`.
    ///
    /// # Errors
    /// [`Error::InvalidInput`] for an unknown storage, levels whose lengths don't fit their grid or each other, and other than one leaf per active
    /// voxel of level 0.
    pub fn check<U>(
        &self,
        levels: &VoxelLevelBuffers<U>,
        len: impl Fn(&U) -> usize,
        leaves: usize,
    ) -> Result<usize> {
        let words = words_of(self.storage)?;
        levels.check(len)?;
        if leaves != levels.starts[1] as usize {
            let what = format!("{leaves} leaves of {} voxels", levels.starts[1]);
            return Err(Error::invalid("reduce_mips leaves", what));
        }
        Ok(words)
    }
}

impl<U> VoxelLevelBuffers<U> {
    /// Whether the levels have the lengths that their grid asks for; `len` gives the length of a buffer.
    ///
    /// # Errors
    /// [`Error::InvalidInput`] where they haven't, or for a grid out of its budget.
    pub fn check(&self, len: impl Fn(&U) -> usize) -> Result<()> {
        self.grid.check()?;
        let words = word_starts(self.grid.padded())[self.grid.level_count() as usize];
        let found = [&self.mask, &self.ranks, &self.active].map(&len);
        let total = self.starts.last().copied().unwrap_or(0) as usize;
        let rise = self.starts.len() == self.grid.level_count() as usize + 1
            && self.starts[0] == 0
            && self.starts.windows(2).all(|ends| ends[0] <= ends[1]);
        if !rise || found != [words, words + 1, total] {
            let what = format!("{found:?} words, ranks and codes of {self:?}, which has {words} words");
            return Err(Error::invalid("voxel levels", what));
        }
        Ok(())
    }
}
