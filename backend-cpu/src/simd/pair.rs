//! Eight lanes as two vectors of four.

use super::{LaneMask, Lanes};
use std::ops::{Add, BitAnd, BitOr, BitXor, Div, Mul, Sub};

/// Lanes 0 to 3 and 4 to 7; of lanes or of masks.
#[derive(Clone, Copy)]
pub struct Pair<T>(T, T);

macro_rules! operators {
    ($($trait:ident $method:ident),*) => {$(
        impl<T: $trait<Output = T>> $trait for Pair<T> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Pair(self.0.$method(other.0), self.1.$method(other.1))
            }
        }
    )*};
}
operators!(Add add, Sub sub, Mul mul, Div div, BitAnd bitand, BitOr bitor, BitXor bitxor);

impl<M: LaneMask> LaneMask for Pair<M> {
    #[inline(always)]
    fn bits(self) -> u32 {
        self.0.bits() | self.1.bits() << 4
    }
}

impl<L: Lanes<Array = [f32; 4]>> Lanes for Pair<L> {
    type Token = L::Token;
    type Array = [f32; 8];
    type Mask = Pair<L::Mask>;

    #[inline(always)]
    fn splat(token: L::Token, value: f32) -> Self {
        let half = L::splat(token, value);
        Pair(half, half)
    }
    #[inline(always)]
    fn load(token: L::Token, &[a, b, c, d, e, f, g, h]: &[f32; 8]) -> Self {
        Pair(L::load(token, &[a, b, c, d]), L::load(token, &[e, f, g, h]))
    }
    #[inline(always)]
    fn to_array(self) -> [f32; 8] {
        let ([a, b, c, d], [e, f, g, h]) = (self.0.to_array(), self.1.to_array());
        [a, b, c, d, e, f, g, h]
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Pair(self.0.abs(), self.1.abs())
    }
    #[inline(always)]
    fn minimum(self, other: Self) -> Self {
        Pair(self.0.minimum(other.0), self.1.minimum(other.1))
    }
    #[inline(always)]
    fn maximum(self, other: Self) -> Self {
        Pair(self.0.maximum(other.0), self.1.maximum(other.1))
    }
    #[inline(always)]
    fn select(self, mask: Self::Mask, other: Self) -> Self {
        Pair(self.0.select(mask.0, other.0), self.1.select(mask.1, other.1))
    }
    #[inline(always)]
    fn lt(self, other: Self) -> Self::Mask {
        Pair(self.0.lt(other.0), self.1.lt(other.1))
    }
    #[inline(always)]
    fn le(self, other: Self) -> Self::Mask {
        Pair(self.0.le(other.0), self.1.le(other.1))
    }
}
