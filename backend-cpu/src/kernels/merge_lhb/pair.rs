//! The same lists of both inputs, as one.

use super::lists::{BLOCK, Lists};
use std::ops::Range;
use twinlight_core::Result;
use twinlight_core::kernels::merge_lhb::MergeLhbParams;
use twinlight_core::kernels::rasterize_lhb::{CAP_FAR, LhbElement};

/// What is read beyond the last list.
const NOTHING: LhbElement = LhbElement { surface: 0, depth: 0 };

/// A chunk's lists.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pair<'a> {
    pub(super) kept: Lists<'a>,
    pub(super) added: Lists<'a>,
    pub(super) params: &'a MergeLhbParams,
}

impl Pair<'_> {
    /// Elements without a cap.
    pub(super) fn len(&self) -> u64 {
        self.kept.element_count() + self.added.element_count()
    }

    /// Applies the cap: writes where each list ends, from the first's begin on and modulo 2³², and what is left out of it; returns the
    /// number of elements.
    ///
    /// # Errors
    /// [`twinlight_core::Error::InvalidInput`] for offsets that fall.
    pub(super) fn size(&self, ends: &mut [u32], left_out: &mut [u32]) -> Result<u64> {
        self.kept.expect_rising()?;
        self.added.expect_rising()?;
        let before = self.kept.left_out.iter().zip(self.added.left_out);
        let lens = self.kept.offsets.windows(2).zip(self.added.offsets.windows(2));
        let cap = u64::from(self.params.layer_cap);
        let mut sum = 0;
        for (((end, left_out), (k, a)), (kept, added)) in ends.iter_mut().zip(left_out).zip(before).zip(lens)
        {
            let len = u64::from(kept[1] - kept[0]) + u64::from(added[1] - added[0]);
            let stays = len.min(cap);
            sum += stays;
            *end = sum as u32;
            *left_out = k.wrapping_add(*a).wrapping_add((len - stays) as u32);
        }
        Ok(sum)
    }

    /// Moves the ends that `size` wrote to where the chunk begins.
    pub(super) fn shift(&self, ends: &mut [u32], begin: u32) {
        ends.iter_mut().for_each(|end| *end = end.wrapping_add(begin));
    }

    /// Writes where each list ends without a cap: where both inputs' do.
    ///
    /// # Errors
    /// [`twinlight_core::Error::InvalidInput`] for offsets that fall.
    pub(super) fn add(&self, ends: &mut [u32]) -> Result<()> {
        self.kept.expect_rising()?;
        self.added.expect_rising()?;
        let offsets = self.kept.offsets[1..].iter().zip(&self.added.offsets[1..]);
        ends.iter_mut().zip(offsets).for_each(|(end, (kept, added))| *end = kept.wrapping_add(*added));
        Ok(())
    }

    /// Fills the lists, the first of which begins at `begin` and which end at `ends`.
    pub(super) fn merge(&self, begin: u32, ends: &[u32], out: &mut [LhbElement]) {
        let place = |list: usize| if list == 0 { 0 } else { (ends[list - 1] - begin) as usize };
        let mut list = 0;
        while list < ends.len() {
            let next = ends.len().min(list + BLOCK).max(self.one_sided_to(list));
            if !self.copy(list..next, &mut out[place(list)..place(next)]) {
                for list in list..next {
                    self.merge_list(list, &mut out[place(list)..place(list + 1)]);
                }
            }
            list = next;
        }
    }

    /// Where the blocks of lists from `list` on end that are empty in the same one of the inputs.
    #[inline(always)]
    fn one_sided_to(&self, list: usize) -> usize {
        let end = self.added.empty_to(list);
        if end > list { end } else { self.kept.empty_to(list) }
    }

    /// Copies lists that only one of the inputs has and no cap cuts; whether they are such.
    #[inline(always)]
    fn copy(&self, lists: Range<usize>, out: &mut [LhbElement]) -> bool {
        let kept = &self.kept.elements[self.kept.places(lists.clone())];
        let added = &self.added.elements[self.added.places(lists)];
        if added.is_empty() && kept.len() == out.len() {
            out.copy_from_slice(kept);
        } else if kept.is_empty() && added.len() == out.len() {
            out.iter_mut().zip(added).for_each(|(out, element)| *out = self.renumbered(element));
        } else {
            return false;
        }
        true
    }

    /// Fills a list, element by element.
    #[inline(always)]
    fn merge_list(&self, list: usize, out: &mut [LhbElement]) {
        let (mut kept, mut added) = (self.kept.places(list..list + 1), self.added.places(list..list + 1));
        if self.params.cap_side == CAP_FAR {
            for _ in out.len()..kept.len() + added.len() {
                self.next(&mut kept, &mut added);
            }
        }
        out.iter_mut().for_each(|out| *out = self.next(&mut kept, &mut added));
    }

    /// Takes the next element of those that are left in two lists. Without a branch on what can't be foreseen: beyond the end of
    /// a list is another list, or nothing, and either goes unused.
    #[inline(always)]
    fn next(&self, kept: &mut Range<usize>, added: &mut Range<usize>) -> LhbElement {
        let at = |elements: &[LhbElement], i: usize| elements.get(i).copied().unwrap_or(NOTHING);
        let (a, b) = (at(self.kept.elements, kept.start), at(self.added.elements, added.start));
        let is_added = (kept.start == kept.end) | ((added.start < added.end) & (b.depth < a.depth));
        kept.start += usize::from(!is_added);
        added.start += usize::from(is_added);
        let renumbered = self.renumbered(&b);
        LhbElement {
            surface: if is_added { renumbered.surface } else { a.surface },
            depth: if is_added { b.depth } else { a.depth },
        }
    }

    #[inline(always)]
    fn renumbered(&self, added: &LhbElement) -> LhbElement {
        LhbElement { surface: added.surface.wrapping_add(2 * self.params.first_triangle), depth: added.depth }
    }
}
