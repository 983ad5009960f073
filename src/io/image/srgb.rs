//! IEC 61966-2-1 in both directions.

/// Linear value in [0, 1] of an sRGB value in [0, 1].
pub fn srgb_to_linear(encoded: f32) -> f32 {
    let c = f64::from(encoded);
    let linear = if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) };
    linear as f32
}

/// The nearest 8-bit sRGB value of a linear value; outside [0, 1] the ends, for NaN 0.
pub fn linear_to_srgb(linear: f32) -> u8 {
    let c = f64::from(linear);
    let c = if c > 0.0 { c.min(1.0) } else { 0.0 };
    let encoded = if c <= 0.003_130_8 { c * 12.92 } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 };
    (encoded * 255.0 + 0.5) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_byte_survives_the_way_there_and_back() {
        for byte in 0..=255_u8 {
            assert_eq!(linear_to_srgb(srgb_to_linear(f32::from(byte) / 255.0)), byte);
        }
    }

    #[test]
    fn known_values_and_the_outside() {
        // 0.5 and 188/255 → 0.5028865 are the textbook pair.
        assert_eq!(linear_to_srgb(0.5), 188);
        assert!((srgb_to_linear(188.0 / 255.0) - 0.502_886_5).abs() < 1e-6);
        assert_eq!([f32::NAN, -1.0, f32::NEG_INFINITY].map(linear_to_srgb), [0; 3]);
        assert_eq!([1.0, 7.0, f32::INFINITY].map(linear_to_srgb), [255; 3]);
    }
}
