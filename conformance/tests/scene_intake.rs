//! Hard cases of scene intake: what never reaches a kernel.

use twinlight_conformance::scenes::{scene_of, separate};
use twinlight_core::scene::{HAS_NORMALS, Limits, Scene, Transform, compile};
use twinlight_core::{Error, Result};
use twinlight_fixtures::meshes;

fn with_vertex(x: f32) -> Scene {
    let sound = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    scene_of(separate("pair", &[sound, [[x, 0.0, 0.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0]]]))
}

fn lenient() -> Limits {
    Limits { lenient: true, ..Limits::default() }
}

fn refused<T>(result: Result<T>) -> String {
    match result {
        Err(error @ Error::InvalidInput { .. }) => error.to_string(),
        Err(other) => panic!("{other:?} instead of InvalidInput"),
        Ok(_) => panic!("accepted"),
    }
}

#[test]
fn g1_vertices_that_are_no_numbers() {
    for x in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let text = refused(compile(&with_vertex(x), &Limits::default()));
        assert!(text.contains("triangle 1 vertex 3"), "{text}");
        let compiled = compile(&with_vertex(x), &lenient()).unwrap();
        assert_eq!(compiled.triangles.len(), 1);
        assert_eq!(compiled.triangles[0].id, 0, "ids are the file's");
        assert!(compiled.notices.iter().any(|n| n.starts_with("1 triangles")), "{:?}", compiled.notices);
    }
}

#[test]
fn g2_coordinates_beyond_the_limit() {
    for exponent in -126..128_i32 {
        let x = f32::from_bits(((exponent + 127) as u32) << 23);
        for x in [x, -x] {
            match compile(&with_vertex(x), &Limits::default()) {
                Ok(compiled) => {
                    assert!(exponent <= 40, "2^{exponent} accepted");
                    let finite = |p: [f32; 3]| p.iter().all(|c| c.is_finite());
                    assert!(compiled.triangles.iter().all(|t| finite(t.p0) && finite(t.p1) && finite(t.p2)));
                    assert!(
                        compiled.bvh.nodes.iter().all(|n| finite(n.min) && finite(n.max)),
                        "2^{exponent}"
                    );
                }
                Err(error) => assert!(exponent > 40, "2^{exponent}: {error}"),
            }
        }
    }
}

#[test]
fn g3_subnormal_coordinates_are_zeros() {
    let (tiny, zero) = (with_vertex(f32::from_bits(1)), with_vertex(0.0));
    let compiled = |scene| compile(scene, &Limits::default()).unwrap();
    assert_eq!(compiled(&tiny).triangles, compiled(&zero).triangles);
}

#[test]
fn g4_indices_out_of_range() {
    let mut scene = with_vertex(0.0);
    scene.meshes[0].triangles[1] = [0, 1, 6];
    let text = refused(compile(&scene, &Limits::default()));
    assert!(text.contains('6'), "{text}");
    let mut scene = with_vertex(0.0);
    scene.meshes[0].material_ids.pop();
    refused(compile(&scene, &Limits::default()));
    let mut scene = with_vertex(0.0);
    scene.instances[0].mesh = 9;
    refused(compile(&scene, &Limits::default()));
}

#[test]
fn g13_singular_transforms() {
    let mut scene = with_vertex(0.0);
    scene.instances[0].transform = Transform::scale_translate(0.0, glam::DVec3::ZERO);
    refused(compile(&scene, &Limits::default()));
    scene.instances[0].transform = Transform::scale_translate(f64::NAN, glam::DVec3::ZERO);
    refused(compile(&scene, &Limits::default()));
}

#[test]
fn g14_unusable_normals_are_counted() {
    let ball = meshes::with_smooth_normals(meshes::icosphere(1));
    let mut scene = scene_of(ball);
    scene.meshes[0].normals.fill([0.0; 3]);
    let compiled = compile(&scene, &Limits::default()).unwrap();
    assert!(compiled.attributes.iter().all(|a| a.flags & HAS_NORMALS == 0));
    assert!(compiled.notices.iter().any(|n| n.starts_with("20 triangles")), "{:?}", compiled.notices);
}
