//! The colour spaces of ꟻLIP and its colour difference (4.1).

/// Hunt-adjusted CIELAB: lightness, and the two chroma axes scaled by lightness / 100.
pub(super) type Hunt = [f64; 3];

/// Linear sRGB to CIE XYZ, D65, in the fractions that the primaries and the white point give exactly.
const TO_XYZ: [[f64; 3]; 3] = [
    [10135552.0 / 24577794.0, 8788810.0 / 24577794.0, 4435075.0 / 24577794.0],
    [2613072.0 / 12288897.0, 8788810.0 / 12288897.0, 887015.0 / 12288897.0],
    [1425312.0 / 73733382.0, 8788810.0 / 73733382.0, 70074185.0 / 73733382.0],
];

/// The exact inverse of [`TO_XYZ`], rounded to `f64`.
const FROM_XYZ: [[f64; 3]; 3] = [
    [3.2410032329763587, -1.5373989694887855, -0.4986158819963629],
    [-0.9692242522025166, 1.875929983695176, 0.041554226340084724],
    [0.055639419851975444, -0.20401120612390997, 1.0571489771875335],
];

/// Exponent of the colour difference (q_c), and the knee of its redistribution (p_c, p_t).
const COLOUR_EXPONENT: f64 = 0.7;
const KNEE_AT: f64 = 0.4;
const KNEE_VALUE: f64 = 0.95;

/// XYZ of linear RGB (1, 1, 1).
const WHITE: [f64; 3] = [
    TO_XYZ[0][0] + TO_XYZ[0][1] + TO_XYZ[0][2],
    TO_XYZ[1][0] + TO_XYZ[1][1] + TO_XYZ[1][2],
    TO_XYZ[2][0] + TO_XYZ[2][1] + TO_XYZ[2][2],
];

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// XYZ over white.
fn to_relative_xyz(rgb: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| dot(TO_XYZ[i], rgb) / WHITE[i])
}

fn from_relative_xyz(relative: [f64; 3]) -> [f64; 3] {
    let xyz = std::array::from_fn(|i| relative[i] * WHITE[i]);
    FROM_XYZ.map(|row| dot(row, xyz))
}

/// Linear RGB to YCxCz, the linear opponent space in which the eye's blur is applied.
pub(super) fn to_opponent(rgb: [f64; 3]) -> [f64; 3] {
    let [x, y, z] = to_relative_xyz(rgb);
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// YCxCz, after the blur, to Hunt-adjusted CIELAB; clamped to the RGB cube on the way, as 4.1.1 asks.
pub(super) fn to_hunt_lab(opponent: [f64; 3]) -> Hunt {
    let y = (opponent[0] + 16.0) / 116.0;
    let relative = [y + opponent[1] / 500.0, y, y - opponent[2] / 200.0];
    hunt_of_linear(from_relative_xyz(relative).map(|value| value.clamp(0.0, 1.0)))
}

fn hunt_of_linear(rgb: [f64; 3]) -> Hunt {
    let [x, y, z] = to_relative_xyz(rgb).map(lab_curve);
    let lightness = 116.0 * y - 16.0;
    let adjust = 0.01 * lightness;
    [lightness, adjust * (500.0 * (x - y)), adjust * (200.0 * (y - z))]
}

/// CIELAB's cube root with its linear foot.
fn lab_curve(value: f64) -> f64 {
    const DELTA: f64 = 6.0 / 29.0;
    if value > DELTA * DELTA * DELTA { value.cbrt() } else { value / (3.0 * DELTA * DELTA) + 4.0 / 29.0 }
}

/// HyAB distance (Abasi et al. 2020) raised to q_c.
pub(super) fn difference(a: Hunt, b: Hunt) -> f64 {
    let [l, p, q] = [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    (l.abs() + (p * p + q * q).sqrt()).powf(COLOUR_EXPONENT)
}

/// The largest [`difference`] of the cube: green against blue (4.1.3).
pub(super) fn largest_difference() -> f64 {
    difference(hunt_of_linear([0.0, 1.0, 0.0]), hunt_of_linear([0.0, 0.0, 1.0]))
}

/// Stretches differences below the knee to [0, p_t] and squeezes the rest into (p_t, 1].
pub(super) fn redistribute(difference: f64, largest: f64) -> f64 {
    let knee = KNEE_AT * largest;
    if difference < knee {
        difference * (KNEE_VALUE / knee)
    } else {
        KNEE_VALUE + (difference - knee) / (largest - knee) * (1.0 - KNEE_VALUE)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn white_and_black() {
        // A few f64 roundings of numbers up to 500.
        let close = |a: Hunt, b: Hunt| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12);
        assert!(close(hunt_of_linear([1.0; 3]), [100.0, 0.0, 0.0]));
        assert!(close(hunt_of_linear([0.0; 3]), [0.0, 0.0, 0.0]));
        assert!(close(to_opponent([1.0; 3]), [100.0, 0.0, 0.0]));
        // 18 % grey: L* = 116 * 0.18^(1/3) - 16 = 49.4961.
        assert!((hunt_of_linear([0.18; 3])[0] - 49.496_107).abs() < 1e-6);
    }

    #[test]
    fn redistribution_hits_its_ends_and_its_knee() {
        assert_eq!(redistribute(0.0, 40.0), 0.0);
        assert_eq!(redistribute(16.0, 40.0), 0.95);
        assert_eq!(redistribute(40.0, 40.0), 1.0);
        // Half the knee, half its value; f64 rounding.
        assert!((redistribute(8.0, 40.0) - 0.475).abs() < 1e-15);
    }

    proptest! {
        #[test]
        fn opponent_space_goes_there_and_back(rgb in prop::array::uniform3(0.0f64..=1.0)) {
            let (direct, around) = (hunt_of_linear(rgb), to_hunt_lab(to_opponent(rgb)));
            for (direct, around) in direct.iter().zip(around) {
                // The cube root near zero multiplies an f64 rounding by at most 500 * 7.8.
                prop_assert!((direct - around).abs() < 1e-10);
            }
        }

        #[test]
        fn green_and_blue_are_the_farthest_colours(
            a in prop::array::uniform3(0.0f64..=1.0), b in prop::array::uniform3(0.0f64..=1.0),
        ) {
            prop_assert!(difference(hunt_of_linear(a), hunt_of_linear(b)) <= largest_difference());
        }
    }
}
