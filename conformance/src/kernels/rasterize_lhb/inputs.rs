//! Meshes and views made to hurt: vertices on pixel centres, edges along them, triangles of every size and shape.

use glam::{DMat3, DVec3, Vec3};
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::select;
use twinlight_core::kernels::rasterize_lhb::RasterizeLhbParams;
use twinlight_core::lattice::{Lattice, LatticeMesh, View};
use twinlight_core::scene::Mesh;
use twinlight_fixtures::meshes;
use twinlight_fixtures::random::Random;

/// Half the side of a cube whose corners are within reach: 18913·√3 < 32760.
pub(in crate::kernels) const SIDE: i16 = 18_913;

pub(in crate::kernels) type Corners = [[i16; 3]; 3];

/// Triangles with corners of their own.
///
/// # Panics
/// When a corner is out of reach: a defect of the case.
pub(in crate::kernels) fn separate(corners: &[Corners]) -> LatticeMesh {
    let triangles = (0..corners.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    LatticeMesh::new(corners.concat(), triangles).expect("the suite's own corners are within reach")
}

/// A float mesh on the lattice around it, its vertices as they are numbered.
pub(in crate::kernels) fn snapped(mesh: &Mesh) -> LatticeMesh {
    let points = mesh.positions.iter().map(|&p| Vec3::from(p).as_dvec3());
    let lattice = Lattice::around(points.clone()).expect("fixtures are finite");
    let vertices = points.map(|p| lattice.snap(p).expect("the lattice is around it")).collect();
    LatticeMesh::new(vertices, mesh.triangles.clone()).expect("fixtures name their own vertices")
}

/// The mesh about the origin by a rotation drawn from a seed.
pub(in crate::kernels) fn turned(mut mesh: Mesh, seed: u64) -> Mesh {
    let mut random = Random::new(seed);
    let x = random.direction();
    let y = x.cross(random.direction()).normalize();
    let turn = DMat3::from_cols(x, y, x.cross(y));
    for p in &mut mesh.positions {
        *p = (turn * Vec3::from(*p).as_dvec3()).as_vec3().to_array();
    }
    mesh
}

/// Along +Z with x to the right and y downwards. Where the size is a power of two, pixel i's centre is the lattice's
/// x = (2i + 1 − size)·2¹⁵/size.
pub(in crate::kernels) fn front() -> View {
    View { right: [16_384, 0, 0, 0], down: [0, 16_384, 0, 0], forward: [0, 0, 16_384, 0] }
}

/// The six axes, twelve edges and eight corners of a cube.
pub(in crate::kernels) fn lattice_directions() -> Vec<DVec3> {
    let signs = [0.0, 1.0, -1.0];
    let all = signs.iter().flat_map(|&x| signs.iter().flat_map(move |&y| signs.map(|z| DVec3::new(x, y, z))));
    all.filter(|d| *d != DVec3::ZERO).collect()
}

/// Views of `size` pixels.
///
/// # Panics
/// When there is no such view: a defect of the case.
pub(in crate::kernels) fn views(directions: &[DVec3], size: u32) -> Vec<View> {
    directions.iter().map(|&d| View::along(d, size).expect("a view")).collect()
}

/// Directions of a seed.
pub(in crate::kernels) fn some_directions(count: usize, seed: u64) -> Vec<DVec3> {
    let mut random = Random::new(seed);
    (0..count).map(|_| random.direction()).collect()
}

/// One call.
#[derive(Debug, Clone)]
pub(in crate::kernels) struct Case {
    pub mesh: LatticeMesh,
    pub views: Vec<View>,
    pub params: RasterizeLhbParams,
}

/// A mesh from one to three directions, in views of up to 128 pixels, on any path.
pub(in crate::kernels) fn case(mesh: impl Strategy<Value = LatticeMesh>) -> impl Strategy<Value = Case> {
    (mesh, vec(direction(), 1..4), size(), 0..5_u32).prop_map(|(mesh, directions, size, path)| {
        let params = RasterizeLhbParams { path, ..RasterizeLhbParams::new(size) };
        Case { mesh, views: views(&directions, size), params }
    })
}

fn direction() -> impl Strategy<Value = DVec3> {
    let any = (-1.0..1.0, -1.0..1.0, -1.0..1.0).prop_map(|(x, y, z)| DVec3::new(x, y, z));
    prop_oneof![
        2 => select(lattice_directions()),
        3 => any.prop_filter("a direction", |d| d.length() > 1e-3),
    ]
}

fn size() -> impl Strategy<Value = u32> {
    prop_oneof![1..=9_u32, 10..=70_u32, select(vec![8, 16, 32, 64, 61, 67, 97, 100, 127, 128])]
}

fn corner(side: i16) -> [std::ops::RangeInclusive<i16>; 3] {
    [-side..=side, -side..=side, -side..=side]
}

pub(in crate::kernels) fn soup() -> impl Strategy<Value = LatticeMesh> {
    vec([corner(SIDE), corner(SIDE), corner(SIDE)], 0..40_usize).prop_map(|c| separate(&c))
}

/// From a lattice step to the whole screen.
pub(in crate::kernels) fn mixed_sizes() -> impl Strategy<Value = LatticeMesh> {
    let triangle = (corner(SIDE / 2), 0..15_u32, [corner(SIDE / 2), corner(SIDE / 2), corner(SIDE / 2)]);
    let shrunk = |(middle, by, offsets): ([i16; 3], u32, Corners)| -> Corners {
        offsets.map(|o| std::array::from_fn(|i| middle[i] + (o[i] >> by)))
    };
    vec(triangle.prop_map(shrunk), 0..80_usize).prop_map(|c| separate(&c))
}

/// Coordinates on multiples of 2¹⁰ to 2¹⁴: along the axes, at sizes up to 32, vertices fall on pixel centres and corners,
/// and edges run through both.
pub(in crate::kernels) fn aligned() -> impl Strategy<Value = LatticeMesh> {
    let triangles = vec([corner(16), corner(16), corner(16)], 0..40_usize);
    (triangles, 10..=14_u32).prop_map(|(corners, power)| {
        // Coordinates stay within ±2¹⁴, whatever the power.
        let most = 1_i16 << (14 - power);
        let place = |c: i16| ((c + 16) % (2 * most + 1) - most) << power;
        separate(&corners.iter().map(|t| t.map(|p| p.map(place))).collect::<Vec<Corners>>())
    })
}

pub(in crate::kernels) fn fans_and_strips() -> impl Strategy<Value = LatticeMesh> {
    (1..40_u32, any::<bool>(), any::<u64>()).prop_map(|(count, fan, seed)| {
        snapped(&turned(if fan { meshes::fan(count) } else { meshes::strip(count) }, seed))
    })
}

pub(in crate::kernels) fn thin() -> impl Strategy<Value = LatticeMesh> {
    (1..60_u32, 0..3_u32, any::<u64>()).prop_map(|(count, kind, seed)| match kind {
        0 => snapped(&meshes::slivers(count, 1e-3, seed)),
        1 => snapped(&meshes::slivers(count, 1e-6, seed)),
        _ => snapped(&meshes::needles(count, seed)),
    })
}

/// Few triangles, many times each, in one order or another.
pub(in crate::kernels) fn duplicates() -> impl Strategy<Value = LatticeMesh> {
    let pick = vec(any::<prop::sample::Index>(), 1..120_usize);
    (vec([corner(SIDE), corner(SIDE), corner(SIDE)], 1..5_usize), pick)
        .prop_map(|(few, pick)| separate(&pick.iter().map(|i| *i.get(&few)).collect::<Vec<Corners>>()))
}

/// Any of these.
pub(in crate::kernels) fn any_mesh() -> impl Strategy<Value = LatticeMesh> {
    prop_oneof![soup(), mixed_sizes(), aligned(), fans_and_strips(), thin(), duplicates()]
}
