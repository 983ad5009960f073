//! Eight lanes in an AVX register.

use super::avx2_words::U8;
use super::sse2::F4;
use super::{Kernel, LaneMask, Lanes, Width};
use std::arch::x86_64::{
    __m256, _CMP_LE_OQ, _CMP_LT_OQ, _mm256_add_ps, _mm256_and_ps, _mm256_andnot_ps, _mm256_blendv_ps,
    _mm256_cmp_ps, _mm256_div_ps, _mm256_loadu_ps, _mm256_max_ps, _mm256_min_ps, _mm256_movemask_ps,
    _mm256_mul_ps, _mm256_or_ps, _mm256_set1_ps, _mm256_storeu_ps, _mm256_sub_ps, _mm256_xor_ps,
};
use std::ops::{Add, BitAnd, BitOr, BitXor, Div, Mul, Sub};

/// Token of AVX2, BMI1, BMI2, LZCNT and POPCNT; exists only where the processor has them.
#[derive(Debug, Clone, Copy)]
pub struct Avx2(());

impl Avx2 {
    /// The token, if this processor and system support the instructions.
    #[inline]
    #[must_use]
    pub fn detect() -> Option<Self> {
        let found = is_x86_feature_detected!("avx2")
            && is_x86_feature_detected!("bmi1")
            && is_x86_feature_detected!("bmi2")
            && is_x86_feature_detected!("lzcnt")
            && is_x86_feature_detected!("popcnt");
        found.then_some(Avx2(()))
    }
}

/// Runs `kernel` in a function compiled for AVX2.
#[inline]
pub(super) fn run<K: Kernel>(width: Avx2, kernel: K) -> K::Output {
    #[target_feature(enable = "avx2,bmi1,bmi2,lzcnt,popcnt")]
    fn inside<K: Kernel>(width: Avx2, kernel: K) -> K::Output {
        kernel.run(width)
    }
    // SAFETY: the token exists, so the processor has these features.
    unsafe { inside(width, kernel) }
}

impl Width for Avx2 {
    type F4 = F4<Avx2>;
    type F8 = F8;
    type U8 = U8;
}

/// Eight lanes. Only made from an [`Avx2`], or from other lanes.
#[derive(Clone, Copy)]
pub struct F8(__m256);

/// Eight truth values. Only made from [`F8`].
#[derive(Clone, Copy)]
pub struct M8(__m256);

macro_rules! operators {
    ($($wrapper:ident $trait:ident $method:ident $intrinsic:ident),*) => {$(
        impl $trait for $wrapper {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                // SAFETY: lanes exist, so a token existed, so the processor has AVX2.
                $wrapper(unsafe { $intrinsic(self.0, other.0) })
            }
        }
    )*};
}
operators!(
    F8 Add add _mm256_add_ps,
    F8 Sub sub _mm256_sub_ps,
    F8 Mul mul _mm256_mul_ps,
    F8 Div div _mm256_div_ps,
    M8 BitAnd bitand _mm256_and_ps,
    M8 BitOr bitor _mm256_or_ps,
    M8 BitXor bitxor _mm256_xor_ps
);

impl LaneMask for M8 {
    #[inline(always)]
    fn bits(self) -> u32 {
        // SAFETY: a mask exists, so the processor has AVX2.
        unsafe { _mm256_movemask_ps(self.0) as u32 }
    }
}

impl Lanes for F8 {
    type Token = Avx2;
    type Array = [f32; 8];
    type Mask = M8;

    #[inline(always)]
    fn splat(_: Avx2, value: f32) -> Self {
        // SAFETY: the token exists, so the processor has AVX2.
        F8(unsafe { _mm256_set1_ps(value) })
    }
    #[inline(always)]
    fn load(_: Avx2, from: &[f32; 8]) -> Self {
        // SAFETY: the token exists, so the processor has AVX2; the load is unaligned and inside the array.
        F8(unsafe { _mm256_loadu_ps(from.as_ptr()) })
    }
    #[inline(always)]
    fn to_array(self) -> [f32; 8] {
        let mut out = [0.0; 8];
        // SAFETY: lanes exist, so the processor has AVX2; the store is unaligned and inside the array.
        unsafe { _mm256_storeu_ps(out.as_mut_ptr(), self.0) };
        out
    }
    #[inline(always)]
    fn abs(self) -> Self {
        // SAFETY: lanes exist, so the processor has AVX2.
        F8(unsafe { _mm256_andnot_ps(_mm256_set1_ps(-0.0), self.0) })
    }
    #[inline(always)]
    fn minimum(self, other: Self) -> Self {
        // SAFETY: lanes exist, so the processor has AVX2.
        F8(unsafe { _mm256_min_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn maximum(self, other: Self) -> Self {
        // SAFETY: lanes exist, so the processor has AVX2.
        F8(unsafe { _mm256_max_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn select(self, mask: M8, other: Self) -> Self {
        // SAFETY: lanes exist, so the processor has AVX2.
        F8(unsafe { _mm256_blendv_ps(other.0, self.0, mask.0) })
    }
    #[inline(always)]
    fn lt(self, other: Self) -> M8 {
        // SAFETY: lanes exist, so the processor has AVX2.
        M8(unsafe { _mm256_cmp_ps::<_CMP_LT_OQ>(self.0, other.0) })
    }
    #[inline(always)]
    fn le(self, other: Self) -> M8 {
        // SAFETY: lanes exist, so the processor has AVX2.
        M8(unsafe { _mm256_cmp_ps::<_CMP_LE_OQ>(self.0, other.0) })
    }
}
