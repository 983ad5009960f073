//! Lane by lane.

#[inline(always)]
pub(super) fn dot_halves(a: [u32; 8], b: [u32; 8]) -> [u32; 8] {
    let low = |x: u32| i32::from(x as i16);
    let high = |x: u32| x as i32 >> 16;
    std::array::from_fn(|i| (low(a[i]) * low(b[i])).wrapping_add(high(a[i]) * high(b[i])) as u32)
}

#[inline(always)]
pub(super) fn greater_signed(a: [u32; 8], b: [u32; 8]) -> u32 {
    let pairs = a.iter().zip(b).enumerate();
    pairs.fold(0, |bits, (i, (&a, b))| bits | u32::from(a as i32 > b as i32) << i)
}
