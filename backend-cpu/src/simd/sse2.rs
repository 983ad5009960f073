//! Four lanes in an SSE register. Every x86-64 processor has SSE2, so the token needs no proof.

use super::pair::Pair;
use super::{LaneMask, Lanes, Width, words};
use std::arch::x86_64::{
    __m128, _mm_add_ps, _mm_and_ps, _mm_andnot_ps, _mm_cmple_ps, _mm_cmplt_ps, _mm_div_ps, _mm_loadu_ps,
    _mm_max_ps, _mm_min_ps, _mm_movemask_ps, _mm_mul_ps, _mm_or_ps, _mm_set1_ps, _mm_storeu_ps, _mm_sub_ps,
    _mm_xor_ps,
};
use std::marker::PhantomData;
use std::ops::{Add, BitAnd, BitOr, BitXor, Div, Mul, Sub};

/// Token of SSE2.
#[derive(Debug, Clone, Copy)]
pub struct Sse2;

impl Width for Sse2 {
    type F4 = F4<Sse2>;
    type F8 = Pair<F4<Sse2>>;
    type U8 = words::Array<Sse2>;
}

/// Four lanes; `W` is the token of the width it serves, so that AVX2 code can use it too.
#[derive(Clone, Copy)]
pub struct F4<W>(__m128, PhantomData<W>);

/// Four truth values.
#[derive(Clone, Copy)]
pub struct M4(__m128);

macro_rules! operators {
    ($($trait:ident $method:ident $intrinsic:ident),*) => {$(
        impl<W> $trait for F4<W> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                // SAFETY: x86-64 has SSE2.
                F4(unsafe { $intrinsic(self.0, other.0) }, PhantomData)
            }
        }
    )*};
}
operators!(Add add _mm_add_ps, Sub sub _mm_sub_ps, Mul mul _mm_mul_ps, Div div _mm_div_ps);

macro_rules! mask_operators {
    ($($trait:ident $method:ident $intrinsic:ident),*) => {$(
        impl $trait for M4 {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                // SAFETY: x86-64 has SSE2.
                M4(unsafe { $intrinsic(self.0, other.0) })
            }
        }
    )*};
}
mask_operators!(BitAnd bitand _mm_and_ps, BitOr bitor _mm_or_ps, BitXor bitxor _mm_xor_ps);

impl LaneMask for M4 {
    #[inline(always)]
    fn bits(self) -> u32 {
        // SAFETY: x86-64 has SSE2.
        unsafe { _mm_movemask_ps(self.0) as u32 }
    }
}

impl<W: Copy> Lanes for F4<W> {
    type Token = W;
    type Array = [f32; 4];
    type Mask = M4;

    #[inline(always)]
    fn splat(_: W, value: f32) -> Self {
        // SAFETY: x86-64 has SSE2.
        F4(unsafe { _mm_set1_ps(value) }, PhantomData)
    }
    #[inline(always)]
    fn load(_: W, from: &[f32; 4]) -> Self {
        // SAFETY: x86-64 has SSE2; the load is unaligned and inside the array.
        F4(unsafe { _mm_loadu_ps(from.as_ptr()) }, PhantomData)
    }
    #[inline(always)]
    fn to_array(self) -> [f32; 4] {
        let mut out = [0.0; 4];
        // SAFETY: x86-64 has SSE2; the store is unaligned and inside the array.
        unsafe { _mm_storeu_ps(out.as_mut_ptr(), self.0) };
        out
    }
    #[inline(always)]
    fn abs(self) -> Self {
        // SAFETY: x86-64 has SSE2.
        F4(unsafe { _mm_andnot_ps(_mm_set1_ps(-0.0), self.0) }, PhantomData)
    }
    #[inline(always)]
    fn minimum(self, other: Self) -> Self {
        // SAFETY: x86-64 has SSE2.
        F4(unsafe { _mm_min_ps(self.0, other.0) }, PhantomData)
    }
    #[inline(always)]
    fn maximum(self, other: Self) -> Self {
        // SAFETY: x86-64 has SSE2.
        F4(unsafe { _mm_max_ps(self.0, other.0) }, PhantomData)
    }
    #[inline(always)]
    fn select(self, mask: M4, other: Self) -> Self {
        // SAFETY: x86-64 has SSE2.
        F4(unsafe { _mm_or_ps(_mm_and_ps(mask.0, self.0), _mm_andnot_ps(mask.0, other.0)) }, PhantomData)
    }
    #[inline(always)]
    fn lt(self, other: Self) -> M4 {
        // SAFETY: x86-64 has SSE2.
        M4(unsafe { _mm_cmplt_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn le(self, other: Self) -> M4 {
        // SAFETY: x86-64 has SSE2.
        M4(unsafe { _mm_cmple_ps(self.0, other.0) })
    }
}
