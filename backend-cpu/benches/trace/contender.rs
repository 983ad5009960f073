//! Who traces: the wide hierarchy at every vector width, and obvhs.

use glam::Vec3A;
use obvhs::BvhBuildParams;
use obvhs::cwbvh::CwBvh;
use obvhs::cwbvh::builder::build_cwbvh_from_tris;
use obvhs::ray::RayHit;
use obvhs::rt_triangle::RtTriangle;
use obvhs::triangle::Triangle;
use rayon::prelude::*;
use std::time::Duration;
use twinlight_backend_cpu::bvh8::{NO_SLOT, WideBvh};
use twinlight_backend_cpu::simd::{Isa, Kernel, Width, dispatch};
use twinlight_core::kernels::trace::Ray;
use twinlight_core::scene::CompiledScene;

/// Rays per task.
const TASK: usize = 512;

/// Counts the rays of a slice that hit.
type Trace<'a> = Box<dyn Fn(&[Ray]) -> usize + Sync + 'a>;

pub struct Contender<'a> {
    pub name: &'static str,
    pub closest: Trace<'a>,
    pub any: Trace<'a>,
}

pub fn contenders<'a>(scene: &CompiledScene, wide: &'a WideBvh) -> Vec<Contender<'a>> {
    let names =
        [(Isa::Avx2, "twinlight avx2"), (Isa::Sse2, "twinlight sse2"), (Isa::Portable, "twinlight portable")];
    let mut list: Vec<Contender<'a>> = names
        .into_iter()
        .filter(|(isa, _)| isa.is_available())
        .map(|(isa, name)| Contender {
            name,
            closest: in_tasks(move |rays| dispatch(isa, Closest(wide, rays))),
            any: in_tasks(move |rays| dispatch(isa, Any(wide, rays))),
        })
        .collect();
    let native = cfg!(target_feature = "avx2");
    let name = if native { "obvhs cwbvh, compiled avx2" } else { "obvhs cwbvh, compiled sse2" };
    let (closest, any) = (Compressed::new(scene), Compressed::new(scene));
    list.push(Contender {
        name,
        closest: in_tasks(move |rays| rays.iter().filter(|ray| closest.closest(ray)).count()),
        any: in_tasks(move |rays| rays.iter().filter(|ray| any.any(ray)).count()),
    });
    list
}

fn in_tasks<'a>(count: impl Fn(&[Ray]) -> usize + Sync + 'a) -> Trace<'a> {
    Box::new(move |rays| rays.par_chunks(TASK).map(&count).sum())
}

struct Closest<'a>(&'a WideBvh, &'a [Ray]);

impl Kernel for Closest<'_> {
    type Output = usize;
    #[inline(always)]
    fn run<W: Width>(self, width: W) -> usize {
        let mut hits = 0;
        for r in self.1 {
            let hit = self.0.closest(width, r.origin.into(), r.direction.into(), r.t_min, r.t_max);
            hits += usize::from(hit.slot != NO_SLOT);
        }
        hits
    }
}

struct Any<'a>(&'a WideBvh, &'a [Ray]);

impl Kernel for Any<'_> {
    type Output = usize;
    #[inline(always)]
    fn run<W: Width>(self, width: W) -> usize {
        let mut hits = 0;
        for r in self.1 {
            let (origin, direction) = (r.origin.into(), r.direction.into());
            hits += usize::from(self.0.occluded(width, origin, direction, r.t_min, r.t_max));
        }
        hits
    }
}

/// obvhs's hierarchy, built with the parameters of `twinlight_core::bvh`, and its triangles in its order.
struct Compressed {
    bvh: CwBvh,
    triangles: Vec<RtTriangle>,
}

impl Compressed {
    fn new(scene: &CompiledScene) -> Self {
        let corner = |p: [f32; 3]| Vec3A::from(p);
        let triangles: Vec<Triangle> = scene
            .triangles
            .iter()
            .map(|t| Triangle { v0: corner(t.p0), v1: corner(t.p1), v2: corner(t.p2) })
            .collect();
        let bvh = build_cwbvh_from_tris(&triangles, BvhBuildParams::fast_build(), &mut Duration::default());
        let in_order =
            bvh.primitive_indices.iter().map(|&i| RtTriangle::from(&triangles[i as usize])).collect();
        Compressed { bvh, triangles: in_order }
    }

    fn ray(ray: &Ray) -> obvhs::ray::Ray {
        obvhs::ray::Ray::new(Vec3A::from(ray.origin), Vec3A::from(ray.direction), ray.t_min, ray.t_max)
    }

    #[inline(always)]
    fn closest(&self, ray: &Ray) -> bool {
        let mut hit = RayHit::none();
        self.bvh.ray_traverse(Self::ray(ray), &mut hit, |ray, id| self.triangles[id].intersect(ray))
    }

    #[inline(always)]
    fn any(&self, ray: &Ray) -> bool {
        !self.bvh.ray_traverse_miss(Self::ray(ray), |ray, id| self.triangles[id].intersect(ray))
    }
}
