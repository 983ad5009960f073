//! Culling takes nothing that covers a pixel, and takes most of what doesn't.

use super::Fragment;
use super::cover::{Candidate, cover};
use super::draw::draw;
use super::project::Projection;
use crate::mesh::{Boxes, CpuMesh, RUN, halves};
use crate::simd::{Isa, Kernel, Width, dispatch};
use bytemuck::Zeroable;
use glam::DVec3;
use proptest::prelude::*;
use twinlight_core::kernels::rasterize_lhb::RasterizeLhbParams;
use twinlight_core::lattice::{LatticeMesh, REACH, View, subpixel_bits};

/// A coordinate of the screen, as the contract has it, in integers that can't overflow.
fn on_screen(row: [i32; 4], p: [i16; 3], size: u32) -> i64 {
    let middle = (i64::from(size) << (subpixel_bits(size) + 14)) + (1 << 14);
    (0..3).fold(middle, |sum, i| sum + i64::from(row[i]) * i64::from(p[i])) >> 15
}

/// Whether a centre lies between two coordinates, ends included.
fn holds_a_centre(least: i64, greatest: i64, size: u32) -> bool {
    let (pixel, half) = (1_i64 << subpixel_bits(size), 1_i64 << (subpixel_bits(size) - 1));
    let first = (least - half).div_euclid(pixel) + i64::from((least - half).rem_euclid(pixel) > 0);
    first * pixel + half <= greatest
}

/// The fragments of every triangle, none of them culled.
struct Unculled<'a>(&'a LatticeMesh, &'a View, &'a RasterizeLhbParams);

impl Kernel for Unculled<'_> {
    type Output = Vec<Fragment>;

    fn run<W: Width>(self, _: W) -> Vec<Fragment> {
        let Self(mesh, view, params) = self;
        let resident = CpuMesh::new(mesh).unwrap();
        let mut fragments = Vec::new();
        for (i, triangle) in mesh.triangles().iter().enumerate() {
            let corners = triangle.map(|v| {
                let p = mesh.vertices()[v as usize];
                [view.right, view.down].map(|row| on_screen(row, p, params.size) as i32)
            });
            let run = &resident.clusters.as_flattened()[i / RUN];
            cover(
                &Candidate { triangle: i as u32, corners, run, lane: i % RUN },
                view,
                params,
                &mut fragments,
            );
        }
        fragments
    }
}

struct Culled<'a>(&'a LatticeMesh, &'a View, &'a RasterizeLhbParams);

impl Kernel for Culled<'_> {
    type Output = Vec<Fragment>;

    fn run<W: Width>(self, width: W) -> Vec<Fragment> {
        let mut fragments = Vec::new();
        draw::<W::U8>(width, &CpuMesh::new(self.0).unwrap(), self.1, self.2, &mut Vec::new(), &mut fragments);
        fragments
    }
}

/// Which boxes are kept.
struct Kept<'a>(&'a Boxes, &'a View, u32);

impl Kernel for Kept<'_> {
    type Output = u32;

    fn run<W: Width>(self, width: W) -> u32 {
        Projection::<W::U8>::new(width, self.1, self.2).boxes_with_a_centre(width, self.0)
    }
}

/// A position made to be in reach.
fn pulled_in(p: [i32; 3]) -> [i16; 3] {
    let p = DVec3::from(p.map(f64::from));
    let most = f64::from(REACH);
    let p = if p.length() > most { p * (most / p.length()) } else { p };
    p.to_array().map(|c| c as i16)
}

/// Any direction; often one along axes, on whose views lattice points are at centres and edges.
fn direction() -> impl Strategy<Value = DVec3> {
    let some = [-1.0..1.0_f64, -1.0..1.0, -1.0..1.0].prop_map(DVec3::from);
    let straight = [-1..=1_i32, -1..=1, -1..=1].prop_map(|d| DVec3::from(d.map(f64::from)));
    prop_oneof![some, straight].prop_filter("a direction", |d| d.length() > 0.1)
}

/// Sizes of all kinds.
fn size() -> impl Strategy<Value = u32> {
    prop_oneof![1..=1024_u32, 1..=9_u32, Just(128), Just(1024)]
}

/// Coordinates everywhere, at the ends, and on multiples of powers of two.
fn coordinate() -> impl Strategy<Value = i32> {
    let any = -REACH..=REACH;
    let even = (-REACH..=REACH, 0..14_u32).prop_map(|(c, bits)| c >> bits << bits);
    prop_oneof![any, even, Just(REACH), Just(-REACH), -1..=1_i32]
}

/// Small triangles around a point, often on a coarse grid.
fn tiny_mesh() -> impl Strategy<Value = LatticeMesh> {
    let place = [coordinate(), coordinate(), coordinate()];
    let corner = [-20..=20_i32, -20..=20, -20..=20];
    let triangles = prop::collection::vec((corner.clone(), corner.clone(), corner), 0..200);
    (place, 0..9_u32, triangles).prop_map(|(place, bits, triangles)| {
        let at =
            |c: [i32; 3]| pulled_in(std::array::from_fn(|i| (place[i] >> bits << bits) + (c[i] << bits)));
        let vertices: Vec<_> = triangles.iter().flat_map(|&(a, b, c)| [at(a), at(b), at(c)]).collect();
        let numbers = (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        LatticeMesh::new(vertices, numbers).unwrap()
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, ..ProptestConfig::default() })]

    #[test]
    fn culled_and_unculled_are_the_same(mesh in tiny_mesh(), direction in direction(), size in size()) {
        let (view, params) = (View::along(direction, size).unwrap(), RasterizeLhbParams::new(size));
        let all = dispatch(Isa::Portable, Unculled(&mesh, &view, &params));
        for isa in Isa::ALL {
            prop_assert_eq!(&dispatch(isa, Culled(&mesh, &view, &params)), &all);
        }
    }

    /// Boxes with corners out of reach among them.
    #[test]
    fn boxes_are_kept_exactly_where_corners_enclose_a_centre(
        corners in prop::collection::vec(([coordinate(), coordinate(), coordinate()], [0..400_i32, 0..400, 0..400], 0..8_u32), RUN),
        direction in direction(),
        size in size(),
    ) {
        let view = View::along(direction, size).unwrap();
        let mut boxes = Boxes::zeroed();
        let mut wanted = 0;
        for (lane, (least, extent, shift)) in corners.into_iter().enumerate() {
            let end: [i32; 3] = std::array::from_fn(|i| (least[i] + (extent[i] >> shift)).min(REACH));
            let ends = [least, end].map(|p| p.map(|c| c as i16));
            boxes.least[lane] = halves(ends[0][0], ends[0][1]);
            boxes.greatest[lane] = halves(ends[1][0], ends[1][1]);
            boxes.z[lane] = halves(ends[0][2], ends[1][2]);
            let holds = |row: [i32; 4]| {
                let on_screen = |i: usize| on_screen(row, std::array::from_fn(|axis| ends[i >> axis & 1][axis]), size);
                let (least, greatest) = (0..8).map(on_screen).fold((i64::MAX, i64::MIN), |(a, b), x| (a.min(x), b.max(x)));
                holds_a_centre(least, greatest, size)
            };
            wanted |= u32::from(holds(view.right) && holds(view.down)) << lane;
        }
        for isa in Isa::ALL {
            prop_assert_eq!(dispatch(isa, Kept(&boxes, &view, size)), wanted);
        }
    }
}

/// A sheet of triangles a twentieth of a pixel wide: few of its runs are looked into, and every pixel's centre is still found.
#[test]
fn few_runs_of_a_fine_mesh_are_looked_into() {
    let (size, cells, step) = (128, 160_u32, 26);
    let vertex = |i: u32| (i as i32 - cells as i32 / 2) as i16 * step;
    let vertices = (0..=cells).flat_map(|y| (0..=cells).map(move |x| [vertex(x), vertex(y), 0])).collect();
    let corner = |x: u32, y: u32| y * (cells + 1) + x;
    let quads = (0..cells).flat_map(|y| (0..cells).map(move |x| (x, y)));
    let triangles = quads.flat_map(|(x, y)| {
        [
            [corner(x, y), corner(x + 1, y), corner(x, y + 1)],
            [corner(x + 1, y), corner(x + 1, y + 1), corner(x, y + 1)],
        ]
    });
    let mesh = LatticeMesh::new(vertices, triangles.collect()).unwrap();
    let resident = CpuMesh::new(&mesh).unwrap();
    for direction in [DVec3::Z, DVec3::new(0.2, 0.3, -1.0)] {
        let view = View::along(direction, size).unwrap();
        let kept = |boxes: &Boxes| dispatch(Isa::Portable, Kept(boxes, &view, size)).count_ones();
        let kept: u32 = resident.boxes.iter().map(kept).sum();
        let runs = mesh.triangles().len() / RUN;
        let params = RasterizeLhbParams::new(size);
        let pixels = dispatch(Isa::Portable, Culled(&mesh, &view, &params)).len();
        assert!(pixels > 40, "{pixels} pixels");
        assert!((kept as usize) < runs / 20, "{kept} of {runs} runs, {pixels} pixels");
    }
}
