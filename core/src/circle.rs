//! Points on the circle and angles between vectors in f64, without a platform's `sin` or `atan2`: the same bits
//! everywhere.

use glam::DVec3;

/// (cos, sin) of the angle `2π·index/count`, with an error below 2⁻⁵² and the same bits everywhere: octants by integer
/// arithmetic, Taylor series on [0, π/4]. Multiples of a quarter turn are exact. A `count` of 0 counts as 1.
pub fn circle_point(index: u64, count: u64) -> (f64, f64) {
    let count = count.max(1);
    let eighths = (index % count) * 8;
    let (octant, rest) = (eighths / count, eighths % count);
    let angle = |part: u64| part as f64 / count as f64 * std::f64::consts::FRAC_PI_4;
    let (mut x, mut y) = if octant % 2 == 0 {
        series(angle(rest))
    } else {
        let (cos, sin) = series(angle(count - rest));
        (sin, cos)
    };
    for _ in 0..octant / 2 {
        (x, y) = (-y, x);
    }
    (x, y)
}

/// (cos, sin) for 0 ≤ x ≤ π/4. The first terms left out, x¹⁸/18! and x¹⁹/19!, are below 3e-18.
fn series(x: f64) -> (f64, f64) {
    let square = x * x;
    let (mut cos, mut sin) = (1.0, 1.0);
    for k in (1..=8).rev() {
        let n = f64::from(2 * k);
        cos = 1.0 - square / (n * (n - 1.0)) * cos;
        sin = 1.0 - square / (n * (n + 1.0)) * sin;
    }
    (cos, sin * x)
}

/// The angle of (x, y) for y ≥ 0, in [0, π], within 4 units in the last place; 0 at the origin.
pub fn arctangent(y: f64, x: f64) -> f64 {
    if y == 0.0 && x == 0.0 {
        return 0.0;
    }
    // Tangents of halves: at most π/4 after the first, π/32 and less after three more. The first term that the series
    // leaves out is below 1e-18.
    let mut t = y / ((x * x + y * y).sqrt() + x.abs());
    for _ in 0..3 {
        t /= 1.0 + (1.0 + t * t).sqrt();
    }
    let square = t * t;
    let series = (0..8).rev().fold(0.0, |sum, k| 1.0 / f64::from(2 * k + 1) - square * sum);
    let angle = 16.0 * t * series;
    if x < 0.0 { std::f64::consts::PI - angle } else { angle }
}

/// The angle between two unit vectors, radians. Accurate for small angles, as the arc cosine of their product is not.
pub fn angle_between(a: DVec3, b: DVec3) -> f64 {
    2.0 * arctangent((a - b).length(), (a + b).length())
}

/// Solid angle of the spherical triangle between unit vectors, steradians. Van Oosterom & Strackee, IEEE Trans.
/// Biomed. Eng. 30(2) 1983.
pub fn solid_angle(a: DVec3, b: DVec3, c: DVec3) -> f64 {
    2.0 * arctangent(a.dot(b.cross(c)).abs(), 1.0 + a.dot(b) + b.dot(c) + c.dot(a))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_the_standard_library() {
        for count in [1, 2, 3, 4, 5, 7, 8, 12, 360, 1001] {
            for index in 0..2 * count {
                let angle = std::f64::consts::TAU * (index % count) as f64 / count as f64;
                let (x, y) = circle_point(index, count);
                // The standard library's argument is itself rounded by up to 2^-51 below 2π.
                assert!(
                    (x - angle.cos()).abs() < 2e-15 && (y - angle.sin()).abs() < 2e-15,
                    "{index}/{count}"
                );
                // A few roundings of numbers below 1; one missing term of the series makes 1e-15.
                assert!((x * x + y * y - 1.0).abs() < 6e-16, "{index}/{count}");
            }
        }
    }

    #[test]
    fn quarter_turns_are_exact() {
        assert_eq!(
            [0, 1, 2, 3].map(|i| circle_point(i, 4)),
            [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)]
        );
    }

    #[test]
    fn arctangents_agree_with_the_standard_library() {
        for i in 0..=100_000 {
            let angle = std::f64::consts::PI * f64::from(i) / 100_000.0;
            let (y, x) = (angle.sin().max(0.0), angle.cos());
            let (got, want) = (arctangent(3.0 * y, 3.0 * x), y.atan2(x));
            assert!((got - want).abs() <= 4.0 * f64::EPSILON * want, "{got} for {want}");
        }
        assert_eq!(arctangent(0.0, 0.0), 0.0);
        assert_eq!(arctangent(0.0, -1.0), std::f64::consts::PI);
    }

    #[test]
    fn angles_of_the_octant() {
        let quarter = std::f64::consts::FRAC_PI_2;
        assert!((solid_angle(DVec3::X, DVec3::Y, DVec3::Z) - quarter).abs() < 1e-15);
        assert!((angle_between(DVec3::X, DVec3::Y) - quarter).abs() < 1e-15);
        assert!((angle_between(DVec3::X, DVec3::new(1.0, 1e-9, 0.0)) - 1e-9).abs() < 1e-24);
        assert!((angle_between(DVec3::X, -DVec3::X) - 2.0 * quarter).abs() < 1e-15);
    }
}
