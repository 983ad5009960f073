//! Separable filters on planes of `f64`, whole windows only: a kernel of `2r + 1` taps shortens an axis by `2r`.
//!
//! Each output is a sum over taps in ascending order, whatever the size of the plane: deterministic. The loops run
//! tap by tap over whole rows so that the compiler can use vector registers without reordering a sum.

/// One value per pixel, row-major.
pub(super) struct Plane {
    pub width: usize,
    pub height: usize,
    pub values: Vec<f64>,
}

impl Plane {
    pub fn from_fn(width: usize, height: usize, mut value: impl FnMut(usize, usize) -> f64) -> Self {
        let mut values = Vec::with_capacity(width * height);
        for y in 0..height {
            for x in 0..width {
                values.push(value(x, y));
            }
        }
        Self { width, height, values }
    }

    pub fn row(&self, y: usize) -> &[f64] {
        &self.values[y * self.width..][..self.width]
    }
}

/// Correlates every row with `kernel`, which must not be longer than a row.
pub(super) fn filter_rows(plane: &Plane, kernel: &[f64]) -> Plane {
    let width = plane.width + 1 - kernel.len();
    let mut values = vec![0.0; width * plane.height];
    for (y, out) in values.chunks_exact_mut(width).enumerate() {
        for (tap, &weight) in kernel.iter().enumerate() {
            accumulate(out, &plane.row(y)[tap..][..width], weight);
        }
    }
    Plane { width, height: plane.height, values }
}

/// Correlates every column with `kernel`, which must not be longer than a column.
pub(super) fn filter_columns(plane: &Plane, kernel: &[f64]) -> Plane {
    let (width, height) = (plane.width, plane.height + 1 - kernel.len());
    let mut values = vec![0.0; width * height];
    for (y, out) in values.chunks_exact_mut(width).enumerate() {
        for (tap, &weight) in kernel.iter().enumerate() {
            accumulate(out, plane.row(y + tap), weight);
        }
    }
    Plane { width, height, values }
}

fn accumulate(sums: &mut [f64], values: &[f64], weight: f64) {
    for (sum, &value) in sums.iter_mut().zip(values) {
        *sum += weight * value;
    }
}

/// `exp(-i^2 / (2 sigma^2))` for `i` in `-radius..=radius`, not normalised.
pub(super) fn gaussian(sigma: f64, radius: usize) -> Vec<f64> {
    let falloff = -0.5 / (sigma * sigma);
    offsets(radius).map(|i| (i * i * falloff).exp()).collect()
}

/// `-radius..=radius` as floats.
pub(super) fn offsets(radius: usize) -> impl Iterator<Item = f64> {
    (0..=2 * radius).map(move |i| i as f64 - radius as f64)
}

/// Scales the kernel so that its sum is 1.
pub(super) fn normalised(mut kernel: Vec<f64>) -> Vec<f64> {
    let sum: f64 = kernel.iter().sum();
    kernel.iter_mut().for_each(|weight| *weight /= sum);
    kernel
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_and_columns_by_hand() {
        let plane = Plane { width: 4, height: 3, values: (1..=12).map(f64::from).collect() };
        let rows = filter_rows(&plane, &[1.0, 10.0, 100.0]);
        assert_eq!((rows.width, rows.height), (2, 3));
        assert_eq!(rows.values, [321.0, 432.0, 765.0, 876.0, 1209.0, 1320.0]);
        let columns = filter_columns(&plane, &[1.0, 0.0, 10.0]);
        assert_eq!((columns.width, columns.height), (4, 1));
        assert_eq!(columns.values, [91.0, 102.0, 113.0, 124.0]);
    }

    #[test]
    fn gaussian_is_symmetric_and_normalises() {
        let kernel = normalised(gaussian(1.5, 5));
        assert_eq!(kernel.len(), 11);
        for i in 0..5 {
            assert_eq!(kernel[i], kernel[10 - i]);
        }
        // Eleven f64 terms: a few ulp.
        assert!((kernel.iter().sum::<f64>() - 1.0).abs() < 1e-15);
        // exp(-1 / 4.5), by the definition.
        assert!((kernel[4] / kernel[5] - (-1.0f64 / 4.5).exp()).abs() < 1e-15);
    }
}
