//! The wide hierarchy finds, at every vector width, the bits that testing every triangle finds.

use crate::common::{
    Random, assert_hits_are_least, bumps, closed_mesh, scene_of, scene_of_triangles, scene_of_two_parts,
};
use glam::Vec3;
use twinlight_backend_cpu::bvh8::WideBvh;
use twinlight_core::bvh::Bvh;
use twinlight_core::kernels::trace::Ray;
use twinlight_core::math::trig::sin_cos_turns;
use twinlight_core::math::vector::basis;
use twinlight_core::scene::CompiledScene;
use twinlight_core::transport::offset::offset_origin;

fn ray(origin: Vec3, direction: Vec3) -> Ray {
    Ray { origin: origin.into(), t_min: 0.0, direction: direction.into(), t_max: f32::INFINITY }
}

/// Rays from around the scene into it, a third with a short reach.
fn random_rays(count: usize, spread: f32, seed: u64) -> Vec<Ray> {
    let mut random = Random::new(seed);
    let mut next = |i: usize| {
        let mut ray = ray(random.vector() * spread, random.direction());
        if i.is_multiple_of(3) {
            ray.t_max = random.unit() * spread;
            ray.t_min = random.unit() * 0.2 * spread;
        }
        ray
    };
    (0..count).map(&mut next).collect()
}

fn soup(count: usize, size: f32, seed: u64) -> Vec<[Vec3; 3]> {
    let mut random = Random::new(seed);
    let mut next = || {
        let p = random.vector();
        [p, p + random.vector() * size, p + random.vector() * size]
    };
    (0..count).map(|_| next()).collect()
}

/// Rays from outside through every vertex and through the middle of every edge.
fn rays_at_features(scene: &CompiledScene, origin: Vec3) -> Vec<Ray> {
    let mut rays = Vec::new();
    for t in &scene.triangles {
        let [a, b, c]: [Vec3; 3] = [t.p0.into(), t.p1.into(), t.p2.into()];
        for target in [a, b, c, (a + b) * 0.5, (b + c) * 0.5, (c + a) * 0.5] {
            rays.push(ray(origin, target - origin));
        }
    }
    rays
}

#[test]
fn soups_of_every_small_number() {
    for count in [1, 2, 7, 8, 9, 15, 16, 17, 63, 64, 65, 300] {
        let scene = scene_of_triangles(&soup(count, 0.6, count as u64));
        let rays = random_rays(2000, 1.5, 7 + count as u64);
        let hits = assert_hits_are_least("soup", &scene, &rays);
        assert!(hits > 2 && hits < 2000, "{hits} hits among {count} triangles");
    }
}

#[test]
fn soups_of_which_a_part_moves() {
    for count in [2, 3, 4, 9, 30, 300] {
        let scene = scene_of_two_parts(&soup(count, 0.6, count as u64));
        assert_eq!(scene.parts().1.len(), count / 3);
        let hits = assert_hits_are_least("parts", &scene, &random_rays(2000, 1.5, 7 + count as u64));
        assert!(hits > 2 && hits < 2000, "{hits} hits among {count} triangles");
    }
}

#[test]
fn slivers() {
    let mut random = Random::new(3);
    let mut sliver = || {
        let (p, along) = (random.vector(), random.direction());
        [p, p + along, p + along * 0.5 + random.vector() * 1e-6]
    };
    let corners: Vec<[Vec3; 3]> = (0..400).map(|_| sliver()).collect();
    let scene = scene_of_triangles(&corners);
    let mut rays = rays_at_features(&scene, Vec3::new(0.3, 2.0, -0.1));
    rays.extend(random_rays(1000, 1.5, 5));
    let hits = assert_hits_are_least("slivers", &scene, &rays);
    assert!(hits > 100, "{hits}");
}

/// The wall of a pipe of that radius and of length 1 about an axis, in rings of needles.
fn pipe(radius: f32, axis: Vec3, foot: Vec3) -> Vec<[Vec3; 3]> {
    const FACETS: u32 = 24;
    const RINGS: u32 = 6;
    let (tangent, bitangent) = basis(axis);
    let corner = |facet: u32, ring: u32| {
        let (sine, cosine) = sin_cos_turns(facet as f32 / FACETS as f32);
        foot + axis * (ring as f32 / RINGS as f32) + (tangent * cosine + bitangent * sine) * radius
    };
    let quad = |facet: u32, ring: u32| {
        let [a, b, c, d] = [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(f, r)| corner(facet + f, ring + r));
        [[a, b, c], [a, c, d]]
    };
    (0..RINGS).flat_map(|ring| (0..FACETS).flat_map(move |facet| quad(facet, ring))).collect()
}

/// Rays along pipes of needles, from their walls: they pass so close over the facets ahead that rounding of the edge
/// functions is a large part of what is left of them.
#[test]
fn rays_along_pipes_of_needles() {
    let mut random = Random::new(7);
    for radius in [1e-2, 1e-4, 1e-5, 1e-6] {
        let axis = random.direction();
        let scene = scene_of_triangles(&pipe(radius, axis, random.vector()));
        let mut rays = Vec::new();
        for triangle in &scene.triangles {
            let [p0, p1, p2] = [triangle.p0, triangle.p1, triangle.p2].map(Vec3::from);
            let normal = Vec3::from(triangle.normal);
            for k in 0..24 {
                let (u, v) = (random.unit() * 0.5, random.unit() * 0.5);
                let position = (p0 * ((1.0 - u) - v) + p1 * u) + p2 * v;
                let direction = axis + random.vector() * [radius, 1e-1 * radius, 1e-6][k % 3];
                rays.push(ray(offset_origin(position, triangle.offset, normal, direction), direction));
            }
        }
        let hits = assert_hits_are_least(&format!("pipe of {radius}"), &scene, &rays);
        assert!(hits > 50, "{hits}");
    }
}

#[test]
fn coplanar_duplicates_go_to_the_lower_id() {
    let mut corners = soup(60, 0.8, 11);
    let copies: Vec<[Vec3; 3]> = corners.iter().map(|&[a, b, c]| [b, c, a]).collect();
    corners.extend_from_within(..);
    corners.extend(copies);
    let scene = scene_of_triangles(&corners);
    let mut rays = random_rays(3000, 1.2, 13);
    rays.extend(rays_at_features(&scene, Vec3::new(0.1, 0.2, 3.0)));
    let hits = assert_hits_are_least("duplicates", &scene, &rays);
    assert!(hits > 1000, "{hits}");
    let bvh = WideBvh::new(&scene);
    let first = crate::common::closest(twinlight_backend_cpu::simd::detect(), &bvh, &rays);
    for hit in first.iter().filter(|hit| hit.slot != u32::MAX) {
        let id = scene.triangles[hit.slot as usize].id;
        assert!(!(60..120).contains(&id), "{id} has an equal with a lower id");
    }
}

/// T10: slabs whose direction component is ±0, with origins on the planes of boxes.
#[test]
fn t10_axis_parallel_rays() {
    let cell = |x: i32, y: i32, z: i32| Vec3::new(x as f32, y as f32, z as f32) * 0.25;
    let mut corners = Vec::new();
    for i in 0..5 {
        for j in 0..5 {
            for k in 0..3 {
                let p = |a: i32, b: i32| match k {
                    0 => cell(i - 2, a + j - 2, b - 1),
                    1 => cell(a - 1, i - 2, b + j - 2),
                    _ => cell(a + j - 2, b - 1, i - 2),
                };
                corners.extend([[p(0, 0), p(1, 0), p(1, 1)], [p(0, 0), p(1, 1), p(0, 1)]]);
            }
        }
    }
    let scene = scene_of_triangles(&corners);
    let mut rays = Vec::new();
    let steps = [-0.75, -0.5, -0.375, -0.25, -0.0, 0.0, 0.125, 0.25, 0.5, 0.75];
    for a in steps {
        for b in steps {
            for zero in [0.0, -0.0] {
                for one in [1.0_f32, -1.0, 3.0e-3] {
                    rays.push(ray(Vec3::new(a, b, -2.0 * one.signum()), Vec3::new(zero, -zero, one)));
                    rays.push(ray(Vec3::new(a, -2.0 * one.signum(), b), Vec3::new(zero, one, zero)));
                    rays.push(ray(Vec3::new(-2.0 * one.signum(), a, b), Vec3::new(one, zero, -zero)));
                    rays.push(ray(Vec3::new(a, b, 0.25), Vec3::new(one, zero, one)));
                }
            }
        }
    }
    let hits = assert_hits_are_least("axis-parallel", &scene, &rays);
    assert!(hits > rays.len() / 4, "{hits} of {}", rays.len());
}

#[test]
fn edges_and_vertices_of_a_closed_mesh() {
    let (positions, triangles) = closed_mesh(2, bumps);
    let scene = scene_of(positions, triangles);
    for origin in [Vec3::new(0.05, -0.02, 0.01), Vec3::new(3.0, 1.0, -2.0)] {
        let rays = rays_at_features(&scene, origin);
        let hits = assert_hits_are_least("closed mesh", &scene, &rays);
        assert!(hits > rays.len() * 9 / 10, "{hits} of {}", rays.len());
    }
}

#[test]
fn directions_of_any_length_and_origins_far_away() {
    let scene = scene_of_triangles(&soup(200, 0.5, 21));
    let mut random = Random::new(22);
    let mut rays = Vec::new();
    for exponent in -30..30_i32 {
        let scale = f32::from_bits(((127 + exponent) as u32) << 23);
        for _ in 0..40 {
            let target = random.vector() * 0.5;
            let origin = random.direction() * if exponent % 2 == 0 { 2.0 } else { 1e5 };
            rays.push(ray(origin, (target - origin) * scale));
        }
    }
    let hits = assert_hits_are_least("lengths", &scene, &rays);
    assert!(hits > 500, "{hits}");
}

#[test]
fn rays_without_direction_or_reach_miss() {
    let scene = scene_of_triangles(&soup(100, 0.9, 31));
    let inside = Vec3::new(0.1, 0.0, 0.0);
    let mut rays = vec![ray(inside, Vec3::ZERO), ray(inside, Vec3::NAN), ray(Vec3::NAN, Vec3::X)];
    rays.push(Ray { t_max: -1.0, ..ray(inside, Vec3::X) });
    rays.push(Ray { t_max: f32::NAN, ..ray(inside, Vec3::X) });
    rays.push(Ray { t_min: 1e9, ..ray(inside, Vec3::X) });
    assert_eq!(assert_hits_are_least("no reach", &scene, &rays), 0);
}

#[test]
fn an_empty_scene_is_never_met() {
    let scene = scene_of(Vec::new(), Vec::new());
    assert_eq!(assert_hits_are_least("empty", &scene, &random_rays(100, 1.0, 1)), 0);
}

/// Hierarchies that the builder never makes, but a caller's scene may hold: one huge leaf, and a chain.
#[test]
fn leaves_of_any_size_and_chains_of_any_length() {
    let mut scene = scene_of_triangles(&soup(700, 0.3, 41));
    let rays = random_rays(1000, 1.5, 42);
    let whole = scene.bvh.nodes[0];
    let leaf = |first: u32, count: u32| twinlight_core::bvh::BvhNode { first, count, ..whole };
    scene.bvh = Bvh { nodes: vec![leaf(0, 700)], depth: 0 };
    assert!(assert_hits_are_least("one leaf", &scene, &rays) > 100);
    let mut nodes = vec![leaf(1, 0)];
    for i in 0..699 {
        let rest = if i == 698 { leaf(699, 1) } else { leaf(2 * i + 3, 0) };
        nodes.extend([leaf(i, 1), rest]);
    }
    scene.bvh = Bvh { nodes, depth: 699 };
    assert!(assert_hits_are_least("chain", &scene, &rays) > 100);
}
