// Elements of layered hit buffers in a word, and back. Twin of core/src/math/packed.rs. Who includes this file has LhbElement.

const SURFACE_BITS: u32 = 21u;
const DEPTH_SHIFT: u32 = 19u;
const LAST_BIN: u32 = 2047u;

// An element of a triangle below the most that a word can number.
fn packed_element(element: LhbElement) -> u32 {
    let bin = min(element.depth >> DEPTH_SHIFT, LAST_BIN);
    return (bin << SURFACE_BITS) | element.surface;
}

// A word as an element, in the middle of its depths.
fn unpacked_element(word: u32) -> LhbElement {
    let surface = word & ((1u << SURFACE_BITS) - 1u);
    let bin = word >> SURFACE_BITS;
    return LhbElement(surface, (bin << DEPTH_SHIFT) + (1u << (DEPTH_SHIFT - 1u)));
}
