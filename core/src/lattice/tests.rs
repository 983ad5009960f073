use super::*;
use crate::scene::{Limits, Material, Mesh, Scene, compile};
use proptest::prelude::*;

fn direction() -> impl Strategy<Value = DVec3> {
    (-1.0..1.0, -1.0..1.0, -1.0..1.0)
        .prop_map(|(x, y, z)| DVec3::new(x, y, z))
        .prop_filter("a direction", |d| d.length() > 1e-3)
}

fn dot(row: [i32; 4], p: [i64; 3]) -> i64 {
    (0..3).map(|c| i64::from(row[c]) * p[c]).sum()
}

proptest! {
    /// The budget at its limit: a position as far along a row as one can be.
    #[test]
    fn screen_coordinates_stay_on_the_image(d in direction(), towards in direction(), size in 1..=MAX_SIZE) {
        let view = View::along(d, size).unwrap();
        prop_assert!(view.check(size).is_ok());
        let shift = subpixel_bits(size) + 14;
        let edge = i64::from(size) << subpixel_bits(size);
        prop_assert!(edge <= 1 << 15);
        for row in [view.right, view.down, view.forward] {
            let along = DVec3::new(row[0].into(), row[1].into(), row[2].into()).normalize();
            for to in [along, -along, towards.normalize()] {
                let p = (to * f64::from(REACH)).to_array().map(|c| c.trunc() as i64);
                for axis in [view.right, view.down] {
                    let x = (dot(axis, p) + (i64::from(size) << shift) + (1 << 14)) >> 15;
                    prop_assert!((0..=edge).contains(&x), "{x} of {edge}");
                }
                let depth = dot(view.forward, p) + i64::from(DEPTH_ORIGIN);
                prop_assert!(depth > 0 && depth < 1 << 30);
            }
        }
    }

    #[test]
    fn the_opposite_view_is_the_mirror_image(d in direction(), size in 1..=MAX_SIZE) {
        let (view, opposite) = (View::along(d, size).unwrap(), View::along(-d, size).unwrap());
        prop_assert_eq!(opposite.down, view.down);
        prop_assert_eq!(opposite.right, view.right.map(|c| -c));
        prop_assert_eq!(opposite.forward, view.forward.map(|c| -c));
        prop_assert!((view.direction() - d.normalize()).length() < 0.9 / 16384.0);
    }

    #[test]
    fn snapping_moves_by_half_a_step(x in -1e3..1e3, y in -1e3..1e3, z in -1e3..1e3) {
        let lattice = Lattice::new(DVec3::new(1.0, -2.0, 3.0), 2000.0).unwrap();
        let p = DVec3::new(x, y, z);
        let moved = (lattice.place(lattice.snap(p).unwrap()) - p).abs().max_element();
        prop_assert!(moved <= lattice.step() * 0.500_001);
    }

    /// G11 and G12: shifts and scales that f64 takes exactly don't change what is snapped.
    #[test]
    fn exact_shifts_and_scales_change_nothing(
        points in prop::collection::vec([-1000_i32..1000, -1000..1000, -1000..1000], 1..20),
        shift in [-1048576_i32..1048576, -1048576..1048576, -1048576..1048576],
        power in -20_i32..20,
    ) {
        let as_given: Vec<DVec3> = points.iter().map(|&p| glam::IVec3::from(p).as_dvec3()).collect();
        let factor = f64::from(power).exp2();
        let moved: Vec<DVec3> =
            as_given.iter().map(|&p| (p + glam::IVec3::from(shift).as_dvec3()) * factor).collect();
        let snapped = |points: &[DVec3]| {
            let lattice = Lattice::around(points.iter().copied()).unwrap();
            points.iter().map(|&p| lattice.snap(p).unwrap()).collect::<Vec<_>>()
        };
        prop_assert_eq!(snapped(&as_given), snapped(&moved));
    }
}

#[test]
fn the_farthest_point_is_in_reach() {
    let points = [DVec3::new(3.0, 0.0, 0.0), DVec3::new(-3.0, 0.0, 0.0), DVec3::new(1.0, 2.0, 2.0)];
    let lattice = Lattice::around(points.into_iter()).unwrap();
    assert!((lattice.step() * 32_759.0 - 3.0).abs() < 0.51);
    assert!(points.iter().all(|&p| lattice.snap(p).is_some()));
    assert_eq!(lattice.snap(DVec3::new(300.0, 0.0, 0.0)), None);
    assert_eq!(lattice.snap(DVec3::NAN), None);
}

/// G10: bounds flat in one, two or three axes.
#[test]
fn flat_bounds_have_a_lattice() {
    for points in [vec![], vec![DVec3::ONE], vec![DVec3::ONE, DVec3::X], vec![DVec3::ONE, DVec3::X, DVec3::Y]]
    {
        let lattice = Lattice::around(points.iter().copied()).unwrap();
        assert!(lattice.step() > 0.0);
        assert!(points.iter().all(|&p| lattice.snap(p).is_some()));
    }
    assert!(Lattice::around([DVec3::NAN].into_iter()).is_err());
    assert!(Lattice::new(DVec3::ZERO, f64::INFINITY).is_err());
}

#[test]
fn meshes_are_checked() {
    let corner = [[0_i16, 0, 0], [1, 0, 0], [0, 1, 0]].to_vec();
    assert!(LatticeMesh::new(corner.clone(), vec![[0, 1, 2]]).is_ok());
    let error = LatticeMesh::new(corner, vec![[0, 1, 2], [0, 1, 3]]).unwrap_err().to_string();
    assert_eq!(error, "triangles[1]: [0, 1, 3] names a vertex beyond the 3 there are");
    let error = LatticeMesh::new(vec![[30000, 20000, 0]], vec![]).unwrap_err().to_string();
    assert_eq!(error, "vertices[0]: [30000, 20000, 0] is farther than 32760 from the centre");
}

#[test]
fn shared_corners_become_one_vertex() {
    let lattice = Lattice::new(DVec3::ZERO, 1.0).unwrap();
    let [a, b, c, d] = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::ONE * 0.5];
    let mesh = LatticeMesh::snap(&lattice, [[a, b, c], [b, d, c]].into_iter()).unwrap();
    assert_eq!((mesh.vertices().len(), mesh.triangles()), (4, &[[0, 1, 2], [1, 3, 2]][..]));
    let twice = mesh.followed_by(&mesh).unwrap();
    assert_eq!(twice.triangles()[3], [5, 7, 6]);
    assert!(LatticeMesh::snap(&lattice, [[a, b, c * 1.1]].into_iter()).is_err());
}

#[test]
fn bad_views_are_refused() {
    assert!(View::along(DVec3::ZERO, 8).is_err());
    assert!(View::along(DVec3::NAN, 8).is_err());
    assert!(View::along(DVec3::X, 0).is_err());
    assert!(View::along(DVec3::X, 1025).is_err());
    let mut view = View::along(DVec3::X, 8).unwrap();
    view.down[0] = i32::MIN;
    assert!(view.check(8).unwrap_err().to_string().starts_with("view.down: ["));
}

/// A floor of two units around the origin, and a triangle at a height that moves.
fn floor_and(height: f32) -> CompiledScene {
    let mut scene = Scene::default();
    let material = scene.add_material(Material::default());
    let floor = vec![[-1.0, 0.0, -1.0], [1.0, 0.0, -1.0], [1.0, 0.0, 1.0], [-1.0, 0.0, 1.0]];
    let bird = vec![[0.0, height, 0.0], [0.1, height, 0.0], [0.0, height, 0.1]];
    scene.add_mesh(Mesh::new("bird", bird, vec![[0, 1, 2]], material));
    scene.add_mesh(Mesh::new("floor", floor, vec![[0, 2, 1], [0, 3, 2]], material));
    scene.instances[0].moves = true;
    compile(&scene, &Limits::default()).unwrap()
}

/// The lattice is that of what stays for as long as it reaches everything, and then that of everything.
#[test]
fn what_moves_is_on_the_lattice_of_what_stays() {
    let floor = Lattice::new(DVec3::ZERO, 2.0_f64.sqrt()).unwrap();
    for (height, near) in [(0.5, true), (-1.0, true), (1.4, true), (1.42, false), (30.0, false)] {
        let scene = floor_and(height);
        let lattice = Lattice::of_scene(&scene).unwrap();
        assert_eq!(lattice == floor, near, "{height}: {lattice:?}");
        let all = Lattice::of_triangles(&scene.triangles).unwrap();
        assert_eq!(lattice == all, !near, "{height}: {lattice:?}");
        let (staying, moving) = scene.parts();
        assert_eq!((staying.len(), moving.len(), moving[0].id), (2, 1, 0));
        let whole = LatticeMesh::of_scene(&lattice, &scene).unwrap();
        let [behind, first] =
            [moving, staying].map(|part| LatticeMesh::of_triangles(&lattice, part).unwrap());
        assert!(first.followed_by(&behind).unwrap().planes().eq(whole.planes()));
    }
}
