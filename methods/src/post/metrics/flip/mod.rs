//! LDR-ꟻLIP: Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström, Fairchild, "ꟻLIP: A Difference Evaluator for
//! Alternating Images", Proc. ACM Comput. Graph. Interact. Tech. 3(2), 2020 (section numbers below are its own).
//!
//! What a viewer notices when two images are flipped on one screen: a colour difference after the eye's blur
//! (4.1), amplified where edges or points differ (4.2), per pixel in [0, 1].
//!
//! The input is the linear colour of a [`Display`], clamped to [0, 1]. Deviations from the paper: none in the
//! formulas; all filters are evaluated as sums of separable ones (they are, exactly), and everything is `f64`.

mod colour;
mod filters;

use super::convolve::{Plane, filter_columns, filter_rows};
use super::pair::{Pair, Side};
use crate::post::PostError;
use crate::post::image::{ErrorMap, Image};
use crate::post::tonemap::Display;
use colour::{Hunt, to_hunt_lab, to_opponent};
use filters::Filters;

/// The paper's viewer: 0.7 m from a 3840-pixel screen that is 0.7 m wide (about 67).
pub const DEFAULT_PIXELS_PER_DEGREE: f64 = 3840.0 * std::f64::consts::PI / 180.0;

/// Rows that are filtered at once: planes stay in the second-level cache, and memory does not grow with the image.
const BAND_ROWS: usize = 64;

/// Mean and map of ꟻLIP.
#[derive(Clone, Debug, PartialEq)]
pub struct Flip {
    /// Mean over the compared pixels, in [0, 1].
    pub mean: f64,
    /// Error of every pixel in [0, 1]; NaN where a pixel was left out.
    pub map: ErrorMap,
}

/// LDR-ꟻLIP of two images on a display, seen at `pixels_per_degree`.
///
/// # Errors
/// [`PostError::SizeMismatch`], [`PostError::NoFinitePixels`], and [`PostError::OutOfRange`] unless
/// `pixels_per_degree` is in 1..=1000: below, the filters are narrower than a pixel; above, wider than any screen.
pub fn flip(
    test: &Image,
    reference: &Image,
    display: &Display,
    pixels_per_degree: f64,
) -> Result<Flip, PostError> {
    of_pair(&Pair::new(test, reference)?, display, pixels_per_degree)
}

pub(super) fn of_pair(pair: &Pair, display: &Display, pixels_per_degree: f64) -> Result<Flip, PostError> {
    if !(1.0..=1000.0).contains(&pixels_per_degree) {
        let value = pixels_per_degree;
        return Err(PostError::OutOfRange { name: "pixels per degree", range: "1..=1000", value });
    }
    let filters = Filters::new(pixels_per_degree);
    let largest = colour::largest_difference();
    let (width, height) = (pair.width(), pair.height());
    let mut values = Vec::with_capacity(width * height);
    let mut sum = 0.0;
    for first in (0..height).step_by(BAND_ROWS) {
        let rows = BAND_ROWS.min(height - first);
        let [test, reference] =
            [Side::Test, Side::Reference].map(|side| Seen::band(pair, side, display, &filters, first, rows));
        for index in 0..rows * width {
            if pair.is_excluded(first * width + index) {
                values.push(f32::NAN);
                continue;
            }
            let error = pixel_error(&test, &reference, index, largest);
            sum += error;
            values.push(error as f32);
        }
    }
    let map = ErrorMap::new(width as u32, height as u32, values)?;
    Ok(Flip { mean: sum / pair.compared as f64, map })
}

/// One image as the model sees it: perceived colour, and the strength of edges and points.
struct Seen {
    colours: Vec<Hunt>,
    edges: Vec<f64>,
    points: Vec<f64>,
}

impl Seen {
    /// `rows` rows from `first` on. The image is continued by its border pixels.
    fn band(
        pair: &Pair,
        side: Side,
        display: &Display,
        filters: &Filters,
        first: usize,
        rows: usize,
    ) -> Self {
        let [achromatic, red_green, blue_yellow] = opponent_band(pair, side, display, filters, first, rows);
        let blurred = [
            filters.achromatic.apply(&achromatic),
            filters.red_green.apply(&red_green),
            filters.blue_yellow.apply(&blue_yellow),
        ];
        let colours = (0..blurred[0].values.len())
            .map(|i| to_hunt_lab([blurred[0].values[i], blurred[1].values[i], blurred[2].values[i]]))
            .collect();

        // 4.2: Y of the opponent space brought to [0, 1]; the constant drops out of both zero-sum filters.
        let [smooth, edge, point] = [&filters.feature_blur, &filters.edge, &filters.point];
        let smooth_rows = filter_rows(&achromatic, smooth);
        let strength = |kernel: &Vec<f64>| {
            let x = filter_columns(&filter_rows(&achromatic, kernel), smooth);
            let y = filter_columns(&smooth_rows, kernel);
            let norm = |(x, y): (&f64, &f64)| (x * x + y * y).sqrt() / 116.0;
            x.values.iter().zip(&y.values).map(norm).collect()
        };
        Self { colours, edges: strength(edge), points: strength(point) }
    }
}

/// The opponent planes of a band, padded by the filters' radius on every side.
fn opponent_band(
    pair: &Pair,
    side: Side,
    display: &Display,
    filters: &Filters,
    first: usize,
    rows: usize,
) -> [Plane; 3] {
    let radius = filters.radius;
    let (width, height) = (pair.width() + 2 * radius, rows + 2 * radius);
    let clamped = |position: usize, size: usize| position.saturating_sub(radius).min(size - 1);
    let mut planes = [(); 3].map(|()| Plane { width, height, values: Vec::with_capacity(width * height) });
    for y in 0..height {
        let row = clamped(first + y, pair.height()) * pair.width();
        let line: Vec<[f64; 3]> =
            (0..pair.width()).map(|x| to_opponent(pair.shown(side, display, row + x))).collect();
        for (channel, plane) in planes.iter_mut().enumerate() {
            plane.values.extend((0..width).map(|x| line[clamped(x, pair.width())][channel]));
        }
    }
    planes
}

/// Colour difference (4.1.3) raised to one minus the feature difference (4.3).
fn pixel_error(test: &Seen, reference: &Seen, index: usize, largest: f64) -> f64 {
    let colour =
        colour::redistribute(colour::difference(test.colours[index], reference.colours[index]), largest);
    let edge = (test.edges[index] - reference.edges[index]).abs();
    let point = (test.points[index] - reference.points[index]).abs();
    let feature = (edge.max(point) * std::f64::consts::FRAC_1_SQRT_2).sqrt();
    colour.powf(1.0 - feature)
}
