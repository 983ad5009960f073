use super::*;
use twinlight_core::kernels::rasterize_lhb::CAP_FAR;
use twinlight_core::lattice::DEPTH_ORIGIN;

/// One lattice step of depth.
const STEP: u32 = 1 << 14;

/// Along +Z with x to the right and y downwards. At size 4 a pixel has 8192 sub-pixels of 2 lattice steps, so column i's
/// centre is the lattice's x = (2i − 3)·8192; at size 8 (2i − 7)·4096.
fn front() -> View {
    View { right: [16_384, 0, 0, 0], down: [0, 16_384, 0, 0], forward: [0, 0, 16_384, 0] }
}

/// Centres of pixels (column, row) of a view of `size`, at z.
fn at(size: i16, (column, row): (i16, i16), z: i16) -> [i16; 3] {
    let centre = |i: i16| (2 * i32::from(i) + 1 - i32::from(size)) * (32_768 / i32::from(size));
    [centre(column) as i16, centre(row) as i16, z]
}

fn mesh(corners: &[[[i16; 3]; 3]]) -> LatticeMesh {
    let triangles = (0..corners.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    LatticeMesh::new(corners.concat(), triangles).unwrap()
}

fn drawn(corners: &[[[i16; 3]; 3]], size: u32) -> Lists {
    rasterize(&mesh(corners), &[front()], &RasterizeLhbParams::new(size))
}

/// Pixels with something in their list, and how many.
fn pixels(lists: &Lists, size: usize) -> Vec<(usize, usize, usize)> {
    let place = |(i, list): (usize, &[LhbElement])| (i % size, i / size, list.len());
    lists.each().enumerate().filter(|(_, list)| !list.is_empty()).map(place).collect()
}

#[test]
fn coordinates_are_those_of_the_view() {
    // 16384·x + 4·2^27 + 2^14 over 2^15 is 16384 + (x + 1)/2, rounded down.
    for (x, screen) in [(0, 16_384), (1, 16_385), (2, 16_385), (-1, 16_384), (-2, 16_383), (-3, 16_383)] {
        assert_eq!(on_screen(&front(), 4, [x, 0, -5]), [screen, 16_384, -5 * 16_384]);
    }
    assert_eq!([1, 2, 3, 4, 5, 1000, 1024].map(subpixels), [32_768, 16_384, 8192, 8192, 4096, 32, 32]);
}

/// Corners on pixel corners (8192, 8192), (24576, 8192), (8192, 24576): the hypotenuse x + y = 32768 runs through the
/// centres of (2, 1) and (1, 2), which a right edge does not own; (1, 1) is inside, (2, 2) beyond.
#[test]
fn a_right_triangle_and_its_other_half() {
    let [a, b, c, d] =
        [[-16_384, -16_384, 0], [16_384, -16_384, 0], [-16_384, 16_384, 0], [16_384, 16_384, 0]];
    assert_eq!(pixels(&drawn(&[[a, b, c]], 4), 4), [(1, 1, 1)]);
    assert_eq!(pixels(&drawn(&[[b, d, c]], 4), 4), [(2, 1, 1), (1, 2, 1), (2, 2, 1)]);
    // Both halves: each of the four pixels once, whatever the corner a triangle begins with.
    let square = [(1, 1, 1), (2, 1, 1), (1, 2, 1), (2, 2, 1)];
    for halves in [[[a, b, c], [b, d, c]], [[c, a, b], [c, d, b]], [[b, a, c], [d, c, b]]] {
        assert_eq!(pixels(&drawn(&halves, 4), 4), square);
    }
}

/// On the screen y grows downwards: right, then down is clockwise, so the viewer sees the back.
#[test]
fn facing_is_the_turn_that_the_viewer_sees() {
    let [a, b, c] = [at(4, (1, 1), 0), at(4, (2, 1), 0), at(4, (1, 2), 0)];
    let surfaces = |corners| drawn(&[corners], 4).elements[0].surface;
    assert_eq!([surfaces([a, b, c]), surfaces([a, c, b])], [0, 1]);
    // The geometric normal of the front, (c − a) × (b − a), is −Z: towards the viewer.
    assert!(drawn(&[[a, c, b]], 4).elements[0].is_front());
}

/// Of a square's corners on centres it owns the top left one. A triangle owns a corner when a point a little to the right,
/// and far less far down, is inside.
#[test]
fn centres_on_corners() {
    let [a, b, c, d] = [(1, 1), (2, 1), (2, 2), (1, 2)].map(|p| at(4, p, 0));
    assert_eq!(pixels(&drawn(&[[a, b, c], [a, c, d]], 4), 4), [(1, 1, 1)]);
    // The left corner of a triangle that ends in a vertical right edge through (2, 1).
    assert_eq!(pixels(&drawn(&[[a, at(4, (2, 0), 0), c]], 4), 4), [(1, 1, 1)]);
    // The middle of a vertical left edge; the right edge falls away at once from the corner above.
    assert_eq!(pixels(&drawn(&[[at(4, (1, 0), 0), b, d]], 4), 4), [(1, 1, 1)]);
}

/// From (1.5, 1.5) pixels the plane rises by one step, 16384 units, in 3 pixels. Column 2 is half a pixel on: 2730.67, so
/// 2731; a pixel is 5461.33, so 5461 each: 8192 and 13653 where the plane is at 8192 and 13653.33.
#[test]
fn depth_adds_rounded_gradients() {
    let corner = |x: i16, y: i16, z| [(x - 4) * 8192, (y - 4) * 8192, z];
    let lists = drawn(&[[corner(2, 2, 0), corner(5, 2, 1), corner(2, 5, 0)]], 8);
    let row: Vec<u32> = lists.elements.iter().take(2).map(|e| e.depth - (1 << 29)).collect();
    assert_eq!(pixels(&lists, 8), [(2, 2, 1), (3, 2, 1), (2, 3, 1)]);
    assert_eq!((row, DEPTH_ORIGIN), (vec![2731, 8192], 1 << 29));
    let shown = Shown::new(&mesh(&[[corner(2, 2, 0), corner(5, 2, 1), corner(2, 5, 0)]]), 0, &front(), 8);
    let depth = |column| shown.as_ref().map(|s| s.depth(column, 2) - (1 << 29));
    assert_eq!([depth(3), depth(4)], [Some(8192), Some(13_653)]);
}

/// Corners on the centres of (2, 5), (5, 3), (5, 6), at 2, 0 and 2 steps: 10922.67 units per row, so 10923, and two rows
/// above the first corner −21845.33, so −21845. Back at that corner the sum is one unit beyond it, and is clamped.
#[test]
fn depth_stays_among_the_corners() {
    let corners = [at(8, (2, 5), 2), at(8, (5, 3), 0), at(8, (5, 6), 2)];
    let shown = Shown::new(&mesh(&[corners]), 0, &front(), 8).unwrap();
    assert!(shown.covers(2, 5));
    assert_eq!(shown.unclamped(2, 5), 2 * i128::from(STEP) + 1);
    assert_eq!(shown.depth(2, 5), (1 << 29) + 2 * STEP);
}

/// The bound at a pixel three columns and one row on is 5 halves.
#[test]
fn the_plane_allows_the_roundings_and_no_more() {
    let corners = [at(8, (1, 1), 0), at(8, (6, 1), 5), at(8, (1, 6), 0)];
    let shown = Shown::new(&mesh(&[corners]), 0, &front(), 8).unwrap();
    let exact = (1 << 29) + 3 * STEP;
    assert_eq!(shown.depth(4, 2), exact);
    let near = [-3, -2, 0, 2, 3].map(|d| shown.is_near_plane(4, 2, exact.wrapping_add_signed(d)));
    assert_eq!(near, [false, true, true, true, false]);
}

#[test]
fn lists_are_ordered_by_depth_then_number_and_cut_from_either_end() {
    let layer = |z| [at(4, (1, 1), z), at(4, (3, 1), z), at(4, (1, 2), z)];
    let layers = mesh(&[layer(3), layer(-1), layer(3), layer(-7)]);
    let with = |layer_cap, cap_side| {
        let params = RasterizeLhbParams { layer_cap, cap_side, ..RasterizeLhbParams::new(4) };
        let lists = rasterize(&layers, &[front()], &params);
        let first = lists.each().find(|list| !list.is_empty()).unwrap_or_default();
        (first.iter().map(|e| e.triangle()).collect::<Vec<_>>(), lists.left_out.get(5).copied())
    };
    assert_eq!(with(0, CAP_FAR), (vec![3, 1, 0, 2], None));
    assert_eq!(with(1, CAP_NEAR), (vec![3], Some(3)));
    assert_eq!(with(3, CAP_FAR), (vec![1, 0, 2], Some(1)));
    assert_eq!(with(4, CAP_FAR), (vec![3, 1, 0, 2], Some(0)));
    assert_eq!(with(u32::MAX, CAP_NEAR), (vec![3, 1, 0, 2], Some(0)));
}

#[test]
fn views_follow_each_other() {
    let corners = [at(4, (1, 0), 0), at(4, (2, 0), 0), at(4, (1, 1), 0)];
    let turned = View { right: front().down, down: front().right, ..front() };
    let lists = rasterize(&mesh(&[corners]), &[front(), turned], &RasterizeLhbParams::new(4));
    let filled: Vec<usize> =
        lists.each().enumerate().filter(|(_, l)| !l.is_empty()).map(|(i, _)| i).collect();
    // (1, 0) of the first view is (0, 1) of the second.
    assert_eq!((filled, lists.offsets.len()), (vec![1, 16 + 4], 33));
    assert_eq!([lists.elements[0].surface, lists.elements[1].surface], [0, 1]);
    let nothing = rasterize(&LatticeMesh::default(), &[front()], &RasterizeLhbParams::new(2));
    assert_eq!(nothing, Lists { offsets: vec![0; 5], ..Lists::default() });
    assert_eq!(rasterize(&mesh(&[corners]), &[], &RasterizeLhbParams::new(2)).offsets, [0]);
}
