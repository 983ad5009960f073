use super::*;
use twinlight_core::kernels::voxelize::NO_CUTOFF;

/// A unit is a lattice step, the middle of 2¹⁵ the lattice's.
fn grid(dims: [u32; 3], subvoxel_bits: u32) -> VoxelGrid {
    VoxelGrid { dims, scale: 1 << 14, offset: [1 << 28; 3], subvoxel_bits }
}

fn mesh(corners: [[i16; 3]; 3]) -> LatticeMesh {
    let vertices = corners.map(|corner| corner.map(|c| c - 16_384));
    LatticeMesh::new(vertices.to_vec(), vec![[0, 1, 2]]).expect("a triangle in reach")
}

fn met(corners: [[i16; 3]; 3], separation: u32) -> Vec<Triple> {
    let params = VoxelizeParams { separation, cutoff: NO_CUTOFF };
    let occupied = voxelize(&mesh(corners), &grid([4; 3], 6), &params);
    occupied.active.into_iter().map(voxel).collect()
}

#[test]
fn codes_interleave_bits_and_come_back() {
    assert_eq!(code([1, 0, 0]), 0b001);
    assert_eq!(code([0, 1, 0]), 0b010);
    assert_eq!(code([2, 0, 3]), 0b10_1100);
    for voxel_of in [[0, 0, 0], [511, 0, 300], [5, 511, 77]] {
        assert_eq!(voxel(code(voxel_of)), voxel_of);
    }
}

#[test]
fn places_are_rounded_down_and_moved_into_the_box() {
    let half = VoxelGrid { scale: 1 << 13, offset: [0; 3], ..grid([1, 2, 3], 6) };
    assert_eq!(place(&half, [3, -1, 32_000]), [1, 0, 191]);
    assert_eq!(place(&grid([512; 3], 6), [-16_384, 0, 16_383]), [0, 16_384, 32_767]);
}

#[test]
fn a_wall_in_the_plane_of_a_face_is_one_voxel_thick_or_two() {
    for axis in 0..3 {
        let wall = [[64, 70, 74], [64, 100, 70], [64, 70, 110]].map(|mut corner: [i16; 3]| {
            corner.rotate_right(axis);
            corner
        });
        let turned = |mut voxel: Triple| {
            voxel.rotate_right(axis);
            voxel
        };
        assert_eq!(met(wall, THIN), [turned([1, 1, 1])]);
        assert_eq!(met(wall, CONSERVATIVE), [turned([0, 1, 1]), turned([1, 1, 1])]);
    }
}

#[test]
fn points_and_segments_are_met_by_what_they_touch() {
    assert_eq!(met([[80; 3]; 3], THIN), [[0; 3]; 0]);
    assert_eq!(met([[80; 3]; 3], CONSERVATIVE), [[1; 3]]);
    // Within a unit of a corner of eight.
    assert_eq!(met([[65; 3]; 3], CONSERVATIVE).len(), 8);
    assert_eq!(met([[66; 3]; 3], CONSERVATIVE).len(), 1);
    let along_x = met([[10, 80, 80], [200, 80, 80], [100, 80, 80]], CONSERVATIVE);
    assert_eq!(along_x, [[0, 1, 1], [1, 1, 1], [2, 1, 1], [3, 1, 1]]);
}

#[test]
fn an_edge_passes_a_cube_by() {
    // The bounds hold the voxel (1, 1, 1), the plane passes through it, the triangle ends before it.
    let flat = [[10, 10, 96], [180, 20, 96], [20, 180, 96]];
    assert!(met(flat, CONSERVATIVE).contains(&[1, 1, 1]));
    let away = [[10, 10, 96], [190, 10, 96], [10, 70, 96]];
    assert!(!met(away, CONSERVATIVE).contains(&[1, 1, 1]));
    assert_eq!(met(away, THIN), [[0, 0, 1], [1, 0, 1], [2, 0, 1]]);
    // Thin voxels have the triangle on a line through their centres.
    let corner_only = [[0, 0, 96], [70, 0, 96], [0, 70, 96]];
    assert_eq!(met(corner_only, THIN), [[0, 0, 1]]);
    assert_eq!(met(corner_only, CONSERVATIVE), [[0, 0, 1], [1, 0, 1], [0, 1, 1]]);
}

#[test]
fn classes_go_by_the_cells_of_the_bounds() {
    // Three cells by two along z.
    let corners = [[10, 10, 5], [140, 20, 5], [30, 70, 20]];
    let classes = |cutoff: u32| {
        let occupied =
            voxelize(&mesh(corners), &grid([4; 3], 6), &VoxelizeParams { separation: THIN, cutoff });
        (occupied.small, occupied.large)
    };
    assert_eq!(classes(6), (vec![0], vec![]));
    assert_eq!(classes(5), (vec![], vec![0]));
}

#[test]
fn lists_follow_from_codes() {
    let codes = BTreeSet::from([0, 31, 32, 33, 511]);
    let occupied = Occupied::of_codes(&codes, &grid([5, 1, 8], 6));
    assert_eq!((occupied.mask.len(), occupied.mask[0], occupied.mask[1]), (16, 1 << 31 | 1, 3));
    assert_eq!((occupied.ranks[..4].to_vec(), occupied.ranks[16]), (vec![0, 2, 4, 4], 5));
    assert_eq!(occupied.parents, [0, 3, 4, 63]);
}
