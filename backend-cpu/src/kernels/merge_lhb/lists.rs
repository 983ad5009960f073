//! Lists of one of the inputs.

use crate::CpuBackend;
use std::ops::Range;
use twinlight_core::kernels::rasterize_lhb::{Lhb, LhbElement};
use twinlight_core::{Error, Result};

/// Lists that are copied together or not at all: fewer aren't worth the question whether they can be.
pub(super) const BLOCK: usize = 8;

/// Consecutive lists.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lists<'a> {
    /// Where each begins, and where the last ends.
    pub(super) offsets: &'a [u32],
    /// From where the first begins to where the last ends.
    pub(super) elements: &'a [LhbElement],
    /// Empty without a cap.
    pub(super) left_out: &'a [u32],
}

impl<'a> Lists<'a> {
    /// All lists, whose offsets are known to be one more.
    ///
    /// # Errors
    /// [`Error::InvalidInput`] where they don't begin before they end, inside the elements.
    pub(super) fn of(lhb: &'a Lhb<CpuBackend>) -> Result<Self> {
        let (offsets, elements) = (lhb.offsets.as_slice(), lhb.elements.as_slice());
        let left_out = lhb.left_out.as_slice();
        let (first, last) = (offsets[0] as usize, offsets[offsets.len() - 1] as usize);
        let elements = elements.get(first..last).ok_or_else(malformed)?;
        Ok(Self { offsets, elements, left_out })
    }

    /// Some of these lists.
    ///
    /// # Errors
    /// As [`Lists::of`].
    pub(super) fn part(&self, lists: Range<usize>) -> Result<Self> {
        let at = |list: usize| self.offsets[list].checked_sub(self.offsets[0]).ok_or_else(malformed);
        let (first, last) = (at(lists.start)? as usize, at(lists.end)? as usize);
        let elements = self.elements.get(first..last).ok_or_else(malformed)?;
        let left_out = self.left_out.get(lists.clone()).unwrap_or_default();
        Ok(Self { offsets: &self.offsets[lists.start..=lists.end], elements, left_out })
    }

    /// Number of lists.
    pub(super) fn len(&self) -> usize {
        self.offsets.len() - 1
    }

    /// Where the first list begins.
    pub(super) fn begin(&self) -> u64 {
        self.offsets[0].into()
    }

    /// Elements of all lists.
    pub(super) fn element_count(&self) -> u64 {
        self.elements.len() as u64
    }

    /// Whether every list begins before it ends. Until that is known, only `part` and the sums above may be asked for.
    ///
    /// # Errors
    /// [`Error::InvalidInput`] where one doesn't.
    pub(super) fn expect_rising(&self) -> Result<()> {
        // Without an early exit, so that offsets are compared many at a time.
        let rising = self.offsets.iter().zip(&self.offsets[1..]).fold(true, |all, (a, b)| all & (a <= b));
        if rising { Ok(()) } else { Err(malformed()) }
    }

    /// Where some lists begin and end in `elements`.
    #[inline(always)]
    pub(super) fn places(&self, lists: Range<usize>) -> Range<usize> {
        let at = |list: usize| (self.offsets[list] - self.offsets[0]) as usize;
        at(lists.start)..at(lists.end)
    }

    /// Where the blocks of empty lists from `list` on end.
    #[inline(always)]
    pub(super) fn empty_to(&self, list: usize) -> usize {
        let mut end = list;
        while end < self.len() {
            let next = self.len().min(end + BLOCK);
            // Offsets rise: between two that are equal there is no other.
            if self.offsets[next] != self.offsets[list] {
                break;
            }
            end = next;
        }
        end
    }
}

fn malformed() -> Error {
    Error::invalid("merge_lhb", "offsets fall or leave their elements")
}
