use super::*;
use twinlight_core::kernels::sum_voxels::texel_word;

/// Across one voxel of 2⁶ units, flat along z, its right angle at the corner 0.
fn corner_of_a_voxel() -> Placed {
    Placed::new([[0, 0, 32], [128, 0, 32], [0, 128, 32]], 64)
}

fn surface() -> VoxelSurface {
    VoxelSurface {
        normals: [u32::from_le_bytes([0, 0, 127, 0]), u32::from_le_bytes([0x81, 0, 0, 0]), 0],
        texture: 2,
        texcoords: [[0, 0], [4 << 6, 0], [0, -(4 << 6)]],
        texture_size: 3 | 2 << 16,
        flags: 0,
        tint: [4095 | 2048 << 16, 0],
        emission: [7 | 9 << 16, 11],
    }
}

#[test]
fn weights_are_those_of_the_point_under_the_centre() {
    let placed = corner_of_a_voxel();
    // A quarter of the way along both legs.
    assert_eq!(weights(&placed, placed.centre([0, 0, 0])), [8_192, 4_096, 4_096]);
    // Beyond the third edge the first corner counts nothing.
    assert_eq!(weights(&placed, placed.centre([1, 1, 0])), [0, 8_192, 8_192]);
}

#[test]
fn weights_are_rounded_down_twice() {
    // Twice the area has 18 bits, so that the last bit of each part is dropped; the first corner takes what is left.
    let placed = Placed::new([[0, 0, 0], [401, 0, 0], [0, 401, 0]], 64);
    let [of_2, of_0, of_1] = [32 * 401, 401 * (401 - 64), 32 * 401].map(|e| e / 2);
    let whole = of_0 + of_1 + of_2;
    let [w1, w2] = [of_1, of_2].map(|a| (a << 14) / whole);
    assert_eq!(weights(&placed, [32, 32, 0]), [WHOLE - w1 - w2, w1, w2]);
}

#[test]
fn triangles_without_area_are_weighed_as_others_are() {
    // No axis dominates, so that the first one does.
    let segment = Placed::new([[0, 0, 0], [100, 50, 0], [200, 100, 0]], 64);
    assert_eq!(weights(&segment, [96, 32, 32]), [8_192, 0, 8_192]);
    assert_eq!(weights(&Placed::new([[9; 3]; 3], 64), [32; 3]), [WHOLE, 0, 0]);
}

#[test]
fn a_fragment_is_what_the_surface_is_there() {
    let mut texels = vec![0; 8];
    // u = 1.0, v = −1.0: the second column of the last row.
    texels[2 + 3 + 1] = texel_word([1023, 512, 9]);
    let found = fragment(&surface(), [8_192, 4_096, 4_096], &texels);
    assert_eq!(found.albedo, [4095, (2048 * 512 + 511) / 1023, 0]);
    // 127/2 = 63.5 goes up; −127/4 = −31.75 to −32.
    assert_eq!((found.normal, found.emission, found.count), ([-32, 0, 64], [7, 9, 11], 1));
}

#[test]
fn coordinates_beyond_a_texture_wrap_or_are_its_borders() {
    let number = |flags: u32, weights: Triple| texel_number(&VoxelSurface { flags, ..surface() }, weights);
    // u = 4 of 3 columns.
    assert_eq!([0, CLAMP].map(|flags| number(flags, [0, WHOLE, 0])), [Some(2 + 1), Some(2 + 2)]);
    // v = −4 of 2 rows; a little less is rounded down.
    assert_eq!([0, CLAMP].map(|flags| number(flags, [0, 0, WHOLE])), [Some(2), Some(2)]);
    assert_eq!([0, CLAMP].map(|flags| number(flags, [WHOLE - 1, 0, 1])), [Some(2 + 3), Some(2)]);
    assert_eq!(texel_number(&VoxelSurface { texture: NONE, ..surface() }, [WHOLE, 0, 0]), None);
}
