//! The one place where coordinates become integers: meshes are snapped once to a lattice around the scene, views are
//! quantised once, and from there on rotation, coverage and depth are exact in 32 bits.
//!
//! *The budget.* A snapped position has length at most [`REACH`] < 2¹⁵, a row of a view's basis at most 2¹⁴ and the
//! rounding of its components, √3/2. Their dot product stays under 2²⁹ in every partial sum, since products of two of the
//! three components are bounded by the product of the lengths. Screen coordinates come from it by a shift: they lie in
//! [0, 2¹⁵], so twice the area of any triangle on the screen, which is what an edge function is, stays within 2³⁰.
//!
//! *What snapping costs.* A vertex moves by at most half a [`Lattice::step`] per axis, 2⁻¹⁶ of the scene's radius. Vertices at
//! one place stay at one place, so a closed mesh stays closed.

mod grid;
mod mesh;
mod plane;
mod view;
mod voxel;

pub use grid::{COORDINATE_BITS, MAX_VOXELS, SCALE_BITS, VoxelGrid, mask_words};
pub use mesh::LatticeMesh;
pub use plane::LatticePlane;
pub use view::{DEPTH_ORIGIN, MAX_SIZE, View, subpixel_bits};
pub use voxel::{VoxelTriangle, WEIGHT_BITS, others};

pub(crate) use view::check_size;

use crate::error::{Error, Result};
use crate::scene::{CompiledScene, Triangle};
use glam::DVec3;

/// Largest length of a snapped position. The 8 steps to 2¹⁵ are what the rounding of a view's rows may add to a screen
/// coordinate, with room to spare: 2¹⁴ · 8/2¹⁵ > √3/2 + ½ even when a row is halved for a size that is no power of two.
pub const REACH: i32 = 32_760;

/// Steps from the centre to the farthest point: [`REACH`] less what snapping may add to a length, √3/2.
const RADIUS_STEPS: f64 = 32_759.0;

fn corners(triangle: &Triangle) -> [DVec3; 3] {
    [triangle.p0, triangle.p1, triangle.p2].map(|p| glam::Vec3::from(p).as_dvec3())
}

/// A cubic lattice around a ball: what integer coordinates mean.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lattice {
    centre: DVec3,
    step: f64,
}

impl Lattice {
    /// The lattice of the ball of `radius` around `centre`. A point's ball has the radius 1.
    ///
    /// # Errors
    /// [`Error::InvalidInput`] for a centre or radius that is not finite, or a negative radius.
    pub fn new(centre: DVec3, radius: f64) -> Result<Self> {
        if !centre.is_finite() || !radius.is_finite() || radius < 0.0 {
            let what = format!("a ball of radius {radius} around {centre} is no place for a lattice");
            return Err(Error::invalid("lattice", what));
        }
        let radius = if radius > 0.0 { radius } else { 1.0 };
        Ok(Self { centre, step: radius / RADIUS_STEPS })
    }

    /// The lattice of the ball around the middle of the bounds that holds all of `points`.
    ///
    /// Shifting the points exactly shifts the lattice, scaling them by a power of two scales it: the snapped coordinates
    /// stay the same.
    ///
    /// # Errors
    /// [`Error::InvalidInput`] when a point is not finite.
    pub fn around(points: impl Iterator<Item = DVec3> + Clone) -> Result<Self> {
        if let Some(p) = points.clone().find(|p| !p.is_finite()) {
            return Err(Error::invalid("lattice", format!("{p} is no place for a lattice")));
        }
        let empty = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let (low, high) = points.clone().fold(empty, |(low, high), p| (low.min(p), high.max(p)));
        let centre = if low.x <= high.x { low + (high - low) * 0.5 } else { DVec3::ZERO };
        let radius = points.map(|p| (p - centre).length()).fold(0.0, f64::max);
        Self::new(centre, radius)
    }

    /// The lattice of triangles of a scene, relative to [`CompiledScene::origin`] as they are.
    ///
    /// # Errors
    /// As [`Lattice::around`].
    pub fn of_triangles(triangles: &[Triangle]) -> Result<Self> {
        Self::around(triangles.iter().flat_map(corners))
    }

    /// The lattice of a scene: of what stays from frame to frame ([`CompiledScene::moving_from`]) while all that moves is within
    /// its reach, else of everything. It depends on this frame alone.
    ///
    /// # Errors
    /// As [`Lattice::around`].
    pub fn of_scene(scene: &CompiledScene) -> Result<Self> {
        let (staying, moving) = scene.parts();
        if !staying.is_empty() {
            let lattice = Self::of_triangles(staying)?;
            if lattice.reaches(moving) {
                return Ok(lattice);
            }
        }
        Self::of_triangles(&scene.triangles)
    }

    /// Whether every corner can be snapped.
    pub fn reaches(&self, triangles: &[Triangle]) -> bool {
        triangles.iter().flat_map(corners).all(|corner| self.snap(corner).is_some())
    }

    /// The point with coordinates 0 0 0.
    pub fn centre(&self) -> DVec3 {
        self.centre
    }

    /// World units from one lattice point to the next.
    pub fn step(&self) -> f64 {
        self.step
    }

    /// The nearest lattice point, ties to even, or `None` where its length is beyond [`REACH`].
    pub fn snap(&self, point: DVec3) -> Option<[i16; 3]> {
        let p = ((point - self.centre) / self.step).to_array().map(f64::round_ties_even);
        let reach = f64::from(REACH);
        let inside = p[0] * p[0] + p[1] * p[1] + p[2] * p[2] <= reach * reach;
        inside.then(|| p.map(|c| c as i16))
    }

    /// Where a lattice point is.
    pub fn place(&self, point: [i16; 3]) -> DVec3 {
        DVec3::from(point.map(f64::from)) * self.step + self.centre
    }
}

#[cfg(test)]
mod tests;
