//! Mean structural similarity: Wang, Bovik, Sheikh, Simoncelli, "Image quality assessment: from error visibility
//! to structural similarity", IEEE TIP 13(4), 2004.
//!
//! Computed on the sRGB-encoded luminance of the display image, which lies in [0, 1] (L = 1), with the paper's
//! 11×11 Gaussian of σ 1.5, K1 = 0.01 and K2 = 0.03, population variances, and the mean over whole windows only.
//! Deviation for images narrower than a window: the radius on that axis shrinks to `(size - 1) / 2` and the
//! Gaussian is normalised anew, so that every size has an answer.

use super::convolve::{Plane, filter_columns, filter_rows, gaussian, normalised};
use super::pair::{Pair, Side};
use crate::post::image::Image;
use crate::post::tonemap::Display;
use crate::post::{PostError, srgb};

/// Rows of windows that are filtered at once, so that memory does not grow with the image.
const BAND_ROWS: usize = 64;
const RADIUS: usize = 5;
const SIGMA: f64 = 1.5;
const C1: f64 = 0.01 * 0.01;
const C2: f64 = 0.03 * 0.03;

/// MSSIM in [-1, 1]; 1 means equal display luminance.
///
/// # Errors
/// [`PostError::SizeMismatch`], [`PostError::NoFinitePixels`].
pub fn mssim(test: &Image, reference: &Image, display: &Display) -> Result<f64, PostError> {
    of_pair(&Pair::new(test, reference)?, display)
}

pub(super) fn of_pair(pair: &Pair, display: &Display) -> Result<f64, PostError> {
    let window = Window::of_image(pair.width(), pair.height());
    let whole_windows = pair.height() - 2 * window.radius_y();
    let (mut sum, mut windows) = (0.0, 0u64);
    for first in (0..whole_windows).step_by(BAND_ROWS) {
        let rows = BAND_ROWS.min(whole_windows - first);
        let band = Band::new(pair, display, &window, first, rows);
        for index in 0..band.mean_x.values.len() {
            let (column, row) = (index % band.mean_x.width, first + index / band.mean_x.width);
            let centre = (row + window.radius_y()) * pair.width() + column + window.radius_x();
            if !pair.is_excluded(centre) {
                sum += band.similarity(index);
                windows += 1;
            }
        }
    }
    if windows == 0 { Err(pair.nothing_left()) } else { Ok(sum / windows as f64) }
}

/// Local moments of both images for some rows of windows.
struct Band {
    mean_x: Plane,
    mean_r: Plane,
    mean_xx: Plane,
    mean_rr: Plane,
    mean_xr: Plane,
}

impl Band {
    fn new(pair: &Pair, display: &Display, window: &Window, first: usize, rows: usize) -> Self {
        let height = rows + 2 * window.radius_y();
        let encoded_luminance = |side| {
            Plane::from_fn(pair.width(), height, |x, y| {
                let index = (first + y) * pair.width() + x;
                srgb::encode(srgb::luminance(pair.shown(side, display, index)))
            })
        };
        let (x, r) = (encoded_luminance(Side::Test), encoded_luminance(Side::Reference));
        Self {
            mean_x: window.filter(&x),
            mean_r: window.filter(&r),
            mean_xx: window.filter(&product(&x, &x)),
            mean_rr: window.filter(&product(&r, &r)),
            mean_xr: window.filter(&product(&x, &r)),
        }
    }

    /// SSIM of one window: the paper's eq. 13.
    fn similarity(&self, index: usize) -> f64 {
        let (mx, mr) = (self.mean_x.values[index], self.mean_r.values[index]);
        let variance_x = self.mean_xx.values[index] - mx * mx;
        let variance_r = self.mean_rr.values[index] - mr * mr;
        let covariance = self.mean_xr.values[index] - mx * mr;
        let luminance = (2.0 * (mx * mr) + C1) / (mx * mx + mr * mr + C1);
        let structure = (2.0 * covariance + C2) / (variance_x + variance_r + C2);
        luminance * structure
    }
}

struct Window {
    horizontal: Vec<f64>,
    vertical: Vec<f64>,
}

impl Window {
    fn of_image(width: usize, height: usize) -> Self {
        let axis = |size: usize| normalised(gaussian(SIGMA, RADIUS.min((size - 1) / 2)));
        Self { horizontal: axis(width), vertical: axis(height) }
    }

    fn filter(&self, plane: &Plane) -> Plane {
        filter_columns(&filter_rows(plane, &self.horizontal), &self.vertical)
    }

    fn radius_x(&self) -> usize {
        self.horizontal.len() / 2
    }

    fn radius_y(&self) -> usize {
        self.vertical.len() / 2
    }
}

fn product(a: &Plane, b: &Plane) -> Plane {
    let values = a.values.iter().zip(&b.values).map(|(a, b)| a * b).collect();
    Plane { width: a.width, height: a.height, values }
}
