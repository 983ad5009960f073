//! Sets of directions that cover the sphere, for views and cones that are prepared in advance, and the constant-time
//! way from any direction to the nearest of a set.
//!
//! With a direction, a set holds its exact negative (but for the last one of an odd [`DirectionSet::halton`]). A view
//! answers both, so 320 directions need 160 views, one per *line*.
//!
//! How evenly sets cover the sphere: covering radius ρ in degrees, the largest over the smallest solid angle, and what
//! [`NearestMap`] adds to the angle to the nearest direction at most ([`DirectionSet::nearest_error`]), with the map's
//! size and longest list.
//!
//! | set | ρ | solid angles | map's error, % of ρ | map |
//! |---|---|---|---|---|
//! | `icosahedron:20` | 37.38 | 1.00 | 0.04 | 32², 6 KiB, 5 |
//! | `icosahedron:80` | 20.10 | 1.04 | 0.12 | 64², 25 KiB, 6 |
//! | `icosahedron:320` | 9.94 | 1.20 | 0.45 | 128², 97 KiB, 6 |
//! | `icosahedron:1280` | 5.32 | 1.28 | 1.63 | 256², 385 KiB, 6 |
//! | `octahedron:8` | 54.74 | 1.00 | 0.02 | 16², 2 KiB, 4 |
//! | `octahedron:32` | 32.37 | 1.02 | 0.05 | 32², 8 KiB, 6 |
//! | `octahedron:128` | 16.03 | 1.66 | 0.22 | 64², 29 KiB, 6 |
//! | `octahedron:512` | 9.30 | 2.06 | 0.75 | 128², 115 KiB, 6 |
//! | `octahedron:2048` | 4.94 | 2.19 | 2.75 | 256², 460 KiB, 6 |
//! | `halton:20` | 46.94 | 2.46 | 0.06 | 32², 6 KiB, 4 |
//! | `halton:50` | 26.58 | 2.09 | 0.10 | 64², 21 KiB, 4 |
//! | `halton:320` | 12.09 | 2.83 | 0.84 | 128², 96 KiB, 6 |
//! | `halton:1280` | 6.60 | 4.19 | 3.82 | 256², 386 KiB, 6 |
//! | `uv:4x8` | 41.41 | 1.05 | 0.04 | 32², 8 KiB, 8 |
//! | `uv:8x16` | 28.96 | 1.09 | 0.13 | 64², 30 KiB, 16 |
//! | `uv:16x20` | 20.36 | 1.10 | 0.30 | 128², 95 KiB, 20 |
//!
//! Everything here is made of + − × ÷ and square roots in f64, in one order: the same bits on every machine.
//!
//! *Source.* Yu, spherical layered hit buffers: directions and directional map. Deviation: the map has a short list of
//! candidates per cell instead of one direction per texel.
//!
//! ```
//! use twinlight_core::directions::{DirectionSet, NearestMap};
//! use twinlight_core::lattice::View;
//! # fn main() -> twinlight_core::Result<()> {
//! let set: DirectionSet = "icosahedron:320".parse()?;
//! let views: Vec<View> = set.lines().iter().map(|&line| View::along(line, 128)).collect::<Result<_, _>>()?;
//! assert_eq!((set.len(), views.len()), (320, 160));
//!
//! let map = NearestMap::new(&set);
//! let nearest = map.nearest(glam::Vec3::new(0.6, 0.0, -0.8)) as usize;
//! let on_line = set.on_lines()[nearest];
//! let line = set.lines()[on_line.line as usize];
//! assert_eq!(set.directions()[nearest], if on_line.reversed { -line } else { line });
//! # Ok(())
//! # }
//! ```

mod lines;
mod nearest;
mod parse;
mod patterns;
mod polyhedra;
mod voronoi;

pub use lines::OnLine;
pub use nearest::{MAX_RESOLUTION, NearestMap};

use crate::error::{Error, Result};
use glam::DVec3;
use lines::{find_lines, opposites_after};
use std::fmt;

/// Most directions of a set.
pub const MAX_DIRECTIONS: u32 = 4096;

/// Unit vectors that cover the sphere. No two are equal.
#[derive(Debug, Clone, PartialEq)]
pub struct DirectionSet {
    name: String,
    directions: Vec<DVec3>,
    on_lines: Vec<OnLine>,
    lines: Vec<DVec3>,
    solid_angles: Vec<f64>,
    covering_radius: f64,
}

impl DirectionSet {
    /// The centres of an icosahedron's 20·4ᵏ faces after `subdivisions` k: 20, 80, 320 or 1280. Opposites are half the
    /// set apart.
    ///
    /// # Errors
    /// [`Error::LimitExceeded`] beyond [`MAX_DIRECTIONS`].
    pub fn icosahedron(subdivisions: u32) -> Result<Self> {
        let count = check_count(20_u64.saturating_mul(4_u64.saturating_pow(subdivisions)))?;
        let half = polyhedra::icosahedron(subdivisions);
        Ok(Self::new(format!("icosahedron:{count}"), opposites_after(half)))
    }

    /// The centres of an octahedron's 8·4ᵏ faces after `subdivisions` k: 8, 32, 128, 512 or 2048. Opposites are half
    /// the set apart.
    ///
    /// # Errors
    /// As [`DirectionSet::icosahedron`].
    pub fn octahedron(subdivisions: u32) -> Result<Self> {
        let count = check_count(8_u64.saturating_mul(4_u64.saturating_pow(subdivisions)))?;
        let half = polyhedra::octahedron(subdivisions);
        Ok(Self::new(format!("octahedron:{count}"), opposites_after(half)))
    }

    /// `count` directions, each odd one the opposite of the one before. The even ones are Halton points (bases 2 and 3,
    /// from the second point on) of the hemisphere z > 0: z = 1 − ξ₂, φ = 2π·ξ₃, so that z is uniform in [−1, 1] over
    /// the whole set. The last one of an odd `count` has no opposite.
    ///
    /// # Errors
    /// [`Error::InvalidInput`] for a count of 0, [`Error::LimitExceeded`] beyond [`MAX_DIRECTIONS`].
    pub fn halton(count: u32) -> Result<Self> {
        let count = check_count(count.into())?;
        Ok(Self::new(format!("halton:{count}"), patterns::halton(count)))
    }

    /// `rows` of equal solid angle, from z = 1 downwards, of `columns` directions each, row after row: the middles of
    /// the cells in φ and z. Rows are uniform in z, so columns crowd at the poles.
    ///
    /// # Errors
    /// [`Error::InvalidInput`] for no rows, no columns or an odd number of columns, in which no direction would have
    /// its opposite; [`Error::LimitExceeded`] beyond [`MAX_DIRECTIONS`].
    pub fn uv_grid(rows: u32, columns: u32) -> Result<Self> {
        if columns % 2 == 1 {
            let what = format!("{columns} columns; directions have their opposites for even numbers only");
            return Err(Error::invalid("directions", what));
        }
        check_count(u64::from(rows) * u64::from(columns))?;
        let half = patterns::uv_grid_half(rows, columns);
        let opposite = |i: u32| {
            let (row, column) = (i / columns, (i + columns / 2) % columns);
            (rows - 1 - row) * columns + column
        };
        let directions = (0..rows * columns).map(|i| match half.get(i as usize) {
            Some(&direction) => direction,
            None => -half[opposite(i) as usize],
        });
        Ok(Self::new(format!("uv:{rows}x{columns}"), directions.collect()))
    }

    fn new(name: String, directions: Vec<DVec3>) -> Self {
        let (on_lines, lines) = find_lines(&directions);
        let (solid_angles, covering_radius) = voronoi::measure(&directions, &on_lines, lines.len());
        Self { name, directions, on_lines, lines, solid_angles, covering_radius }
    }

    /// Number of directions; at least 1.
    #[expect(clippy::len_without_is_empty, reason = "no set is empty")]
    pub fn len(&self) -> usize {
        self.directions.len()
    }

    /// Unit vectors.
    pub fn directions(&self) -> &[DVec3] {
        &self.directions
    }

    /// For each direction its line.
    pub fn on_lines(&self) -> &[OnLine] {
        &self.on_lines
    }

    /// One unit vector for a direction and its opposite: that of the two which comes first. In the order in which they
    /// come.
    pub fn lines(&self) -> &[DVec3] {
        &self.lines
    }

    /// Solid angle of the region to which each direction is the nearest one, steradians. Together 4π.
    pub fn solid_angles(&self) -> &[f64] {
        &self.solid_angles
    }

    /// The largest angle from any vector to the direction nearest to it, radians. π for a single direction.
    pub fn covering_radius(&self) -> f64 {
        self.covering_radius
    }
}

/// The name that parses to this set.
impl fmt::Display for DirectionSet {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.name)
    }
}

fn check_count(count: u64) -> Result<u32> {
    if count == 0 {
        return Err(Error::invalid("directions", "0 directions; at least one is needed"));
    }
    if count > MAX_DIRECTIONS.into() {
        return Err(Error::limit("directions of a set", count, MAX_DIRECTIONS.into()));
    }
    Ok(count as u32)
}

#[cfg(test)]
mod tests;
