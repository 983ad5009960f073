// kernel family: trace_paths
// contract core/src/kernels/trace_paths.rs
// cpu backend-cpu/src/kernels/trace_paths.rs
// gpu backend-gpu/src/kernels/trace_paths.wgsl
// oracle conformance/src/oracle/trace_paths.rs
//! Rust twin of `trace_paths`: one path after another, so that a pixel's rays stay in cache.

use crate::path::{Emitters, Met, PathLight, add_direct_light, add_sample, start, visit};
use crate::sampler::Sampler;
use crate::scene::SceneData;
use crate::simd::{Isa, Kernel, Width, dispatch};
use crate::tracer::WideTracer;
use rayon::prelude::*;
use twinlight_core::kernels::trace_paths::{FilmTexel, TracePathsParams};
use twinlight_core::math::hash::mix_pair;
use twinlight_core::transport::SceneView;
use twinlight_core::transport::light::FAR;

/// Pixels per task: enough to hide the cost of a task, few enough to balance rows of uneven depth.
const TASK_PIXELS: usize = 64;

/// Adds the samples of `params`, which has been checked, to `film`.
pub(crate) fn trace_paths(isa: Isa, scene: &SceneData, params: &TracePathsParams, film: &mut [FilmTexel]) {
    let begin = params.pixel_begin as usize;
    let pixels = &mut film[begin..begin + params.pixel_count as usize];
    pixels.par_chunks_mut(TASK_PIXELS).enumerate().for_each(|(task, texels)| {
        let first_pixel = (begin + task * TASK_PIXELS) as u32;
        dispatch(isa, Task { scene, params, first_pixel, texels });
    });
}

/// The pixels of one task.
struct Task<'a> {
    scene: &'a SceneData,
    params: &'a TracePathsParams,
    first_pixel: u32,
    texels: &'a mut [FilmTexel],
}

impl Kernel for Task<'_> {
    type Output = ();

    #[inline(always)]
    fn run<W: Width>(self, width: W) {
        let tracer = WideTracer(&self.scene.bvh, width);
        trace_pixels(&tracer, &self.scene.view(), self.params, self.first_pixel, self.texels);
    }
}

/// Adds the samples of `params` for the pixels from `first_pixel` on to `film`, one texel per pixel.
#[inline(always)]
fn trace_pixels<W: Width>(
    tracer: &WideTracer<'_, W>,
    scene: &SceneView<'_>,
    params: &TracePathsParams,
    first_pixel: u32,
    film: &mut [FilmTexel],
) {
    for (i, texel) in film.iter_mut().enumerate() {
        let pixel = first_pixel + i as u32;
        let stream = mix_pair(params.seed, pixel);
        for sample in params.sample_begin..params.sample_begin + params.sample_count {
            let sampler = Sampler { kind: params.sampler, stream, sample };
            let light = trace_path(tracer, scene, params, pixel, &sampler);
            add_sample(texel, light, params);
        }
    }
}

/// One path from the camera.
#[inline(always)]
fn trace_path<W: Width>(
    tracer: &WideTracer<'_, W>,
    scene: &SceneView<'_>,
    params: &TracePathsParams,
    pixel: u32,
    sampler: &Sampler,
) -> PathLight {
    // [1] sample: a point of the pixel
    let mut path = start(tracer.1, params, pixel, sampler);
    loop {
        // Drawn before it is known whether the ray meets anything: the processor overlaps it with the search, which is
        // worth more than the vector wasted on a path's end.
        let base = Sampler::first_pair(path.vertices);
        let numbers = sampler.vertex(tracer.1, base);
        // [2] vertex: what the ray meets, and its emission
        let hit = tracer.closest(path.origin, path.direction, 0.0, FAR);
        let met = Met { slot: hit.slot, u: hit.u, v: hit.v, t: hit.t };
        // [3] direct light
        // [4] scatter
        // [5] roulette
        let visited =
            visit(&mut path, scene, params, &met, sampler, base, &numbers, Emitters::Balanced, None);
        if let Some(direct) = visited.direct {
            add_direct_light(&mut path.light, tracer, scene, &direct);
        }
        if visited.left.is_none() {
            return path.light;
        }
    }
}
