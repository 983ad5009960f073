//! The one error type of [`crate::post`].

/// Why an image could not be made, compared or shown.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PostError {
    /// A width or a height of zero: there is nothing to compare or show.
    #[error("an image of {width}x{height} pixels has no pixels")]
    ZeroSize {
        /// Pixels per row.
        width: u32,
        /// Rows.
        height: u32,
    },
    /// `width * height` does not fit the address space.
    #[error("an image of {width}x{height} pixels is too large for this machine")]
    TooLarge {
        /// Pixels per row.
        width: u32,
        /// Rows.
        height: u32,
    },
    /// The pixel array does not have `width * height` entries.
    #[error("an image of {width}x{height} needs {needed} pixels, got {found}")]
    PixelCount {
        /// Pixels per row.
        width: u32,
        /// Rows.
        height: u32,
        /// `width * height`.
        needed: usize,
        /// Entries of the array that was given.
        found: usize,
    },
    /// Two images that must have one size have two.
    #[error("the images differ in size: {}x{} against {}x{}", left.0, left.1, right.0, right.1)]
    SizeMismatch {
        /// Width and height of the first image.
        left: (u32, u32),
        /// Width and height of the second image.
        right: (u32, u32),
    },
    /// Every pixel (or every window of a windowed metric) holds a NaN or an infinity in one of the images.
    #[error("no pixel is finite in both images: {test} of the first and {reference} of the second are not")]
    NoFinitePixels {
        /// Non-finite pixels of the test image.
        test: u64,
        /// Non-finite pixels of the reference image.
        reference: u64,
    },
    /// A variance below zero is no variance.
    #[error("the variance at pixel ({x}, {y}), channel {channel} is negative: {value}")]
    NegativeVariance {
        /// Column, from the left.
        x: u32,
        /// Row, from the top.
        y: u32,
        /// 0 red, 1 green, 2 blue.
        channel: usize,
        /// The value found.
        value: f32,
    },
    /// A setting lies outside its range.
    #[error("{name} must be in {range}, got {value}")]
    OutOfRange {
        /// The setting.
        name: &'static str,
        /// Its range, in words.
        range: &'static str,
        /// The value given.
        value: f64,
    },
    /// No metric has this key.
    #[error("no metric is called '{0}'")]
    UnknownMetric(String),
    /// No tone curve has this key.
    #[error("no tone operator is called '{0}' (none, reinhard, aces)")]
    UnknownOperator(String),
}
