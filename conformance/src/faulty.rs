//! A backend with one planted bug: everything goes through to a sound backend, and one result comes back wrong.

mod filter_indirect;
mod light_voxels;
mod merge_lhb;
mod pack_lhb;
mod query_lhb;
mod rasterize_lhb;
mod reduce_mips;
mod scan;
mod shade_primary;
mod sort;
mod sum_voxels;
mod trace;
mod trace_cones;
mod trace_paths;
mod voxelize;
mod walk_lhb;

use crate::faults::Fault;
use bytemuck::Pod;
use twinlight_core::kernels::filter_indirect::{FilterIndirectParams, RadianceTexel};
use twinlight_core::kernels::light_voxels::LightVoxelsBlock;
use twinlight_core::kernels::merge_lhb::MergeLhbParams;
use twinlight_core::kernels::pack_lhb::{PackLhbParams, PackedLhb};
use twinlight_core::kernels::query_lhb::LhbQuery;
use twinlight_core::kernels::rasterize_lhb::{Lhb, LhbElement, RasterizeLhbParams};
use twinlight_core::kernels::reduce_mips::{ReduceMipsParams, VoxelLevels, VoxelLight};
use twinlight_core::kernels::shade_primary::{GBufferTexel, ShadePrimaryParams};
use twinlight_core::kernels::sum_voxels::{VoxelSums, VoxelSurface};
use twinlight_core::kernels::trace::{Hit, Ray};
use twinlight_core::kernels::trace_cones::{Cone, ConeLight, TraceConesBlock};
use twinlight_core::kernels::trace_paths::{FilmTexel, TracePathsParams};
use twinlight_core::kernels::voxelize::{VoxelizeParams, Voxels};
use twinlight_core::kernels::walk_lhb::WalkLhbParams;
use twinlight_core::lattice::{LatticeMesh, View, VoxelGrid};
use twinlight_core::scene::CompiledScene;
use twinlight_core::{Backend, BackendInfo, Result};

/// `inner` with `fault` in it.
#[derive(Debug)]
pub struct Faulty<'a, B> {
    inner: &'a B,
    fault: Fault,
    merged_before: merge_lhb::Previous,
}

/// A scene on the sound backend, and on the host for the bugs that need to know it.
#[derive(Debug)]
pub struct FaultyScene<S> {
    inner: S,
    host: CompiledScene,
}

/// A mesh on the sound backend, and on the host.
#[derive(Debug)]
pub struct FaultyMesh<M> {
    inner: M,
    host: LatticeMesh,
}

impl<'a, B: Backend> Faulty<'a, B> {
    /// Plants `fault` in `inner`.
    pub fn new(inner: &'a B, fault: Fault) -> Self {
        Self { inner, fault, merged_before: merge_lhb::Previous::default() }
    }
}

impl<B: Backend> Backend for Faulty<'_, B> {
    type Buffer<T: Pod + Send + Sync> = B::Buffer<T>;
    type Scene = FaultyScene<B::Scene>;
    type Mesh = FaultyMesh<B::Mesh>;

    fn info(&self) -> BackendInfo {
        self.inner.info()
    }

    fn upload<T: Pod + Send + Sync>(&self, data: &[T]) -> Result<B::Buffer<T>> {
        self.inner.upload(data)
    }

    fn zeroed<T: Pod + Send + Sync>(&self, len: usize) -> Result<B::Buffer<T>> {
        self.inner.zeroed(len)
    }

    fn download<T: Pod + Send + Sync>(&self, buffer: &B::Buffer<T>) -> Result<Vec<T>> {
        self.inner.download(buffer)
    }

    fn len<T: Pod + Send + Sync>(&self, buffer: &B::Buffer<T>) -> usize {
        self.inner.len(buffer)
    }

    fn upload_scene(&self, scene: &CompiledScene) -> Result<Self::Scene> {
        let inner = self.inner.upload_scene(&walk_lhb::broken_scene(
            self.fault,
            trace_paths::broken_scene(self.fault, scene),
        ))?;
        Ok(FaultyScene { inner, host: scene.clone() })
    }

    fn upload_mesh(&self, mesh: &LatticeMesh) -> Result<Self::Mesh> {
        Ok(FaultyMesh { inner: self.inner.upload_mesh(mesh)?, host: mesh.clone() })
    }

    fn scan(&self, input: &B::Buffer<u32>, output: &mut B::Buffer<u32>) -> Result<u32> {
        scan::scan(self.inner, self.fault, input, output)
    }

    fn sort_u32(&self, keys: &mut B::Buffer<u32>, payload: &mut B::Buffer<u32>) -> Result<()> {
        sort::sort(self.inner, self.fault, keys, payload)
    }

    fn sort_u64(&self, keys: &mut B::Buffer<u64>, payload: &mut B::Buffer<u32>) -> Result<()> {
        sort::sort(self.inner, self.fault, keys, payload)
    }

    fn trace_closest(
        &self,
        scene: &Self::Scene,
        rays: &B::Buffer<Ray>,
        hits: &mut B::Buffer<Hit>,
    ) -> Result<()> {
        trace::closest(self.inner, self.fault, scene, rays, hits)
    }

    fn trace_any(
        &self,
        scene: &Self::Scene,
        rays: &B::Buffer<Ray>,
        occluded: &mut B::Buffer<u32>,
    ) -> Result<()> {
        trace::any(self.inner, self.fault, scene, rays, occluded)
    }

    fn shade_primary(
        &self,
        scene: &Self::Scene,
        params: &ShadePrimaryParams,
        gbuffer: &mut B::Buffer<GBufferTexel>,
    ) -> Result<()> {
        shade_primary::shade_primary(self.inner, self.fault, scene, params, gbuffer)
    }

    fn trace_paths(
        &self,
        scene: &Self::Scene,
        params: &TracePathsParams,
        film: &mut B::Buffer<FilmTexel>,
    ) -> Result<()> {
        trace_paths::trace_paths(self.inner, self.fault, scene, params, film)
    }

    fn rasterize_lhb(
        &self,
        mesh: &Self::Mesh,
        views: &[View],
        params: &RasterizeLhbParams,
    ) -> Result<Lhb<Self>> {
        rasterize_lhb::rasterize_lhb(self.inner, self.fault, mesh, views, params)
    }

    fn merge_lhb(&self, kept: &Lhb<Self>, added: &Lhb<Self>, params: &MergeLhbParams) -> Result<Lhb<Self>> {
        merge_lhb::merge_lhb(self.inner, self.fault, &self.merged_before, kept, added, params)
    }

    fn pack_lhb(&self, lhb: &Lhb<Self>, params: &PackLhbParams) -> Result<PackedLhb<Self>> {
        pack_lhb::pack_lhb(self.inner, self.fault, lhb, params)
    }

    fn unpack_lhb(&self, packed: &PackedLhb<Self>) -> Result<Lhb<Self>> {
        pack_lhb::unpack_lhb(self.inner, self.fault, packed)
    }

    fn query_lhb(
        &self,
        mesh: &Self::Mesh,
        lhb: &Lhb<Self>,
        views: &[View],
        queries: &B::Buffer<LhbQuery>,
        hits: &mut B::Buffer<LhbElement>,
    ) -> Result<()> {
        query_lhb::query_lhb(self.inner, self.fault, mesh, lhb, views, queries, hits)
    }

    fn walk_lhb(
        &self,
        scene: &Self::Scene,
        mesh: &Self::Mesh,
        lhb: &Lhb<Self>,
        views: &[View],
        map: &B::Buffer<u32>,
        params: &WalkLhbParams,
        film: &mut B::Buffer<FilmTexel>,
    ) -> Result<()> {
        walk_lhb::walk_lhb(self.inner, self.fault, scene, mesh, lhb, views, map, params, film)
    }

    fn filter_indirect(
        &self,
        gbuffer: &B::Buffer<GBufferTexel>,
        diffuse: &B::Buffer<u32>,
        input: &B::Buffer<RadianceTexel>,
        params: &FilterIndirectParams,
        output: &mut B::Buffer<RadianceTexel>,
    ) -> Result<()> {
        filter_indirect::filter_indirect(self.inner, self.fault, gbuffer, diffuse, input, params, output)
    }

    fn voxelize(&self, mesh: &Self::Mesh, grid: &VoxelGrid, params: &VoxelizeParams) -> Result<Voxels<Self>> {
        voxelize::voxelize(self.inner, self.fault, mesh, grid, params)
    }

    fn sum_voxels(
        &self,
        mesh: &Self::Mesh,
        voxels: &Voxels<Self>,
        surfaces: &B::Buffer<VoxelSurface>,
        texels: &B::Buffer<u32>,
        params: &VoxelizeParams,
    ) -> Result<B::Buffer<VoxelSums>> {
        sum_voxels::sum_voxels(self.inner, self.fault, mesh, voxels, surfaces, texels, params)
    }

    fn voxel_levels(&self, voxels: &Voxels<Self>) -> Result<VoxelLevels<Self>> {
        reduce_mips::voxel_levels(self.inner, self.fault, voxels)
    }

    fn reduce_mips(
        &self,
        levels: &VoxelLevels<Self>,
        leaves: &B::Buffer<VoxelLight>,
        params: &ReduceMipsParams,
    ) -> Result<B::Buffer<u32>> {
        reduce_mips::reduce_mips(self.inner, self.fault, levels, leaves, params)
    }

    fn light_voxels(
        &self,
        scene: &Self::Scene,
        active: &B::Buffer<u32>,
        sums: &B::Buffer<VoxelSums>,
        gathered: &B::Buffer<RadianceTexel>,
        params: &LightVoxelsBlock,
        leaves: &mut B::Buffer<VoxelLight>,
    ) -> Result<()> {
        let voxels = light_voxels::Voxels { active, sums, gathered };
        light_voxels::light_voxels(self.inner, self.fault, scene, voxels, params, leaves)
    }

    fn trace_cones(
        &self,
        levels: &VoxelLevels<Self>,
        values: &B::Buffer<u32>,
        cones: &B::Buffer<Cone>,
        params: &TraceConesBlock,
        light: &mut B::Buffer<ConeLight>,
    ) -> Result<()> {
        trace_cones::trace_cones(self.inner, self.fault, levels, values, cones, params, light)
    }
}
