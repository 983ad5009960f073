//! Why coarse sets of directions show too much light in `builtin:room-70k`: lookups look past the lamp's back, a baffle between what the
//! camera sees and the lit ceiling. The same room lit by a point, with the baffle and without: mean indirect light beside the reference's.
//!
//! `cargo run --release -p twinlight-methods --example baffle`

use twinlight_backend_cpu::CpuBackend;
use twinlight_core::scene::{Camera, CompiledScene, Light, Limits, Material, Scene, compile};
use twinlight_core::{Backend, Result};
use twinlight_fixtures::meshes::{quad, with_material};
use twinlight_fixtures::scenes::{LIGHT_HEIGHT, room};
use twinlight_methods::reference::{Control, Film, Settings, render as trace};
use twinlight_methods::slhb::{LookupSettings, build, render};

/// The room by the light of a point just above where its lamp was.
fn lit_by_a_point() -> Scene {
    let mut scene = room(59);
    scene.lights = vec![Light::Point { position: [0.0, LIGHT_HEIGHT + 0.05, 0.0], intensity: [15.0; 3] }];
    scene
}

fn with_baffle(mut scene: Scene) -> Scene {
    let black = scene.add_material(Material::diffuse("black", [0.0; 3]));
    let (s, y) = (0.35, LIGHT_HEIGHT);
    let baffle = quad([-s, y, s], [s, y, s], [s, y, -s], [-s, y, -s]);
    scene.add_mesh(with_material(baffle, black));
    scene
}

fn indirect(film: &Film) -> f64 {
    film.indirect().iter().flatten().map(|&radiance| f64::from(radiance)).sum()
}

/// The light of lookups over that of the reference.
fn ratio(
    backend: &CpuBackend,
    scene: &CompiledScene,
    camera: &Camera,
    lookups: &LookupSettings,
) -> Result<f64> {
    let settings = Settings { width: 64, height: 64, samples: 128, bounces: Some(4), ..Settings::default() };
    let resident = backend.upload_scene(scene)?;
    let buffers = build(backend, scene, lookups)?;
    let want = trace(backend, &resident, scene, camera, &settings, |_| Control::Continue)?;
    let got = render(backend, &resident, scene, &buffers, camera, &settings, |_| Control::Continue)?;
    Ok(indirect(&got.film) / indirect(&want.film))
}

fn main() -> Result<()> {
    let backend = CpuBackend::new();
    for (name, scene) in [
        ("as it is", room(59)),
        ("a point and a baffle", with_baffle(lit_by_a_point())),
        ("a point, no baffle", lit_by_a_point()),
    ] {
        let compiled = compile(&scene, &Limits::default())?;
        let camera = Camera::of_scene(&scene).expect("the room has one");
        for directions in ["icosahedron:20", "icosahedron:80", "icosahedron:320"] {
            let lookups = LookupSettings { directions: directions.parse()?, ..LookupSettings::default() };
            println!("{name}, {directions}: {:.3}", ratio(&backend, &compiled, &camera, &lookups)?);
        }
    }
    Ok(())
}
