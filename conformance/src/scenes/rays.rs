//! Rays aimed where traversals and triangle tests break.

use glam::Vec3;
use twinlight_core::kernels::trace::Ray;
use twinlight_core::scene::{CompiledScene, Triangle};
use twinlight_fixtures::random::Random;

/// Makes rays for one scene.
#[derive(Debug)]
pub struct Rays<'a> {
    scene: &'a CompiledScene,
    random: Random,
    low: Vec3,
    size: Vec3,
}

/// From one point through another; the second lies at t = 1.
pub fn between(from: Vec3, to: Vec3) -> Ray {
    Ray { origin: from.to_array(), t_min: 0.0, direction: (to - from).to_array(), t_max: f32::INFINITY }
}

impl<'a> Rays<'a> {
    /// Rays around the bounds of `scene`.
    pub fn new(scene: &'a CompiledScene, seed: u64) -> Self {
        let (low, high) = (Vec3::from(scene.bounds.0), Vec3::from(scene.bounds.1));
        let size = (high - low).max(Vec3::splat(1e-3 * (high - low).max_element().max(1e-3)));
        Self { scene, random: Random::new(seed), low, size }
    }

    fn unit(&mut self) -> f32 {
        self.random.unit() as f32
    }

    fn around(&mut self) -> Vec3 {
        let p = Vec3::new(self.unit(), self.unit(), self.unit());
        self.low + self.size * (p * 1.5 - 0.25)
    }

    /// From anywhere to anywhere.
    pub fn incoherent(&mut self) -> Ray {
        let (from, to) = (self.around(), self.around());
        between(from, to)
    }

    fn any_triangle(&mut self) -> Option<Triangle> {
        let index = self.random.index(self.scene.triangles.len());
        self.scene.triangles.get(index).copied()
    }

    /// Straight at a corner, or at a point of an edge.
    pub fn at_edge(&mut self) -> Ray {
        let from = self.around();
        let Some(t) = self.any_triangle() else { return self.incoherent() };
        let corners = [t.p0, t.p1, t.p2].map(Vec3::from);
        let k = self.random.index(3);
        let share = [0.0, 0.5, self.unit()][self.random.index(3)];
        between(from, corners[k] + (corners[(k + 1) % 3] - corners[k]) * share)
    }

    /// Along an axis, either way, with zeros of both signs; every second time straight at a corner.
    pub fn along_axis(&mut self) -> Ray {
        let mut from = self.around();
        if let Some(t) = self.any_triangle().filter(|_| self.random.index(2) == 0) {
            from = Vec3::from(t.p0);
        }
        let axis = self.random.index(3);
        let mut direction = [0, 1, 2].map(|_| if self.random.index(2) == 0 { 0.0 } else { -0.0_f32 });
        direction[axis] = if self.random.index(2) == 0 { 1.0 } else { -1.0 };
        let span = self.size[axis] * 2.0;
        from[axis] = if direction[axis] > 0.0 { self.low[axis] - span } else { self.low[axis] + span };
        Ray { origin: from.to_array(), t_min: 0.0, direction, t_max: f32::INFINITY }
    }

    /// Off a triangle, as a path leaves a surface, with limits that may cut the hit off.
    pub fn from_surface(&mut self) -> Ray {
        let to = self.around();
        let Some(t) = self.any_triangle() else { return self.incoherent() };
        let (p0, p1, p2) = (Vec3::from(t.p0), Vec3::from(t.p1), Vec3::from(t.p2));
        let (mut u, mut v) = (self.unit(), self.unit());
        if u + v > 1.0 {
            (u, v) = (1.0 - u, 1.0 - v);
        }
        let ray = between(p0 + (p1 - p0) * u + (p2 - p0) * v, to);
        let t_min = [0.0, 0.0, 0.25][self.random.index(3)];
        Ray { t_min, t_max: [1.0, 0.5, f32::INFINITY][self.random.index(3)], ..ray }
    }

    /// `count` of all kinds in turn.
    pub fn mixed(&mut self, count: usize) -> Vec<Ray> {
        (0..count)
            .map(|i| match i % 4 {
                0 => self.incoherent(),
                1 => self.at_edge(),
                2 => self.along_axis(),
                _ => self.from_surface(),
            })
            .collect()
    }
}
