//! Turning from one rotation to another at constant speed.

use glam::DQuat;

/// Bisections before the rest of the arc is taken for a line. From an angle of at most π/2 between quaternions, 2⁻²⁰ of it
/// is left; a normalised line of length δ strays from the arc by less than δ³/10, here 4e-19, far below a rounding.
const BISECTIONS: u32 = 20;

/// Spherical linear interpolation by the shortest turn, from `a` at 0 to `b` at 1, both of length 1 (glTF 2.0,
/// Appendix C.4).
///
/// By halving the arc instead of sines and arc cosines, whose bits depend on the platform's libm: the middle of two unit
/// quaternions needs a square root only, which IEEE 754 defines to the last bit.
pub(super) fn slerp(a: DQuat, b: DQuat, share: f64) -> DQuat {
    // A quaternion and its negative are the same rotation: the nearer one is the shorter turn.
    let (mut low, mut high) = (a, if a.dot(b) < 0.0 { -b } else { b });
    let mut share = share;
    for _ in 0..BISECTIONS {
        let middle = (low + high).normalize();
        share *= 2.0;
        if share < 1.0 {
            high = middle;
        } else {
            low = middle;
            share -= 1.0;
        }
    }
    (low * (1.0 - share) + high * share).normalize()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    #[test]
    fn agrees_with_the_formula() {
        let axis = DVec3::new(1.0, -2.0, 0.5).normalize();
        for degrees in [0.0_f64, 1e-7, 1e-3, 1.0, 45.0, 90.0, 120.0, 179.0, 180.0] {
            let (a, b) = (DQuat::from_rotation_x(0.3), DQuat::from_axis_angle(axis, degrees.to_radians()));
            for i in 0..=64 {
                let share = f64::from(i) / 64.0;
                let expected = DQuat::from_axis_angle(axis, share * degrees.to_radians()) * a;
                let found = slerp(a, b * a, share);
                let distance = (found - expected).length().min((found + expected).length());
                assert!(distance < 4e-15, "{degrees}° at {share}: {distance:e}");
            }
        }
    }

    #[test]
    fn takes_the_shorter_turn() {
        let b = DQuat::from_rotation_y(1.0);
        assert!((slerp(DQuat::IDENTITY, -b, 0.5) - DQuat::from_rotation_y(0.5)).length() < 1e-15);
    }
}
