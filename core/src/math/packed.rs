//! Elements of layered hit buffers in a word, and back; see [`crate::kernels::pack_lhb`]. Twin: `backend-gpu/src/shared/packed.wgsl`.

use crate::kernels::pack_lhb::{DEPTH_SHIFT, LAST_BIN, SURFACE_BITS};
use crate::kernels::rasterize_lhb::LhbElement;

/// An element of a triangle below [`crate::kernels::pack_lhb::MAX_TRIANGLES`], as a word.
#[inline(always)]
pub fn packed_element(element: LhbElement) -> u32 {
    let bin = (element.depth >> DEPTH_SHIFT).min(LAST_BIN);
    bin << SURFACE_BITS | element.surface
}

/// A word as an element, in the middle of its depths.
#[inline(always)]
pub fn unpacked_element(word: u32) -> LhbElement {
    let surface = word & ((1 << SURFACE_BITS) - 1);
    let bin = word >> SURFACE_BITS;
    LhbElement { surface, depth: (bin << DEPTH_SHIFT) + (1 << (DEPTH_SHIFT - 1)) }
}
