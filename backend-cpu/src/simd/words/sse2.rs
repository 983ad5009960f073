//! By SSE2, which every x86-64 has.

use std::arch::x86_64::{
    __m128i, _mm_cmpgt_epi32, _mm_madd_epi16, _mm_movemask_epi8, _mm_packs_epi16, _mm_packs_epi32,
};

#[inline(always)]
pub(super) fn dot_halves(a: [u32; 8], b: [u32; 8]) -> [u32; 8] {
    let (a, b): ([__m128i; 2], [__m128i; 2]) = (bytemuck::cast(a), bytemuck::cast(b));
    // SAFETY: x86-64 has SSE2.
    bytemuck::cast(unsafe { [_mm_madd_epi16(a[0], b[0]), _mm_madd_epi16(a[1], b[1])] })
}

#[inline(always)]
pub(super) fn greater_signed(a: [u32; 8], b: [u32; 8]) -> u32 {
    let (a, b): ([__m128i; 2], [__m128i; 2]) = (bytemuck::cast(a), bytemuck::cast(b));
    // SAFETY: x86-64 has SSE2.
    unsafe {
        let words = _mm_packs_epi32(_mm_cmpgt_epi32(a[0], b[0]), _mm_cmpgt_epi32(a[1], b[1]));
        _mm_movemask_epi8(_mm_packs_epi16(words, words)) as u32 & 0xff
    }
}
