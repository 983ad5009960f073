//! The sRGB transfer function (IEC 61966-2-1) and the luminance of Rec. 709 primaries. For the host: kernels look encoded
//! bytes up in a table.

/// Linear value in [0, 1] to sRGB-encoded value in [0, 1]. The piecewise curve, not a power of 2.2.
#[must_use]
pub fn encode(linear: f64) -> f64 {
    if linear <= 0.0031308 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

/// sRGB-encoded value in [0, 1] to linear value in [0, 1]; the inverse of [`encode`].
#[must_use]
pub fn decode(encoded: f64) -> f64 {
    if encoded <= 0.04045 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

/// Linear value to the nearest of the 256 sRGB codes; clamped, NaN becomes 0.
#[must_use]
pub fn encode_u8(linear: f64) -> u8 {
    // `as` saturates and turns NaN into 0; the half makes it round to nearest.
    (encode(linear.clamp(0.0, 1.0)) * 255.0 + 0.5) as u8
}

/// Relative luminance Y of linear Rec. 709 RGB.
#[must_use]
pub fn luminance(rgb: [f64; 3]) -> f64 {
    0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_codes() {
        // 0.5 linear encodes to 0.735357 (code 188); 18 % grey to 118; the knee at 0.0031308 to 10.31.
        assert_eq!(encode_u8(0.5), 188);
        assert_eq!(encode_u8(0.18), 118);
        assert_eq!(encode_u8(0.0031308), 10);
        assert_eq!((encode_u8(0.0), encode_u8(1.0)), (0, 255));
        assert_eq!((encode_u8(-3.0), encode_u8(7.0)), (0, 255));
        assert_eq!((encode_u8(f64::NAN), encode_u8(f64::INFINITY)), (0, 255));
    }

    #[test]
    fn every_code_survives_a_round_trip() {
        for code in 0..=255u8 {
            assert_eq!(encode_u8(decode(f64::from(code) / 255.0)), code);
        }
    }

    #[test]
    fn both_pieces_meet_at_the_knee() {
        // The standard's rounded constants leave a step of about 2e-8 in the curve; a wrong piece leaves far more.
        assert!((encode(0.0031308) - encode(0.003130801)).abs() < 1e-6);
        assert!((decode(0.04045) - decode(0.040450001)).abs() < 1e-6);
    }

    #[test]
    fn white_has_luminance_one() {
        // Sum of three decimal weights in f64: a few ulp.
        assert!((luminance([1.0; 3]) - 1.0).abs() < 1e-15);
    }
}
