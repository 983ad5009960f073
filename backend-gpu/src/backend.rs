//! [`Backend`] on a [`GpuDevice`].

use crate::buffer::GpuBuffer;
use crate::device::{DeviceOptions, GpuDevice};
use crate::kernels::{
    filter_indirect, light_voxels, merge_lhb, pack_lhb, query_lhb, rasterize_lhb, reduce_mips, scan,
    shade_primary, sort, sum_voxels, trace, trace_cones, trace_paths, voxelize, walk_lhb,
};
use crate::mesh::GpuMesh;
use crate::scene::GpuScene;
use crate::strict::Mode;
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

/// The kernels in WGSL on one device.
#[derive(Debug, Clone)]
pub struct GpuBackend {
    device: GpuDevice,
}

impl GpuBackend {
    /// Opens a device; see [`GpuDevice::open`].
    ///
    /// # Errors
    /// [`twinlight_core::Error::BackendUnavailable`], [`twinlight_core::Error::Unsupported`].
    pub fn open(options: &DeviceOptions) -> Result<Self> {
        GpuDevice::open(options).map(Self::new)
    }

    /// Runs the kernels on an open device.
    pub fn new(device: GpuDevice) -> Self {
        Self { device }
    }

    /// The device.
    pub fn device(&self) -> &GpuDevice {
        &self.device
    }
}

impl Backend for GpuBackend {
    type Buffer<T: Pod + Send + Sync> = GpuBuffer<T>;
    type Scene = GpuScene;
    type Mesh = GpuMesh;

    fn info(&self) -> BackendInfo {
        let report = self.device.report();
        BackendInfo {
            kind: "gpu",
            device: report.name.clone(),
            driver: format!("{}, {} {}", report.backend, report.driver, report.driver_info)
                .trim_end()
                .to_owned(),
            strict: self.device.mode() == Mode::Strict,
        }
    }

    fn upload<T: Pod + Send + Sync>(&self, data: &[T]) -> Result<GpuBuffer<T>> {
        self.device.upload(data)
    }

    fn zeroed<T: Pod + Send + Sync>(&self, len: usize) -> Result<GpuBuffer<T>> {
        self.device.zeroed(len)
    }

    fn download<T: Pod + Send + Sync>(&self, buffer: &GpuBuffer<T>) -> Result<Vec<T>> {
        self.device.download(buffer)
    }

    fn len<T: Pod + Send + Sync>(&self, buffer: &GpuBuffer<T>) -> usize {
        buffer.len()
    }

    fn upload_scene(&self, scene: &CompiledScene) -> Result<GpuScene> {
        GpuScene::new(&self.device, scene)
    }

    fn upload_mesh(&self, mesh: &LatticeMesh) -> Result<GpuMesh> {
        GpuMesh::new(&self.device, mesh)
    }

    fn scan(&self, input: &GpuBuffer<u32>, output: &mut GpuBuffer<u32>) -> Result<u32> {
        scan::run(&self.device, input, output)
    }

    fn sort_u32(&self, keys: &mut GpuBuffer<u32>, payload: &mut GpuBuffer<u32>) -> Result<()> {
        sort::run(&self.device, keys, payload)
    }

    fn sort_u64(&self, keys: &mut GpuBuffer<u64>, payload: &mut GpuBuffer<u32>) -> Result<()> {
        sort::run(&self.device, keys, payload)
    }

    fn trace_closest(
        &self,
        scene: &GpuScene,
        rays: &GpuBuffer<Ray>,
        hits: &mut GpuBuffer<Hit>,
    ) -> Result<()> {
        trace::closest(&self.device, scene, rays, hits)
    }

    fn trace_any(
        &self,
        scene: &GpuScene,
        rays: &GpuBuffer<Ray>,
        occluded: &mut GpuBuffer<u32>,
    ) -> Result<()> {
        trace::any(&self.device, scene, rays, occluded)
    }

    fn shade_primary(
        &self,
        scene: &GpuScene,
        params: &ShadePrimaryParams,
        gbuffer: &mut GpuBuffer<GBufferTexel>,
    ) -> Result<()> {
        shade_primary::run(&self.device, scene, params, gbuffer)
    }

    fn trace_paths(
        &self,
        scene: &GpuScene,
        params: &TracePathsParams,
        film: &mut GpuBuffer<FilmTexel>,
    ) -> Result<()> {
        trace_paths::run(&self.device, scene, params, film)
    }

    fn rasterize_lhb(
        &self,
        mesh: &GpuMesh,
        views: &[View],
        params: &RasterizeLhbParams,
    ) -> Result<Lhb<Self>> {
        rasterize_lhb::run(&self.device, mesh, views, params)
    }

    fn merge_lhb(&self, kept: &Lhb<Self>, added: &Lhb<Self>, params: &MergeLhbParams) -> Result<Lhb<Self>> {
        merge_lhb::run(&self.device, kept, added, params)
    }

    fn pack_lhb(&self, lhb: &Lhb<Self>, params: &PackLhbParams) -> Result<PackedLhb<Self>> {
        pack_lhb::pack(&self.device, lhb, params)
    }

    fn unpack_lhb(&self, packed: &PackedLhb<Self>) -> Result<Lhb<Self>> {
        pack_lhb::unpack(&self.device, packed)
    }

    fn query_lhb(
        &self,
        mesh: &GpuMesh,
        lhb: &Lhb<Self>,
        views: &[View],
        queries: &GpuBuffer<LhbQuery>,
        hits: &mut GpuBuffer<LhbElement>,
    ) -> Result<()> {
        query_lhb::run(&self.device, mesh, lhb, views, queries, hits)
    }

    fn walk_lhb(
        &self,
        scene: &GpuScene,
        mesh: &GpuMesh,
        lhb: &Lhb<Self>,
        views: &[View],
        map: &GpuBuffer<u32>,
        params: &WalkLhbParams,
        film: &mut GpuBuffer<FilmTexel>,
    ) -> Result<()> {
        walk_lhb::run(&self.device, scene, mesh, lhb, views, map, params, film)
    }

    fn filter_indirect(
        &self,
        gbuffer: &GpuBuffer<GBufferTexel>,
        diffuse: &GpuBuffer<u32>,
        input: &GpuBuffer<RadianceTexel>,
        params: &FilterIndirectParams,
        output: &mut GpuBuffer<RadianceTexel>,
    ) -> Result<()> {
        filter_indirect::run(&self.device, gbuffer, diffuse, input, params, output)
    }

    fn voxelize(&self, mesh: &GpuMesh, grid: &VoxelGrid, params: &VoxelizeParams) -> Result<Voxels<Self>> {
        voxelize::run(&self.device, mesh, grid, params)
    }

    fn sum_voxels(
        &self,
        mesh: &GpuMesh,
        voxels: &Voxels<Self>,
        surfaces: &GpuBuffer<VoxelSurface>,
        texels: &GpuBuffer<u32>,
        params: &VoxelizeParams,
    ) -> Result<GpuBuffer<VoxelSums>> {
        sum_voxels::run(&self.device, mesh, voxels, surfaces, texels, params)
    }

    fn voxel_levels(&self, voxels: &Voxels<Self>) -> Result<VoxelLevels<Self>> {
        reduce_mips::levels(&self.device, voxels)
    }

    fn reduce_mips(
        &self,
        levels: &VoxelLevels<Self>,
        leaves: &GpuBuffer<VoxelLight>,
        params: &ReduceMipsParams,
    ) -> Result<GpuBuffer<u32>> {
        reduce_mips::reduce(&self.device, levels, leaves, params)
    }

    fn light_voxels(
        &self,
        scene: &GpuScene,
        active: &GpuBuffer<u32>,
        sums: &GpuBuffer<VoxelSums>,
        gathered: &GpuBuffer<RadianceTexel>,
        params: &LightVoxelsBlock,
        leaves: &mut GpuBuffer<VoxelLight>,
    ) -> Result<()> {
        light_voxels::run(&self.device, scene, active, sums, gathered, params, leaves)
    }

    fn trace_cones(
        &self,
        levels: &VoxelLevels<Self>,
        values: &GpuBuffer<u32>,
        cones: &GpuBuffer<Cone>,
        params: &TraceConesBlock,
        light: &mut GpuBuffer<ConeLight>,
    ) -> Result<()> {
        trace_cones::run(&self.device, levels, values, cones, params, light)
    }
}
