//! From radiance to what a display shows: exposure, tone curve, sRGB.

use super::image::Image;
use super::{PostError, srgb};

/// The tone curve, applied after exposure.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Operator {
    /// Clamp to [0, 1]. The default of every comparison: it bends nothing, so numbers stay comparable.
    #[default]
    None,
    /// Colour / (1 + luminance), Reinhard et al. 2002, eq. 3; keeps hue.
    Reinhard,
    /// Narkowicz's fit of the ACES filmic curve (2015), per channel.
    Aces,
}

impl Operator {
    /// All operators.
    pub const ALL: [Self; 3] = [Self::None, Self::Reinhard, Self::Aces];

    /// The word that selects the operator on a command line.
    pub fn key(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Reinhard => "reinhard",
            Self::Aces => "aces",
        }
    }

    /// The curve, for printing; `x` is exposed radiance.
    pub fn formula(self) -> &'static str {
        match self {
            Self::None => "x",
            Self::Reinhard => "x / (1 + Y(x))",
            Self::Aces => "x (2.51 x + 0.03) / (x (2.43 x + 0.59) + 0.14)",
        }
    }

    fn apply(self, x: [f64; 3]) -> [f64; 3] {
        match self {
            Self::None => x,
            Self::Reinhard => {
                let scale = 1.0 / (1.0 + srgb::luminance(x));
                x.map(|value| value * scale)
            }
            Self::Aces => x.map(|v| (v * (2.51 * v + 0.03)) / (v * (2.43 * v + 0.59) + 0.14)),
        }
    }
}

impl std::str::FromStr for Operator {
    type Err = PostError;

    fn from_str(key: &str) -> Result<Self, PostError> {
        let found = Self::ALL.into_iter().find(|operator| operator.key() == key);
        found.ok_or_else(|| PostError::UnknownOperator(key.to_owned()))
    }
}

/// Exposure and tone curve together: the display that an image is judged on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Display {
    exposure_stops: f64,
    scale: f64,
    operator: Operator,
}

impl Default for Display {
    fn default() -> Self {
        Self { exposure_stops: 0.0, scale: 1.0, operator: Operator::None }
    }
}

impl Display {
    /// Radiance is multiplied by `2^exposure_stops` before the tone curve.
    ///
    /// # Errors
    /// [`PostError::OutOfRange`] if `exposure_stops` is not within ±64: beyond, squares of `f32` radiance in the
    /// curves would leave the range of `f64`'s comfortable half and a typing error is the likely cause.
    pub fn new(exposure_stops: f64, operator: Operator) -> Result<Self, PostError> {
        if !(-64.0..=64.0).contains(&exposure_stops) {
            return Err(PostError::OutOfRange {
                name: "exposure",
                range: "-64..=64 stops",
                value: exposure_stops,
            });
        }
        Ok(Self { exposure_stops, scale: exposure_stops.exp2(), operator })
    }

    /// Stops of exposure.
    pub fn exposure_stops(&self) -> f64 {
        self.exposure_stops
    }

    /// The tone curve.
    pub fn operator(&self) -> Operator {
        self.operator
    }

    /// The tone-mapped colour T of the metrics' formulas, in words, for printing beside them.
    pub fn formula(&self) -> String {
        let (curve, stops) = (self.operator.formula(), self.exposure_stops);
        format!("T = {curve}, clamped to [0, 1]; x = 2^{stops} radiance")
    }

    /// Radiance to linear display values in [0, 1]. NaN and negative values become 0, +inf the curve's end.
    pub fn map(&self, radiance: [f32; 3]) -> [f64; 3] {
        // inf would give inf/inf in the curves; the largest f32 lands on the same display value.
        let exposed = radiance.map(|value| f64::from(clean(value)) * self.scale);
        self.operator.apply(exposed).map(|value| value.clamp(0.0, 1.0))
    }

    /// The image as 8-bit sRGB, row-major from the top-left.
    pub fn to_srgb8(&self, image: &Image) -> Vec<[u8; 3]> {
        image.pixels().iter().map(|&pixel| self.map(pixel).map(srgb::encode_u8)).collect()
    }
}

fn clean(value: f32) -> f32 {
    if value > 0.0 { value.min(f32::MAX) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn display(stops: f64, operator: Operator) -> Display {
        Display::new(stops, operator).unwrap()
    }

    #[test]
    fn known_answers() {
        assert_eq!(display(0.0, Operator::None).map([0.25, 1.0, 4.0]), [0.25, 1.0, 1.0]);
        assert_eq!(display(2.0, Operator::None).map([0.125, 0.0, -1.0]), [0.5, 0.0, 0.0]);
        // Grey 3: luminance 3, so 3 / 4. Weights sum to 1 within f64 rounding.
        for value in display(0.0, Operator::Reinhard).map([3.0; 3]) {
            assert!((value - 0.75).abs() < 1e-15);
        }
        // x = 1: 2.54 / 3.16, by hand.
        for value in display(0.0, Operator::Aces).map([1.0; 3]) {
            assert!((value - 2.54 / 3.16).abs() < 1e-15);
        }
    }

    #[test]
    fn picture_of_every_awkward_value() {
        let pixels = vec![[f32::NAN, f32::INFINITY, f32::NEG_INFINITY], [0.5, f32::MAX, f32::MIN_POSITIVE]];
        let image = Image::new(2, 1, pixels).unwrap();
        assert_eq!(display(0.0, Operator::None).to_srgb8(&image), [[0, 255, 0], [188, 255, 0]]);
        // The ACES fit exceeds 1 far out (2.51 / 2.43) and is clamped; 64 stops must not overflow into NaN.
        assert_eq!(display(64.0, Operator::Aces).to_srgb8(&image)[0], [0, 255, 0]);
    }

    #[test]
    fn exposure_outside_its_range_is_an_error() {
        for stops in [64.5, -64.5, f64::NAN, f64::INFINITY] {
            assert!(matches!(Display::new(stops, Operator::None), Err(PostError::OutOfRange { .. })));
        }
    }

    #[test]
    fn keys_parse_back() {
        for operator in Operator::ALL {
            assert_eq!(operator.key().parse(), Ok(operator));
        }
        let formula = "T = x / (1 + Y(x)), clamped to [0, 1]; x = 2^-1.5 radiance";
        assert_eq!(display(-1.5, Operator::Reinhard).formula(), formula);
        assert_eq!("filmic".parse::<Operator>(), Err(PostError::UnknownOperator("filmic".into())));
    }

    proptest! {
        #[test]
        fn curves_are_monotone_and_stay_on_the_display(
            dark in 0.0f32..50.0, factor in 1.0f32..100.0, stops in -8.0f64..8.0, which in 0usize..3,
        ) {
            let display = display(stops, Operator::ALL[which]);
            let (low, high) = (display.map([dark; 3]), display.map([dark * factor; 3]));
            for (low, high) in low.into_iter().zip(high) {
                // Monotone up to rounding of the rational curve.
                prop_assert!((0.0..=1.0).contains(&low) && low <= high + 1e-12);
            }
        }

        #[test]
        fn one_stop_doubles(value in 0.0f32..0.4, which in 0usize..3) {
            let operator = Operator::ALL[which];
            // Doubling is exact in both formats, so the results are equal, not close.
            prop_assert_eq!(display(1.0, operator).map([value; 3]), display(0.0, operator).map([2.0 * value; 3]));
        }
    }
}
