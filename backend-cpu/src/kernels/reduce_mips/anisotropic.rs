//! A colour per face: columns of two, of which the front lets through what it doesn't cover.

use super::Storage;
use super::children::placed;
use twinlight_core::kernels::reduce_mips::{OPAQUE, VoxelLight};

pub(super) struct Anisotropic;

/// For +x, +y and +z: the octants of the upper children, whose lower ones are without the axis's bit.
const UPPER: [[usize; 4]; 3] = [[1, 3, 5, 7], [2, 3, 6, 7], [4, 5, 6, 7]];

impl Storage<24> for Anisotropic {
    #[inline(always)]
    fn leaf(light: &VoxelLight) -> [u32; 24] {
        let [r, g, b] = light.rgb;
        let words = [r, g, b, light.opacity];
        std::array::from_fn(|i| words[i % 4])
    }

    #[inline]
    fn parent(children: &[[u32; 24]], octants: u32) -> [u32; 24] {
        let children = placed(children, octants);
        let mut value = [0; 24];
        for (axis, upper) in UPPER.iter().enumerate() {
            let (mut plus, mut minus) = ([2; 4], [2; 4]);
            for &octant in upper {
                let pair = [&children[octant], &children[octant ^ (1 << axis)]];
                add_column(&mut plus, pair.map(|child| face(child, 2 * axis)));
                let [above, below] = pair.map(|child| face(child, 2 * axis + 1));
                add_column(&mut minus, [below, above]);
            }
            value[8 * axis..][..4].copy_from_slice(&plus.map(|sum| sum >> 2));
            value[8 * axis + 4..][..4].copy_from_slice(&minus.map(|sum| sum >> 2));
        }
        value
    }
}

#[inline(always)]
fn face(value: &[u32; 24], face: usize) -> [u32; 4] {
    std::array::from_fn(|word| value[4 * face + word])
}

#[inline(always)]
fn add_column(sums: &mut [u32; 4], [front, back]: [[u32; 4]; 2]) {
    let passes = u64::from(OPAQUE.wrapping_sub(front[3]));
    for word in 0..4 {
        let behind = ((passes * u64::from(back[word])) >> 16) as u32;
        sums[word] = sums[word].wrapping_add(front[word]).wrapping_add(behind);
    }
}
