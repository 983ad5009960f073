// kernel family: voxelize
// contract core/src/kernels/voxelize.rs
// cpu backend-cpu/src/kernels/voxelize.rs
// gpu backend-gpu/src/kernels/voxelize.wgsl
// oracle conformance/src/oracle/voxelize.rs
//! `voxelize`: which voxels of a grid a mesh passes through.
//!
//! *Shapes.* A [`crate::lattice::LatticeMesh`] of T triangles and a [`VoxelGrid`] in; [`VoxelBuffers`] out.
//! *Units.* Coordinates are [`VoxelGrid::place`]d ones, 2⁻ˢ voxels; all arithmetic below is on them, in integers.
//! A voxel (i, j, k) has the *code* of [`crate::math::morton`].
//!
//! *Meaning.* Of a triangle with the corners p₀ p₁ p₂: n = (p₁−p₀) × (p₂−p₀). Its *dominant axis* is that of the greatest |nₐ|, the first
//! of equals; N is that |nₐ|. v = 2ˢ is a voxel's width, c its centre. For each axis a, with the other two (b, c) in cyclic
//! order, the triangle's projection along a has for each edge p→q, 0→1, 1→2, 2→0, the edge function
//! E(X, Y) = (q_b−p_b)·(Y−p_c) − (q_c−p_c)·(X−p_b), negated where nₐ < 0, so that E ≥ 0 inside; dx and dy are the edge's steps q_b−p_b
//! and q_c−p_c.
//! * [`THIN`] (6-separating): a voxel is *met* when on each axis it is one of those from that of the least corner to that of the greatest;
//!   its column along the dominant axis crosses the triangle's plane in it, at a height z* with k·v ≤ z* < (k+1)·v on the line through its
//!   centre; and for each axis and edge E(c) + ½·v·max(|dx|, |dy|) ≥ 0. A triangle with n = 0 meets nothing.
//! * [`CONSERVATIVE`] (26-separating): a voxel is met when the triangle has a point in common with its closed cube, enlarged by
//!   [`MARGIN`] units to all sides: by the separating-axis theorem on the 3 axes of the cube, n, and the 9 products of their edges. Triangles
//!   without area are segments or points, and meet what those do.
//!
//! *Why these.* A path of voxels that share faces crosses a surface between two centres; the voxel that holds the crossing is met, so that
//! a closed thin surface can't be entered. Where the crossing is on the face between both, the upper one holds it: a wall in the plane of a
//! face is one voxel thick. Snapping moves a surface by at most [`MARGIN`] units (half of one in the grid, and half a lattice step, which is
//! at most a unit): the conservative set of the snapped mesh holds that of the mesh before.
//!
//! *Outputs.* 1. *Classes*: `small` and `large`, the numbers of the triangles whose bounds in whole voxels have at most, or more than,
//! [`VoxelizeParams::cutoff`] cells in the projection along the dominant axis; ascending. On each axis these bounds are the voxels from that
//! of the least corner to that of the greatest, or, with [`CONSERVATIVE`], those of the grid whose enlarged cubes reach the corners' bounds.
//! A thin triangle with n = 0 is in neither. Both ways to work give the same voxels: the lists say what a backend does at once and what it
//! splits over cells.
//! 2. *Occupancy*: `mask[`[`VoxelGrid::mask_words`]`]`; bit (code mod 32) of word (code div 32) is set where the voxel is met.
//! `ranks[words + 1]`: how many bits are set before each word, and in all.
//! 3. *Active lists*: `active`, the codes of met voxels, ascending; `parents`, those of the next level, code div 8 without repetition.
//!
//! *How 32 bits suffice.* Coordinates are in [0, 2¹⁵): n and, at a centre of the grid, E are twice the area of a triangle in a square of that
//! side, at most 2³⁰ (2²⁹ in a grid of one voxel). What is added is at most 2²⁹ + 2¹⁶, or 2³⁰ + 2¹⁶ in a grid of one voxel. z* takes 64 bits and a
//! division, once per cell.
//! *Edge cases.* No triangles: nothing. Grids of one voxel, or of one voxel's thickness: as others.
//! *Limits.* [`crate::lattice::MAX_VOXELS`] voxels per axis, so that codes have 27 bits; [`MAX_TRIANGLES`] triangles.
//! *Source.* Schwarz and Seidel, "Fast parallel surface and solid voxelization on GPUs", 2010; Rauwendaal, voxel cone tracing (hybrid of
//! triangle- and cell-parallel work, active lists). Deviations: half-open in depth, so that a wall in a face's plane is met once; classes go by
//! the cells of the bounds, not by the triangle's area, since it is the cells that are looked at: a sliver along a diagonal
//! has no area and all the cells.

use crate::accuracy::Accuracy;
use crate::backend::Backend;
use crate::error::{Error, Result};
use crate::lattice::VoxelGrid;
use bytemuck::{Pod, Zeroable};
use std::fmt;

/// Every output is decided by integers.
pub const ACCURACY: Accuracy = Accuracy::Exact {
    because: "integer tests, bits that are set in any order, and lists in the order of codes",
};

/// [`VoxelizeParams::separation`]: no path of voxels that share faces gets through.
pub const THIN: u32 = 0;
/// [`VoxelizeParams::separation`]: every voxel that the triangle touches.
pub const CONSERVATIVE: u32 = 1;

/// How far conservative voxels reach beyond their cubes, units.
pub const MARGIN: i32 = 1;

/// [`VoxelizeParams::cutoff`]: every triangle is small.
pub const NO_CUTOFF: u32 = u32::MAX;

/// Most triangles: with more, two flags for each leave a binding of 128 MiB.
pub const MAX_TRIANGLES: usize = 1 << 24;

/// Parameters of one call.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
pub struct VoxelizeParams {
    /// [`THIN`] or [`CONSERVATIVE`].
    pub separation: u32,
    /// Most cells of a small triangle.
    pub cutoff: u32,
}

/// What is met, on a device: `U` holds `u32`.
#[derive(Clone)]
pub struct VoxelBuffers<U> {
    /// The grid.
    pub grid: VoxelGrid,
    /// Small triangles.
    pub small: U,
    /// Large triangles.
    pub large: U,
    /// Occupancy.
    pub mask: U,
    /// Bits set before each word of the mask.
    pub ranks: U,
    /// Codes of met voxels.
    pub active: U,
    /// Codes of the next level.
    pub parents: U,
}

impl<U> fmt::Debug for VoxelBuffers<U> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y, z] = self.grid.dims;
        write!(f, "VoxelBuffers({x}x{y}x{z})")
    }
}

/// [`VoxelBuffers`] in a backend's buffers.
pub type Voxels<B> = VoxelBuffers<<B as Backend>::Buffer<u32>>;

impl VoxelizeParams {
    /// Thin voxels, split where a backend finds it best on the whole.
    pub fn thin() -> Self {
        Self { separation: THIN, cutoff: 64 }
    }

    /// Whether the call is sound, for a mesh of `triangles`.
    ///
    /// # Errors
    /// [`Error::InvalidInput`] for an unknown separation or a grid out of its budget; [`Error::LimitExceeded`] beyond [`MAX_TRIANGLES`].
    pub fn check(&self, grid: &VoxelGrid, triangles: usize) -> Result<()> {
        if self.separation > CONSERVATIVE {
            return Err(Error::invalid("separation", format!("{} is neither 0 nor 1", self.separation)));
        }
        if triangles > MAX_TRIANGLES {
            return Err(Error::limit("triangles to voxelize", triangles as u64, MAX_TRIANGLES as u64));
        }
        grid.check()
    }
}
