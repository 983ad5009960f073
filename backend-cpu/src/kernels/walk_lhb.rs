// kernel family: walk_lhb
// contract core/src/kernels/walk_lhb.rs
// cpu backend-cpu/src/kernels/walk_lhb.rs
// gpu backend-gpu/src/kernels/walk_lhb.wgsl
// oracle conformance/src/oracle/walk_lhb.rs
//! Rust twin of `walk_lhb`: many paths side by side, a vertex at a time. Between vertices their lookups are sorted by view, so
//! that the lists of one view are read together, while they are in cache.

use crate::kernels::query_lhb::{BATCH, LhbData, look_up};
use crate::path::{Aim, Emitters, Met, Path, add_direct_light, add_sample, start, visit};
use crate::sampler::Sampler;
use crate::scene::SceneData;
use crate::simd::{Isa, Kernel, Width, dispatch, prefetch};
use crate::tracer::WideTracer;
use bytemuck::Zeroable;
use glam::Vec3;
use rayon::prelude::*;
use twinlight_core::kernels::query_lhb::LhbQuery;
use twinlight_core::kernels::rasterize_lhb::LhbElement;
use twinlight_core::kernels::trace_paths::FilmTexel;
use twinlight_core::kernels::walk_lhb::{CONE, GATHER, TRACE_MISSES, WalkLhbParams};
use twinlight_core::math::hash::mix_pair;
use twinlight_core::math::octahedral::nearest_direction;
use twinlight_core::scene::{MATERIAL_OPAQUE, NONE};
use twinlight_core::transport::SceneView;
use twinlight_core::transport::lhb::{lhb_hit, lhb_query, lhb_refined, ray_direction};
use twinlight_core::transport::light::FAR;

mod order;
mod shadow;

use order::Order;
use shadow::Shadows;

/// Paths side by side: hundreds for each of 160 views, and their states fit the shared cache.
const WAVE: usize = 1 << 15;

/// What lookups read.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Lookups<'a> {
    pub(crate) lhb: LhbData<'a>,
    /// Words of the directional map, with rays for directions.
    pub(crate) map: &'a [u32],
}

/// A path between two vertices.
#[derive(Debug, Clone, Copy)]
struct Walker {
    path: Path,
    /// The pixel whose numbers it draws.
    numbers_of: u32,
    sample: u32,
    /// Unit normal of what it leaves, on its side.
    normal: Vec3,
    /// Twice the triangle that it leaves, plus 1 on its front.
    leaves: u32,
    /// Twice the number of its view, plus 1 against it; [`TRACED`] for a ray that is traced, [`ENDED`] for a path that has ended.
    ray: u32,
}

/// A ray that leaves a surface.
#[derive(Debug, Clone, Copy)]
struct Leaving {
    origin: Vec3,
    /// Of unit length.
    direction: Vec3,
    /// As a [`Walker`]'s.
    normal: Vec3,
    leaves: u32,
    ray: u32,
}

/// What is looked up when its turn comes.
trait Leaves {
    fn leaving(&self) -> Leaving;
    /// Where its ray ends; [`FAR`] for one that doesn't.
    fn reach(&self) -> f32;
    fn ray(&self) -> u32;
}

impl Leaves for Walker {
    #[inline(always)]
    fn leaving(&self) -> Leaving {
        let Self { path, normal, leaves, ray, .. } = *self;
        Leaving { origin: path.origin, direction: path.direction, normal, leaves, ray }
    }

    #[inline(always)]
    fn reach(&self) -> f32 {
        FAR
    }

    #[inline(always)]
    fn ray(&self) -> u32 {
        self.ray
    }
}

/// [`Walker::ray`]: from the camera, a mirror or glass.
const TRACED: u32 = u32::MAX - 1;
/// [`Walker::ray`]: no more.
const ENDED: u32 = u32::MAX;

/// Adds the samples of `params`, which has been checked, to `film`.
pub(crate) fn walk_lhb(
    isa: Isa,
    scene: &SceneData,
    lookups: Lookups<'_>,
    params: &WalkLhbParams,
    film: &mut [FilmTexel],
) {
    let begin = params.call.pixel_begin as usize;
    let pixels = &mut film[begin..begin + params.call.pixel_count as usize];
    let samples = params.call.sample_count.max(1) as usize;
    // As many pixels as make a wave with all of their samples: their texels belong to one task.
    let per_task = (WAVE / samples).clamp(1, pixels.len().div_ceil(rayon::current_num_threads()).max(1));
    pixels.par_chunks_mut(per_task).enumerate().for_each(|(task, texels)| {
        let first_pixel = (begin + task * per_task) as u32;
        dispatch(isa, Task { scene, lookups, params, first_pixel, texels });
    });
}

/// The pixels of one task.
struct Task<'a> {
    scene: &'a SceneData,
    lookups: Lookups<'a>,
    params: &'a WalkLhbParams,
    first_pixel: u32,
    texels: &'a mut [FilmTexel],
}

impl Kernel for Task<'_> {
    type Output = ();

    #[inline(always)]
    fn run<W: Width>(self, width: W) {
        let tracer = WideTracer(&self.scene.bvh, width);
        let wave = Wave { tracer, scene: self.scene.view(), lookups: self.lookups, params: self.params };
        let call = &self.params.call;
        let most = (WAVE / self.texels.len()).max(1) as u32;
        let mut sample = call.sample_begin;
        let end = call.sample_begin + call.sample_count;
        while sample < end {
            let count = most.min(end - sample);
            wave.run(self.first_pixel, self.texels, sample..sample + count);
            sample += count;
        }
    }
}

/// Asks for the lines of walkers that will be read: in the order of views they are anywhere.
#[inline(always)]
fn fetch(walkers: &[Walker], indices: &[u32]) {
    for &index in indices {
        let walker = &walkers[index as usize];
        prefetch(&walker.path);
        prefetch(&walker.ray);
    }
}

/// What a wave of paths reads.
struct Wave<'a, W> {
    tracer: WideTracer<'a, W>,
    scene: SceneView<'a>,
    lookups: Lookups<'a>,
    params: &'a WalkLhbParams,
}

impl<W: Width> Wave<'_, W> {
    #[inline(always)]
    fn run(&self, first_pixel: u32, texels: &mut [FilmTexel], samples: std::ops::Range<u32>) {
        let mut walkers = Vec::with_capacity(texels.len() * samples.len());
        for sample in samples {
            for i in 0..texels.len() as u32 {
                walkers.push(self.begin(first_pixel + i, sample));
            }
        }
        let views = self.lookups.lhb.views.len();
        let (mut order, mut shadows) = (Order::new(views), Shadows::new(views));
        let mut met = vec![Met { slot: NONE, u: 0.0, v: 0.0, t: FAR }; walkers.len()];
        loop {
            order.sort(&walkers);
            if order.is_empty() {
                break;
            }
            for &index in order.traced() {
                met[index as usize] = self.traced(&walkers[index as usize]);
            }
            let mut next = order.looked_up().chunks(BATCH).skip(1);
            for batch in order.looked_up().chunks(BATCH) {
                fetch(&walkers, next.next().unwrap_or_default());
                self.look_up(&walkers, batch, &mut met);
            }
            // In the walkers' order, so that rays to lights start from neighbouring pixels.
            let pairs = walkers.iter_mut().zip(&met).enumerate();
            for (index, (walker, met)) in pairs.filter(|(_, (walker, _))| walker.ray != ENDED) {
                self.step(walker, met, index as u32, &mut shadows);
            }
            // [8] shadow: adds the light that waits unless the lookup of its ray finds something before it
            self.add_waiting(&mut shadows, &mut walkers);
        }
        for walkers in walkers.chunks_exact(texels.len()) {
            for (texel, walker) in texels.iter_mut().zip(walkers) {
                add_sample(texel, walker.path.light, &self.params.call);
            }
        }
    }

    fn sampler(&self, pixel: u32, sample: u32) -> Sampler {
        let call = &self.params.call;
        Sampler { kind: call.sampler, stream: mix_pair(call.seed, pixel), sample }
    }

    /// The pixel of the first tile whose numbers a pixel draws from its first vertex on.
    #[inline(always)]
    fn pattern_pixel(&self, pixel: u32) -> u32 {
        let (n, width) = (self.params.lookup.interleave, self.params.call.width);
        ((pixel / width) % n) * width + (pixel % width) % n
    }

    /// Whether a path goes on from a triangle, its first vertex, by the numbers of another pixel.
    #[inline(always)]
    fn is_interleaved(&self, slot: u32) -> bool {
        if self.params.lookup.interleave <= 1 || slot == NONE {
            return false;
        }
        let material = &self.scene.materials[self.scene.triangles[slot as usize].material as usize];
        material.kind == MATERIAL_OPAQUE && material.specular_f90 == 0.0
    }

    // [1] sample: a point of the pixel
    #[inline(always)]
    fn begin(&self, pixel: u32, sample: u32) -> Walker {
        let sampler = self.sampler(pixel, sample);
        let path = start(self.tracer.1, &self.params.call, pixel, &sampler);
        Walker { path, numbers_of: pixel, sample, normal: Vec3::ZERO, leaves: 0, ray: TRACED }
    }

    /// What shines on what the ray meets, and the next ray.
    #[inline(always)]
    fn step(&self, walker: &mut Walker, met: &Met, index: u32, shadows: &mut Shadows) {
        let sampler = self.sampler(walker.numbers_of, walker.sample);
        let base = Sampler::first_pair(walker.path.vertices);
        let mut numbers = sampler.vertex(self.tracer.1, base);
        if walker.path.vertices == 0 && self.is_interleaved(met.slot) {
            walker.numbers_of = self.pattern_pixel(walker.numbers_of);
            let pattern = self.sampler(walker.numbers_of, walker.sample);
            numbers.direction = pattern.vertex(self.tracer.1, base).direction;
        }
        let (scene, call) = (&self.scene, &self.params.call);
        let emitters = Emitters::Denser;
        // [3] direct light
        // [4] scatter
        // [5] roulette
        let aim = (walker.path.vertices == 0).then(|| self.aim(walker.sample)).flatten();
        let shadows_wait = self.shadows_are_looked_up(walker.path.vertices);
        let visited = visit(&mut walker.path, scene, call, met, &sampler, base, &numbers, emitters, aim);
        if let Some(direct) = &visited.direct
            && !(shadows_wait && self.leave(direct, index, met.slot, shadows))
        {
            add_direct_light(&mut walker.path.light, &self.tracer, scene, direct);
        }
        walker.ray = match visited.left {
            None => ENDED,
            Some(left) if !left.is_opaque => TRACED,
            Some(left) => {
                walker.normal = left.surface.geometric_normal;
                walker.leaves = met.slot << 1 | u32::from(left.surface.front);
                self.nearest_ray(walker.normal, walker.path.direction)
            }
        };
    }

    // [2] vertex: what the ray meets, and its emission
    #[inline(always)]
    fn traced(&self, walker: &Walker) -> Met {
        let hit = self.tracer.closest(walker.path.origin, walker.path.direction, 0.0, FAR);
        Met { slot: hit.slot, u: hit.u, v: hit.v, t: hit.t }
    }

    /// Where the first vertex of a path sends it, if directions are gathered.
    #[inline(always)]
    fn aim(&self, sample: u32) -> Option<Aim> {
        let lookup = &self.params.lookup;
        if lookup.flags & GATHER == 0 {
            return None;
        }
        let entry = (lookup.gather_begin + 2 * (sample % lookup.gather_count)) as usize;
        let &[ray, angle] = self.lookups.map.get(entry..)?.first_chunk()?;
        let view = self.lookups.lhb.views.get((ray >> 1) as usize)?;
        let scale = f32::from_bits(angle) * lookup.gather_count as f32;
        Some(Aim { direction: ray_direction(view, ray), scale })
    }

    // [6] direction: the nearest that leaves the surface
    #[inline(always)]
    fn nearest_ray(&self, normal: Vec3, direction: Vec3) -> u32 {
        let (map, lookup) = (self.lookups.map, &self.params.lookup);
        let ray = nearest_direction(map, lookup.map_resolution, direction);
        let leaves = normal.dot(ray_direction(&self.lookups.lhb.views[(ray >> 1) as usize], ray));
        if leaves > 0.0 {
            return ray;
        }
        let lifted = direction + normal * lookup.lift;
        nearest_direction(map, lookup.map_resolution, lifted)
    }

    // [7] lookup: along the line through the start, then through the hit
    #[inline(always)]
    fn find<R: Leaves>(&self, rays: &[R], batch: &[u32]) -> ([LhbQuery; BATCH], [LhbElement; BATCH]) {
        let (lookup, lhb) = (&self.params.lookup, &self.lookups.lhb);
        let mut queries = [LhbQuery::zeroed(); BATCH];
        let mut found = [LhbElement { surface: 0, depth: 0 }; BATCH];
        for (query, &index) in queries.iter_mut().zip(batch) {
            let Leaving { origin, normal, leaves, ray, .. } = rays[index as usize].leaving();
            let view = &lhb.views[(ray >> 1) as usize];
            *query = lhb_query(lookup, view, ray, origin, normal, leaves);
        }
        look_up(self.tracer.1, lhb, &queries[..batch.len()], &mut found);
        if self.follows_rays() {
            for ((query, found), &index) in queries.iter_mut().zip(&found).zip(batch) {
                let Leaving { direction, normal, ray, .. } = rays[index as usize].leaving();
                let view = &lhb.views[(ray >> 1) as usize];
                let reach = rays[index as usize].reach();
                *query = lhb_refined(lookup, view, query, normal, direction, reach, *found);
            }
            look_up(self.tracer.1, lhb, &queries[..batch.len()], &mut found);
        }
        for found in &found[..batch.len()] {
            if let Some(triangle) = self.scene.triangles.get((found.surface >> 1) as usize) {
                prefetch(triangle);
            }
        }
        (queries, found)
    }

    /// Whether lookups follow the ray or its nearest direction alone.
    #[inline(always)]
    fn follows_rays(&self) -> bool {
        self.params.lookup.flags & CONE != 0
    }

    /// What a batch of walkers meets.
    #[inline(always)]
    fn look_up(&self, walkers: &[Walker], batch: &[u32], met: &mut [Met]) {
        let lookup = &self.params.lookup;
        let cone = self.follows_rays();
        let (queries, found) = self.find(walkers, batch);
        for ((query, found), &index) in queries.iter().zip(&found).zip(batch) {
            let Walker { path, ray, .. } = &walkers[index as usize];
            let view = &self.lookups.lhb.views[(ray >> 1) as usize];
            let hit = lhb_hit(lookup, &self.scene, view, query, path.origin, path.direction, *found, cone);
            let is_doubtful = hit.slot == NONE || self.scene.triangles[hit.slot as usize].light != NONE;
            let is_traced = is_doubtful && lookup.flags & TRACE_MISSES != 0;
            met[index as usize] = if is_traced {
                self.traced(&walkers[index as usize])
            } else {
                Met { slot: hit.slot, u: hit.u, v: hit.v, t: hit.t }
            };
        }
    }
}
