//! One colour for all directions: sums, whatever the octants.

use super::Storage;
use twinlight_core::kernels::reduce_mips::VoxelLight;

pub(super) struct Isotropic;

impl Storage<4> for Isotropic {
    #[inline(always)]
    fn leaf(light: &VoxelLight) -> [u32; 4] {
        let [r, g, b] = light.rgb;
        [r, g, b, light.opacity]
    }

    #[inline(always)]
    fn parent(children: &[[u32; 4]], _: u32) -> [u32; 4] {
        let mut sums = [4_u32; 4];
        for child in children {
            sums.iter_mut().zip(child).for_each(|(sum, word)| *sum = sum.wrapping_add(*word));
        }
        sums.map(|sum| sum >> 3)
    }
}
