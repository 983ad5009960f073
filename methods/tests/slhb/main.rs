//! Layered hit buffers as a method: bits, bias against the reference tracer with equal bounces, and what the knobs do.

mod cramped;
mod filter;
mod kept;

use twinlight_backend_cpu::CpuBackend;
use twinlight_core::Backend;
use twinlight_core::scene::{Camera, CompiledScene, Limits, compile};
use twinlight_fixtures::scenes::builtin;
use twinlight_methods::reference::{self, Control, Film, Settings};
use twinlight_methods::slhb::{Elements, LookupSettings, build, render, sheet};

struct Room {
    backend: CpuBackend,
    resident: <CpuBackend as Backend>::Scene,
    scene: CompiledScene,
    camera: Camera,
}

impl Room {
    fn new(name: &str, threads: usize) -> Self {
        let scene = builtin(name).unwrap();
        let camera = Camera::of_scene(&scene).unwrap();
        let scene = compile(&scene, &Limits::default()).unwrap();
        let backend = CpuBackend::with_threads(threads).unwrap();
        let resident = backend.upload_scene(&scene).unwrap();
        Self { backend, resident, scene, camera }
    }

    fn looked_up(&self, lookups: &LookupSettings, settings: &Settings) -> Film {
        let Self { backend, resident, scene, camera } = self;
        let buffers = build(backend, scene, lookups).unwrap();
        render(backend, resident, scene, &buffers, camera, settings, |_| Control::Continue).unwrap().film
    }

    fn traced(&self, settings: &Settings) -> Film {
        let Self { backend, resident, scene, camera } = self;
        reference::render(backend, resident, scene, camera, settings, |_| Control::Continue).unwrap().film
    }
}

fn lookups(directions: &str, size: u32) -> LookupSettings {
    LookupSettings { directions: directions.parse().unwrap(), size, ..LookupSettings::default() }
}

fn settings(size: u32, samples: u32, bounces: u32) -> Settings {
    Settings { width: size, height: size, samples, bounces: Some(bounces), ..Settings::default() }
}

fn mean(film: &Film) -> f64 {
    film.radiance().iter().flatten().map(|&c| f64::from(c)).sum()
}

#[test]
fn same_bits_for_any_number_of_threads_and_any_split() {
    let (lookups, settings) = (lookups("icosahedron:80", 48), settings(24, 6, 4));
    let film = Room::new("cornell", 1).looked_up(&lookups, &settings);
    for threads in [2, 3, 8] {
        assert_eq!(Room::new("cornell", threads).looked_up(&lookups, &settings), film, "{threads} threads");
    }
    let room = Room::new("cornell", 2);
    let mut halves = room.looked_up(&lookups, &Settings { samples: 2, ..settings.clone() });
    let rest = Settings { samples: 4, first_sample: 2, ..settings };
    halves.merge(&room.looked_up(&lookups, &rest)).unwrap();
    assert_eq!(halves, film);
}

/// With one scattering vertex nothing is looked up; what differs from the reference is the weight of the lamp alone.
#[test]
fn emission_and_direct_light_are_the_references() {
    let room = Room::new("cornell", 2);
    let emission = settings(32, 4, 0);
    let lookups = lookups("icosahedron:20", 16);
    assert_eq!(room.looked_up(&lookups, &emission), room.traced(&emission));
    let direct = settings(32, 64, 1);
    let ratio = mean(&room.looked_up(&lookups, &direct)) / mean(&room.traced(&direct));
    // 65 k samples each; measured 1.0006.
    assert!((ratio - 1.0).abs() < 0.01, "{ratio}");
}

/// The contract's promise is ±5 % for 320 directions of 128². Measured here: 1.003 and 0.985.
#[test]
fn light_is_neither_lost_nor_made() {
    for (name, samples) in [("cornell", 64), ("room-70k", 64)] {
        let room = Room::new(name, 2);
        let settings = settings(32, samples, 4);
        let ratio = mean(&room.looked_up(&lookups("icosahedron:320", 128), &settings))
            / mean(&room.traced(&settings));
        assert!((ratio - 1.0).abs() < 0.05, "{name}: {ratio}");
    }
}

/// The mean over blocks of 8 × 8 pixels, where noise averages out, differs less from the reference with more directions.
#[test]
fn error_falls_with_directions() {
    let room = Room::new("cornell", 2);
    let settings = settings(64, 32, 4);
    let blocks = |film: &Film| {
        let radiance = film.radiance();
        let mut sums = [0.0; 64];
        for (i, pixel) in radiance.iter().enumerate() {
            sums[i / 64 / 8 * 8 + i % 64 / 8] += f64::from(pixel[0] + pixel[1] + pixel[2]);
        }
        sums
    };
    let truth = blocks(&room.traced(&Settings { samples: 128, ..settings.clone() }));
    let error = |directions: &str, cone: bool| {
        let lookups = LookupSettings { cone, ..lookups(directions, 64) };
        let got = blocks(&room.looked_up(&lookups, &settings));
        let squares = got.iter().zip(&truth).map(|(g, t)| (g - t).powi(2) / (t * t)).sum::<f64>();
        (squares / 64.0).sqrt()
    };
    let [few, some, many] = ["octahedron:8", "icosahedron:80", "icosahedron:320"].map(|set| error(set, true));
    assert!(few > some && some > many, "{few} {some} {many}");
    let without_cone = error("octahedron:8", false);
    assert!(without_cone > 2.0 * few, "8 directions band: {without_cone}, with the cone {few}");
}

#[test]
fn a_cap_keeps_the_nearest() {
    let room = Room::new("cornell", 2);
    let all = build(&room.backend, &room.scene, &lookups("icosahedron:20", 32)).unwrap();
    let capped = LookupSettings { layers: Some(2), ..lookups("icosahedron:20", 32) };
    let capped = build(&room.backend, &room.scene, &capped).unwrap();
    assert!(capped.elements(&room.backend) < all.elements(&room.backend));
    let left_out: u32 = room.backend.download(&capped.lhb.left_out).unwrap().iter().sum();
    assert_eq!(capped.elements(&room.backend) + left_out as usize, all.elements(&room.backend));
    assert!(capped.bytes(&room.backend) > 0);
}

/// Measured: 0.99994 of the light that full elements give.
#[test]
fn packed_elements_give_the_same_light() {
    let room = Room::new("cornell", 2);
    let settings = settings(32, 16, 4);
    let light = |elements| {
        mean(&room.looked_up(&LookupSettings { elements, ..lookups("icosahedron:80", 64) }, &settings))
    };
    let full = light(Elements::Full);
    for elements in [Elements::Packed, Elements::Layers(16)] {
        let ratio = light(elements) / full;
        assert!(ratio != 1.0 && (ratio - 1.0).abs() < 0.005, "{elements}: {ratio}");
    }
}

#[test]
fn elements_say_what_they_are() {
    for elements in [Elements::Full, Elements::Packed, Elements::Layers(16)] {
        assert_eq!(elements.to_string().parse::<Elements>().unwrap(), elements);
    }
    let room = Room::new("cornell", 2);
    let none = LookupSettings { elements: Elements::Layers(0), ..lookups("icosahedron:20", 32) };
    let refused = build(&room.backend, &room.scene, &none).map(|_| ()).unwrap_err().to_string();
    assert_eq!(refused, "elements: no layers hold no elements");
}

/// More triangles than a word numbers: refused before anything is drawn, and no more than that.
#[test]
fn too_many_triangles_are_refused() {
    let mut scene = Room::new("cornell", 2).scene;
    let triangle = scene.triangles[0];
    scene.triangles.resize((1 << 20) - 1, triangle);
    let packed = LookupSettings { elements: Elements::Packed, ..lookups("icosahedron:20", 1) };
    let backend = CpuBackend::new();
    assert!(build(&backend, &scene, &packed).is_ok());
    scene.triangles.push(triangle);
    for elements in [Elements::Packed, Elements::Layers(3)] {
        let settings = LookupSettings { elements, ..packed.clone() };
        let refused = build(&backend, &scene, &settings).map(|_| ()).unwrap_err().to_string();
        assert!(refused.contains("1048576") && refused.contains("1048575"), "{refused}");
    }
}

#[test]
fn a_sheet_shows_what_a_view_holds() {
    let room = Room::new("cornell", 2);
    let buffers = build(&room.backend, &room.scene, &lookups("icosahedron:20", 32)).unwrap();
    let drawn = sheet(&room.backend, &buffers, 3).unwrap();
    assert_eq!((drawn.width, drawn.height, drawn.pixels.len()), (8 * 32, 32, 8 * 32 * 32));
    assert!(drawn.covered > 0.2 && drawn.covered < 0.9 && drawn.deepest >= 2);
    assert_eq!(drawn.pixels[0], [0; 3], "a corner of a view sees nothing");
    let counted = drawn.pixels.chunks(256).flat_map(|row| &row[..32]).filter(|p| **p != [0; 3]).count();
    let layered = drawn.pixels.chunks(256).flat_map(|row| &row[32..64]).filter(|p| **p != [0; 3]).count();
    assert_eq!(counted, layered);
    assert_eq!(
        sheet(&room.backend, &buffers, 10).unwrap_err().to_string(),
        "view: 10: there are 10 views, from 0 on"
    );
}
