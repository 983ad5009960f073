//! Planes of snapped triangles.

use bytemuck::{Pod, Zeroable};
use glam::DVec3;

/// The plane of a triangle: normal·p = offset for the points p on it, to half a percent of a pixel of 128².
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
pub struct LatticePlane {
    /// Unit normal of the side on which the vertices run counter-clockwise, times 2¹³; 0 without an area.
    pub normal: [i16; 3],
    /// Unused, 0.
    pub padding: u16,
    /// Of the vertices' mean, rounded down.
    pub offset: i32,
}

impl LatticePlane {
    /// The plane of a snapped triangle.
    ///
    /// Lengths keep normal·p within 2¹³·2¹⁵ and a rounding: it fits 32 bits, as does its difference to the offset.
    pub fn of(corners: [[i16; 3]; 3]) -> Self {
        let [a, b, c] = corners.map(|p| DVec3::from(p.map(f64::from)));
        // Exact in f64: differences have 17 bits, products 34.
        let normal = (b - a).cross(c - a).normalize_or_zero() * 8192.0;
        let normal = normal.to_array().map(|n| n.round_ties_even() as i16);
        let dot = |p: [i16; 3]| (0..3).map(|i| i64::from(normal[i]) * i64::from(p[i])).sum::<i64>();
        let offset = corners.map(dot).iter().sum::<i64>().div_euclid(3);
        Self { normal, padding: 0, offset: offset as i32 }
    }
}
