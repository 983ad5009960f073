//! [`CpuBackend`]: checks the caller's lengths, then runs a kernel in a thread pool and turns a panic into an error.

use crate::buffer::{CpuBuffer, try_copy, try_zeroed};
use crate::kernels::light_voxels::Lit;
use crate::kernels::query_lhb::LhbData;
use crate::kernels::walk_lhb::Lookups;
use crate::scratch::Scratch;
use crate::simd::Isa;
use crate::{CpuMesh, CpuScene, kernels, processor, simd};
use bytemuck::Pod;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use twinlight_core::kernels::filter_indirect::{FilterIndirectParams, RadianceTexel};
use twinlight_core::kernels::light_voxels::LightVoxelsBlock;
use twinlight_core::kernels::merge_lhb::MergeLhbParams;
use twinlight_core::kernels::pack_lhb::{PackLhbParams, PackedLhb};
use twinlight_core::kernels::query_lhb::LhbQuery;
use twinlight_core::kernels::rasterize_lhb::{Lhb, LhbElement, RasterizeLhbParams};
use twinlight_core::kernels::reduce_mips::{self, ReduceMipsParams, VoxelLevels, VoxelLight};
use twinlight_core::kernels::shade_primary::{GBufferTexel, ShadePrimaryParams};
use twinlight_core::kernels::sum_voxels::{self, VoxelSums, VoxelSurface};
use twinlight_core::kernels::trace::{Hit, Ray};
use twinlight_core::kernels::trace_cones::{Cone, ConeLight, TraceConesBlock};
use twinlight_core::kernels::trace_paths::{FilmTexel, TracePathsParams};
use twinlight_core::kernels::voxelize::{VoxelizeParams, Voxels};
use twinlight_core::kernels::walk_lhb::WalkLhbParams;
use twinlight_core::kernels::{scan, sort};
use twinlight_core::lattice::{LatticeMesh, View, VoxelGrid, subpixel_bits};
use twinlight_core::scene::CompiledScene;
use twinlight_core::{Backend, BackendInfo, Error, Result};

/// Most threads a pool of our own may have.
const MAX_THREADS: usize = 1024;

/// Every kernel on the host's processor. Clones share the thread pool and the working memory, which stays as large as
/// the largest sort has needed (8 bytes per 32-bit pair, 12 per 64-bit pair) until the last clone is dropped.
#[derive(Debug, Clone)]
pub struct CpuBackend {
    pool: Option<Arc<ThreadPool>>,
    scratch: Arc<Scratch>,
    isa: Isa,
}

impl Default for CpuBackend {
    fn default() -> Self {
        Self::new()
    }
}

impl CpuBackend {
    /// Uses the rayon pool of the calling thread: the caller's own, or the global one.
    pub fn new() -> Self {
        Self { pool: None, scratch: Arc::default(), isa: simd::detect() }
    }

    /// Starts a pool of `threads` threads.
    ///
    /// # Errors
    /// [`Error::InvalidInput`] for 0, [`Error::LimitExceeded`] above 1024, [`Error::BackendUnavailable`] when the
    /// system refuses to start them.
    pub fn with_threads(threads: usize) -> Result<Self> {
        if threads == 0 {
            return Err(Error::invalid("threads", "0; at least one is needed"));
        }
        if threads > MAX_THREADS {
            return Err(Error::limit("threads", threads as u64, MAX_THREADS as u64));
        }
        let pool = ThreadPoolBuilder::new()
            .num_threads(threads)
            .thread_name(|i| format!("twinlight-{i}"))
            .build()
            .map_err(|e| Error::BackendUnavailable { tried: format!("cpu with {threads} threads: {e}") })?;
        Ok(Self { pool: Some(Arc::new(pool)), scratch: Arc::default(), isa: simd::detect() })
    }

    /// The same backend on the instructions of `isa`, if this machine has them. The bits stay the same.
    #[must_use]
    pub fn with_isa(self, isa: Isa) -> Self {
        Self { isa: if isa.is_available() { isa } else { self.isa }, ..self }
    }

    /// Threads that kernels called from here run on.
    pub fn threads(&self) -> usize {
        self.pool.as_ref().map_or_else(rayon::current_num_threads, |pool| pool.current_num_threads())
    }

    /// Runs a kernel in the pool. A panic, on whatever thread, ends as [`Error::Internal`]: buffers the kernel was
    /// writing hold some initialised values, and the backend stays usable.
    fn run<R: Send>(&self, kernel: &str, body: impl FnOnce() -> Result<R> + Send) -> Result<R> {
        let guarded = AssertUnwindSafe(|| match &self.pool {
            Some(pool) => pool.install(body),
            None => body(),
        });
        catch_unwind(guarded)
            .unwrap_or_else(|panic| Err(Error::Internal(format!("{kernel}: {}", panic_text(&*panic)))))
    }
}

fn panic_text(panic: &(dyn Any + Send)) -> &str {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("panic without a message")
}

fn check_equal(place: &str, found: usize, expected: usize) -> Result<()> {
    if found == expected {
        return Ok(());
    }
    Err(Error::invalid(place, format!("has {found} elements where {expected} are needed")))
}

fn check_limit(what: &str, found: usize, limit: usize) -> Result<()> {
    if found <= limit { Ok(()) } else { Err(Error::limit(what, found as u64, limit as u64)) }
}

impl Backend for CpuBackend {
    type Buffer<T: Pod + Send + Sync> = CpuBuffer<T>;
    type Scene = CpuScene;
    type Mesh = CpuMesh;

    fn info(&self) -> BackendInfo {
        let driver = format!("{} {}, {} threads", std::env::consts::ARCH, self.isa.name(), self.threads());
        BackendInfo { kind: "cpu", device: processor::name(), driver, strict: true }
    }

    fn upload<T: Pod + Send + Sync>(&self, data: &[T]) -> Result<CpuBuffer<T>> {
        try_copy(data).map(CpuBuffer::from)
    }

    fn zeroed<T: Pod + Send + Sync>(&self, len: usize) -> Result<CpuBuffer<T>> {
        try_zeroed(len).map(CpuBuffer::from)
    }

    fn download<T: Pod + Send + Sync>(&self, buffer: &CpuBuffer<T>) -> Result<Vec<T>> {
        try_copy(buffer.as_slice())
    }

    fn len<T: Pod + Send + Sync>(&self, buffer: &CpuBuffer<T>) -> usize {
        buffer.as_slice().len()
    }

    fn upload_scene(&self, scene: &CompiledScene) -> Result<CpuScene> {
        self.run("upload_scene", || CpuScene::new(scene))
    }

    fn upload_mesh(&self, mesh: &LatticeMesh) -> Result<CpuMesh> {
        self.run("upload_mesh", || CpuMesh::new(mesh))
    }

    fn scan(&self, input: &CpuBuffer<u32>, output: &mut CpuBuffer<u32>) -> Result<u32> {
        let (input, output) = (input.as_slice(), output.as_mut_slice());
        check_equal("scan output", output.len(), input.len())?;
        check_limit("elements to scan", input.len(), scan::MAX_LEN)?;
        self.run("scan", || Ok(kernels::scan::scan(input, output)))
    }

    fn sort_u32(&self, keys: &mut CpuBuffer<u32>, payload: &mut CpuBuffer<u32>) -> Result<()> {
        let (keys, payload) = (keys.as_mut_slice(), payload.as_mut_slice());
        check_equal("sort_u32 payload", payload.len(), keys.len())?;
        check_limit("pairs to sort", keys.len(), sort::MAX_LEN)?;
        self.run("sort_u32", || kernels::sort::sort(keys, payload, &self.scratch))
    }

    fn sort_u64(&self, keys: &mut CpuBuffer<u64>, payload: &mut CpuBuffer<u32>) -> Result<()> {
        let (keys, payload) = (keys.as_mut_slice(), payload.as_mut_slice());
        check_equal("sort_u64 payload", payload.len(), keys.len())?;
        check_limit("pairs to sort", keys.len(), sort::MAX_LEN)?;
        self.run("sort_u64", || kernels::sort::sort(keys, payload, &self.scratch))
    }

    fn trace_closest(
        &self,
        scene: &CpuScene,
        rays: &CpuBuffer<Ray>,
        hits: &mut CpuBuffer<Hit>,
    ) -> Result<()> {
        let (rays, hits) = (rays.as_slice(), hits.as_mut_slice());
        check_equal("trace_closest hits", hits.len(), rays.len())?;
        self.run("trace_closest", || {
            kernels::trace::trace_closest(self.isa, scene.data(), rays, hits);
            Ok(())
        })
    }

    fn trace_any(
        &self,
        scene: &CpuScene,
        rays: &CpuBuffer<Ray>,
        occluded: &mut CpuBuffer<u32>,
    ) -> Result<()> {
        let (rays, occluded) = (rays.as_slice(), occluded.as_mut_slice());
        check_equal("trace_any occluded", occluded.len(), rays.len())?;
        self.run("trace_any", || {
            kernels::trace::trace_any(self.isa, scene.data(), rays, occluded);
            Ok(())
        })
    }

    fn shade_primary(
        &self,
        scene: &CpuScene,
        params: &ShadePrimaryParams,
        gbuffer: &mut CpuBuffer<GBufferTexel>,
    ) -> Result<()> {
        let gbuffer = gbuffer.as_mut_slice();
        check_equal("shade_primary gbuffer", gbuffer.len(), params.width as usize * params.height as usize)?;
        self.run("shade_primary", || {
            kernels::shade_primary::shade_primary(self.isa, scene.data(), params, gbuffer);
            Ok(())
        })
    }

    fn trace_paths(
        &self,
        scene: &CpuScene,
        params: &TracePathsParams,
        film: &mut CpuBuffer<FilmTexel>,
    ) -> Result<()> {
        let film = film.as_mut_slice();
        params.check(film.len())?;
        self.run("trace_paths", || {
            kernels::trace_paths::trace_paths(self.isa, scene.data(), params, film);
            Ok(())
        })
    }

    fn rasterize_lhb(
        &self,
        mesh: &CpuMesh,
        views: &[View],
        params: &RasterizeLhbParams,
    ) -> Result<Lhb<Self>> {
        params.check(views)?;
        self.run("rasterize_lhb", || kernels::rasterize_lhb::rasterize_lhb(self.isa, mesh, views, params))
    }

    fn merge_lhb(&self, kept: &Lhb<Self>, added: &Lhb<Self>, params: &MergeLhbParams) -> Result<Lhb<Self>> {
        params.check(kept, added, |buffer| buffer.as_slice().len())?;
        self.run("merge_lhb", || kernels::merge_lhb::merge_lhb(kept, added, params))
    }

    fn pack_lhb(&self, lhb: &Lhb<Self>, params: &PackLhbParams) -> Result<PackedLhb<Self>> {
        let len = |buffer: &CpuBuffer<u32>| buffer.as_slice().len();
        let shape = params.check(lhb, len, lhb.elements.as_slice().len())?;
        self.run("pack_lhb", || kernels::pack_lhb::pack_lhb(lhb, params, shape))
    }

    fn unpack_lhb(&self, packed: &PackedLhb<Self>) -> Result<Lhb<Self>> {
        let shape = packed.check(|buffer| buffer.as_slice().len())?;
        self.run("unpack_lhb", || kernels::pack_lhb::unpack_lhb(packed, shape))
    }

    fn query_lhb(
        &self,
        mesh: &CpuMesh,
        lhb: &Lhb<Self>,
        views: &[View],
        queries: &CpuBuffer<LhbQuery>,
        hits: &mut CpuBuffer<LhbElement>,
    ) -> Result<()> {
        let (queries, hits) = (queries.as_slice(), hits.as_mut_slice());
        check_equal("query_lhb hits", hits.len(), queries.len())?;
        let lhb = lhb_data(mesh, lhb, views)?;
        self.run("query_lhb", || {
            kernels::query_lhb::query_lhb(self.isa, lhb, queries, hits);
            Ok(())
        })
    }

    fn walk_lhb(
        &self,
        scene: &CpuScene,
        mesh: &CpuMesh,
        lhb: &Lhb<Self>,
        views: &[View],
        map: &CpuBuffer<u32>,
        params: &WalkLhbParams,
        film: &mut CpuBuffer<FilmTexel>,
    ) -> Result<()> {
        let film = film.as_mut_slice();
        params.check(film.len(), views, map.as_slice().len())?;
        check_equal("walk_lhb size", lhb.size as usize, params.lookup.size as usize)?;
        check_equal("walk_lhb triangles", mesh.len(), scene.data().triangles.len())?;
        let lookups = Lookups { lhb: lhb_data(mesh, lhb, views)?, map: map.as_slice() };
        self.run("walk_lhb", || {
            kernels::walk_lhb::walk_lhb(self.isa, scene.data(), lookups, params, film);
            Ok(())
        })
    }

    fn filter_indirect(
        &self,
        gbuffer: &CpuBuffer<GBufferTexel>,
        diffuse: &CpuBuffer<u32>,
        input: &CpuBuffer<RadianceTexel>,
        params: &FilterIndirectParams,
        output: &mut CpuBuffer<RadianceTexel>,
    ) -> Result<()> {
        let (gbuffer, input, output) = (gbuffer.as_slice(), input.as_slice(), output.as_mut_slice());
        params.check([gbuffer.len(), input.len(), output.len()])?;
        self.run("filter_indirect", || {
            kernels::filter_indirect::filter_indirect(
                self.isa,
                gbuffer,
                diffuse.as_slice(),
                input,
                params,
                output,
            )
        })
    }

    fn voxelize(&self, mesh: &CpuMesh, grid: &VoxelGrid, params: &VoxelizeParams) -> Result<Voxels<Self>> {
        params.check(grid, mesh.len())?;
        self.run("voxelize", || kernels::voxelize::voxelize(self.isa, mesh, grid, params))
    }

    fn sum_voxels(
        &self,
        mesh: &CpuMesh,
        voxels: &Voxels<Self>,
        surfaces: &CpuBuffer<VoxelSurface>,
        texels: &CpuBuffer<u32>,
        params: &VoxelizeParams,
    ) -> Result<CpuBuffer<VoxelSums>> {
        let (surfaces, texels) = (surfaces.as_slice(), texels.as_slice());
        let len = |buffer: &CpuBuffer<u32>| buffer.as_slice().len();
        let active = sum_voxels::check(params, voxels, len, mesh.len(), surfaces.len())?;
        self.run("sum_voxels", || {
            kernels::sum_voxels::sum_voxels(mesh, voxels, surfaces, texels, params, active)
        })
    }

    fn voxel_levels(&self, voxels: &Voxels<Self>) -> Result<VoxelLevels<Self>> {
        reduce_mips::check_voxels(voxels, |buffer| buffer.as_slice().len())?;
        self.run("voxel_levels", || kernels::reduce_mips::voxel_levels(self.isa, voxels))
    }

    fn reduce_mips(
        &self,
        levels: &VoxelLevels<Self>,
        leaves: &CpuBuffer<VoxelLight>,
        params: &ReduceMipsParams,
    ) -> Result<CpuBuffer<u32>> {
        let leaves = leaves.as_slice();
        let words = params.check(levels, |buffer| buffer.as_slice().len(), leaves.len())?;
        self.run("reduce_mips", || kernels::reduce_mips::reduce_mips(levels, leaves, params.storage, words))
    }

    fn light_voxels(
        &self,
        scene: &CpuScene,
        active: &CpuBuffer<u32>,
        sums: &CpuBuffer<VoxelSums>,
        gathered: &CpuBuffer<RadianceTexel>,
        params: &LightVoxelsBlock,
        leaves: &mut CpuBuffer<VoxelLight>,
    ) -> Result<()> {
        let (active, sums, gathered) = (active.as_slice(), sums.as_slice(), gathered.as_slice());
        let leaves = leaves.as_mut_slice();
        params.check([active.len(), sums.len(), gathered.len(), leaves.len()])?;
        self.run("light_voxels", || {
            let voxels = Lit { active, sums, gathered };
            kernels::light_voxels::light_voxels(self.isa, scene.data(), voxels, params, leaves);
            Ok(())
        })
    }

    fn trace_cones(
        &self,
        levels: &VoxelLevels<Self>,
        values: &CpuBuffer<u32>,
        cones: &CpuBuffer<Cone>,
        params: &TraceConesBlock,
        light: &mut CpuBuffer<ConeLight>,
    ) -> Result<()> {
        let (values, cones, light) = (values.as_slice(), cones.as_slice(), light.as_mut_slice());
        params.check(levels, |buffer| buffer.as_slice().len(), values.len(), [cones.len(), light.len()])?;
        self.run("trace_cones", || {
            kernels::trace_cones::trace_cones(levels, values, cones, params, light);
            Ok(())
        })
    }
}

/// What queries read, if it belongs together.
fn lhb_data<'a>(mesh: &'a CpuMesh, lhb: &'a Lhb<CpuBackend>, views: &'a [View]) -> Result<LhbData<'a>> {
    check_equal("query_lhb views", views.len(), lhb.view_count as usize)?;
    check_equal("query_lhb offsets", lhb.offsets.as_slice().len(), lhb.lists()? + 1)?;
    Ok(LhbData {
        size: lhb.size,
        bits: subpixel_bits(lhb.size),
        views,
        offsets: lhb.offsets.as_slice(),
        elements: lhb.elements.as_slice(),
        planes: &mesh.planes,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use rayon::prelude::*;

    /// D9: a panic on a worker or on the calling thread is an error, and the backend goes on working.
    #[test]
    fn panics_become_internal_errors() {
        for backend in [CpuBackend::new(), CpuBackend::with_threads(3).unwrap()] {
            let on_worker = backend.run("probe", || {
                (0..100).into_par_iter().for_each(|i| assert!(i != 57, "planted at {i}"));
                Ok(())
            });
            assert!(matches!(on_worker, Err(Error::Internal(text)) if text == "probe: planted at 57"));
            let on_caller: Result<()> = backend.run("probe", || panic!("planted"));
            assert!(matches!(on_caller, Err(Error::Internal(text)) if text == "probe: planted"));
            assert_eq!(backend.run("probe", || Ok(5)).unwrap(), 5);
        }
    }

    #[test]
    fn thread_counts_are_checked() {
        assert!(matches!(CpuBackend::with_threads(0), Err(Error::InvalidInput { .. })));
        assert!(matches!(
            CpuBackend::with_threads(usize::MAX),
            Err(Error::LimitExceeded { limit: 1024, .. })
        ));
        assert_eq!(CpuBackend::with_threads(3).unwrap().threads(), 3);
    }

    #[test]
    fn information_names_processor_and_instruction_set() {
        let info = CpuBackend::with_threads(2).unwrap().info();
        assert_eq!(info.kind, "cpu");
        assert!(!info.device.is_empty());
        assert!(info.driver.starts_with(std::env::consts::ARCH), "{}", info.driver);
        assert!(info.driver.ends_with(", 2 threads"), "{}", info.driver);
        assert!(info.strict);
    }

    #[test]
    fn lengths_are_checked_before_anything_runs() {
        let backend = CpuBackend::new();
        let (two, mut three) = (backend.upload(&[1_u32, 2]).unwrap(), backend.upload(&[7_u32; 3]).unwrap());
        assert_eq!(
            backend.scan(&two, &mut three).unwrap_err().to_string(),
            "scan output: has 3 elements where 2 are needed"
        );
        assert_eq!(three.as_slice(), [7; 3]);
        let mut keys = backend.upload(&[2_u64, 1]).unwrap();
        assert!(matches!(backend.sort_u64(&mut keys, &mut three), Err(Error::InvalidInput { .. })));
        assert!(matches!(backend.sort_u32(&mut two.clone(), &mut three), Err(Error::InvalidInput { .. })));
        assert_eq!(keys.as_slice(), [2, 1]);
    }

    /// Pages that nothing touches cost nothing, so the limits themselves can be passed by one.
    #[test]
    fn lengths_beyond_the_limits_are_errors() {
        let backend = CpuBackend::new();
        let mut long = backend.zeroed::<u32>(scan::MAX_LEN + 1).unwrap();
        let mut also = backend.zeroed::<u32>(scan::MAX_LEN + 1).unwrap();
        let error = backend.scan(&long, &mut also).unwrap_err().to_string();
        assert_eq!(error, "elements to scan: needs 134217729, the limit is 134217728");
        assert!(matches!(backend.sort_u32(&mut long, &mut also), Err(Error::LimitExceeded { .. })));
        let mut keys = backend.zeroed::<u64>(sort::MAX_LEN + 1).unwrap();
        let mut payload = backend.zeroed::<u32>(sort::MAX_LEN + 1).unwrap();
        assert!(matches!(backend.sort_u64(&mut keys, &mut payload), Err(Error::LimitExceeded { .. })));
    }
}
