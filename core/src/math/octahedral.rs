//! From a direction to the nearest of a fixed set. Twin: `backend-gpu/src/shared/octahedral.wgsl`.
//!
//! Floats appear in one place, where components become integers by a product with a power of two and truncation. Both
//! are exact, so not even an adapter that rounds divisions its own way can come to another cell.

use glam::{IVec3, Vec3};

/// Units of a quantised component to 1.
pub(crate) const STEPS: i32 = 1 << 15;

/// Bit of a candidate's second word that says: the list ends here.
pub(crate) const LAST: u32 = 1 << 15;

/// Bits of a candidate's second word that number the direction.
pub(crate) const INDEX: u32 = LAST - 1;

/// The odd number of units 2⁻¹⁵ that is within one of |c|, which is cut at 1. Odd, so that no sum of three is 0.
#[inline(always)]
fn steps(c: f32) -> i32 {
    let size = c.abs();
    let cut = if size < 1.0 { size } else { 1.0 };
    2 * ((cut * 16_384.0) as i32) + 1
}

/// The number of steps with the sign of c. Subnormals, which adapters may flush, count as 0, and 0 as positive.
#[inline(always)]
fn signed_steps(c: f32) -> i32 {
    if c < -1e-30 { -steps(c) } else { steps(c) }
}

/// The direction in units of 2⁻¹⁵, within one unit per component.
#[inline(always)]
pub(crate) fn quantised(direction: Vec3) -> IVec3 {
    IVec3::new(signed_steps(direction.x), signed_steps(direction.y), signed_steps(direction.z))
}

/// Octahedral projection: |x| + |y| + |z| = 1, with the faces below z = 0 folded outwards over the diagonals. Products
/// stay below 2¹⁷ · 2¹¹ for resolutions up to 4096.
#[inline(always)]
fn cell_of(q: IVec3, resolution: u32) -> u32 {
    let (x, y, z) = (q.x.unsigned_abs(), q.y.unsigned_abs(), q.z.unsigned_abs());
    let sum = x + y + z;
    let half = resolution >> 1;
    let column = (if q.z < 0 { sum - y } else { x }) * half / sum;
    let row = (if q.z < 0 { sum - x } else { y }) * half / sum;
    let row = if q.y < 0 { half - 1 - row } else { half + row };
    row * resolution + if q.x < 0 { half - 1 - column } else { half + column }
}

/// The cell of an octahedral map of `resolution` × `resolution` cells that the unit `direction` falls into: row times
/// `resolution` plus column, columns along x and rows along y, z = 1 in the middle and z = −1 in the corners. Even
/// resolutions from 2 to 4096. Any vector has some cell, one with NaN or of length 0 too. Source: Cigolle et al., "A
/// survey of efficient representations for independent unit vectors", JCGT 3(2) 2014.
#[inline(always)]
pub fn nearest_cell(direction: Vec3, resolution: u32) -> u32 {
    cell_of(quantised(direction), resolution)
}

/// Scalar product with a candidate's vector. Below 2³¹ even for (1, 1, 1), which is no unit vector.
#[inline(always)]
fn alignment(q: IVec3, xy: u32, z: u32) -> i32 {
    q.x * ((xy << 16) as i32 >> 16) + q.y * (xy as i32 >> 16) + q.z * (z as i32 >> 16)
}

/// Index of the direction nearest to the unit `direction`, by a [`crate::directions::NearestMap`]'s words and
/// resolution. The first of equals.
#[inline(always)]
pub fn nearest_direction(map: &[u32], resolution: u32, direction: Vec3) -> u32 {
    let q = quantised(direction);
    let mut at = map[cell_of(q, resolution) as usize] as usize;
    let mut word = map[at + 1];
    let mut nearest = word & INDEX;
    // About half of the cells have one candidate, and no product to compute.
    if word & LAST == LAST {
        return nearest;
    }
    let mut best = alignment(q, map[at], word);
    while word & LAST == 0 {
        at += 2;
        word = map[at + 1];
        let aligned = alignment(q, map[at], word);
        if aligned > best {
            best = aligned;
            nearest = word & INDEX;
        }
    }
    nearest
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Whatever the bits, the cell is on the map: its index is used without a check.
        #[test]
        fn every_vector_has_a_cell(x: u32, y: u32, z: u32, half in 1_u32..=2048) {
            let v = Vec3::new(f32::from_bits(x), f32::from_bits(y), f32::from_bits(z));
            prop_assert!(nearest_cell(v, 2 * half) < 4 * half * half);
        }

        #[test]
        fn cells_are_those_of_the_projection(
            x in -1.0_f64..1.0, y in -1.0_f64..1.0, z in -1.0_f64..1.0, half in 1_u32..=2048,
        ) {
            let d = glam::DVec3::new(x, y, z);
            prop_assume!(d.length() > 1e-3);
            let d = d.normalize();
            let p = d / d.abs().element_sum();
            let sign = |c: f64| if c < 0.0 { -1.0 } else { 1.0 };
            let (u, v) = if p.z < 0.0 {
                ((1.0 - p.y.abs()) * sign(p.x), (1.0 - p.x.abs()) * sign(p.y))
            } else {
                (p.x, p.y)
            };
            let cell = nearest_cell(d.as_vec3(), 2 * half);
            let at = |w: f64| (w + 1.0) * f64::from(half);
            // Components are off by a unit of 2⁻¹⁵, u and v by four at most.
            let slack = f64::from(half) * 4.0 / f64::from(STEPS);
            for (cell, at) in [(cell % (2 * half), at(u)), (cell / (2 * half), at(v))] {
                let low = f64::from(cell);
                prop_assert!(low - slack <= at && at <= low + 1.0 + slack, "{at} in cell {cell}");
            }
        }
    }

    #[test]
    fn poles_and_corners() {
        assert_eq!(nearest_cell(Vec3::Z, 4), 10);
        assert_eq!(nearest_cell(-Vec3::Z, 4), 15);
        assert_eq!(nearest_cell(Vec3::X, 4), 11);
        assert_eq!(nearest_cell(Vec3::NEG_X, 4), 8);
        assert_eq!(nearest_cell(Vec3::Y, 4), 14);
        assert_eq!(nearest_cell(Vec3::new(-0.1, -0.1, -0.9), 4), 0);
    }

    /// Adapters may take subnormals for 0.
    #[test]
    fn subnormals_have_no_sign() {
        for tiny in [0.0, -0.0, 1e-40, -1e-40] {
            assert_eq!(quantised(Vec3::new(tiny, -1.0, -1e-20)), IVec3::new(1, -STEPS - 1, -1));
        }
    }

    #[test]
    fn products_fit() {
        let q = quantised(Vec3::splat(f32::INFINITY));
        assert_eq!(q, IVec3::splat(STEPS + 1));
        let longest = (32_767.0 + 0.75_f64.sqrt()) * q.as_dvec3().length();
        assert!(longest < f64::from(i32::MAX));
    }
}
