//! Codes of voxels in Morton order. Twin: `backend-gpu/src/shared/morton.wgsl`.
//!
//! Bit 3b of a code is bit b of x, bit 3b+1 that of y, bit 3b+2 that of z. Children of one parent have neighbouring codes, and a
//! code without its last three bits is the parent's.

/// `x` with two zeroes between its bits, for x < 2¹⁰.
#[inline(always)]
pub fn spread(x: u32) -> u32 {
    let a = (x | (x << 16)) & 0x0300_00ff;
    let b = (a | (a << 8)) & 0x0300_f00f;
    let c = (b | (b << 4)) & 0x030c_30c3;
    (c | (c << 2)) & 0x0924_9249
}

/// The way back from [`spread`]: every third bit of `x`, from the first.
#[inline(always)]
pub fn gather_thirds(x: u32) -> u32 {
    let a = x & 0x0924_9249;
    let b = (a | (a >> 2)) & 0x030c_30c3;
    let c = (b | (b >> 4)) & 0x0300_f00f;
    let d = (c | (c >> 8)) & 0x0300_00ff;
    (d | (d >> 16)) & 0x3ff
}

/// The code of a voxel.
#[inline(always)]
pub fn morton_code(voxel: [u32; 3]) -> u32 {
    spread(voxel[0]) | (spread(voxel[1]) << 1) | (spread(voxel[2]) << 2)
}

/// The voxel of a code.
#[inline(always)]
pub fn morton_voxel(code: u32) -> [u32; 3] {
    [gather_thirds(code), gather_thirds(code >> 1), gather_thirds(code >> 2)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Bit by bit.
    fn naive(voxel: [u32; 3]) -> u32 {
        let bit = |i: u32| (voxel[i as usize % 3] >> (i / 3) & 1) << i;
        (0..30).map(bit).sum()
    }

    proptest! {
        #[test]
        fn codes_interleave_bits_and_come_back(voxel in prop::array::uniform3(0..1024_u32)) {
            let code = morton_code(voxel);
            prop_assert_eq!(code, naive(voxel));
            prop_assert_eq!(morton_voxel(code), voxel);
        }
    }
}
