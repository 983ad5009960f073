// kernel family: trace
// contract core/src/kernels/trace.rs
// cpu backend-cpu/src/kernels/trace.rs
// gpu backend-gpu/src/kernels/trace.wgsl
// oracle conformance/src/oracle/trace.rs
//! `trace`: one ray at a time down the eight-wide hierarchy ([`crate::bvh8`]), eight boxes or triangles at once.

use crate::bvh8::NO_SLOT;
use crate::parallel::{RAYS, fill_chunks};
use crate::scene::SceneData;
use crate::simd::{Isa, Kernel, Width};
use twinlight_core::kernels::trace::{Hit, NO_HIT, Ray};

/// The closest hit of every ray.
pub(crate) fn trace_closest(isa: Isa, scene: &SceneData, rays: &[Ray], hits: &mut [Hit]) {
    fill_chunks(isa, RAYS, hits, |first, hits| Closest { scene, rays: &rays[first..], hits });
}

/// Whether anything lies on each ray.
pub(crate) fn trace_any(isa: Isa, scene: &SceneData, rays: &[Ray], occluded: &mut [u32]) {
    fill_chunks(isa, RAYS, occluded, |first, occluded| Any { scene, rays: &rays[first..], occluded });
}

struct Closest<'a> {
    scene: &'a SceneData,
    rays: &'a [Ray],
    hits: &'a mut [Hit],
}

impl Kernel for Closest<'_> {
    type Output = ();

    #[inline(always)]
    fn run<W: Width>(self, width: W) {
        for (ray, hit) in self.rays.iter().zip(self.hits) {
            let (origin, direction) = (ray.origin.into(), ray.direction.into());
            let met = self.scene.bvh.closest(width, origin, direction, ray.t_min, ray.t_max);
            let triangle =
                if met.slot == NO_SLOT { NO_HIT } else { self.scene.triangles[met.slot as usize].id };
            *hit = Hit { t: met.t, triangle, u: met.u, v: met.v };
        }
    }
}

struct Any<'a> {
    scene: &'a SceneData,
    rays: &'a [Ray],
    occluded: &'a mut [u32],
}

impl Kernel for Any<'_> {
    type Output = ();

    #[inline(always)]
    fn run<W: Width>(self, width: W) {
        for (ray, occluded) in self.rays.iter().zip(self.occluded) {
            let (origin, direction) = (ray.origin.into(), ray.direction.into());
            *occluded = u32::from(self.scene.bvh.occluded(width, origin, direction, ray.t_min, ray.t_max));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::CpuScene;
    use crate::simd::detect;
    use glam::Vec3;
    use twinlight_core::scene::{Limits, Material, Mesh, Scene, compile};
    use twinlight_core::transport::intersect::{ray_frame, triangle};

    /// Deterministic numbers in [-1, 1).
    fn number(i: u32) -> f32 {
        let mut x = i.wrapping_mul(0x9E37_79B9) ^ 0x85EB_CA6B;
        x = (x ^ (x >> 16)).wrapping_mul(0x7FEB_352D);
        x = (x ^ (x >> 15)).wrapping_mul(0x846C_A68B);
        ((x ^ (x >> 16)) >> 8) as f32 / 8_388_608.0 - 1.0
    }

    fn vector(i: u32) -> [f32; 3] {
        [number(3 * i), number(3 * i + 1), number(3 * i + 2)]
    }

    /// A soup in which every triangle occurs twice, so that ties occur on every hit.
    fn soup(triangles: u32) -> CpuScene {
        let mut scene = Scene::default();
        scene.add_material(Material::default());
        scene.add_mesh(Mesh {
            positions: (0..triangles * 3).map(vector).collect(),
            triangles: (0..triangles * 2).map(|i| [0, 1, 2].map(|k| i % triangles * 3 + k)).collect(),
            material_ids: vec![0; triangles as usize * 2],
            ..Mesh::default()
        });
        CpuScene::new(&compile(&scene, &Limits::default()).unwrap()).unwrap()
    }

    fn every_triangle(scene: &SceneData, ray: &Ray) -> Hit {
        let frame = ray_frame(Vec3::from(ray.origin), Vec3::from(ray.direction));
        let mut best = Hit { t: ray.t_max, triangle: NO_HIT, u: 0.0, v: 0.0 };
        for t in &scene.triangles {
            if let Some(met) = triangle(&frame, t, ray.t_min, ray.t_max)
                && (met.t, t.id) < (best.t, best.triangle)
            {
                best = Hit { t: met.t, triangle: t.id, u: met.u, v: met.v };
            }
        }
        best
    }

    #[test]
    fn hits_are_those_of_testing_every_triangle() {
        let scene = soup(200);
        let ray = |i: u32| Ray {
            origin: vector(90_000 + 2 * i).map(|x| 1.5 * x),
            t_min: 0.0,
            direction: vector(90_001 + 2 * i),
            t_max: if i.is_multiple_of(3) { f32::INFINITY } else { number(i).abs() },
        };
        let rays: Vec<Ray> = (0..3000).map(ray).collect();
        let (mut hits, mut occluded) = (vec![bytemuck::Zeroable::zeroed(); rays.len()], vec![7; rays.len()]);
        trace_closest(detect(), scene.data(), &rays, &mut hits);
        trace_any(detect(), scene.data(), &rays, &mut occluded);
        let mut met = 0;
        for ((ray, hit), occluded) in rays.iter().zip(&hits).zip(occluded) {
            assert_eq!(*hit, every_triangle(scene.data(), ray));
            assert_eq!(occluded, u32::from(hit.triangle != NO_HIT));
            met += occluded;
        }
        assert!(met > 500 && met < 2500, "{met} of 3000 rays hit");
    }

    #[test]
    fn an_empty_scene_is_never_hit() {
        let scene = CpuScene::new(&compile(&Scene::default(), &Limits::default()).unwrap()).unwrap();
        let ray = Ray { origin: [0.0; 3], t_min: 0.0, direction: [0.0, 0.0, 1.0], t_max: 4.0 };
        let (mut hits, mut occluded) = ([bytemuck::Zeroable::zeroed()], [7]);
        trace_closest(detect(), scene.data(), &[ray], &mut hits);
        trace_any(detect(), scene.data(), &[ray], &mut occluded);
        assert_eq!((hits[0], occluded[0]), (Hit { t: 4.0, triangle: NO_HIT, u: 0.0, v: 0.0 }, 0));
    }
}
