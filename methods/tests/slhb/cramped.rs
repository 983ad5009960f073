//! A device on which what stays and the whole don't fit at once.

use crate::lookups;
use bytemuck::Pod;
use twinlight_backend_cpu::{CpuBackend, CpuBuffer, CpuMesh};
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
use twinlight_core::scene::{CompiledScene, Limits, compile};
use twinlight_core::{Backend, BackendInfo, Error, Result};
use twinlight_fixtures::scenes::builtin;
use twinlight_methods::slhb::{Kept, build};

type Buffer<T> = CpuBuffer<T>;

struct Cramped(CpuBackend);

const OTHER: &str = "building hit buffers has no use for it";

impl Backend for Cramped {
    type Buffer<T: Pod + Send + Sync> = CpuBuffer<T>;
    type Scene = ();
    type Mesh = CpuMesh;

    fn info(&self) -> BackendInfo {
        self.0.info()
    }

    fn upload<T: Pod + Send + Sync>(&self, data: &[T]) -> Result<Buffer<T>> {
        self.0.upload(data)
    }

    fn zeroed<T: Pod + Send + Sync>(&self, len: usize) -> Result<Buffer<T>> {
        self.0.zeroed(len)
    }

    fn download<T: Pod + Send + Sync>(&self, buffer: &Buffer<T>) -> Result<Vec<T>> {
        self.0.download(buffer)
    }

    fn len<T: Pod + Send + Sync>(&self, buffer: &Buffer<T>) -> usize {
        self.0.len(buffer)
    }

    fn upload_scene(&self, _: &CompiledScene) -> Result<()> {
        unreachable!("{OTHER}")
    }

    fn upload_mesh(&self, mesh: &LatticeMesh) -> Result<CpuMesh> {
        self.0.upload_mesh(mesh)
    }

    fn scan(&self, _: &Buffer<u32>, _: &mut Buffer<u32>) -> Result<u32> {
        unreachable!("{OTHER}")
    }

    fn sort_u32(&self, _: &mut Buffer<u32>, _: &mut Buffer<u32>) -> Result<()> {
        unreachable!("{OTHER}")
    }

    fn sort_u64(&self, _: &mut Buffer<u64>, _: &mut Buffer<u32>) -> Result<()> {
        unreachable!("{OTHER}")
    }

    fn trace_closest(&self, (): &(), _: &Buffer<Ray>, _: &mut Buffer<Hit>) -> Result<()> {
        unreachable!("{OTHER}")
    }

    fn trace_any(&self, (): &(), _: &Buffer<Ray>, _: &mut Buffer<u32>) -> Result<()> {
        unreachable!("{OTHER}")
    }

    fn shade_primary(&self, (): &(), _: &ShadePrimaryParams, _: &mut Buffer<GBufferTexel>) -> Result<()> {
        unreachable!("{OTHER}")
    }

    fn trace_paths(&self, (): &(), _: &TracePathsParams, _: &mut Buffer<FilmTexel>) -> Result<()> {
        unreachable!("{OTHER}")
    }

    fn rasterize_lhb(
        &self,
        mesh: &CpuMesh,
        views: &[View],
        params: &RasterizeLhbParams,
    ) -> Result<Lhb<Self>> {
        self.0.rasterize_lhb(mesh, views, params)
    }

    fn merge_lhb(&self, _: &Lhb<Self>, _: &Lhb<Self>, _: &MergeLhbParams) -> Result<Lhb<Self>> {
        Err(Error::OutOfMemory { device: "cramped".into(), bytes: 1 })
    }

    fn pack_lhb(&self, _: &Lhb<Self>, _: &PackLhbParams) -> Result<PackedLhb<Self>> {
        unreachable!("{OTHER}")
    }

    fn unpack_lhb(&self, _: &PackedLhb<Self>) -> Result<Lhb<Self>> {
        unreachable!("{OTHER}")
    }

    fn query_lhb(
        &self,
        _: &CpuMesh,
        _: &Lhb<Self>,
        _: &[View],
        _: &Buffer<LhbQuery>,
        _: &mut Buffer<LhbElement>,
    ) -> Result<()> {
        unreachable!("{OTHER}")
    }

    fn filter_indirect(
        &self,
        _: &Buffer<GBufferTexel>,
        _: &Buffer<u32>,
        _: &Buffer<RadianceTexel>,
        _: &FilterIndirectParams,
        _: &mut Buffer<RadianceTexel>,
    ) -> Result<()> {
        unreachable!("{OTHER}")
    }

    fn walk_lhb(
        &self,
        (): &(),
        _: &CpuMesh,
        _: &Lhb<Self>,
        _: &[View],
        _: &Buffer<u32>,
        _: &WalkLhbParams,
        _: &mut Buffer<FilmTexel>,
    ) -> Result<()> {
        unreachable!("{OTHER}")
    }

    fn voxelize(&self, _: &CpuMesh, _: &VoxelGrid, _: &VoxelizeParams) -> Result<Voxels<Self>> {
        unreachable!("{OTHER}")
    }

    fn sum_voxels(
        &self,
        _: &CpuMesh,
        _: &Voxels<Self>,
        _: &Buffer<VoxelSurface>,
        _: &Buffer<u32>,
        _: &VoxelizeParams,
    ) -> Result<Buffer<VoxelSums>> {
        unreachable!("{OTHER}")
    }

    fn voxel_levels(&self, _: &Voxels<Self>) -> Result<VoxelLevels<Self>> {
        unreachable!("{OTHER}")
    }

    fn reduce_mips(
        &self,
        _: &VoxelLevels<Self>,
        _: &Buffer<VoxelLight>,
        _: &ReduceMipsParams,
    ) -> Result<Buffer<u32>> {
        unreachable!("{OTHER}")
    }

    fn light_voxels(
        &self,
        _: &(),
        _: &Buffer<u32>,
        _: &Buffer<VoxelSums>,
        _: &Buffer<RadianceTexel>,
        _: &LightVoxelsBlock,
        _: &mut Buffer<VoxelLight>,
    ) -> Result<()> {
        unreachable!("{OTHER}")
    }

    fn trace_cones(
        &self,
        _: &VoxelLevels<Self>,
        _: &Buffer<u32>,
        _: &Buffer<Cone>,
        _: &TraceConesBlock,
        _: &mut Buffer<ConeLight>,
    ) -> Result<()> {
        unreachable!("{OTHER}")
    }
}

/// Whoever could render a frame alone can render it in a sequence.
#[test]
fn frames_that_fit_only_alone_are_built_whole() {
    let mut scene = builtin("axis").unwrap();
    scene.instances[0].moves = true;
    let scene = compile(&scene, &Limits::default()).unwrap();
    assert!(!scene.parts().0.is_empty() && !scene.parts().1.is_empty());
    let (backend, settings) = (Cramped(CpuBackend::new()), lookups("icosahedron:20", 16));
    let whole = build(&backend, &scene, &settings).unwrap();
    let mut kept = Kept::new();
    for _ in 0..2 {
        let found = kept.build(&backend, &scene, &settings).unwrap();
        assert_eq!(found.kept_elements, 0);
        assert_eq!(
            backend.download(&found.lhb.elements).unwrap(),
            backend.download(&whole.lhb.elements).unwrap()
        );
    }
}
