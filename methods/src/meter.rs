//! A backend that counts its calls and takes their time.

use bytemuck::Pod;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};
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

/// The calls of one kernel, or of one kind of transfer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Calls {
    /// The method of [`Backend`].
    pub name: &'static str,
    /// How many.
    pub count: u64,
    /// Until they returned, all together.
    pub time: Duration,
}

/// A backend behind which another does the work: it counts calls and takes their time. Buffers, scenes and meshes are those of the other.
///
/// Backends may return before the device is done: what a call waits for is counted where it is waited for, unless [`Metered::waiting`] has each call wait
/// for itself.
///
/// ```
/// use twinlight_backend_cpu::CpuBackend;
/// use twinlight_core::Backend;
/// use twinlight_methods::Metered;
///
/// # fn main() -> twinlight_core::Result<()> {
/// let cpu = CpuBackend::new();
/// let metered = Metered::new(&cpu);
/// let input = metered.upload(&[1_u32, 2, 3])?;
/// let mut output = metered.zeroed(3)?;
/// metered.scan(&input, &mut output)?;
/// assert_eq!(metered.count("scan"), 1);
/// assert_eq!(metered.count("voxelize"), 0);
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct Metered<'a, B> {
    inner: &'a B,
    waits: bool,
    calls: Mutex<Vec<Calls>>,
}

impl<'a, B> Metered<'a, B> {
    /// Counts what goes to `inner` from now on.
    pub fn new(inner: &'a B) -> Self {
        Self { inner, waits: false, calls: Mutex::default() }
    }

    /// As [`Metered::new`], and every call waits until the device is done with it: calls have the time that is their own.
    pub fn waiting(inner: &'a B) -> Self {
        Self { waits: true, ..Self::new(inner) }
    }

    /// Everything so far, in the order of first calls.
    pub fn calls(&self) -> Vec<Calls> {
        self.calls.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// How often a method was called so far.
    pub fn count(&self, name: &str) -> u64 {
        self.calls().iter().find(|calls| calls.name == name).map_or(0, |calls| calls.count)
    }

    fn count_call(&self, name: &'static str, time: Duration) {
        let mut calls = self.calls.lock().unwrap_or_else(PoisonError::into_inner);
        match calls.iter_mut().find(|calls| calls.name == name) {
            Some(known) => {
                known.count += 1;
                known.time += time;
            }
            None => calls.push(Calls { name, count: 1, time }),
        }
    }
}

impl<B: Backend> Metered<'_, B> {
    fn took<T>(&self, name: &'static str, call: impl FnOnce() -> Result<T>) -> Result<T> {
        let start = Instant::now();
        let result = call().and_then(|value| self.wait().map(|()| value));
        self.count_call(name, start.elapsed());
        result
    }

    /// Reads something back, which comes after everything before.
    fn wait(&self) -> Result<()> {
        if self.waits {
            self.inner.download(&self.inner.zeroed::<u32>(1)?)?;
        }
        Ok(())
    }
}

impl<B: Backend> Backend for Metered<'_, B> {
    type Buffer<T: Pod + Send + Sync> = B::Buffer<T>;
    type Scene = B::Scene;
    type Mesh = B::Mesh;

    fn info(&self) -> BackendInfo {
        self.inner.info()
    }

    fn upload<T: Pod + Send + Sync>(&self, data: &[T]) -> Result<B::Buffer<T>> {
        self.took("upload", || self.inner.upload(data))
    }

    fn zeroed<T: Pod + Send + Sync>(&self, len: usize) -> Result<B::Buffer<T>> {
        self.took("zeroed", || self.inner.zeroed(len))
    }

    fn download<T: Pod + Send + Sync>(&self, buffer: &B::Buffer<T>) -> Result<Vec<T>> {
        self.took("download", || self.inner.download(buffer))
    }

    fn len<T: Pod + Send + Sync>(&self, buffer: &B::Buffer<T>) -> usize {
        self.inner.len(buffer)
    }

    fn upload_scene(&self, scene: &CompiledScene) -> Result<B::Scene> {
        self.took("upload_scene", || self.inner.upload_scene(scene))
    }

    fn upload_mesh(&self, mesh: &LatticeMesh) -> Result<B::Mesh> {
        self.took("upload_mesh", || self.inner.upload_mesh(mesh))
    }

    fn scan(&self, input: &B::Buffer<u32>, output: &mut B::Buffer<u32>) -> Result<u32> {
        self.took("scan", || self.inner.scan(input, output))
    }

    fn sort_u32(&self, keys: &mut B::Buffer<u32>, payload: &mut B::Buffer<u32>) -> Result<()> {
        self.took("sort", || self.inner.sort_u32(keys, payload))
    }

    fn sort_u64(&self, keys: &mut B::Buffer<u64>, payload: &mut B::Buffer<u32>) -> Result<()> {
        self.took("sort", || self.inner.sort_u64(keys, payload))
    }

    fn trace_closest(
        &self,
        scene: &B::Scene,
        rays: &B::Buffer<Ray>,
        hits: &mut B::Buffer<Hit>,
    ) -> Result<()> {
        self.took("trace_closest", || self.inner.trace_closest(scene, rays, hits))
    }

    fn trace_any(
        &self,
        scene: &B::Scene,
        rays: &B::Buffer<Ray>,
        occluded: &mut B::Buffer<u32>,
    ) -> Result<()> {
        self.took("trace_any", || self.inner.trace_any(scene, rays, occluded))
    }

    fn shade_primary(
        &self,
        scene: &B::Scene,
        params: &ShadePrimaryParams,
        gbuffer: &mut B::Buffer<GBufferTexel>,
    ) -> Result<()> {
        self.took("shade_primary", || self.inner.shade_primary(scene, params, gbuffer))
    }

    fn trace_paths(
        &self,
        scene: &B::Scene,
        params: &TracePathsParams,
        film: &mut B::Buffer<FilmTexel>,
    ) -> Result<()> {
        self.took("trace_paths", || self.inner.trace_paths(scene, params, film))
    }

    fn rasterize_lhb(&self, mesh: &B::Mesh, views: &[View], params: &RasterizeLhbParams) -> Result<Lhb<B>> {
        self.took("rasterize_lhb", || self.inner.rasterize_lhb(mesh, views, params))
    }

    fn merge_lhb(&self, kept: &Lhb<B>, added: &Lhb<B>, params: &MergeLhbParams) -> Result<Lhb<B>> {
        self.took("merge_lhb", || self.inner.merge_lhb(kept, added, params))
    }

    fn pack_lhb(&self, lhb: &Lhb<B>, params: &PackLhbParams) -> Result<PackedLhb<B>> {
        self.took("pack_lhb", || self.inner.pack_lhb(lhb, params))
    }

    fn unpack_lhb(&self, packed: &PackedLhb<B>) -> Result<Lhb<B>> {
        self.took("unpack_lhb", || self.inner.unpack_lhb(packed))
    }

    fn query_lhb(
        &self,
        mesh: &B::Mesh,
        lhb: &Lhb<B>,
        views: &[View],
        queries: &B::Buffer<LhbQuery>,
        hits: &mut B::Buffer<LhbElement>,
    ) -> Result<()> {
        self.took("query_lhb", || self.inner.query_lhb(mesh, lhb, views, queries, hits))
    }

    fn walk_lhb(
        &self,
        scene: &B::Scene,
        mesh: &B::Mesh,
        lhb: &Lhb<B>,
        views: &[View],
        map: &B::Buffer<u32>,
        params: &WalkLhbParams,
        film: &mut B::Buffer<FilmTexel>,
    ) -> Result<()> {
        self.took("walk_lhb", || self.inner.walk_lhb(scene, mesh, lhb, views, map, params, film))
    }

    fn filter_indirect(
        &self,
        gbuffer: &B::Buffer<GBufferTexel>,
        diffuse: &B::Buffer<u32>,
        input: &B::Buffer<RadianceTexel>,
        params: &FilterIndirectParams,
        output: &mut B::Buffer<RadianceTexel>,
    ) -> Result<()> {
        self.took("filter_indirect", || self.inner.filter_indirect(gbuffer, diffuse, input, params, output))
    }

    fn voxelize(&self, mesh: &B::Mesh, grid: &VoxelGrid, params: &VoxelizeParams) -> Result<Voxels<B>> {
        self.took("voxelize", || self.inner.voxelize(mesh, grid, params))
    }

    fn sum_voxels(
        &self,
        mesh: &B::Mesh,
        voxels: &Voxels<B>,
        surfaces: &B::Buffer<VoxelSurface>,
        texels: &B::Buffer<u32>,
        params: &VoxelizeParams,
    ) -> Result<B::Buffer<VoxelSums>> {
        self.took("sum_voxels", || self.inner.sum_voxels(mesh, voxels, surfaces, texels, params))
    }

    fn voxel_levels(&self, voxels: &Voxels<B>) -> Result<VoxelLevels<B>> {
        self.took("voxel_levels", || self.inner.voxel_levels(voxels))
    }

    fn reduce_mips(
        &self,
        levels: &VoxelLevels<B>,
        leaves: &B::Buffer<VoxelLight>,
        params: &ReduceMipsParams,
    ) -> Result<B::Buffer<u32>> {
        self.took("reduce_mips", || self.inner.reduce_mips(levels, leaves, params))
    }

    fn light_voxels(
        &self,
        scene: &B::Scene,
        active: &B::Buffer<u32>,
        sums: &B::Buffer<VoxelSums>,
        gathered: &B::Buffer<RadianceTexel>,
        params: &LightVoxelsBlock,
        leaves: &mut B::Buffer<VoxelLight>,
    ) -> Result<()> {
        self.took("light_voxels", || self.inner.light_voxels(scene, active, sums, gathered, params, leaves))
    }

    fn trace_cones(
        &self,
        levels: &VoxelLevels<B>,
        values: &B::Buffer<u32>,
        cones: &B::Buffer<Cone>,
        params: &TraceConesBlock,
        light: &mut B::Buffer<ConeLight>,
    ) -> Result<()> {
        self.took("trace_cones", || self.inner.trace_cones(levels, values, cones, params, light))
    }
}
