//! Deterministic parallel loops: chunks whose size doesn't depend on the number of threads, results by index.

use crate::simd::{Isa, Kernel, dispatch};
use rayon::prelude::*;
use std::marker::PhantomData;
use std::sync::{Mutex, PoisonError};

/// Elements per task of [`fill_chunks`] where each is a ray: enough to hide the cost of a task, few enough to balance uneven rays.
pub(crate) const RAYS: usize = 256;

/// Runs, for every chunk of `out`, of `chunk` elements but for the last, the kernel that `kernel` makes of the chunk's first index and
/// the chunk.
pub(crate) fn fill_chunks<'a, T, K>(
    isa: Isa,
    chunk: usize,
    out: &'a mut [T],
    kernel: impl Fn(usize, &'a mut [T]) -> K + Sync,
) where
    T: Send,
    K: Kernel<Output = ()>,
{
    out.par_chunks_mut(chunk)
        .enumerate()
        .for_each(|(number, elements)| dispatch(isa, kernel(number * chunk, elements)));
}

/// Hands the items to the pool's threads one at a time and strictly in order: when an item is begun, every earlier one
/// has been.
pub(crate) fn in_order<I>(items: I, work: impl Fn(I::Item) + Sync)
where
    I: Iterator + Send,
    I::Item: Send,
{
    let queue = Mutex::new(items);
    let drain = || {
        loop {
            // The lock is released before the work: a panic in it can't poison the queue.
            let next = queue.lock().unwrap_or_else(PoisonError::into_inner).next();
            match next {
                Some(item) => work(item),
                None => return,
            }
        }
    };
    rayon::scope(|scope| (0..rayon::current_num_threads()).for_each(|_| scope.spawn(|_| drain())));
}

/// A slice that threads write to at places that they know to be theirs alone.
pub(crate) struct Scattered<'a, T> {
    start: *mut T,
    len: usize,
    borrow: PhantomData<&'a mut [T]>,
}

// SAFETY: elements are only ever written, by `write`, whose caller promises that no two threads write the same one.
// T: Send makes writing from another thread sound.
unsafe impl<T: Send> Sync for Scattered<'_, T> {}

impl<'a, T: Copy> Scattered<'a, T> {
    pub(crate) fn new(slice: &'a mut [T]) -> Self {
        Self { start: slice.as_mut_ptr(), len: slice.len(), borrow: PhantomData }
    }

    /// Writes one element.
    ///
    /// # Safety
    /// `index` is inside the slice, and no other thread writes the same element meanwhile.
    #[inline(always)]
    pub(crate) unsafe fn write(&self, index: usize, value: T) {
        debug_assert!(index < self.len);
        // SAFETY: the caller's promise; the slice is borrowed mutably for as long as this lives.
        unsafe { self.start.add(index).write(value) }
    }
}
