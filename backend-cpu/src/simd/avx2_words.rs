//! Eight lanes of `u32` in an AVX register.

use super::{Avx2, Words};
use std::arch::x86_64::{
    __m256i, _mm_cvtsi32_si128, _mm256_add_epi32, _mm256_and_si256, _mm256_blend_epi32, _mm256_castsi256_ps,
    _mm256_cmpeq_epi32, _mm256_cmpgt_epi32, _mm256_cvtepi32_ps, _mm256_loadu_si256, _mm256_madd_epi16,
    _mm256_max_epi32, _mm256_min_epi32, _mm256_movemask_ps, _mm256_mul_ps, _mm256_mullo_epi32,
    _mm256_or_si256, _mm256_permute2x128_si256, _mm256_set1_epi8, _mm256_set1_epi32, _mm256_set1_ps,
    _mm256_setr_epi8, _mm256_setzero_si256, _mm256_shuffle_epi8, _mm256_sra_epi32, _mm256_srai_epi32,
    _mm256_srl_epi32, _mm256_srli_epi16, _mm256_srli_epi32, _mm256_storeu_ps, _mm256_storeu_si256,
    _mm256_sub_epi32, _mm256_unpackhi_epi32, _mm256_unpackhi_epi64, _mm256_unpacklo_epi32,
    _mm256_unpacklo_epi64, _mm256_xor_si256,
};
use std::ops::{Add, BitAnd, BitXor, Mul, Sub};

/// Eight words. Only made from an [`Avx2`], or from other words.
#[derive(Clone, Copy)]
pub struct U8(__m256i);

macro_rules! operators {
    ($($trait:ident $method:ident $intrinsic:ident),*) => {$(
        impl $trait for U8 {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                // SAFETY: words exist, so a token existed, so the processor has AVX2.
                U8(unsafe { $intrinsic(self.0, other.0) })
            }
        }
    )*};
}
operators!(
    Add add _mm256_add_epi32,
    Sub sub _mm256_sub_epi32,
    Mul mul _mm256_mullo_epi32,
    BitAnd bitand _mm256_and_si256,
    BitXor bitxor _mm256_xor_si256
);

impl Words for U8 {
    type Token = Avx2;

    #[inline(always)]
    fn splat(_: Avx2, value: u32) -> Self {
        // SAFETY: the token exists, so the processor has AVX2.
        U8(unsafe { _mm256_set1_epi32(value as i32) })
    }
    #[inline(always)]
    fn load(_: Avx2, from: &[u32; 8]) -> Self {
        // SAFETY: the token exists, so the processor has AVX2; the load is unaligned and inside the array.
        U8(unsafe { _mm256_loadu_si256(from.as_ptr().cast()) })
    }
    #[inline(always)]
    fn to_array(self) -> [u32; 8] {
        let mut out = [0; 8];
        // SAFETY: words exist, so the processor has AVX2; the store is unaligned and inside the array.
        unsafe { _mm256_storeu_si256(out.as_mut_ptr().cast(), self.0) };
        out
    }
    #[inline(always)]
    fn shift_right<const BITS: i32>(self) -> Self {
        // SAFETY: words exist, so the processor has AVX2.
        U8(unsafe { _mm256_srli_epi32::<BITS>(self.0) })
    }
    #[inline(always)]
    fn shift_right_by(self, bits: u32) -> Self {
        // SAFETY: words exist, so the processor has AVX2.
        U8(unsafe { _mm256_srl_epi32(self.0, _mm_cvtsi32_si128(bits as i32)) })
    }
    #[inline(always)]
    fn shift_right_signed<const BITS: i32>(self) -> Self {
        // SAFETY: words exist, so the processor has AVX2.
        U8(unsafe { _mm256_srai_epi32::<BITS>(self.0) })
    }
    #[inline(always)]
    fn shift_right_signed_by(self, bits: u32) -> Self {
        // SAFETY: words exist, so the processor has AVX2.
        U8(unsafe { _mm256_sra_epi32(self.0, _mm_cvtsi32_si128(bits as i32)) })
    }
    #[inline(always)]
    fn dot_halves(self, other: Self) -> Self {
        // SAFETY: words exist, so the processor has AVX2.
        U8(unsafe { _mm256_madd_epi16(self.0, other.0) })
    }
    #[inline(always)]
    fn least_signed(self, other: Self) -> Self {
        // SAFETY: words exist, so the processor has AVX2.
        U8(unsafe { _mm256_min_epi32(self.0, other.0) })
    }
    #[inline(always)]
    fn greatest_signed(self, other: Self) -> Self {
        // SAFETY: words exist, so the processor has AVX2.
        U8(unsafe { _mm256_max_epi32(self.0, other.0) })
    }
    #[inline(always)]
    fn clamp_signed(self, edge: Self) -> Self {
        // SAFETY: words exist, so the processor has AVX2.
        U8(unsafe { _mm256_min_epi32(_mm256_max_epi32(self.0, _mm256_setzero_si256()), edge.0) })
    }
    #[inline(always)]
    fn greater_signed(self, other: Self) -> u32 {
        // SAFETY: words exist, so the processor has AVX2.
        unsafe { _mm256_movemask_ps(_mm256_castsi256_ps(_mm256_cmpgt_epi32(self.0, other.0))) as u32 }
    }
    #[inline(always)]
    fn equal(self, other: Self) -> u32 {
        // SAFETY: words exist, so the processor has AVX2.
        unsafe { _mm256_movemask_ps(_mm256_castsi256_ps(_mm256_cmpeq_epi32(self.0, other.0))) as u32 }
    }
    #[inline(always)]
    fn transpose([a, b, c, d, e, f, g, h]: [Self; 8]) -> [Self; 8] {
        let (left, right) = (transpose_halves([a, b, c, d]), transpose_halves([e, f, g, h]));
        // SAFETY: words exist, so the processor has AVX2.
        unsafe {
            [
                U8(_mm256_permute2x128_si256::<0x20>(left[0], right[0])),
                U8(_mm256_permute2x128_si256::<0x20>(left[1], right[1])),
                U8(_mm256_permute2x128_si256::<0x20>(left[2], right[2])),
                U8(_mm256_permute2x128_si256::<0x20>(left[3], right[3])),
                U8(_mm256_permute2x128_si256::<0x31>(left[0], right[0])),
                U8(_mm256_permute2x128_si256::<0x31>(left[1], right[1])),
                U8(_mm256_permute2x128_si256::<0x31>(left[2], right[2])),
                U8(_mm256_permute2x128_si256::<0x31>(left[3], right[3])),
            ]
        }
    }
    /// Bytes are reversed by one shuffle, the halves of each byte by looking up their reversals in another.
    #[inline(always)]
    fn reverse_bits(self) -> Self {
        // SAFETY: words exist, so the processor has AVX2.
        unsafe {
            #[rustfmt::skip]
            let bytes = _mm256_setr_epi8(
                3, 2, 1, 0, 7, 6, 5, 4, 11, 10, 9, 8, 15, 14, 13, 12,
                3, 2, 1, 0, 7, 6, 5, 4, 11, 10, 9, 8, 15, 14, 13, 12,
            );
            #[rustfmt::skip]
            let reversed = _mm256_setr_epi8(
                0, 8, 4, 12, 2, 10, 6, 14, 1, 9, 5, 13, 3, 11, 7, 15,
                0, 8, 4, 12, 2, 10, 6, 14, 1, 9, 5, 13, 3, 11, 7, 15,
            );
            #[rustfmt::skip]
            let reversed_high = _mm256_setr_epi8(
                0, -128, 64, -64, 32, -96, 96, -32, 16, -112, 80, -48, 48, -80, 112, -16,
                0, -128, 64, -64, 32, -96, 96, -32, 16, -112, 80, -48, 48, -80, 112, -16,
            );
            let half = _mm256_set1_epi8(0x0f);
            let swapped = _mm256_shuffle_epi8(self.0, bytes);
            let low = _mm256_and_si256(swapped, half);
            let high = _mm256_and_si256(_mm256_srli_epi16::<4>(swapped), half);
            U8(_mm256_or_si256(_mm256_shuffle_epi8(reversed_high, low), _mm256_shuffle_epi8(reversed, high)))
        }
    }
    #[inline(always)]
    fn lower_then_upper(self, upper: Self) -> Self {
        // SAFETY: words exist, so the processor has AVX2.
        U8(unsafe { _mm256_blend_epi32::<0xf0>(self.0, upper.0) })
    }
    #[inline(always)]
    fn to_units(self) -> [f32; 8] {
        let mut out = [0.0; 8];
        // SAFETY: words exist, so the processor has AVX2; the store is unaligned and inside the array.
        unsafe {
            // 24 bits fit a positive i32 and an f32: both conversions are exact.
            let whole = _mm256_cvtepi32_ps(_mm256_srli_epi32::<8>(self.0));
            let units = _mm256_mul_ps(whole, _mm256_set1_ps(twinlight_core::math::hash::UNIT));
            _mm256_storeu_ps(out.as_mut_ptr(), units);
        }
        out
    }
}

/// The two 4 × 4 blocks of four rows, transposed each.
#[inline(always)]
fn transpose_halves([a, b, c, d]: [U8; 4]) -> [__m256i; 4] {
    // SAFETY: words exist, so the processor has AVX2.
    unsafe {
        let (ab_low, ab_high) = (_mm256_unpacklo_epi32(a.0, b.0), _mm256_unpackhi_epi32(a.0, b.0));
        let (cd_low, cd_high) = (_mm256_unpacklo_epi32(c.0, d.0), _mm256_unpackhi_epi32(c.0, d.0));
        [
            _mm256_unpacklo_epi64(ab_low, cd_low),
            _mm256_unpackhi_epi64(ab_low, cd_low),
            _mm256_unpacklo_epi64(ab_high, cd_high),
            _mm256_unpackhi_epi64(ab_high, cd_high),
        ]
    }
}
