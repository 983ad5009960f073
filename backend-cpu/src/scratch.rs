//! Working memory that outlives a call: the system hands out fresh memory a page fault at a time, which costs a sort
//! more than a pass over the keys.

use crate::buffer::try_zeroed;
use std::fmt;
use std::sync::{Mutex, MutexGuard, PoisonError};
use twinlight_core::Result;

/// Keeps the largest block of words that calls have needed so far. Calls at the same time get blocks of their own.
#[derive(Default)]
pub(crate) struct Scratch(Mutex<Vec<u32>>);

impl Scratch {
    /// Calls `body` with `words` words of any content.
    ///
    /// # Errors
    /// [`twinlight_core::Error::OutOfMemory`]; whatever `body` returns.
    pub(crate) fn lend<R>(&self, words: usize, body: impl FnOnce(&mut [u32]) -> R) -> Result<R> {
        let mut block = std::mem::take(&mut *self.kept());
        if block.len() < words {
            // The short block goes first, so that both are never held.
            drop(block);
            block = try_zeroed(words)?;
        }
        let result = body(&mut block[..words]);
        let mut kept = self.kept();
        if kept.len() < block.len() {
            *kept = block;
        }
        Ok(result)
    }

    fn kept(&self) -> MutexGuard<'_, Vec<u32>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl fmt::Debug for Scratch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Scratch({} words)", self.kept().len())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_block_is_kept() {
        let scratch = Scratch::default();
        let first = scratch.lend(100, |words| words.as_ptr()).unwrap();
        assert_eq!(scratch.lend(60, |words| (words.as_ptr(), words.len())).unwrap(), (first, 60));
        let inner = scratch.lend(100, |outer| {
            outer.fill(7);
            scratch.lend(50, |inner| inner.fill(8)).unwrap();
            outer.iter().all(|&x| x == 7)
        });
        assert!(inner.unwrap(), "calls at the same time share nothing");
        assert_eq!(format!("{scratch:?}"), "Scratch(100 words)");
        assert!(scratch.lend(usize::MAX / 8, |_| ()).is_err());
        scratch.lend(3, |words| assert_eq!(words.len(), 3)).unwrap();
    }
}
