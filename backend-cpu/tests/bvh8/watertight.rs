//! No ray leaves a closed mesh through an edge or a vertex.

use crate::common::{Random, bumps, closed_mesh, closest, scene_of};
use glam::Vec3;
use twinlight_backend_cpu::bvh8::{NO_SLOT, WideBvh};
use twinlight_backend_cpu::simd::detect;
use twinlight_core::kernels::trace::Ray;
use twinlight_core::scene::CompiledScene;

/// Rays from near the middle through every vertex and through random points of every edge.
fn rays_at_features(scene: &CompiledScene, scale: f32, random: &mut Random) -> Vec<Ray> {
    let mut rays = Vec::new();
    for t in &scene.triangles {
        let [a, b, c]: [Vec3; 3] = [t.p0.into(), t.p1.into(), t.p2.into()];
        for (from, to) in [(a, b), (b, c), (c, a)] {
            let origin = random.vector() * (0.3 * scale);
            for target in [from, from + (to - from) * random.unit(), (from + to) * 0.5] {
                let direction = target - origin;
                rays.push(Ray {
                    origin: origin.into(),
                    t_min: 0.0,
                    direction: direction.into(),
                    t_max: f32::INFINITY,
                });
            }
        }
    }
    rays
}

#[test]
fn no_ray_leaves_a_closed_mesh() {
    let mut random = Random::new(99);
    for scale in [1e-3_f32, 1.0, 37.5, 1e3, 1e6] {
        for smooth in [true, false] {
            let radius = |d: Vec3| if smooth { scale } else { bumps(d) * scale };
            let (positions, triangles) = closed_mesh(5, radius);
            let scene = scene_of(positions, triangles);
            let bvh = WideBvh::new(&scene);
            let rays = rays_at_features(&scene, scale, &mut random);
            assert!(rays.len() > 100_000, "{}", rays.len());
            let lost = closest(detect(), &bvh, &rays).iter().filter(|hit| hit.slot == NO_SLOT).count();
            assert_eq!(lost, 0, "of {} rays at scale {scale}, smooth {smooth}", rays.len());
        }
    }
}
