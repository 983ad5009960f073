//! Eight lanes of `u32` as an array; what every instruction set without vector multiplication uses.

use super::Words;
use std::marker::PhantomData;
use std::ops::{Add, BitAnd, BitXor, Mul};

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
operators!(Add add wrapping_add, Mul mul wrapping_mul, BitAnd bitand bitand, BitXor bitxor bitxor);

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
        let low = |x: u32| i32::from(x as i16);
        let high = |x: u32| x as i32 >> 16;
        let dot = |a: u32, b: u32| (low(a) * low(b)).wrapping_add(high(a) * high(b)) as u32;
        Array(std::array::from_fn(|i| dot(self.0[i], other.0[i])), PhantomData)
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
        let pairs = self.0.iter().zip(other.0).enumerate();
        pairs.fold(0, |bits, (i, (&a, b))| bits | u32::from(a as i32 > b as i32) << i)
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
