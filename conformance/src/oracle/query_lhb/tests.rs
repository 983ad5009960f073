use super::*;
use crate::oracle::rasterize_lhb::rasterize;
use twinlight_core::kernels::rasterize_lhb::RasterizeLhbParams;
use twinlight_core::lattice::LatticePlane;
use twinlight_fixtures::random::Random;

/// Along +Z with x to the right and y downwards.
const FRONT: View = View { right: [16_384, 0, 0, 0], down: [0, 16_384, 0, 0], forward: [0, 0, 16_384, 0] };

/// Counter-clockwise from −Z, where the viewer is: from above its first corner down to the second, then back to the right.
fn wall(z: i16) -> [[i16; 3]; 3] {
    [[-9_000, -18_000, z], [-9_000, 18_000, z], [18_000, 0, z]]
}

fn mesh(corners: &[[[i16; 3]; 3]]) -> LatticeMesh {
    let triangles = (0..corners.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    LatticeMesh::new(corners.concat(), triangles).unwrap()
}

fn at(z: i32) -> LhbQuery {
    LhbQuery { position: [0, 0, z], ray: 0, offset: [0; 2], leaves: u32::MAX, window: 0 }
}

fn met(walls: &[i16], queries: &[LhbQuery]) -> Vec<u32> {
    let mesh = mesh(&walls.iter().map(|&z| wall(z)).collect::<Vec<_>>());
    let lists = rasterize(&mesh, &[FRONT], &RasterizeLhbParams::new(8));
    query(&mesh, &lists, 8, &[FRONT], queries).iter().map(|e| e.surface).collect()
}

/// 3·8192/√14 is 6567.9…, twice that 13135.8….
#[test]
fn planes_are_rounded_to_the_nearest() {
    assert_eq!(rounded(3, 14), 6_568);
    assert_eq!(rounded(1, 14), 2_189);
    assert_eq!([rounded(0, 7), rounded(5, 25), rounded(0, 0)], [0, 8_192, 0]);
    let plane = Plane::of(wall(5));
    assert_eq!((plane.normal, plane.offset), ([0, 0, -8_192], -5 * 8_192));
    // The viewer is before the wall.
    assert!(plane.side([0, 0, -30_000]) > 0);
}

/// Another way to the same integers: f64, whose error of 10⁻¹² decides one component in 10¹² otherwise.
#[test]
fn planes_are_those_of_the_lattice() {
    let mut random = Random::new(3);
    for bits in (0..15).cycle().take(3_000) {
        let corner = |random: &mut Random| [(); 3].map(|()| (random.next_u32() as i16 / 2) >> bits);
        let corners = [(); 3].map(|()| corner(&mut random));
        let (exact, plane) = (Plane::of(corners), LatticePlane::of(corners));
        let same = exact.normal == plane.normal.map(i128::from) && exact.offset == plane.offset.into();
        assert!(same, "{corners:?}: {exact:?} {plane:?}");
    }
}

#[test]
fn lists_are_read_from_either_end() {
    let walls = [100, -100, 300];
    let away = [-200, 0, 200, 400].map(at);
    assert_eq!(met(&walls, &away), [3, 1, 5, NO_ELEMENT]);
    // From behind, their backs; at its very depth a wall is not ahead.
    let back = [-200, 0, 200, 400, 100].map(|z| LhbQuery { ray: 1, ..at(z) });
    assert_eq!(met(&walls, &back), [NO_ELEMENT, 2, 0, 4, 2]);
    assert_eq!(met(&walls, &[LhbQuery { ray: 2, ..at(0) }]), [NO_ELEMENT]);
}

/// Walls 9 steps ahead and 9 behind, within the window: the one ahead is entered, and 8 steps are not enough.
#[test]
fn within_the_window_planes_decide() {
    let window = 20 << 14;
    let leaving = |leaves| LhbQuery { leaves, window, ..at(0) };
    assert_eq!(met(&[-9, 9, 90], &[leaving(7), leaving(6), leaving(3)]), [3, 5, 5]);
    assert_eq!(met(&[-9, 8, 90], &[leaving(7)]), [5]);
    let back = |leaves| LhbQuery { ray: 1, ..leaving(leaves) };
    assert_eq!(met(&[-9, 9, -90], &[back(6), back(7), back(0)]), [0, 4, 4]);
}

/// Pixel 4 of 8 begins at the middle, and each has 4096 sub-pixels. The wall covers the centres of pixels 3 and 4.
#[test]
fn offsets_move_on_the_screen() {
    let moved = |x| met(&[100], &[LhbQuery { offset: [x, 0], ..at(0) }])[0] == 1;
    let edges = [-4_097, -4_096, 0, 4_095, 4_096].map(moved);
    assert_eq!(edges, [false, true, true, true, false]);
    let far = |x| met(&[100], &[LhbQuery { offset: [x, i32::MIN], ..at(0) }])[0];
    assert_eq!([far(i32::MAX), far(i32::MIN)], [NO_ELEMENT; 2]);
}
