//! `trace` and `shade_primary` through the backend: known pictures, and the same bits for any number of threads on any
//! instruction set.

use bytemuck::{Zeroable, cast_slice};
use glam::{DVec3, Vec3};
use twinlight_backend_cpu::CpuBackend;
use twinlight_backend_cpu::simd::{Isa, detect};
use twinlight_core::kernels::shade_primary::{GBufferTexel, ShadePrimaryParams};
use twinlight_core::kernels::trace::{Hit, NO_HIT, Ray};
use twinlight_core::scene::{Camera, Light, Limits, Material, Mesh, Scene, compile};
use twinlight_core::{Backend, Error};
use twinlight_fixtures::random::Random;
use twinlight_fixtures::scenes::builtin;

const EYE: [f64; 3] = [0.0, 0.0, 5.0];

/// A wall of two triangles in the plane z = 0, seen from z = 5; the second material is the wall's.
fn wall(normals: Vec<[f32; 3]>) -> Scene {
    let mut scene = Scene {
        materials: vec![Material::diffuse("other", [0.1; 3]), Material::diffuse("wall", [0.2, 0.4, 0.6])],
        camera: Some(Camera { position: EYE, target: [0.0; 3], up: [0.0, 1.0, 0.0], vfov_degrees: 60.0 }),
        ..Scene::default()
    };
    let positions = vec![[-2.0, -2.0, 0.0], [2.0, -2.0, 0.0], [2.0, 2.0, 0.0], [-2.0, 2.0, 0.0]];
    let mesh = Mesh::new("wall", positions, vec![[0, 1, 2], [0, 2, 3]], 1);
    scene.add_mesh(Mesh { normals, ..mesh });
    scene
}

fn picture(backend: &CpuBackend, scene: &Scene, width: u32, height: u32) -> (Vec<GBufferTexel>, [f64; 3]) {
    let compiled = compile(scene, &Limits::default()).expect("a valid scene");
    let camera = Camera::of_scene(scene).expect("a camera");
    let camera = camera.record(width, height, compiled.origin).expect("a valid camera");
    let params = ShadePrimaryParams { camera, width, height, padding: [0; 2] };
    let resident = backend.upload_scene(&compiled).expect("memory");
    // Not zeroed: a texel that nothing writes must not look like one that sees nothing.
    let stale = GBufferTexel { depth: -7.0, triangle: 7, ..GBufferTexel::zeroed() };
    let mut gbuffer = backend.upload(&vec![stale; (width * height) as usize]).expect("memory");
    backend.shade_primary(&resident, &params, &mut gbuffer).expect("lengths agree");
    (backend.download(&gbuffer).expect("memory"), compiled.origin)
}

fn nothing() -> GBufferTexel {
    GBufferTexel { triangle: NO_HIT, ..GBufferTexel::zeroed() }
}

#[test]
fn a_wall_is_where_it_is() {
    let (texels, origin) = picture(&CpuBackend::new(), &wall(Vec::new()), 64, 48);
    let mut seen = [0; 2];
    for (i, texel) in texels.iter().enumerate() {
        let (x, y) = ((i % 64) as f64 + 0.5, (i / 64) as f64 + 0.5);
        // The picture's half height is 5·tan 30° in the wall's plane; pixels are square.
        let pixel = 5.0 * (0.5 * 60.0_f64.to_radians()).tan() / 24.0;
        let point = DVec3::new((x - 32.0) * pixel, (24.0 - y) * pixel, 0.0);
        if point.abs().max_element() > 2.0 {
            assert_eq!(*texel, nothing(), "pixel {i}");
            continue;
        }
        let position = Vec3::from(texel.position).as_dvec3() + DVec3::from(origin);
        assert!((position - point).length() < 1e-5, "pixel {i}: {position}, not {point}");
        assert!((f64::from(texel.depth) - 5.0).abs() < 1e-5, "depth along the axis, not along the ray");
        assert_eq!((texel.geometric_normal, texel.shading_normal), ([0.0, 0.0, 1.0], [0.0, 0.0, 1.0]));
        assert_eq!((texel.albedo, texel.material), ([0.2, 0.4, 0.6], 1));
        // On the diagonal, rounding may put the ray into either.
        if (point.y - point.x).abs() > 1e-6 {
            assert_eq!(texel.triangle, u32::from(point.y > point.x), "pixel {i}");
        }
        seen[texel.triangle as usize] += 1;
    }
    assert!(seen.iter().all(|&count| count > 500), "{seen:?}");
}

#[test]
fn normals_face_the_camera_and_follow_the_vertices() {
    let backend = CpuBackend::new();
    let tilted = [0.6_f32, 0.0, 0.8];
    let center = |scene: &Scene| picture(&backend, scene, 1, 1).0[0];
    assert_eq!(center(&wall(vec![tilted; 4])).shading_normal, tilted);
    // Contrary ones end on the side of the camera all the same.
    assert!(center(&wall(vec![[0.0, 0.6, -0.8]; 4])).shading_normal[2] >= 0.8);
    let mut behind = wall(vec![tilted; 4]);
    behind.camera = behind.camera.map(|c| Camera { position: [0.0, 0.0, -5.0], ..c });
    let texel = center(&behind);
    assert_eq!((texel.geometric_normal, texel.shading_normal), ([0.0, 0.0, -1.0], [-0.6, 0.0, -0.8]));
}

#[test]
fn a_sphere_light_hides_what_is_behind_it() {
    let lamp = |z: f32| Light::Sphere { center: [0.0, 0.0, z], radius: 0.5, radiance: [1.0; 3] };
    let mut scene = wall(Vec::new());
    scene.lights.push(lamp(2.0));
    let (texels, _) = picture(&CpuBackend::new(), &scene, 33, 33);
    let middle = 16 * 33 + 16;
    assert_eq!(texels[middle], nothing());
    assert_eq!(texels[middle + 10].triangle, 0, "beside the lamp");
    scene.lights[0] = lamp(-2.0);
    let (texels, _) = picture(&CpuBackend::new(), &scene, 33, 33);
    assert_ne!(texels[middle].triangle, NO_HIT, "the lamp is behind the wall");
}

#[test]
fn an_empty_scene_shows_nothing() {
    let scene = Scene { camera: wall(Vec::new()).camera, ..Scene::default() };
    let (texels, _) = picture(&CpuBackend::new(), &scene, 5, 3);
    assert_eq!(texels, vec![nothing(); 15]);
}

#[test]
fn a_buffer_of_the_wrong_length_is_an_error() {
    let (backend, scene) = (CpuBackend::new(), wall(Vec::new()));
    let compiled = compile(&scene, &Limits::default()).unwrap();
    let camera = Camera::of_scene(&scene).unwrap().record(4, 4, compiled.origin).unwrap();
    let resident = backend.upload_scene(&compiled).unwrap();
    let mut gbuffer = backend.zeroed(15).unwrap();
    let params = ShadePrimaryParams { camera, width: 4, height: 4, padding: [0; 2] };
    let error = backend.shade_primary(&resident, &params, &mut gbuffer).unwrap_err();
    assert!(matches!(error, Error::InvalidInput { .. }), "{error}");
    let params = ShadePrimaryParams { width: u32::MAX, height: u32::MAX, ..params };
    assert!(backend.shade_primary(&resident, &params, &mut gbuffer).is_err());
}

/// Bytes of the hits, the shadows and the picture of a scene.
fn everything(backend: &CpuBackend, scene: &Scene) -> Vec<u8> {
    let compiled = compile(scene, &Limits::default()).unwrap();
    let resident = backend.upload_scene(&compiled).unwrap();
    let mut random = Random::new(5);
    let (low, high) = (Vec3::from(compiled.bounds.0).as_dvec3(), Vec3::from(compiled.bounds.1).as_dvec3());
    let mut ray = || Ray {
        origin: random.point(low, high).as_vec3().to_array(),
        t_min: 0.0,
        direction: random.direction().as_vec3().to_array(),
        t_max: if random.unit() < 0.5 { f32::INFINITY } else { random.unit() as f32 },
    };
    let rays = backend.upload(&(0..5000).map(|_| ray()).collect::<Vec<_>>()).unwrap();
    let mut hits = backend.zeroed::<Hit>(5000).unwrap();
    let mut occluded = backend.zeroed::<u32>(5000).unwrap();
    backend.trace_closest(&resident, &rays, &mut hits).unwrap();
    backend.trace_any(&resident, &rays, &mut occluded).unwrap();
    let (hits, occluded) = (backend.download(&hits).unwrap(), backend.download(&occluded).unwrap());
    let met = hits.iter().filter(|hit| hit.triangle != NO_HIT).count();
    assert!(met > 1000 && met < 5000, "{met}");
    let (texels, _) = picture(backend, scene, 97, 61);
    [cast_slice(&hits), cast_slice(&occluded), cast_slice(&texels)].concat()
}

#[test]
fn any_number_of_threads_and_any_instruction_set_give_the_same_bits() {
    for name in ["cornell", "materials"] {
        let scene = builtin(name).expect("a builtin scene");
        let expected = everything(&CpuBackend::with_threads(1).unwrap().with_isa(Isa::Portable), &scene);
        for (threads, isa) in
            [(1, detect()), (2, Isa::Sse2), (2, detect()), (3, Isa::Portable), (8, detect())]
        {
            let backend = CpuBackend::with_threads(threads).unwrap().with_isa(isa);
            assert!(everything(&backend, &scene) == expected, "{name}: {threads} threads, {isa:?}");
        }
    }
}
