//! Error maps as pictures: a dark-to-light colour ramp.

use super::PostError;
use super::image::ErrorMap;

/// Nine sRGB anchors, equally spaced; between them the ramp is linear.
///
/// Computed in CIELAB: lightness rises evenly from 2 to 98 while the hue turns from 285° (blue) over magenta and
/// orange to 100° (yellow), with the chroma reduced to what sRGB can show. Lightness alone orders the values, so
/// the picture survives grey-scale printing and every common colour blindness.
const RAMP: [[u8; 3]; 9] = [
    [3, 6, 23],
    [42, 26, 76],
    [109, 18, 107],
    [175, 0, 109],
    [229, 31, 95],
    [254, 98, 82],
    [255, 158, 98],
    [253, 208, 145],
    [255, 250, 227],
];

/// Colour of a pixel that was left out of the comparison (NaN in the map): a green that the ramp never comes near.
pub const LEFT_OUT: [u8; 3] = [0, 255, 0];

/// Colour of `t` in [0, 1], dark to light. Values outside are clamped, NaN becomes [`LEFT_OUT`].
pub fn ramp(t: f32) -> [u8; 3] {
    if t.is_nan() {
        return LEFT_OUT;
    }
    let last = RAMP.len() - 1;
    let position = f64::from(t.clamp(0.0, 1.0)) * last as f64;
    let below = (position as usize).min(last - 1);
    let fraction = position - below as f64;
    std::array::from_fn(|channel| {
        let (low, high) = (f64::from(RAMP[below][channel]), f64::from(RAMP[below + 1][channel]));
        (low + (high - low) * fraction + 0.5) as u8
    })
}

/// The map as 8-bit sRGB, row-major from the top-left; a value of `white` (and more) is the ramp's light end.
/// Use 1 for ꟻLIP, whose scale is absolute, and [`ErrorMap::max`] for maps without a scale of their own.
///
/// # Errors
/// [`PostError::OutOfRange`] if `white` is not a positive finite number.
pub fn false_colour(map: &ErrorMap, white: f32) -> Result<Vec<[u8; 3]>, PostError> {
    if !(white.is_finite() && white > 0.0) {
        let range = "the positive finite numbers";
        return Err(PostError::OutOfRange { name: "white", range, value: f64::from(white) });
    }
    Ok(map.values().iter().map(|&value| ramp(value / white)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::post::srgb;

    #[test]
    fn ends_anchors_and_midpoints() {
        assert_eq!(ramp(0.0), RAMP[0]);
        assert_eq!(ramp(1.0), RAMP[8]);
        assert_eq!(ramp(0.5), RAMP[4]);
        // Halfway between the first two anchors, halves rounded up.
        assert_eq!(ramp(1.0 / 16.0), [23, 16, 50]);
        assert_eq!(ramp(-2.0), RAMP[0]);
        assert_eq!(ramp(f32::INFINITY), RAMP[8]);
        assert_eq!(ramp(f32::NAN), LEFT_OUT);
    }

    #[test]
    fn luminance_rises_along_the_ramp() {
        let luminance = |colour: [u8; 3]| srgb::luminance(colour.map(|c| srgb::decode(f64::from(c) / 255.0)));
        let steps: Vec<f64> = (0..=64).map(|i| luminance(ramp(i as f32 / 64.0))).collect();
        assert!(steps.windows(2).all(|pair| pair[0] < pair[1]), "{steps:?}");
    }

    #[test]
    fn map_is_scaled_by_white() {
        let map = ErrorMap::new(4, 1, vec![0.0, 1.0, 2.0, f32::NAN]).unwrap();
        assert_eq!(false_colour(&map, 2.0).unwrap(), [RAMP[0], RAMP[4], RAMP[8], LEFT_OUT]);
        for white in [0.0, -1.0, f32::NAN, f32::INFINITY] {
            assert!(matches!(false_colour(&map, white), Err(PostError::OutOfRange { .. })));
        }
    }
}
