// kernel family: trace_paths
// contract core/src/kernels/trace_paths.rs
// cpu backend-cpu/src/kernels/trace_paths.rs
// gpu backend-gpu/src/kernels/trace_paths.wgsl
// oracle conformance/src/oracle/trace_paths.rs
//! Oracle of `trace_paths`: scenes whose radiance is known without tracing a path, in closed form or by quadrature in
//! f64. Each view is so narrow, or its radiance so even, that one number holds for the whole picture; `slack` bounds what
//! that leaves out.

mod glossy;

use std::f64::consts::PI;
use twinlight_core::scene::{Camera, Environment, Light, Material, MaterialKind, Mesh, Scene};
use twinlight_fixtures::meshes::{icosphere, quad, with_material};
use twinlight_fixtures::scenes;

/// A scene with a known answer.
#[derive(Debug, Clone)]
pub struct Known {
    /// What it shows.
    pub name: String,
    /// The scene, camera included.
    pub scene: Scene,
    /// Scattering vertices; `None` for as many as roulette grants.
    pub bounces: Option<u32>,
    /// Radiance of every pixel.
    pub radiance: [f64; 3],
    /// Relative error of that number: the view's extent, facets of round things.
    pub slack: f64,
}

/// Colours that tell the channels apart.
const TINT: [f64; 3] = [1.0, 0.5, 0.25];

fn tinted(value: f64) -> [f64; 3] {
    TINT.map(|t| t * value)
}

fn light(value: f64) -> [f32; 3] {
    TINT.map(|t| (t * value) as f32)
}

/// Closed rooms of albedo ρ and emission Lₑ: Lₑ·Σ ρᵏ, k from 0 to the cap (T1).
pub fn furnaces() -> Vec<Known> {
    let case = |albedo: f64, emission: f64, bounces: Option<u32>| {
        let terms =
            bounces.map_or(1.0 / (1.0 - albedo), |cap| (0..=cap).map(|k| albedo.powi(k as i32)).sum());
        Known {
            name: format!("furnace, albedo {albedo}, {bounces:?} bounces"),
            scene: scenes::furnace(albedo as f32, emission as f32),
            bounces,
            radiance: [emission * terms; 3],
            slack: 2e-6,
        }
    };
    vec![
        case(0.0, 0.75, None),
        case(0.5, 0.5, None),
        case(0.5, 0.5, Some(0)),
        case(0.5, 0.5, Some(1)),
        case(0.5, 0.5, Some(2)),
        case(0.9, 0.25, Some(6)),
        case(0.9, 0.1, None),
        case(1.0, 0.25, Some(4)),
    ]
}

/// A lamp in a diffuse sphere (T2): B = ρE₀ + ρ(1 − q)B with q the share of the wall's light that the lamp swallows.
pub fn sphere_room() -> Known {
    let (albedo, lamp, radiance) = (0.5, 0.25, 17.0);
    let share: f64 = lamp * lamp;
    let known = albedo * share * radiance / (1.0 - albedo * (1.0 - share));
    Known {
        name: "sphere room".into(),
        scene: scenes::sphere_room(albedo as f32, lamp as f32, radiance as f32),
        bounces: None,
        radiance: [known; 3],
        // 48-fold facets are tilted by up to 0.017: cosines are off by 1.5e-4, squared distances by 3e-4.
        slack: 1e-3,
    }
}

const ALBEDO: f64 = 0.6;

/// A floor at y = 0, seen at the origin through 0.4° from (0, 1.5, 1.5).
fn floor() -> Scene {
    let mut scene = Scene {
        materials: vec![Material::diffuse("floor", [ALBEDO as f32; 3])],
        camera: Some(Camera {
            position: [0.0, 1.5, 1.5],
            target: [0.0; 3],
            up: [0.0, 1.0, 0.0],
            vfov_degrees: 0.4,
        }),
        ..Scene::default()
    };
    scene.add_mesh(quad([-9.0, 0.0, 9.0], [9.0, 0.0, 9.0], [9.0, 0.0, -9.0], [-9.0, 0.0, -9.0]));
    scene
}

/// The patch seen is ±0.011 by ±0.0075 around the origin, at least 1 from every light: the mean over it differs from its
/// middle by second-order terms only, below 3·(0.011)².
const PATCH: f64 = 4e-4;

/// The floor under irradiance `e` reflects ρ/π of it.
fn lit(name: &str, light: Light, e: f64) -> Known {
    let mut scene = floor();
    scene.lights.push(light);
    Known { name: name.into(), scene, bounces: None, radiance: tinted(ALBEDO / PI * e), slack: PATCH }
}

/// Lights without extent.
pub fn punctual_lights() -> Vec<Known> {
    let (r2, cosine) = (5.0_f64, 2.0 / 5.0_f64.sqrt());
    let position = [1.0, 2.0, 0.0];
    let (inner, outer) = (0.3_f64, 0.6_f64);
    // KHR_lights_punctual: the squared, clamped, linear ramp between the cosines.
    let falloff =
        |angle: f64| ((angle.cos() - outer.cos()) / (inner.cos() - outer.cos())).clamp(0.0, 1.0).powi(2);
    let spot = |angle: f64| {
        // The axis leans away from the patch by `angle`, out of the plane of light and patch.
        let towards = [-1.0 / 5.0_f64.sqrt(), -2.0 / 5.0_f64.sqrt()];
        let axis = [towards[0] * angle.cos(), towards[1] * angle.cos(), angle.sin()].map(|x| x as f32);
        let light = Light::Spot {
            position,
            direction: axis,
            intensity: light(20.0),
            inner_angle: inner as f32,
            outer_angle: outer as f32,
        };
        let known =
            lit(&format!("spot light, {angle} off its axis"), light, 20.0 * falloff(angle) * cosine / r2);
        // On the ramp the falloff changes by up to 12 per radian, over a patch of 0.005 rad; symmetric but for its bend.
        Known { slack: if angle > inner { 2e-3 } else { PATCH }, ..known }
    };
    let slant = [-3.0_f32, -4.0, 0.0];
    vec![
        lit("point light", Light::Point { position, intensity: light(20.0) }, 20.0 * cosine / r2),
        lit("directional light", Light::Directional { direction: slant, irradiance: light(3.0) }, 3.0 * 0.8),
        spot(0.0),
        spot(0.4),
        spot(0.7),
    ]
}

/// Lights with an extent, above the floor.
pub fn area_lights() -> Vec<Known> {
    // Lambert's formula for a point under the corner of a parallel rectangle, four times.
    let corner = |a: f64, b: f64| {
        let (sa, sb) = ((1.0 + a * a).sqrt(), (1.0 + b * b).sqrt());
        (a / sa * (b / sa).atan() + b / sb * (a / sb).atan()) / (2.0 * PI)
    };
    let (height, half_width, half_depth) = (2.0_f64, 1.0, 0.5);
    let factor = 4.0 * corner(half_width / height, half_depth / height);
    let (x, y, z) = (half_width as f32, height as f32, half_depth as f32);
    let rectangle = Light::Rectangle {
        corner: [-x, y, -z],
        edge_u: [2.0 * x, 0.0, 0.0],
        edge_v: [0.0, 0.0, 2.0 * z],
        radiance: light(5.0),
    };
    let mut emitter = floor();
    let glowing = emitter.add_material(Material::emitter("panel", light(5.0)));
    let panel = quad([-x, y, -z], [x, y, -z], [x, y, z], [-x, y, z]);
    emitter.add_mesh(with_material(panel, glowing));
    let (radius, distance) = (0.5_f64, 2.0);
    let sphere = Light::Sphere { center: [1.2, 1.6, 0.0], radius: radius as f32, radiance: light(8.0) };
    // A sphere wholly above the horizon: E = π·L·(R/d)²·cos θ.
    let irradiance = PI * 8.0 * (radius / distance).powi(2) * 0.8;
    vec![
        lit("rectangle light", rectangle, PI * 5.0 * factor),
        Known { scene: emitter, name: "emissive mesh".into(), ..lit("", rectangle, PI * 5.0 * factor) },
        lit("sphere light", sphere, irradiance),
    ]
}

/// The same radiance from everywhere, on the floor and around a glass ball.
pub fn environments() -> Vec<Known> {
    let mut open = floor();
    open.environment = Some(Environment::constant(light(2.0)));
    let mut halves = floor();
    // The upper quarter of the map glows, down to 45°: E = π·L·sin²45°.
    let mut sky =
        Environment { width: 8, height: 4, texels: vec![[0.0; 3]; 32], ..Environment::constant([0.0; 3]) };
    sky.texels[..8].fill(light(2.0));
    halves.environment = Some(sky);
    let mut ball = Scene {
        materials: vec![glass(1.5)],
        environment: Some(Environment::constant(light(2.0))),
        camera: Some(Camera {
            position: [0.0, 0.0, 4.0],
            target: [0.0; 3],
            up: [0.0, 1.0, 0.0],
            vfov_degrees: 40.0,
        }),
        ..Scene::default()
    };
    ball.add_mesh(icosphere(6));
    let known = |name: &str, scene: Scene, radiance: f64| Known {
        name: name.into(),
        scene,
        bounces: None,
        radiance: tinted(radiance),
        slack: PATCH,
    };
    vec![
        known("floor under an even sky", open, ALBEDO * 2.0),
        known("floor under the sky's cap", halves, ALBEDO * 2.0 * 0.5),
        known("glass ball under an even sky", ball, 2.0),
    ]
}

fn glass(ior: f32) -> Material {
    Material { kind: MaterialKind::Dielectric { ior }, ..Material::diffuse("glass", [0.0; 3]) }
}

/// A wall of radiance 3 at z = −4 behind what `in_front` adds, seen along −z.
fn before_wall(in_front: impl FnOnce(&mut Scene), camera_z: f64, target_z: f64) -> Scene {
    let mut scene = Scene {
        materials: vec![Material::emitter("wall", light(3.0))],
        camera: Some(Camera {
            position: [0.0, 0.0, camera_z],
            target: [0.0, 0.0, target_z],
            up: [0.0, 1.0, 0.0],
            vfov_degrees: 0.4,
        }),
        ..Scene::default()
    };
    scene.add_mesh(wall(-4.0, true, 0));
    in_front(&mut scene);
    scene
}

/// A square of half-width 5 across the view axis; `front` faces +z.
fn wall(z: f32, front: bool, material: u32) -> Mesh {
    let s = if front { 5.0 } else { -5.0 };
    with_material(quad([-s, -5.0, z], [s, -5.0, z], [s, 5.0, z], [-s, 5.0, z]), material)
}

/// Mirrors and plates of glass.
pub fn specular() -> Vec<Known> {
    let reflectance = 0.7_f64;
    let mirror = before_wall(
        |scene| {
            let kind = MaterialKind::Mirror;
            let silver = Material {
                kind,
                specular_f0: [reflectance as f32; 3],
                ..Material::diffuse("mirror", [0.0; 3])
            };
            let silver = scene.add_material(silver);
            scene.add_mesh(wall(2.0, false, silver));
        },
        0.0,
        2.0,
    );
    let ior = 1.7_f64;
    let plate = before_wall(
        |scene| {
            let pane = scene.add_material(glass(ior as f32));
            scene.add_mesh(wall(-1.0, true, pane));
            scene.add_mesh(wall(-1.5, false, pane));
        },
        0.0,
        -4.0,
    );
    // Fresnel at normal incidence, and the geometric series of reflections inside the plate.
    let single = ((ior - 1.0) / (ior + 1.0)).powi(2);
    let through = (1.0 - single) / (1.0 + single);
    let known = |name: &str, scene: Scene, bounces: Option<u32>, radiance: f64| Known {
        name: name.into(),
        scene,
        bounces,
        radiance: tinted(radiance),
        slack: PATCH,
    };
    vec![
        known("wall in a mirror", mirror.clone(), None, 3.0 * reflectance),
        known("wall in a mirror, no bounce", mirror, Some(0), 0.0),
        known("wall through a plate", plate, None, 3.0 * through),
    ]
}

/// A glossy floor under an even sky: quadrature of the contract's BRDF over the hemisphere.
pub fn glossy() -> Vec<Known> {
    let case = |roughness: f64, f0: f64, albedo: f64| {
        let mut scene = floor();
        scene.materials[0] = Material {
            roughness: roughness as f32,
            specular_f0: [f0 as f32; 3],
            ..Material::diffuse("glossy", [albedo as f32; 3])
        };
        scene.environment = Some(Environment::constant(light(2.0)));
        let cosine = 1.5 / (1.5_f64 * 1.5 * 2.0).sqrt();
        Known {
            name: format!("glossy floor, roughness {roughness}, f0 {f0}, albedo {albedo}"),
            scene,
            bounces: None,
            radiance: tinted(2.0 * glossy::albedo(roughness, f0, albedo, cosine)),
            // The view cosine varies by 0.3 % over the patch and the albedo with it, symmetrically.
            slack: 1e-3,
        }
    };
    vec![case(0.5, 0.9, 0.0), case(0.3, 0.04, 0.5), case(1.0, 0.5, 0.3), case(0.2, 0.6, 0.0)]
}
