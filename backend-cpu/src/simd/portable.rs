//! Lanes as arrays.

use super::{LaneMask, Lanes, Width, words};
use std::ops::{Add, BitAnd, BitOr, BitXor, Div, Mul, Sub};

/// Token of the portable width.
#[derive(Debug, Clone, Copy)]
pub struct Portable;

impl Width for Portable {
    type F4 = Array<4>;
    type F8 = Array<8>;
    type U8 = words::Array<Portable>;
}

/// N lanes.
#[derive(Clone, Copy)]
pub struct Array<const N: usize>([f32; N]);

/// N truth values, lane i in bit i.
#[derive(Clone, Copy)]
pub struct Bits(u32);

impl<const N: usize> Array<N> {
    #[inline(always)]
    fn zip(self, other: Self, f: impl Fn(f32, f32) -> f32) -> Self {
        Array(std::array::from_fn(|i| f(self.0[i], other.0[i])))
    }

    #[inline(always)]
    fn compare(self, other: Self, f: impl Fn(f32, f32) -> bool) -> Bits {
        Bits((0..N).fold(0, |bits, i| bits | u32::from(f(self.0[i], other.0[i])) << i))
    }
}

macro_rules! operators {
    ($($trait:ident $method:ident $op:tt),*) => {$(
        impl<const N: usize> $trait for Array<N> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                self.zip(other, |a, b| a $op b)
            }
        }
    )*};
}
operators!(Add add +, Sub sub -, Mul mul *, Div div /);

macro_rules! mask_operators {
    ($($trait:ident $method:ident $op:tt),*) => {$(
        impl $trait for Bits {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Bits(self.0 $op other.0)
            }
        }
    )*};
}
mask_operators!(BitAnd bitand &, BitOr bitor |, BitXor bitxor ^);

impl LaneMask for Bits {
    #[inline(always)]
    fn bits(self) -> u32 {
        self.0
    }
}

impl<const N: usize> Lanes for Array<N> {
    type Token = Portable;
    type Array = [f32; N];
    type Mask = Bits;

    #[inline(always)]
    fn splat(_: Portable, value: f32) -> Self {
        Array([value; N])
    }
    #[inline(always)]
    fn load(_: Portable, from: &[f32; N]) -> Self {
        Array(*from)
    }
    #[inline(always)]
    fn to_array(self) -> [f32; N] {
        self.0
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Array(self.0.map(f32::abs))
    }
    #[inline(always)]
    fn minimum(self, other: Self) -> Self {
        self.zip(other, |a, b| if a < b { a } else { b })
    }
    #[inline(always)]
    fn maximum(self, other: Self) -> Self {
        self.zip(other, |a, b| if a > b { a } else { b })
    }
    #[inline(always)]
    fn select(self, mask: Bits, other: Self) -> Self {
        Array(std::array::from_fn(|i| if mask.0 >> i & 1 == 1 { self.0[i] } else { other.0[i] }))
    }
    #[inline(always)]
    fn lt(self, other: Self) -> Bits {
        self.compare(other, |a, b| a < b)
    }
    #[inline(always)]
    fn le(self, other: Self) -> Bits {
        self.compare(other, |a, b| a <= b)
    }
}
