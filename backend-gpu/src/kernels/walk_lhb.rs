// kernel family: walk_lhb
// contract core/src/kernels/walk_lhb.rs
// cpu backend-cpu/src/kernels/walk_lhb.rs
// gpu backend-gpu/src/kernels/walk_lhb.wgsl
// oracle conformance/src/oracle/walk_lhb.rs
//! Host side of `walk_lhb`.

use crate::backend::GpuBackend;
use crate::buffer::GpuBuffer;
use crate::device::GpuDevice;
use crate::dispatch::Recorder;
use crate::kernels::path::{Batches, PathState, WORKGROUP_SIZE, follow, texels_of};
use crate::kernels::query_lhb::{LhbHeader, Lookups, check_equal};
use crate::kernels::status;
use crate::mesh::GpuMesh;
use crate::pipeline::Pipeline;
use crate::scene::GpuScene;
use crate::shared;
use crate::source::{KernelSource, WgslFile};
use bytemuck::{Pod, Zeroable};
use std::sync::Arc;
use twinlight_core::Result;
use twinlight_core::kernels::rasterize_lhb::Lhb;
use twinlight_core::kernels::trace_paths::{FilmTexel, TracePathsParams};
use twinlight_core::kernels::walk_lhb::{self as contract, GATHER, SHADOW_LOOKUPS};
use twinlight_core::lattice::View;
use twinlight_core::scene::EnvironmentHeader;

/// The WGSL.
pub const SOURCE: KernelSource = KernelSource {
    stem: "walk_lhb",
    files: &[
        shared::DISPATCH,
        shared::HASH,
        shared::SOBOL,
        shared::FIXED,
        shared::TRIG,
        shared::VECTOR,
        shared::OCTAHEDRAL,
        shared::SCENE,
        shared::INTERSECT,
        shared::TRAVERSE,
        shared::TEXTURE,
        shared::OFFSET,
        shared::SURFACE,
        shared::BSDF,
        shared::ENVIRONMENT,
        shared::LIGHT,
        shared::PATH,
        shared::LATTICE,
        shared::LOOK_UP,
        shared::LHB,
        WgslFile { path: "backend-gpu/src/kernels/walk_lhb.wgsl", text: include_str!("walk_lhb.wgsl") },
    ],
};

/// Twin of the WGSL struct.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct WalkLhbParams {
    /// The pixels and samples of the dispatch.
    pub call: TracePathsParams,
    /// The contract's.
    pub lookup: contract::WalkLhbBlock,
    /// The scene's.
    pub environment: EnvironmentHeader,
    /// What is looked up.
    pub lhb: LhbHeader,
    /// 0 starts the paths, others go on.
    pub segment: u32,
    /// Word of `status` that counts the paths still alive.
    pub alive_word: u32,
    /// For `loops_run`.
    pub loop_rounds: u32,
    /// The pixel that `film` begins with.
    pub film_begin: u32,
}

/// Twin of the WGSL struct: a path between two dispatches.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub struct Walker {
    /// The path.
    pub path: PathState,
    /// Unit normal of what it leaves, on its side.
    pub normal: [f32; 3],
    /// Twice the triangle that it leaves, plus 1 on its front; all ones for a ray that is traced.
    pub leaves: u32,
    /// The triangle that a looked-up ray meets.
    pub slot: u32,
    /// Barycentric weight of its second vertex.
    pub u: f32,
    /// Barycentric weight of its third vertex.
    pub v: f32,
    /// Distance along the ray.
    pub t: f32,
    /// Light that waits for its shadow ray.
    pub light: [f32; 3],
    /// How often that has been scattered; 0 where none waits.
    pub order: u32,
    /// Unit direction of the shadow ray.
    pub to_light: [f32; 3],
    /// Its length.
    pub light_distance: f32,
}

/// Adds samples to a film; see the contract. After an error the film's sums are void.
///
/// # Errors
/// [`twinlight_core::Error::InvalidInput`] for what doesn't belong together, `Unsupported` when the driver ends loops
/// early.
pub fn run(
    device: &GpuDevice,
    scene: &GpuScene,
    mesh: &GpuMesh,
    lhb: &Lhb<GpuBackend>,
    views: &[View],
    map: &GpuBuffer<u32>,
    params: &contract::WalkLhbParams,
    film: &mut GpuBuffer<FilmTexel>,
) -> Result<()> {
    params.check(film.len(), views, map.len())?;
    check_equal("walk_lhb size", lhb.size as usize, params.lookup.size as usize)?;
    check_equal("walk_lhb triangles", mesh.triangle_count() as usize, scene.triangle_count as usize)?;
    let lookups = Lookups::new(device, mesh, lhb, views)?;
    if params.call.pixel_count == 0 || params.call.sample_count == 0 {
        return Ok(());
    }
    let batches = Batches::new(device, &params.call, size_of::<Walker>());
    let walk = Walk {
        aim_paths: device.pipeline(&SOURCE, "aim_paths")?,
        extend_paths: device.pipeline(&SOURCE, "extend_paths")?,
        look_up_rays: device.pipeline(&SOURCE, "look_up_rays")?,
        look_up_shadows: device.pipeline(&SOURCE, "look_up_shadows")?,
        add_samples: device.pipeline(&SOURCE, "add_samples")?,
        paths: device.zeroed(batches.paths())?,
        status: status::new(device)?,
        device,
        scene,
        lookups,
        map,
        params,
    };
    batches.of(&params.call).try_for_each(|batch| walk.run(&batch, film))
}

struct Walk<'a> {
    aim_paths: Arc<Pipeline>,
    extend_paths: Arc<Pipeline>,
    look_up_rays: Arc<Pipeline>,
    look_up_shadows: Arc<Pipeline>,
    add_samples: Arc<Pipeline>,
    paths: GpuBuffer<Walker>,
    status: GpuBuffer<u32>,
    device: &'a GpuDevice,
    scene: &'a GpuScene,
    lookups: Lookups<'a>,
    map: &'a GpuBuffer<u32>,
    params: &'a contract::WalkLhbParams,
}

impl Walk<'_> {
    /// Follows the paths of one batch to their ends and adds them to the film.
    fn run(&self, batch: &TracePathsParams, film: &GpuBuffer<FilmTexel>) -> Result<()> {
        let (texels, film_begin) = texels_of(batch, film);
        let params = WalkLhbParams {
            call: *batch,
            lookup: self.params.lookup,
            environment: self.scene.environment,
            lhb: self.lookups.header,
            segment: 0,
            alive_word: 0,
            loop_rounds: status::LOOP_ROUNDS,
            film_begin,
        };
        let paths = ("paths", self.paths.binding());
        let workgroups = batch.pixel_count.div_ceil(WORKGROUP_SIZE);
        // A segment is a vertex, and the vertex after the last bounce ends a path.
        let most = batch.max_bounces.saturating_add(1);
        follow(
            self.device,
            "walk_lhb",
            &self.status,
            most,
            |recorder, segment, alive_word| {
                let params = WalkLhbParams { segment, alive_word, ..params };
                self.visit_vertices(recorder, &params, segment + 1 == most)
            },
            |recorder| {
                recorder.dispatch(
                    "add samples",
                    &self.add_samples,
                    &params,
                    &[paths, ("film", texels)],
                    workgroups,
                )
            },
        )
    }

    /// A vertex of every path, and what the rays from there meet unless it is the last.
    fn visit_vertices<'a>(
        &'a self,
        recorder: &mut Recorder<'a>,
        params: &WalkLhbParams,
        is_last: bool,
    ) -> Result<()> {
        let workgroups = (params.call.pixel_count * params.call.sample_count).div_ceil(WORKGROUP_SIZE);
        let own = [("paths", self.paths.binding()), ("status", self.status.binding())];
        let buffers = self.scene.buffers_and(&own);
        let lookups = self.lookups.buffers_and(&[("nearest_map", self.map.binding())]);
        let all = [buffers.clone(), lookups].concat();
        if params.segment == 0 && params.lookup.flags & GATHER != 0 {
            recorder.dispatch("aim paths", &self.aim_paths, params, &all, workgroups)?;
        }
        recorder.dispatch("extend paths", &self.extend_paths, params, &buffers, workgroups)?;
        // There nothing scatters, and no light waits.
        if is_last {
            return Ok(());
        }
        if params.lookup.flags & SHADOW_LOOKUPS != 0 {
            recorder.dispatch("look up shadows", &self.look_up_shadows, params, &all, workgroups)?;
        }
        recorder.dispatch("look up rays", &self.look_up_rays, params, &all, workgroups)
    }
}
