//! Sums, and least and greatest: what is below, whatever the octants.

use super::Storage;
use twinlight_core::kernels::reduce_mips::VoxelLight;

pub(super) struct Sums;

impl Storage<2> for Sums {
    #[inline(always)]
    fn leaf(light: &VoxelLight) -> [u32; 2] {
        words(light.rgb.iter().map(|&c| u64::from(c)).sum())
    }

    #[inline(always)]
    fn parent(children: &[[u32; 2]], _: u32) -> [u32; 2] {
        let wide = |[low, high]: &[u32; 2]| u64::from(*high) << 32 | u64::from(*low);
        words(children.iter().map(wide).fold(0, u64::wrapping_add))
    }
}

#[inline(always)]
fn words(sum: u64) -> [u32; 2] {
    [sum as u32, (sum >> 32) as u32]
}

pub(super) struct Ranges;

impl Storage<2> for Ranges {
    #[inline(always)]
    fn leaf(light: &VoxelLight) -> [u32; 2] {
        [light.rgb.iter().fold(0, |sum: u32, c| sum.wrapping_add(*c)); 2]
    }

    #[inline(always)]
    fn parent(children: &[[u32; 2]], _: u32) -> [u32; 2] {
        children
            .iter()
            .fold([u32::MAX, 0], |[least, greatest], child| [least.min(child[0]), greatest.max(child[1])])
    }
}
