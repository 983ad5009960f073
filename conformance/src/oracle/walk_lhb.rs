// kernel family: walk_lhb
// contract core/src/kernels/walk_lhb.rs
// cpu backend-cpu/src/kernels/walk_lhb.rs
// gpu backend-gpu/src/kernels/walk_lhb.wgsl
// oracle conformance/src/oracle/walk_lhb.rs
//! Oracle of `walk_lhb`: scenes whose radiance is known and does not depend on where looked-up rays end, only on whether they do:
//! convex ones, in which nothing is looked up that is there, and furnaces, in which everything looks alike. `lost` bounds the
//! light of rays that leave through a silhouette, where the centre of a pixel is beside the room.

use super::trace_paths::{self, Known};
use twinlight_core::scene::{Camera, Environment, Material, Mesh, Scene};
use twinlight_fixtures::meshes::{cube, icosphere, quad, torus, with_material};
use twinlight_fixtures::scenes;

/// A scene with a known answer, and the buffers to look it up in.
#[derive(Debug, Clone)]
pub struct Looked {
    /// The scene and its radiance.
    pub known: Known,
    /// The set of directions.
    pub directions: &'static str,
    /// Pixels per row and column of a view.
    pub size: u32,
    /// Share of the radiance that the resolution of the buffers may lose.
    pub lost: f64,
    /// Whether rays are traced whose lookup finds nothing or a lamp: without, lamps of a few pixels are met too often.
    pub trace_misses: bool,
}

/// A set of directions with its covering radius.
type Set = (&'static str, f64);

const COARSE: Set = ("icosahedron:80", 0.3508);
const FINE: Set = ("icosahedron:320", 0.1735);

/// The share of rays that leave a closed convex room unseen, at most, in two parts.
///
/// Pixels. Starts of rays are spread evenly over what a view shows of the room, area A, and the silhouette, length P, cuts its
/// pixels anywhere: ⅛ of a pixel's width along it is inside with the pixel's centre outside. P/A is 2.7 over the lattice's radius
/// for a cube and 2 for a ball, and a pixel 2/size: 0.68/size and 0.5/size.
///
/// Directions. The line that crosses the ray at the distance which the first lookup found is beside the first line by that
/// distance times an angle up to the covering radius ρ, and misses the room where it crosses the silhouette: a strip as wide as
/// the angle, of which a share as large as the angle lies behind the wall that the ray meets. Measured ρ²/3.
fn unseen((_, radius): Set, size: u32) -> f64 {
    0.37 * radius * radius + 0.7 / f64::from(size)
}

/// Closed rooms of albedo ρ and emission Lₑ. The light of k bounces was looked up at most k times: the last time where lamps are met by
/// rays.
pub fn furnaces() -> Vec<Looked> {
    let case = |albedo: f64, emission: f64, bounces: Option<u32>, set: Set, size| {
        let light = |kept: f64| {
            (0..=bounces.unwrap_or(400)).map(|k| emission * (albedo * kept).powi(k as i32)).sum::<f64>()
        };
        let known = Known {
            name: format!("furnace, albedo {albedo}, {bounces:?} bounces, {}, size {size}", set.0),
            scene: scenes::furnace(albedo as f32, emission as f32),
            bounces,
            radiance: [light(1.0); 3],
            slack: 2e-6,
        };
        let lost = 1.0 - light(1.0 - unseen(set, size)) / light(1.0);
        Looked { known, directions: set.0, size, lost, trace_misses: false }
    };
    vec![
        case(0.0, 0.75, None, COARSE, 32),
        case(0.5, 0.5, None, COARSE, 32),
        case(0.5, 0.5, None, FINE, 128),
        case(0.5, 0.5, Some(0), COARSE, 32),
        case(0.5, 0.5, Some(1), COARSE, 32),
        case(0.9, 0.25, Some(6), COARSE, 64),
        case(1.0, 0.25, Some(4), FINE, 100),
    ]
}

/// A lamp in a diffuse sphere. With q the share of the wall's light that the lamp takes, a looked-up ray finds the wall
/// with the probability 1 − q, less what is unseen.
pub fn sphere_room() -> Looked {
    let size = 64;
    let wall = 0.5 * (1.0 - 0.0625);
    let light = |seen: f64| 1.0 / (1.0 - wall * seen);
    let lost = 1.0 - light(1.0 - unseen(COARSE, size)) / light(1.0);
    Looked { known: trace_paths::sphere_room(), directions: COARSE.0, size, lost, trace_misses: false }
}

fn convex(known: Known) -> Looked {
    Looked { known, directions: COARSE.0, size: 32, lost: 0.0, trace_misses: false }
}

/// Lights over a floor.
pub fn lights() -> Vec<Looked> {
    let mut all = trace_paths::punctual_lights();
    all.extend(trace_paths::area_lights());
    all.into_iter().map(|known| Looked { trace_misses: true, ..convex(known) }).collect()
}

/// Floors under skies.
pub fn environments() -> Vec<Looked> {
    let mut all = trace_paths::environments();
    all.extend(trace_paths::glossy());
    let open = all[0].clone();
    let mut all: Vec<Looked> = all.into_iter().map(convex).collect();
    // With two directions half of all rays are nearer to the one below the horizon.
    for directions in ["halton:2", "octahedron:8", "halton:50", "uv:4x8", "icosahedron:320"] {
        let mut known = open.clone();
        let black = known.scene.add_material(Material::diffuse("cellar", [0.0; 3]));
        let s = 9.0;
        let below = quad([-s, -1.0, s], [s, -1.0, s], [s, -1.0, -s], [-s, -1.0, -s]);
        known.scene.add_mesh(with_material(below, black));
        known.name = format!("floor over a cellar, {directions}");
        all.push(Looked { directions, ..convex(known) });
    }
    all
}

/// White bodies under an even sky of radiance 2: they vanish.
pub fn white_furnaces() -> Vec<Looked> {
    let case = |name: &str, mesh: Mesh, lost: f64| {
        let mut scene = Scene {
            materials: vec![Material::diffuse("white", [1.0; 3])],
            environment: Some(Environment::constant([2.0; 3])),
            camera: Some(Camera {
                position: [1.5, 2.0, 3.0],
                target: [0.0; 3],
                up: [0.0, 1.0, 0.0],
                vfov_degrees: 25.0,
            }),
            ..Scene::default()
        };
        scene.add_mesh(mesh);
        let known = Known { name: name.into(), scene, bounces: None, radiance: [2.0; 3], slack: 1e-4 };
        Looked { lost, ..convex(known) }
    };
    vec![
        case("white cube", cube(), 0.0),
        case("white sphere", icosphere(8), 0.0),
        // Seen, in part, from its hole: what leaks into the ring, at a silhouette, comes out no more.
        case("white torus", torus(24, 12, 0.4), unseen(COARSE, 32) / 4.0),
    ]
}

/// Mirrors and plates of glass, whose rays are traced.
pub fn specular() -> Vec<Looked> {
    trace_paths::specular().into_iter().map(convex).collect()
}
