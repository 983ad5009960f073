//! Two bands of spherical harmonics: the contract's matrix, child by child.

use super::Storage;
use twinlight_core::kernels::reduce_mips::{NEAR_LESS_FAR, TWO_THIRDS, VoxelLight};

pub(super) struct Harmonics;

impl Storage<13> for Harmonics {
    #[inline(always)]
    fn leaf(light: &VoxelLight) -> [u32; 13] {
        let [r, g, b] = light.rgb;
        [light.opacity, r, 0, 0, 0, g, 0, 0, 0, b, 0, 0, 0]
    }

    #[inline]
    fn parent(children: &[[u32; 13]], octants: u32) -> [u32; 13] {
        let mut opacity = 4_u32;
        let mut sums = [[0_i32; 4]; 3];
        let mut octants = octants;
        for child in children {
            let octant = octants.trailing_zeros();
            octants &= octants.wrapping_sub(1);
            opacity = opacity.wrapping_add(child[0]);
            for (channel, sums) in sums.iter_mut().enumerate() {
                let a = std::array::from_fn(|k| child[1 + 4 * channel + k].cast_signed());
                add(sums, a, octant);
            }
        }
        let mut value = [opacity >> 3; 13];
        for (i, sum) in sums.as_flattened().iter().enumerate() {
            value[1 + i] = eighth(*sum);
        }
        value
    }
}

/// Adds what a child in `octant` has to its parent's coefficients.
#[inline(always)]
fn add(sums: &mut [i32; 4], a: [i32; 4], octant: u32) {
    sums[0] = sums[0].wrapping_add(a[0]);
    let gradient = scaled(2 * NEAR_LESS_FAR, a[0]);
    for axis in 0..3 {
        let is_lower = (octant >> axis) & 1 == 0;
        let signed = |x: i32| if is_lower { x.wrapping_neg() } else { x };
        let along = a[axis + 1];
        sums[0] = sums[0].wrapping_add(signed(scaled(NEAR_LESS_FAR, along)));
        sums[axis + 1] =
            sums[axis + 1].wrapping_add(signed(gradient)).wrapping_add(scaled(TWO_THIRDS, along));
    }
}

/// m(k, x) of the contract, for k < 2¹⁴: towards 0.
#[inline(always)]
fn scaled(k: u32, x: i32) -> i32 {
    let magnitude = ((u64::from(k) * u64::from(x.unsigned_abs())) >> 14) as i32;
    if x < 0 { -magnitude } else { magnitude }
}

/// An eighth, to the nearest; halves away from 0.
#[inline(always)]
fn eighth(sum: i32) -> u32 {
    let magnitude = (sum.unsigned_abs() + 4) >> 3;
    if sum < 0 { magnitude.wrapping_neg() } else { magnitude }
}
