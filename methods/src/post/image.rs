//! Images of linear radiance and maps of one value per pixel.

use super::PostError;

/// Linear RGB radiance (Rec. 709 primaries, W·m⁻²·sr⁻¹ up to the scene's scale), row-major from the top-left.
///
/// Values may be negative or non-finite: an image that a renderer got wrong must be representable, or nothing
/// could report it. [`Image::non_finite_count`] counts such pixels; every metric states what it does with them.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    width: u32,
    height: u32,
    pixels: Vec<[f32; 3]>,
}

impl Image {
    /// Takes ownership of `pixels`, row-major from the top-left.
    ///
    /// # Errors
    /// [`PostError::ZeroSize`], [`PostError::TooLarge`], [`PostError::PixelCount`].
    pub fn new(width: u32, height: u32, pixels: Vec<[f32; 3]>) -> Result<Self, PostError> {
        let needed = pixel_count(width, height)?;
        if pixels.len() != needed {
            return Err(PostError::PixelCount { width, height, needed, found: pixels.len() });
        }
        Ok(Self { width, height, pixels })
    }

    /// An image of one colour.
    ///
    /// # Errors
    /// As [`Image::new`].
    pub fn filled(width: u32, height: u32, colour: [f32; 3]) -> Result<Self, PostError> {
        Self::new(width, height, vec![colour; pixel_count(width, height)?])
    }

    /// An image from a function of column and row.
    ///
    /// # Errors
    /// As [`Image::new`].
    pub fn from_fn(
        width: u32,
        height: u32,
        mut colour: impl FnMut(u32, u32) -> [f32; 3],
    ) -> Result<Self, PostError> {
        let mut pixels = Vec::with_capacity(pixel_count(width, height)?);
        for y in 0..height {
            for x in 0..width {
                pixels.push(colour(x, y));
            }
        }
        Self::new(width, height, pixels)
    }

    /// Pixels per row.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Rows.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// All pixels, row-major from the top-left.
    pub fn pixels(&self) -> &[[f32; 3]] {
        &self.pixels
    }

    /// Gives the pixels back.
    pub fn into_pixels(self) -> Vec<[f32; 3]> {
        self.pixels
    }

    /// Pixels with a NaN or an infinity in any channel.
    pub fn non_finite_count(&self) -> u64 {
        self.pixels.iter().filter(|pixel| !is_finite(pixel)).count() as u64
    }

    /// `Err(SizeMismatch)` unless both images have one size.
    pub(crate) fn expect_same_size(&self, other: &Self) -> Result<(), PostError> {
        let (left, right) = ((self.width, self.height), (other.width, other.height));
        if left == right { Ok(()) } else { Err(PostError::SizeMismatch { left, right }) }
    }
}

/// One value per pixel, row-major from the top-left. NaN marks a pixel that was left out.
#[derive(Clone, Debug, PartialEq)]
pub struct ErrorMap {
    width: u32,
    height: u32,
    values: Vec<f32>,
}

impl ErrorMap {
    /// Takes ownership of `values`, row-major from the top-left.
    ///
    /// # Errors
    /// As [`Image::new`].
    pub fn new(width: u32, height: u32, values: Vec<f32>) -> Result<Self, PostError> {
        let needed = pixel_count(width, height)?;
        if values.len() != needed {
            return Err(PostError::PixelCount { width, height, needed, found: values.len() });
        }
        Ok(Self { width, height, values })
    }

    /// Pixels per row.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Rows.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// All values, row-major from the top-left.
    pub fn values(&self) -> &[f32] {
        &self.values
    }

    /// The largest value that is not NaN; `None` if there is none.
    pub fn max(&self) -> Option<f32> {
        self.values.iter().copied().filter(|value| !value.is_nan()).reduce(f32::max)
    }
}

/// Whether no channel is NaN or infinite.
pub(super) fn is_finite(pixel: &[f32; 3]) -> bool {
    pixel.iter().all(|value| value.is_finite())
}

/// Checked before anything is allocated, so that an absurd header cannot abort the process.
fn pixel_count(width: u32, height: u32) -> Result<usize, PostError> {
    if width == 0 || height == 0 {
        return Err(PostError::ZeroSize { width, height });
    }
    let bytes = u128::from(width) * u128::from(height) * size_of::<[f32; 3]>() as u128;
    if bytes > isize::MAX as u128 {
        return Err(PostError::TooLarge { width, height });
    }
    Ok(width as usize * height as usize)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn constructor_rejects_every_wrong_size() {
        assert_eq!(Image::new(0, 3, vec![]), Err(PostError::ZeroSize { width: 0, height: 3 }));
        assert_eq!(Image::new(3, 0, vec![]), Err(PostError::ZeroSize { width: 3, height: 0 }));
        assert_eq!(
            Image::new(2, 2, vec![[0.0; 3]; 3]),
            Err(PostError::PixelCount { width: 2, height: 2, needed: 4, found: 3 })
        );
        assert_eq!(
            Image::filled(u32::MAX, u32::MAX, [0.0; 3]),
            Err(PostError::TooLarge { width: u32::MAX, height: u32::MAX })
        );
        assert_eq!(
            ErrorMap::new(2, 1, vec![0.0]),
            Err(PostError::PixelCount { width: 2, height: 1, needed: 2, found: 1 })
        );
    }

    #[test]
    fn rows_run_from_the_top_left() {
        let image = Image::from_fn(3, 2, |x, y| [x as f32, y as f32, 0.0]).unwrap();
        assert_eq!(image.pixels()[4], [1.0, 1.0, 0.0]);
        assert_eq!((image.width(), image.height()), (3, 2));
        assert_eq!(image.into_pixels().len(), 6);
    }

    #[test]
    fn non_finite_pixels_are_counted_once_each() {
        let image =
            Image::new(3, 1, vec![[f32::NAN, f32::INFINITY, 0.0], [1.0; 3], [0.0, 0.0, f32::NEG_INFINITY]])
                .unwrap();
        assert_eq!(image.non_finite_count(), 2);
    }

    #[test]
    fn largest_value_skips_nan() {
        let max = |values: Vec<f32>| ErrorMap::new(values.len() as u32, 1, values).unwrap().max();
        assert_eq!(max(vec![f32::NAN, 0.25, 0.5, f32::NAN]), Some(0.5));
        assert_eq!(max(vec![f32::NAN]), None);
    }
}
