//! Cones over a hemisphere, and sums of what comes through them.

use super::{Cones, Lit};
use glam::Vec3;
use twinlight_core::Backend;
use twinlight_core::kernels::sum_voxels::VoxelSums;
use twinlight_core::kernels::trace_cones::{Cone, ConeLight, SIXTY_DEGREES};
use twinlight_core::math::morton::morton_voxel;
use twinlight_core::math::trig::sin_cos_turns;
use twinlight_core::math::vector::{basis, normalized, to_world};
use twinlight_core::transport::PI;

/// How far above its surface a cone's apex is, voxels: where it is curved, its neighbours' voxels rise above its plane.
const LIFT: f32 = 1.0;
/// Where cones begin, voxels: the first sample is as wide.
const START: f32 = 1.0;

/// A cone of a hemisphere around +z.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Lobe {
    direction: Vec3,
    sine: f32,
    /// Its share of irradiance: the sum over the hemisphere is π.
    weight: f32,
}

/// The cones of a hemisphere, and the flags of the kernel that they need.
pub(super) fn hemisphere(cones: Cones) -> (Vec<Lobe>, u32) {
    match cones {
        Cones::Six => (six(), SIXTY_DEGREES),
        Cones::Generic(count) => (generic(count), 0),
    }
}

/// One along the axis with π/4, five at 60° from it with 3π/20 each.
fn six() -> Vec<Lobe> {
    let lobe = |direction, weight| Lobe { direction, sine: 0.5, weight };
    let mut lobes = vec![lobe(Vec3::Z, PI * 0.25)];
    for i in 0..5_u8 {
        let (sine, cosine) = sin_cos_turns(f32::from(i) * 0.2);
        let across = 0.866_025_4;
        lobes.push(lobe(Vec3::new(across * cosine, across * sine, 0.5), PI * 0.15));
    }
    lobes
}

/// `count` directions along a spiral, even in projected area, so that each has the same weight; together as wide as the hemisphere: cones
/// of the solid angle 2π/`count`.
fn generic(count: u32) -> Vec<Lobe> {
    let n = count as f32;
    // The solid angle of a cone of half-angle a is 2π(1 − cos a).
    let cosine = 1.0 - 1.0 / n;
    let sine = (1.0 - cosine * cosine).sqrt();
    let lobe = |i: u32| {
        let squared = (i as f32 + 0.5) / n;
        // 1/φ of a turn.
        let turns = i as f32 * 0.618_034;
        let (s, c) = sin_cos_turns(turns - turns.floor());
        let radius = squared.sqrt();
        Lobe { direction: Vec3::new(radius * c, radius * s, (1.0 - squared).sqrt()), sine, weight: PI / n }
    };
    (0..count).map(lobe).collect()
}

/// Cones of many surfaces: of each as many, one after the other.
pub(super) struct Bundle {
    pub(super) cones: Vec<Cone>,
    lobes: Vec<Lobe>,
}

impl Bundle {
    /// Of no surface yet.
    pub(super) fn new(lobes: Vec<Lobe>, surfaces: usize) -> Self {
        Self { cones: Vec::with_capacity(surfaces * lobes.len()), lobes }
    }

    /// Adds the cones of a surface at `position` with the unit normal `normal`, in voxels `voxel` wide.
    pub(super) fn push(&mut self, position: Vec3, normal: Vec3, voxel: f32) {
        let (t, b) = basis(normal);
        let origin = (position + normal * (LIFT * voxel)).to_array();
        let cone = |lobe: &Lobe| Cone {
            origin,
            sine: lobe.sine,
            direction: to_world(t, b, normal, lobe.direction).to_array(),
            start: START * voxel,
            normal: normal.to_array(),
            padding: 0,
        };
        self.cones.extend(self.lobes.iter().map(cone));
    }

    /// The irradiance of each surface.
    pub(super) fn sums(&self, light: &[ConeLight]) -> Vec<[f32; 3]> {
        let sum = |light: &[ConeLight]| {
            let parts = light.iter().zip(&self.lobes).map(|(l, lobe)| Vec3::from(l.rgb) * lobe.weight);
            parts.fold(Vec3::ZERO, |sum, part| sum + part).to_array()
        };
        light.chunks(self.lobes.len()).map(sum).collect()
    }
}

/// Six cones of every voxel, on the side of its normal, which is that of its triangles' winding: what is behind is as a rule the inside of a thing,
/// whose walls are lit voxels too. Those without a normal look along +z, a side as good as any.
pub(super) fn voxel_cones<B: Backend>(lit: &Lit<B>, sums: &[VoxelSums], active: &[u32]) -> (Bundle, u32) {
    let (lobes, flags) = hemisphere(Cones::Six);
    let mut bundle = Bundle::new(lobes, active.len());
    for (&code, sums) in active.iter().zip(sums) {
        let place = Vec3::from(morton_voxel(code).map(|i| i as f32 + 0.5));
        let position = Vec3::from(lit.call.frame.corner) + place * lit.voxel;
        let normal = Vec3::from(sums.normal.map(|c| c as f32));
        let normal = if normal == Vec3::ZERO { Vec3::Z } else { normalized(normal) };
        bundle.push(position, normal, lit.voxel);
    }
    (bundle, flags)
}
