//! Meshes, rays and the definition of a hit, for the tests of traversal.

use glam::Vec3;
use twinlight_backend_cpu::bvh8::{NO_SLOT, SlotHit, WideBvh};
use twinlight_backend_cpu::simd::{Isa, Kernel, Width, dispatch};
use twinlight_core::kernels::trace::Ray;
use twinlight_core::scene::{CompiledScene, Limits, Material, Mesh, Scene, compile};
use twinlight_core::transport::intersect::{ray_frame, triangle};

/// Numbers in [0, 1), the same on every machine (PCG-XSH-RR, O'Neill 2014).
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Random(seed.wrapping_mul(2) + 1)
    }

    pub fn bits(&mut self) -> u32 {
        let old = self.0;
        self.0 = old.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((((old >> 18) ^ old) >> 27) as u32).rotate_right((old >> 59) as u32)
    }

    pub fn unit(&mut self) -> f32 {
        (self.bits() >> 8) as f32 / 16_777_216.0
    }

    pub fn vector(&mut self) -> Vec3 {
        Vec3::new(self.unit(), self.unit(), self.unit()) * 2.0 - 1.0
    }

    /// Uniform in the unit ball without its middle.
    pub fn direction(&mut self) -> Vec3 {
        loop {
            let v = self.vector();
            if v.dot(v) < 1.0 && v.dot(v) > 0.01 {
                return v;
            }
        }
    }
}

pub fn scene_of(positions: Vec<[f32; 3]>, triangles: Vec<[u32; 3]>) -> CompiledScene {
    let mut scene = Scene::default();
    scene.add_material(Material::default());
    let material_ids = vec![0; triangles.len()];
    scene.add_mesh(Mesh { positions, triangles, material_ids, ..Mesh::default() });
    compile(&scene, &Limits::default()).expect("the mesh is valid")
}

/// A scene of separate triangles.
pub fn scene_of_triangles(corners: &[[Vec3; 3]]) -> CompiledScene {
    let positions = corners.iter().flatten().map(Vec3::to_array).collect();
    let triangles = (0..corners.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    scene_of(positions, triangles)
}

/// The same with every third triangle in an instance that moves.
pub fn scene_of_two_parts(corners: &[[Vec3; 3]]) -> CompiledScene {
    let mut scene = Scene::default();
    scene.add_material(Material::default());
    for moves in [true, false] {
        let part = corners.iter().enumerate().filter(|(i, _)| (i % 3 == 2) == moves);
        let positions: Vec<[f32; 3]> = part.flat_map(|(_, t)| t.map(|p| p.to_array())).collect();
        let triangles = (0..positions.len() as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        scene.add_mesh(Mesh::new("part", positions, triangles, 0));
    }
    scene.instances[0].moves = true;
    compile(&scene, &Limits::default()).expect("the mesh is valid")
}

/// A closed sphere-like mesh: an icosahedron, subdivided, with every vertex moved to `radius(direction)`.
pub fn closed_mesh(subdivisions: u32, radius: impl Fn(Vec3) -> f32) -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
    let phi = 1.618_034;
    let mut points: Vec<Vec3> = Vec::new();
    for (a, b) in [(1.0, phi), (1.0, -phi), (-1.0, phi), (-1.0, -phi)] {
        points.extend([Vec3::new(0.0, a, b), Vec3::new(a, b, 0.0), Vec3::new(b, 0.0, a)]);
    }
    // Three vertices are a face when they are all neighbours, 2 apart.
    let near = |a: usize, b: usize| (points[a] - points[b]).length() < 2.5;
    let mut faces: Vec<[u32; 3]> = Vec::new();
    for a in 0..12 {
        for b in a + 1..12 {
            for c in b + 1..12 {
                if near(a, b) && near(b, c) && near(a, c) {
                    faces.push([a as u32, b as u32, c as u32]);
                }
            }
        }
    }
    for _ in 0..subdivisions {
        let mut middles = std::collections::BTreeMap::new();
        let mut middle = |a: u32, b: u32| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                points.push((points[a as usize] + points[b as usize]) * 0.5);
                (points.len() - 1) as u32
            })
        };
        let split = |&[a, b, c]: &[u32; 3]| {
            let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
            [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        };
        faces = faces.iter().flat_map(split).collect();
    }
    let position = |p: &Vec3| {
        let direction = *p / p.length();
        (direction * radius(direction)).to_array()
    };
    (points.iter().map(position).collect(), faces)
}

/// A bumpy radius around 1.
pub fn bumps(d: Vec3) -> f32 {
    let wave = |x: f32| x - 4.0 * x * x * x / 3.0;
    1.0 + 0.2 * wave(d.x * 3.7 - d.y).clamp(-1.0, 1.0) + 0.1 * wave(d.y * 2.9 + d.z * d.x).clamp(-1.0, 1.0)
}

struct Closest<'a>(&'a WideBvh, &'a [Ray]);

impl Kernel for Closest<'_> {
    type Output = Vec<SlotHit>;
    #[inline(always)]
    fn run<W: Width>(self, width: W) -> Vec<SlotHit> {
        let mut hits = Vec::new();
        for r in self.1 {
            hits.push(self.0.closest(width, r.origin.into(), r.direction.into(), r.t_min, r.t_max));
        }
        hits
    }
}

struct Occluded<'a>(&'a WideBvh, &'a [Ray]);

impl Kernel for Occluded<'_> {
    type Output = Vec<bool>;
    #[inline(always)]
    fn run<W: Width>(self, width: W) -> Vec<bool> {
        let mut hits = Vec::new();
        for r in self.1 {
            hits.push(self.0.occluded(width, r.origin.into(), r.direction.into(), r.t_min, r.t_max));
        }
        hits
    }
}

pub fn closest(isa: Isa, bvh: &WideBvh, rays: &[Ray]) -> Vec<SlotHit> {
    dispatch(isa, Closest(bvh, rays))
}

pub fn occluded(isa: Isa, bvh: &WideBvh, rays: &[Ray]) -> Vec<bool> {
    dispatch(isa, Occluded(bvh, rays))
}

/// What the contract says: the least (t, id) of all triangles, tested one by one.
pub fn least_hit(scene: &CompiledScene, ray: &Ray) -> SlotHit {
    let frame = ray_frame(ray.origin.into(), ray.direction.into());
    let mut best = (SlotHit { t: ray.t_max, u: 0.0, v: 0.0, slot: NO_SLOT }, u32::MAX);
    for (slot, t) in scene.triangles.iter().enumerate() {
        let met = triangle(&frame, t, ray.t_min, ray.t_max);
        if let Some(hit) = met
            && (hit.t, t.id) < (best.0.t, best.1)
        {
            best = (SlotHit { t: hit.t, u: hit.u, v: hit.v, slot: slot as u32 }, t.id);
        }
    }
    best.0
}

fn bits(hit: &SlotHit) -> [u32; 4] {
    [hit.t.to_bits(), hit.u.to_bits(), hit.v.to_bits(), hit.slot]
}

/// Every instruction set of this machine gives the bits of [`least_hit`]. Returns how many rays hit something.
pub fn assert_hits_are_least(what: &str, scene: &CompiledScene, rays: &[Ray]) -> usize {
    let bvh = WideBvh::new(scene);
    let expected: Vec<SlotHit> = rays.iter().map(|ray| least_hit(scene, ray)).collect();
    for isa in Isa::ALL.into_iter().filter(|isa| isa.is_available()) {
        let (hits, shadows) = (closest(isa, &bvh, rays), occluded(isa, &bvh, rays));
        for (i, ray) in rays.iter().enumerate() {
            let (found, wanted) = (&hits[i], &expected[i]);
            assert_eq!(bits(found), bits(wanted), "{what}, {isa:?}, {ray:?}: {found:?}, not {wanted:?}");
            assert_eq!(shadows[i], wanted.slot != NO_SLOT, "{what}, {isa:?}, any hit of {ray:?}");
        }
    }
    expected.iter().filter(|hit| hit.slot != NO_SLOT).count()
}
