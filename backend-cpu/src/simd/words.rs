//! Eight lanes of `u32` as an array; what every instruction set without vector multiplication uses. The compiler makes vectors of
//! it; the operations in `ops` are those that it makes poor ones of.

#[cfg(any(test, not(target_arch = "x86_64")))]
mod plain;
#[cfg(target_arch = "x86_64")]
mod sse2;

#[cfg(not(target_arch = "x86_64"))]
use plain as ops;
#[cfg(target_arch = "x86_64")]
use sse2 as ops;

use super::Words;
use std::marker::PhantomData;
use std::ops::{Add, BitAnd, BitXor, Mul, Sub};

/// Eight words; `W` is the token of the width they serve.
#[derive(Clone, Copy)]
pub struct Array<W>([u32; 8], PhantomData<W>);

macro_rules! operators {
    ($($trait:ident $method:ident $word:ident),*) => {$(
        impl<W> $trait for Array<W> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Array(std::array::from_fn(|i| self.0[i].$word(other.0[i])), PhantomData)
            }
        }
    )*};
}
operators!(Add add wrapping_add, Sub sub wrapping_sub, Mul mul wrapping_mul, BitAnd bitand bitand, BitXor bitxor bitxor);

impl<W: Copy> Words for Array<W> {
    type Token = W;

    #[inline(always)]
    fn splat(_: W, value: u32) -> Self {
        Array([value; 8], PhantomData)
    }
    #[inline(always)]
    fn load(_: W, from: &[u32; 8]) -> Self {
        Array(*from, PhantomData)
    }
    #[inline(always)]
    fn to_array(self) -> [u32; 8] {
        self.0
    }
    #[inline(always)]
    fn shift_right<const BITS: i32>(self) -> Self {
        Array(self.0.map(|x| x >> BITS), PhantomData)
    }
    #[inline(always)]
    fn shift_right_by(self, bits: u32) -> Self {
        Array(self.0.map(|x| x >> bits), PhantomData)
    }
    #[inline(always)]
    fn shift_right_signed<const BITS: i32>(self) -> Self {
        Array(self.0.map(|x| (x as i32 >> BITS) as u32), PhantomData)
    }
    #[inline(always)]
    fn shift_right_signed_by(self, bits: u32) -> Self {
        Array(self.0.map(|x| (x as i32 >> bits) as u32), PhantomData)
    }
    #[inline(always)]
    fn dot_halves(self, other: Self) -> Self {
        Array(ops::dot_halves(self.0, other.0), PhantomData)
    }
    #[inline(always)]
    fn least_signed(self, other: Self) -> Self {
        Array(std::array::from_fn(|i| (self.0[i] as i32).min(other.0[i] as i32) as u32), PhantomData)
    }
    #[inline(always)]
    fn greatest_signed(self, other: Self) -> Self {
        Array(std::array::from_fn(|i| (self.0[i] as i32).max(other.0[i] as i32) as u32), PhantomData)
    }
    #[inline(always)]
    fn clamp_signed(self, edge: Self) -> Self {
        let clamp = |i: usize| (self.0[i] as i32).max(0).min(edge.0[i] as i32) as u32;
        Array(std::array::from_fn(clamp), PhantomData)
    }
    #[inline(always)]
    fn greater_signed(self, other: Self) -> u32 {
        ops::greater_signed(self.0, other.0)
    }
    #[inline(always)]
    fn equal(self, other: Self) -> u32 {
        let pairs = self.0.iter().zip(other.0).enumerate();
        pairs.fold(0, |bits, (i, (&a, b))| bits | u32::from(a == b) << i)
    }
    #[inline(always)]
    fn transpose(rows: [Self; 8]) -> [Self; 8] {
        std::array::from_fn(|i| Array(rows.map(|row| row.0[i]), PhantomData))
    }
    #[inline(always)]
    fn reverse_bits(self) -> Self {
        Array(self.0.map(u32::reverse_bits), PhantomData)
    }
    #[inline(always)]
    fn lower_then_upper(self, upper: Self) -> Self {
        let ([a, b, c, d, ..], [.., e, f, g, h]) = (self.0, upper.0);
        Array([a, b, c, d, e, f, g, h], PhantomData)
    }
    #[inline(always)]
    fn to_units(self) -> [f32; 8] {
        self.0.map(twinlight_core::math::hash::to_unit)
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Isa, Kernel, Width, dispatch};
    use super::*;
    use proptest::prelude::*;

    /// Operations on two vectors, at whatever width.
    struct All([u32; 8], [u32; 8], u32);

    impl Kernel for All {
        type Output = ([[u32; 8]; 4], u32);

        fn run<W: Width>(self, width: W) -> Self::Output {
            let (a, b) = (W::U8::load(width, &self.0), W::U8::load(width, &self.1));
            let lanes =
                [a.dot_halves(b), a.least_signed(b), a.greatest_signed(b), a.shift_right_signed_by(self.2)];
            (lanes.map(Words::to_array), a.greater_signed(b))
        }
    }

    /// Any word, often one of the ends of the range of a half.
    fn word() -> impl Strategy<Value = u32> {
        prop_oneof![any::<u32>(), Just(0x8000_8001), Just(0x7fff_8000), Just(u32::MAX), Just(0)]
    }

    proptest! {
        #[test]
        fn widths_agree_with_plain_words(
            a in prop::array::uniform8(word()),
            b in prop::array::uniform8(word()),
            bits in 0..32_u32,
        ) {
            let signed = |pick: fn(i32, i32) -> i32| {
                std::array::from_fn(|i| pick(a[i] as i32, b[i] as i32) as u32)
            };
            let shifted = a.map(|x| (x as i32 >> bits) as u32);
            let wanted = [plain::dot_halves(a, b), signed(Ord::min), signed(Ord::max), shifted];
            for isa in Isa::ALL {
                prop_assert_eq!(dispatch(isa, All(a, b, bits)), (wanted, plain::greater_signed(a, b)));
            }
        }
    }
}
