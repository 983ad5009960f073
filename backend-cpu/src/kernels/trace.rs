// kernel family: trace
// contract core/src/kernels/trace.rs
// cpu backend-cpu/src/kernels/trace.rs
// gpu backend-gpu/src/kernels/trace.wgsl
// oracle conformance/src/oracle/trace.rs
//! `trace`: one ray at a time down the binary hierarchy.

use crate::parallel::fill;
use crate::scene::SceneData;
use crate::tracer::{SlotHit, Tracer};
use glam::Vec3;
use twinlight_core::bvh::MAX_DEPTH;
use twinlight_core::kernels::trace::{Hit, NO_HIT, Ray};
use twinlight_core::transport::intersect::{RayFrame, larger, ray_frame, slab, triangle};

/// Nodes that can wait on the stack: one sibling per level.
const STACK: usize = MAX_DEPTH as usize + 1;

/// The closest hit of every ray.
pub(crate) fn trace_closest(scene: &SceneData, rays: &[Ray], hits: &mut [Hit]) {
    fill(hits, |i| closest(scene, &rays[i]));
}

/// Whether anything lies on each ray.
pub(crate) fn trace_any(scene: &SceneData, rays: &[Ray], occluded: &mut [u32]) {
    fill(occluded, |i| u32::from(any(scene, &rays[i])));
}

/// The least (t, id) on a ray.
pub(crate) fn closest(scene: &SceneData, ray: &Ray) -> Hit {
    let mut best = Hit { t: ray.t_max, triangle: NO_HIT, u: 0.0, v: 0.0 };
    let frame = ray_frame(Vec3::from(ray.origin), Vec3::from(ray.direction));
    visit_leaves(scene, &frame, ray.t_max, |slots| {
        for t in &scene.triangles[slots] {
            let [p0, p1, p2] = [t.p0, t.p1, t.p2].map(Vec3::from);
            if let Some(met) = triangle(&frame, p0, p1, p2, ray.t_min, best.t)
                && (met.t < best.t || t.id < best.triangle)
            {
                best = Hit { t: met.t, triangle: t.id, u: met.u, v: met.v };
            }
        }
        Some(best.t)
    });
    best
}

/// The binary hierarchy as the path tracer uses it.
pub(crate) struct BinaryTracer<'a>(pub(crate) &'a SceneData);

impl Tracer for BinaryTracer<'_> {
    fn closest(&self, origin: Vec3, direction: Vec3, t_min: f32, t_max: f32) -> SlotHit {
        let mut best = SlotHit::miss(t_max);
        let mut best_id = NO_HIT;
        let frame = ray_frame(origin, direction);
        visit_leaves(self.0, &frame, t_max, |slots| {
            for slot in slots {
                let t = &self.0.triangles[slot];
                let [p0, p1, p2] = [t.p0, t.p1, t.p2].map(Vec3::from);
                if let Some(met) = triangle(&frame, p0, p1, p2, t_min, best.t)
                    && (met.t < best.t || t.id < best_id)
                {
                    best = SlotHit { t: met.t, u: met.u, v: met.v, slot: slot as u32 };
                    best_id = t.id;
                }
            }
            Some(best.t)
        });
        best
    }

    fn occluded(&self, origin: Vec3, direction: Vec3, t_min: f32, t_max: f32) -> bool {
        any(self.0, &Ray { origin: origin.to_array(), t_min, direction: direction.to_array(), t_max })
    }
}

/// Whether a ray meets any triangle.
pub(crate) fn any(scene: &SceneData, ray: &Ray) -> bool {
    let frame = ray_frame(Vec3::from(ray.origin), Vec3::from(ray.direction));
    let mut found = false;
    visit_leaves(scene, &frame, ray.t_max, |slots| {
        found = scene.triangles[slots].iter().any(|t| {
            let [p0, p1, p2] = [t.p0, t.p1, t.p2].map(Vec3::from);
            triangle(&frame, p0, p1, p2, ray.t_min, ray.t_max).is_some()
        });
        if found { None } else { Some(ray.t_max) }
    });
    found
}

/// Calls `leaf` with the slots of every leaf that the ray meets before `reach`, nearer siblings first. `leaf` returns
/// the new reach, or `None` to stop.
fn visit_leaves(
    scene: &SceneData,
    frame: &RayFrame,
    mut reach: f32,
    mut leaf: impl FnMut(std::ops::Range<usize>) -> Option<f32>,
) {
    let nodes = &scene.bvh.nodes;
    let entry = |index: u32| {
        let node = &nodes[index as usize];
        let (near, far) = slab(frame, Vec3::from(node.min), Vec3::from(node.max));
        let near = larger(near, 0.0);
        if near <= far { near } else { f32::INFINITY }
    };
    if nodes.is_empty() {
        return;
    }
    let mut stack = [(0.0_f32, 0_u32); STACK];
    let mut waiting = 1;
    stack[0] = (entry(0), 0);
    while waiting > 0 {
        waiting -= 1;
        let (near, index) = stack[waiting];
        // An entry equal to the reach is visited: a lower id may lie at the same distance.
        if near == f32::INFINITY || near > reach {
            continue;
        }
        let node = &nodes[index as usize];
        if node.count > 0 {
            match leaf(node.first as usize..(node.first + node.count) as usize) {
                Some(shorter) => reach = shorter,
                None => return,
            }
            continue;
        }
        let (a, b) = (node.first, node.first + 1);
        let (near_a, near_b) = (entry(a), entry(b));
        let order = if near_a <= near_b { [(near_b, b), (near_a, a)] } else { [(near_a, a), (near_b, b)] };
        stack[waiting..waiting + 2].copy_from_slice(&order);
        waiting += 2;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::CpuScene;
    use twinlight_core::scene::{Limits, Material, Mesh, Scene, compile};

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
            let [p0, p1, p2] = [t.p0, t.p1, t.p2].map(Vec3::from);
            if let Some(met) = triangle(&frame, p0, p1, p2, ray.t_min, ray.t_max)
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
        trace_closest(scene.data(), &rays, &mut hits);
        trace_any(scene.data(), &rays, &mut occluded);
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
        assert_eq!(closest(scene.data(), &ray), Hit { t: 4.0, triangle: NO_HIT, u: 0.0, v: 0.0 });
        assert!(!any(scene.data(), &ray));
    }
}
