//! Vectors of 4 and 8 `f32` lanes with the same bits at every width, and the choice of instruction set at run time.
//!
//! A [`Width`] is a token: holding one proves that its instructions exist on this machine, so every operation is safe.
//! All of it is `#[inline(always)]`: the generic code takes the instruction set of the function it ends up in, which
//! [`dispatch`] provides. No operation fuses or reassociates; `minimum` and `maximum` are the comparison forms of
//! `twinlight_core::transport::intersect::{smaller, larger}`, which is also what `minps` and `maxps` compute.

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx2_words;
mod pair;
mod portable;
#[cfg(target_arch = "x86_64")]
mod sse2;
mod words;

#[cfg(target_arch = "x86_64")]
pub use avx2::Avx2;
pub use portable::Portable;
#[cfg(target_arch = "x86_64")]
pub use sse2::Sse2;

use std::ops::{Add, BitAnd, BitOr, BitXor, Div, Mul, Sub};

/// One truth value per lane.
pub trait LaneMask: Copy + BitAnd<Output = Self> + BitOr<Output = Self> + BitXor<Output = Self> {
    /// Bit i is lane i.
    fn bits(self) -> u32;
}

/// A vector of `f32`.
pub trait Lanes:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    /// Proof that the instructions exist.
    type Token: Copy;
    /// `[f32; LANES]`.
    type Array: Copy;
    /// Result of a comparison.
    type Mask: LaneMask;

    /// The same value in every lane.
    fn splat(token: Self::Token, value: f32) -> Self;
    /// Lanes from memory.
    fn load(token: Self::Token, from: &Self::Array) -> Self;
    /// Lanes to memory.
    fn to_array(self) -> Self::Array;
    /// Magnitudes.
    #[must_use]
    fn abs(self) -> Self;
    /// `self < other ? self : other`.
    fn minimum(self, other: Self) -> Self;
    /// `self > other ? self : other`.
    fn maximum(self, other: Self) -> Self;
    /// `self` where the mask holds, else `other`.
    #[must_use]
    fn select(self, mask: Self::Mask, other: Self) -> Self;
    /// `self < other`; false where either is NaN.
    fn lt(self, other: Self) -> Self::Mask;
    /// `self <= other`; false where either is NaN.
    fn le(self, other: Self) -> Self::Mask;
}

/// A vector of eight `u32`; sums, differences and products wrap.
pub trait Words:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + BitAnd<Output = Self>
    + BitXor<Output = Self>
{
    /// Proof that the instructions exist.
    type Token: Copy;

    /// The same value in every lane.
    fn splat(token: Self::Token, value: u32) -> Self;
    /// Lanes from memory.
    fn load(token: Self::Token, from: &[u32; 8]) -> Self;
    /// Lanes to memory.
    fn to_array(self) -> [u32; 8];
    /// Every lane shifted to the right.
    #[must_use]
    fn shift_right<const BITS: i32>(self) -> Self;
    /// Every lane shifted to the right by a number of bits below 32.
    #[must_use]
    fn shift_right_by(self, bits: u32) -> Self;
    /// Every lane, as `i32`, shifted to the right: rounded down.
    #[must_use]
    fn shift_right_signed<const BITS: i32>(self) -> Self;
    /// Every lane, as `i32`, shifted to the right by a number of bits below 32.
    #[must_use]
    fn shift_right_signed_by(self, bits: u32) -> Self;
    /// Halves of every lane, as `i16`, times those of `other`: the sum of both products.
    #[must_use]
    fn dot_halves(self, other: Self) -> Self;
    /// The lesser of every two lanes, as `i32`.
    #[must_use]
    fn least_signed(self, other: Self) -> Self;
    /// The greater of every two lanes, as `i32`.
    #[must_use]
    fn greatest_signed(self, other: Self) -> Self;
    /// Every lane, as `i32`, brought into [0, `edge`'s lane].
    #[must_use]
    fn clamp_signed(self, edge: Self) -> Self;
    /// Bit i says whether lane i of `self` is greater than that of `other`, as `i32`.
    fn greater_signed(self, other: Self) -> u32;
    /// Bit i says whether lane i of `self` is that of `other`.
    fn equal(self, other: Self) -> u32;
    /// Lane i of vector k becomes lane k of vector i.
    fn transpose(rows: [Self; 8]) -> [Self; 8];
    /// Every lane with its bits in reverse order.
    #[must_use]
    fn reverse_bits(self) -> Self;
    /// Lanes 0 to 3 of `self`, 4 to 7 of `upper`.
    #[must_use]
    fn lower_then_upper(self, upper: Self) -> Self;
    /// [`twinlight_core::math::hash::to_unit`] of every lane.
    fn to_units(self) -> [f32; 8];
}

/// An instruction set.
pub trait Width: Copy + Send + Sync {
    /// Four lanes.
    type F4: Lanes<Token = Self, Array = [f32; 4]>;
    /// Eight lanes.
    type F8: Lanes<Token = Self, Array = [f32; 8]>;
    /// Eight words.
    type U8: Words<Token = Self>;
}

/// Asks for the cache line of `target`, which will be read soon.
#[inline(always)]
pub fn prefetch<T>(target: &T) {
    #[cfg(target_arch = "x86_64")]
    {
        use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        // SAFETY: every x86-64 has the instruction, and it reads nothing that could be seen.
        unsafe { _mm_prefetch::<_MM_HINT_T0>(std::ptr::from_ref(target).cast()) };
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = target;
}

/// [`prefetch`] of an item that need not be there: an address is no access.
#[inline(always)]
pub fn prefetch_item<T>(items: &[T], index: usize) {
    #[cfg(target_arch = "x86_64")]
    {
        use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        // SAFETY: every x86-64 has the instruction, and it neither faults nor reads anything that could be seen.
        unsafe { _mm_prefetch::<_MM_HINT_T0>(items.as_ptr().wrapping_add(index).cast()) };
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = (items, index);
}

/// Instruction sets that can be asked for by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Isa {
    /// Arrays, whatever the compiler makes of them.
    Portable,
    /// Two vectors of four lanes; every x86-64 has it.
    Sse2,
    /// One vector of eight lanes, with BMI1, BMI2, LZCNT and POPCNT.
    Avx2,
}

impl Isa {
    /// All of them, narrowest first.
    pub const ALL: [Isa; 3] = [Isa::Portable, Isa::Sse2, Isa::Avx2];

    /// Whether this machine has it.
    #[must_use]
    pub fn is_available(self) -> bool {
        match self {
            Isa::Portable => true,
            Isa::Sse2 => cfg!(target_arch = "x86_64"),
            #[cfg(target_arch = "x86_64")]
            Isa::Avx2 => Avx2::detect().is_some(),
            #[cfg(not(target_arch = "x86_64"))]
            Isa::Avx2 => false,
        }
    }

    /// Lower-case name, for reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Isa::Portable => "portable",
            Isa::Sse2 => "sse2",
            Isa::Avx2 => "avx2",
        }
    }
}

/// The widest instruction set of this machine.
#[must_use]
pub fn detect() -> Isa {
    Isa::ALL.into_iter().rev().find(|isa| isa.is_available()).unwrap_or(Isa::Portable)
}

/// Work that can run at any width. `run` must be `#[inline(always)]`, as must what it calls on its hot path: that is
/// how it takes on the instruction set. Closures are compiled without it, so loops there are plain loops, and work for
/// other threads calls [`dispatch`] once per chunk.
pub trait Kernel {
    /// What it returns.
    type Output;
    /// Does the work.
    fn run<W: Width>(self, width: W) -> Self::Output;
}

/// Runs `kernel` with the instructions of `isa`, or the portable ones where the machine lacks it: the same bits.
#[inline]
pub fn dispatch<K: Kernel>(isa: Isa, kernel: K) -> K::Output {
    #[cfg(target_arch = "x86_64")]
    match isa {
        Isa::Portable => {}
        Isa::Sse2 => return kernel.run(Sse2),
        Isa::Avx2 => {
            if let Some(width) = Avx2::detect() {
                return avx2::run(width, kernel);
            }
        }
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = isa;
    kernel.run(Portable)
}
