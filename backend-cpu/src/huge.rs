//! Pages of 2 MiB for large arrays: the first touch of 4 KiB costs a fault, and an array of 36 MB that is written once spends more time
//! in 9000 faults than in writing.

/// Smallest array worth a call to the system, bytes.
#[cfg(all(target_os = "linux", target_pointer_width = "64"))]
const LEAST: usize = 4 << 20;

/// Asks for large pages where the system gives them on request. Changes nothing that can be seen, and may do nothing.
#[cfg(all(target_os = "linux", target_pointer_width = "64"))]
pub(crate) fn advise<T>(array: &mut [T]) {
    /// Of every page size that 64-bit Linux has.
    const LARGEST_PAGE: usize = 1 << 16;
    const MADV_HUGEPAGE: i32 = 14;
    unsafe extern "C" {
        fn madvise(begin: *mut std::ffi::c_void, bytes: usize, advice: i32) -> i32;
    }
    let bytes = size_of_val(array);
    if bytes < LEAST {
        return;
    }
    let begin = array.as_mut_ptr().cast::<u8>();
    let skipped = begin.align_offset(LARGEST_PAGE);
    let pages = bytes.saturating_sub(skipped) / LARGEST_PAGE * LARGEST_PAGE;
    // SAFETY: the C library of Linux has this function; `begin + skipped` to `pages` bytes behind it are whole pages within `array`, and
    // the advice leaves their contents alone. A refusal is as good: pages stay as they are.
    unsafe {
        madvise(begin.wrapping_add(skipped).cast(), pages, MADV_HUGEPAGE);
    }
}

/// Elsewhere the system decides by itself.
#[cfg(not(all(target_os = "linux", target_pointer_width = "64")))]
pub(crate) fn advise<T>(_: &mut [T]) {}
