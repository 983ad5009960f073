//! Angles in turns, by polynomials of our own: no two platforms agree on the built-in functions. Twin:
//! `backend-gpu/src/shared/trig.wgsl`. Polynomials: Moshier, Cephes (sinf, cosf, atanf).

use std::f32::consts::{FRAC_PI_2, FRAC_PI_4};

/// (sin, cos) of `a` radians, for −π/4 ≤ a ≤ π/4.
#[inline(always)]
pub fn sin_cos_octant(a: f32) -> (f32, f32) {
    let z = a * a;
    let sine = ((-1.951_529_6e-4 * z + 8.332_161e-3) * z - 1.666_665_5e-1) * z * a + a;
    let cosine = ((2.443_315_7e-5 * z - 1.388_731_6e-3) * z + 4.166_664_6e-2) * (z * z) - 0.5 * z + 1.0;
    (sine, cosine)
}

/// (sin, cos) of `turns` full turns, for 0 ≤ turns ≤ 1; absolute error below 2⁻²².
#[inline(always)]
pub fn sin_cos_turns(turns: f32) -> (f32, f32) {
    let quarters = turns * 4.0;
    let quadrant = (quarters + 0.5) as i32;
    let (sine, cosine) = sin_cos_octant((quarters - quadrant as f32) * FRAC_PI_2);
    let swap = quadrant & 1 == 1;
    let s = if swap { cosine } else { sine };
    let c = if swap { sine } else { cosine };
    (if quadrant & 2 == 2 { -s } else { s }, if (quadrant + 1) & 2 == 2 { -c } else { c })
}

/// The angle of (x, y) in turns, in [0, 1); 0 at the origin. Absolute error below 2⁻²¹ turns.
#[inline(always)]
pub fn atan2_turns(y: f32, x: f32) -> f32 {
    let (ax, ay) = (x.abs(), y.abs());
    let larger = if ax > ay { ax } else { ay };
    let smaller = if ax > ay { ay } else { ax };
    if !(larger > 0.0) {
        return 0.0;
    }
    let ratio = smaller / larger;
    // tan(π/8): above it, atan(r) = π/4 + atan((r − 1)/(r + 1)).
    let shifted = ratio > 0.414_213_57;
    let t = if shifted { (ratio - 1.0) / (ratio + 1.0) } else { ratio };
    let z = t * t;
    let p = (((8.053_744_5e-2 * z - 1.387_768_6e-1) * z + 1.997_771_1e-1) * z - 3.333_295e-1) * z * t + t;
    let first = (if shifted { p + FRAC_PI_4 } else { p }) * 0.159_154_94;
    let octant = if ay > ax { 0.25 - first } else { first };
    let half = if x < 0.0 { 0.5 - octant } else { octant };
    let full = if y < 0.0 { 1.0 - half } else { half };
    if full < 1.0 { full } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sines_are_sines() {
        for i in 0..=1_000_000 {
            let turns = i as f32 / 1_000_000.0;
            let (s, c) = sin_cos_turns(turns);
            let angle = f64::from(turns) * std::f64::consts::TAU;
            assert!((f64::from(s) - angle.sin()).abs() < 2.4e-7, "sin {turns}: {s}");
            assert!((f64::from(c) - angle.cos()).abs() < 2.4e-7, "cos {turns}: {c}");
        }
    }

    #[test]
    fn arctangents_are_arctangents() {
        for i in 0..1_000_000 {
            let angle = std::f64::consts::TAU * f64::from(i) / 1_000_000.0;
            let (y, x) = (angle.sin() as f32, angle.cos() as f32);
            let turns = f64::from(atan2_turns(y, x));
            let error = (turns - f64::from(i) / 1_000_000.0).abs();
            assert!(error.min(1.0 - error) < 4.8e-7, "{turns} for {i}");
            assert!((0.0..1.0).contains(&turns));
        }
        assert_eq!(atan2_turns(0.0, 0.0), 0.0);
        assert_eq!(atan2_turns(0.0, -1.0), 0.5);
        assert_eq!(atan2_turns(-1.0, 0.0), 0.75);
    }
}
