//! Two images of one size and the pixels that both of them can be judged by.

use crate::post::PostError;
use crate::post::image::{Image, is_finite};
use crate::post::tonemap::Display;

/// Which image of a [`Pair`].
#[derive(Clone, Copy)]
pub(super) enum Side {
    Test,
    Reference,
}

/// The images of a comparison, checked.
pub(super) struct Pair<'a> {
    test: &'a Image,
    reference: &'a Image,
    excluded: Vec<bool>,
    pub compared: u64,
    pub non_finite_test: u64,
    pub non_finite_reference: u64,
}

impl<'a> Pair<'a> {
    /// `Err` if the sizes differ or no pixel is finite in both images.
    pub fn new(test: &'a Image, reference: &'a Image) -> Result<Self, PostError> {
        test.expect_same_size(reference)?;
        let both = test.pixels().iter().zip(reference.pixels());
        let excluded: Vec<bool> = both.map(|(x, r)| !is_finite(x) || !is_finite(r)).collect();
        let compared = excluded.iter().filter(|&&excluded| !excluded).count() as u64;
        let pair = Self {
            test,
            reference,
            excluded,
            compared,
            non_finite_test: test.non_finite_count(),
            non_finite_reference: reference.non_finite_count(),
        };
        if compared == 0 { Err(pair.nothing_left()) } else { Ok(pair) }
    }

    pub fn nothing_left(&self) -> PostError {
        PostError::NoFinitePixels { test: self.non_finite_test, reference: self.non_finite_reference }
    }

    pub fn width(&self) -> usize {
        self.test.width() as usize
    }

    pub fn height(&self) -> usize {
        self.test.height() as usize
    }

    pub fn is_excluded(&self, index: usize) -> bool {
        self.excluded[index]
    }

    /// Index, test and reference radiance of every pixel that is finite in both, in image order.
    pub fn compared_pixels(&self) -> impl Iterator<Item = (usize, [f32; 3], [f32; 3])> {
        let both = self.test.pixels().iter().zip(self.reference.pixels()).enumerate();
        both.filter(|&(index, _)| !self.excluded[index]).map(|(index, (&x, &r))| (index, x, r))
    }

    /// Pixels whose bits differ, non-finite ones included.
    pub fn differing(&self) -> u64 {
        let bits = |pixel: &[f32; 3]| pixel.map(f32::to_bits);
        let both = self.test.pixels().iter().zip(self.reference.pixels());
        both.filter(|(x, r)| bits(x) != bits(r)).count() as u64
    }

    /// Linear display colour; black where either image is non-finite, so that a window sees no difference there.
    pub fn shown(&self, side: Side, display: &Display, index: usize) -> [f64; 3] {
        if self.excluded[index] {
            return [0.0; 3];
        }
        display.map(match side {
            Side::Test => self.test.pixels()[index],
            Side::Reference => self.reference.pixels()[index],
        })
    }
}
