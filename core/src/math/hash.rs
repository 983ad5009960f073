//! Integer hashing: the source of all randomness. Twin: `backend-gpu/src/shared/hash.wgsl`.

/// A bijection of u32 that mixes every input bit into every output bit (constants of Wellons' `lowbias32` search).
#[inline(always)]
pub fn mix(value: u32) -> u32 {
    let mut x = value;
    x ^= x >> 16;
    x = x.wrapping_mul(0x7feb_352d);
    x ^= x >> 15;
    x = x.wrapping_mul(0x846c_a68b);
    x ^ (x >> 16)
}

/// Hash of an ordered pair.
#[inline(always)]
pub fn mix_pair(a: u32, b: u32) -> u32 {
    mix(mix(a).wrapping_add(b.wrapping_mul(0x9e37_79b9)))
}

/// 2⁻²⁴.
pub const UNIT: f32 = 5.960_464_477_539_063e-8;

/// A number in [0, 1) from the upper 24 bits: never 1, and exact in f32.
#[inline(always)]
pub fn to_unit(bits: u32) -> f32 {
    (bits >> 8) as f32 * UNIT
}

/// ⌊bits·n / 2³²⌋ and the fractional part in units of 2⁻³²: a uniform index below `n`, and a fresh draw that is
/// independent of it.
#[inline(always)]
pub fn to_index(bits: u32, n: u32) -> (u32, u32) {
    let product = u64::from(bits) * u64::from(n);
    ((product >> 32) as u32, product as u32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn index_is_the_product_in_halves(bits: u32, n: u32) {
            // As WGSL does it, in 16-bit halves.
            let (bl, bh) = (bits & 0xffff, bits >> 16);
            let (nl, nh) = (n & 0xffff, n >> 16);
            let low = bl * nl;
            let middle = bh * nl + (low >> 16);
            let carry = (middle & 0xffff) + bl * nh;
            let high = bh * nh + (middle >> 16) + (carry >> 16);
            prop_assert_eq!(to_index(bits, n), (high, (carry << 16) | (low & 0xffff)));
        }

        #[test]
        fn unit_is_below_one(bits: u32) {
            prop_assert!((0.0..1.0).contains(&to_unit(bits)));
        }
    }

    #[test]
    fn mix_is_a_bijection_on_a_sample() {
        let mut images: Vec<u32> = (0..100_000_u32).map(mix).collect();
        images.sort_unstable();
        images.dedup();
        assert_eq!(images.len(), 100_000);
    }
}
