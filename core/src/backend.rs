//! `Backend`: typed buffers and one method per kernel. The library's table of contents.

use crate::error::Result;
use crate::kernels::filter_indirect::{FilterIndirectParams, RadianceTexel};
use crate::kernels::light_voxels::LightVoxelsBlock;
use crate::kernels::merge_lhb::MergeLhbParams;
use crate::kernels::pack_lhb::{PackLhbParams, PackedLhb};
use crate::kernels::query_lhb::LhbQuery;
use crate::kernels::rasterize_lhb::{Lhb, LhbElement, RasterizeLhbParams};
use crate::kernels::reduce_mips::{ReduceMipsParams, VoxelLevels, VoxelLight};
use crate::kernels::shade_primary::{GBufferTexel, ShadePrimaryParams};
use crate::kernels::sum_voxels::{VoxelSums, VoxelSurface};
use crate::kernels::trace::{Hit, Ray};
use crate::kernels::trace_cones::{Cone, ConeLight, TraceConesBlock};
use crate::kernels::trace_paths::{FilmTexel, TracePathsParams};
use crate::kernels::voxelize::{VoxelizeParams, Voxels};
use crate::kernels::walk_lhb::WalkLhbParams;
use crate::lattice::{LatticeMesh, View, VoxelGrid};
use crate::scene::CompiledScene;
use bytemuck::Pod;

/// What runs the kernels, for reports.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BackendInfo {
    /// `cpu` or `gpu`.
    pub kind: &'static str,
    /// Processor or adapter.
    pub device: String,
    /// Driver and version; on the CPU the instruction set chosen at run time.
    pub driver: String,
    /// Whether float results are those of IEEE 754 evaluated as written: true on the CPU, on a GPU in strict mode.
    pub strict: bool,
}

/// A device that runs every kernel of the library.
///
/// Calls are synchronous in meaning: the effects of one are seen by the next. Lengths are checked before anything
/// runs. Nothing panics on input.
pub trait Backend {
    /// A typed array on the device.
    type Buffer<T: Pod + Send + Sync>;
    /// A scene on the device: geometry, acceleration structure, materials, lights, texels.
    type Scene;
    /// A snapped mesh on the device.
    type Mesh;

    /// What this backend is.
    fn info(&self) -> BackendInfo;

    /// Copies host data to a new buffer.
    ///
    /// # Errors
    /// [`crate::Error::LimitExceeded`] or [`crate::Error::OutOfMemory`] when the device can't hold it.
    fn upload<T: Pod + Send + Sync>(&self, data: &[T]) -> Result<Self::Buffer<T>>;

    /// A new buffer of `len` zeroed elements.
    ///
    /// # Errors
    /// As [`Backend::upload`].
    fn zeroed<T: Pod + Send + Sync>(&self, len: usize) -> Result<Self::Buffer<T>>;

    /// Copies a buffer back.
    ///
    /// # Errors
    /// [`crate::Error::DeviceLost`] when the device went away.
    fn download<T: Pod + Send + Sync>(&self, buffer: &Self::Buffer<T>) -> Result<Vec<T>>;

    /// Number of elements of a buffer.
    fn len<T: Pod + Send + Sync>(&self, buffer: &Self::Buffer<T>) -> usize;

    /// Makes a scene resident.
    ///
    /// # Errors
    /// As [`Backend::upload`].
    fn upload_scene(&self, scene: &CompiledScene) -> Result<Self::Scene>;

    /// Makes a snapped mesh resident.
    ///
    /// # Errors
    /// As [`Backend::upload`].
    fn upload_mesh(&self, mesh: &LatticeMesh) -> Result<Self::Mesh>;

    /// Exclusive prefix sum; returns the total. Contract: [`crate::kernels::scan`].
    ///
    /// # Errors
    /// [`crate::Error::InvalidInput`] when the lengths differ.
    fn scan(&self, input: &Self::Buffer<u32>, output: &mut Self::Buffer<u32>) -> Result<u32>;

    /// Stable ascending sort of 32-bit keys with payload, in place. Contract: [`crate::kernels::sort`].
    ///
    /// # Errors
    /// [`crate::Error::InvalidInput`] when the lengths differ.
    fn sort_u32(&self, keys: &mut Self::Buffer<u32>, payload: &mut Self::Buffer<u32>) -> Result<()>;

    /// Stable ascending sort of 64-bit keys with payload, in place. Contract: [`crate::kernels::sort`].
    ///
    /// # Errors
    /// [`crate::Error::InvalidInput`] when the lengths differ.
    fn sort_u64(&self, keys: &mut Self::Buffer<u64>, payload: &mut Self::Buffer<u32>) -> Result<()>;

    /// Closest hit of every ray. Contract: [`crate::kernels::trace`].
    ///
    /// # Errors
    /// [`crate::Error::InvalidInput`] when the lengths differ.
    fn trace_closest(
        &self,
        scene: &Self::Scene,
        rays: &Self::Buffer<Ray>,
        hits: &mut Self::Buffer<Hit>,
    ) -> Result<()>;

    /// Whether anything lies on each ray: 1 or 0. Contract: [`crate::kernels::trace`].
    ///
    /// # Errors
    /// [`crate::Error::InvalidInput`] when the lengths differ.
    fn trace_any(
        &self,
        scene: &Self::Scene,
        rays: &Self::Buffer<Ray>,
        occluded: &mut Self::Buffer<u32>,
    ) -> Result<()>;

    /// What the camera sees at pixel centres. Contract: [`crate::kernels::shade_primary`].
    ///
    /// # Errors
    /// [`crate::Error::InvalidInput`] when the buffer's length is not `width * height`.
    fn shade_primary(
        &self,
        scene: &Self::Scene,
        params: &ShadePrimaryParams,
        gbuffer: &mut Self::Buffer<GBufferTexel>,
    ) -> Result<()>;

    /// Adds samples `sample_begin..sample_begin + sample_count` of some pixels' light to a film. Contract:
    /// [`crate::kernels::trace_paths`].
    ///
    /// # Errors
    /// [`crate::Error::InvalidInput`] when the film's length is not `width * height` or the pixel range leaves it.
    fn trace_paths(
        &self,
        scene: &Self::Scene,
        params: &TracePathsParams,
        film: &mut Self::Buffer<FilmTexel>,
    ) -> Result<()>;

    /// Every surface along the lines of many orthographic views. Contract: [`crate::kernels::rasterize_lhb`].
    ///
    /// # Errors
    /// [`crate::Error::InvalidInput`] for parameters or views that are out of range, [`crate::Error::LimitExceeded`] or
    /// [`crate::Error::OutOfMemory`] when the lists are too many or too long for the device.
    fn rasterize_lhb(
        &self,
        mesh: &Self::Mesh,
        views: &[View],
        params: &RasterizeLhbParams,
    ) -> Result<Lhb<Self>>;

    /// Layered hit buffers of what stays and of what moves, as one. Contract: [`crate::kernels::merge_lhb`].
    ///
    /// # Errors
    /// [`crate::Error::InvalidInput`] for parameters that are out of range and for buffers that don't fit each other,
    /// [`crate::Error::LimitExceeded`] or [`crate::Error::OutOfMemory`] when the lists are too many or too long for the device.
    fn merge_lhb(&self, kept: &Lhb<Self>, added: &Lhb<Self>, params: &MergeLhbParams) -> Result<Lhb<Self>>;

    /// Layered hit buffers with elements in half the bytes. Contract: [`crate::kernels::pack_lhb`].
    ///
    /// # Errors
    /// [`crate::Error::InvalidInput`] for parameters that are out of range and for malformed buffers,
    /// [`crate::Error::LimitExceeded`] for triangles beyond the limit, and with [`crate::Error::OutOfMemory`] when the words are
    /// too many for the device.
    fn pack_lhb(&self, lhb: &Lhb<Self>, params: &PackLhbParams) -> Result<PackedLhb<Self>>;

    /// The way back from [`Backend::pack_lhb`]. Contract: [`crate::kernels::pack_lhb`].
    ///
    /// # Errors
    /// [`crate::Error::InvalidInput`] for malformed buffers, [`crate::Error::LimitExceeded`] or [`crate::Error::OutOfMemory`] when the
    /// elements are too many for the device.
    fn unpack_lhb(&self, packed: &PackedLhb<Self>) -> Result<Lhb<Self>>;

    /// What points see along the directions of views. Contract: [`crate::kernels::query_lhb`].
    ///
    /// # Errors
    /// [`crate::Error::InvalidInput`] when the lengths differ, or the views are not as many as `lhb` has.
    fn query_lhb(
        &self,
        mesh: &Self::Mesh,
        lhb: &Lhb<Self>,
        views: &[View],
        queries: &Self::Buffer<LhbQuery>,
        hits: &mut Self::Buffer<LhbElement>,
    ) -> Result<()>;

    /// Adds paths whose scattered rays are looked up to a film. `map` holds [`crate::directions::NearestMap::ray_words`].
    /// Contract: [`crate::kernels::walk_lhb`].
    ///
    /// # Errors
    /// As [`Backend::trace_paths`]; [`crate::Error::InvalidInput`] when the buffers' shapes don't fit each other.
    fn walk_lhb(
        &self,
        scene: &Self::Scene,
        mesh: &Self::Mesh,
        lhb: &Lhb<Self>,
        views: &[View],
        map: &Self::Buffer<u32>,
        params: &WalkLhbParams,
        film: &mut Self::Buffer<FilmTexel>,
    ) -> Result<()>;

    /// Indirect light, averaged over neighbours that show the same diffuse surface. Contract: [`crate::kernels::filter_indirect`].
    ///
    /// # Errors
    /// As [`FilterIndirectParams::check`].
    fn filter_indirect(
        &self,
        gbuffer: &Self::Buffer<GBufferTexel>,
        diffuse: &Self::Buffer<u32>,
        input: &Self::Buffer<RadianceTexel>,
        params: &FilterIndirectParams,
        output: &mut Self::Buffer<RadianceTexel>,
    ) -> Result<()>;

    /// Which voxels a mesh passes through. Contract: [`crate::kernels::voxelize`].
    ///
    /// # Errors
    /// As [`VoxelizeParams::check`]; [`crate::Error::LimitExceeded`] or [`crate::Error::OutOfMemory`] when the voxels are too many for
    /// the device.
    fn voxelize(&self, mesh: &Self::Mesh, grid: &VoxelGrid, params: &VoxelizeParams) -> Result<Voxels<Self>>;

    /// Sums over the triangles that meet each active voxel. Contract: [`crate::kernels::sum_voxels`].
    ///
    /// # Errors
    /// As [`crate::kernels::sum_voxels::check`] and [`crate::kernels::sum_voxels::check_fragments`];
    /// [`crate::Error::LimitExceeded`] or [`crate::Error::OutOfMemory`] when the sums are too many for the device.
    fn sum_voxels(
        &self,
        mesh: &Self::Mesh,
        voxels: &Voxels<Self>,
        surfaces: &Self::Buffer<VoxelSurface>,
        texels: &Self::Buffer<u32>,
        params: &VoxelizeParams,
    ) -> Result<Self::Buffer<VoxelSums>>;

    /// The levels above a grid of voxels. Contract: [`crate::kernels::reduce_mips`].
    ///
    /// # Errors
    /// As [`crate::kernels::reduce_mips::check_voxels`]; [`crate::Error::OutOfMemory`] when the device can't hold them.
    fn voxel_levels(&self, voxels: &Voxels<Self>) -> Result<VoxelLevels<Self>>;

    /// What the voxels of all levels store of the light in them. Contract: [`crate::kernels::reduce_mips`].
    ///
    /// # Errors
    /// As [`ReduceMipsParams::check`]; [`crate::Error::LimitExceeded`] or [`crate::Error::OutOfMemory`] when the values are too many for
    /// the device.
    fn reduce_mips(
        &self,
        levels: &VoxelLevels<Self>,
        leaves: &Self::Buffer<VoxelLight>,
        params: &ReduceMipsParams,
    ) -> Result<Self::Buffer<u32>>;

    /// The light that leaves active voxels. Contract: [`crate::kernels::light_voxels`].
    ///
    /// # Errors
    /// As [`LightVoxelsBlock::check`].
    fn light_voxels(
        &self,
        scene: &Self::Scene,
        active: &Self::Buffer<u32>,
        sums: &Self::Buffer<VoxelSums>,
        gathered: &Self::Buffer<RadianceTexel>,
        params: &LightVoxelsBlock,
        leaves: &mut Self::Buffer<VoxelLight>,
    ) -> Result<()>;

    /// The light that comes through cones. Contract: [`crate::kernels::trace_cones`].
    ///
    /// # Errors
    /// As [`TraceConesBlock::check`].
    fn trace_cones(
        &self,
        levels: &VoxelLevels<Self>,
        values: &Self::Buffer<u32>,
        cones: &Self::Buffer<Cone>,
        params: &TraceConesBlock,
        light: &mut Self::Buffer<ConeLight>,
    ) -> Result<()>;
}
