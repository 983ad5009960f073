//! A mask that threads mark together.

use std::sync::atomic::{AtomicU32, Ordering};
use twinlight_core::math::morton::spread;

/// Words that all threads may set bits of.
pub(super) struct Marks<'a> {
    words: &'a [AtomicU32],
}

impl<'a> Marks<'a> {
    /// The words are nobody else's as long as this lives.
    pub(super) fn new(words: &'a mut [u32]) -> Self {
        let (start, len) = (words.as_mut_ptr().cast::<AtomicU32>(), words.len());
        // SAFETY: an `AtomicU32` has size, alignment and bits of a `u32`, and the exclusive borrow ends with this.
        Self { words: unsafe { std::slice::from_raw_parts(start, len) } }
    }

    /// Marks a voxel. Most have been marked by a neighbour before, and looking costs a twentieth of a locked operation.
    #[inline(always)]
    pub(super) fn set(&self, [x, y, z]: [i32; 3]) {
        let code = spread(x as u32) | spread(y as u32) << 1 | spread(z as u32) << 2;
        let (word, bit) = (&self.words[(code >> 5) as usize], 1 << (code & 31));
        if word.load(Ordering::Relaxed) & bit == 0 {
            word.fetch_or(bit, Ordering::Relaxed);
        }
    }
}
