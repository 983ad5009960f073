//! Filtered pictures: less noise, no light lost, and the same picture where there is nothing to average.

use super::{Room, lookups, settings};
use twinlight_core::{Backend, Error};
use twinlight_methods::gbuffer;
use twinlight_methods::reference::{Film, Settings};
use twinlight_methods::slhb::{Filtered, LookupSettings, filter};

const SIZE: u32 = 64;

impl Room {
    fn filtered(&self, film: &Film, window: u32) -> twinlight_core::Result<Filtered> {
        let Self { backend, resident, scene, camera } = self;
        let size = (film.width(), film.height());
        let gbuffer = gbuffer(backend, resident, scene, camera, size)?;
        filter(backend, scene, camera, &gbuffer, film, window)
    }
}

/// Root mean square difference over the mean.
fn error(picture: &[[f32; 3]], truth: &[[f32; 3]]) -> f64 {
    let pairs = || picture.iter().flatten().zip(truth.iter().flatten());
    let squares: f64 = pairs().map(|(&x, &r)| (f64::from(x) - f64::from(r)).powi(2)).sum();
    let mean: f64 = pairs().map(|(_, &r)| f64::from(r)).sum::<f64>() / truth.len() as f64 / 3.0;
    (squares / truth.len() as f64 / 3.0).sqrt() / mean
}

fn mean(picture: &[[f32; 3]]) -> f64 {
    picture.iter().flatten().map(|&c| f64::from(c)).sum()
}

/// Noise of independent samples falls with the square root of their number: 16 pixels make a quarter of it, and the rest is bias. Measured
/// 0.30, 0.25, 0.28 and 0.25.
#[test]
fn filtered_indirect_light_is_nearer_to_the_reference() {
    let room = Room::new("cornell", 2);
    let (lookups, settings) = (lookups("icosahedron:320", 64), settings(SIZE, 4, 4));
    let truth = room.traced(&Settings { samples: 512, ..settings.clone() }).indirect();
    let film = room.looked_up(&lookups, &settings);
    let interleaved = room.looked_up(&LookupSettings { interleave: 4, ..lookups }, &settings);
    let noise = error(&film.indirect(), &truth);
    for (film, window) in [(&film, 4), (&film, 8), (&interleaved, 4), (&interleaved, 8)] {
        let filtered = room.filtered(film, window).unwrap();
        let left = error(&filtered.indirect, &truth) / noise;
        assert!(left < 0.4, "{left} of {noise} is left by a window of {window}");
        let ratio = mean(&filtered.indirect) / mean(&film.indirect());
        assert!((ratio - 1.0).abs() < 0.02, "{ratio} of the light is left by a window of {window}");
    }
}

/// p is the only neighbour of p, and divided by its albedo and multiplied: twice half an ulp, and a subnormal's.
#[test]
fn a_window_of_one_pixel_changes_nothing_but_roundings() {
    let room = Room::new("materials", 2);
    let film = room.looked_up(&lookups("icosahedron:20", 16), &settings(SIZE, 2, 4));
    let filtered = room.filtered(&film, 1).unwrap();
    for (got, want) in filtered.indirect.iter().flatten().zip(film.indirect().iter().flatten()) {
        assert!((got - want).abs() <= want * 1.2e-7 * 1.01 + 1e-40, "{got} for {want}");
    }
    let sum = film.direct().into_iter().zip(&filtered.indirect).map(|(d, i)| [0, 1, 2].map(|c| d[c] + i[c]));
    assert_eq!(filtered.radiance, sum.collect::<Vec<_>>());
}

/// Mirrors, glass and lobes show what they show; the film of more samples is filtered like any other.
#[test]
fn only_diffuse_surfaces_change() {
    let room = Room::new("materials", 2);
    let lookups = lookups("icosahedron:20", 16);
    let mut film = room.looked_up(&lookups, &settings(SIZE, 2, 4));
    film.merge(&room.looked_up(&lookups, &Settings { first_sample: 2, ..settings(SIZE, 2, 4) })).unwrap();
    let filtered = room.filtered(&film, 5).unwrap().indirect;
    let surfaces = gbuffer(&room.backend, &room.resident, &room.scene, &room.camera, (SIZE, SIZE)).unwrap();
    let surfaces = room.backend.download(&surfaces).unwrap();
    let (mut changed, mut kept) = (0, 0);
    for ((surface, got), want) in surfaces.iter().zip(&filtered).zip(film.indirect()) {
        let material = &room.scene.materials[surface.material as usize];
        if surface.depth == 0.0 || material.kind != 0 || material.specular_f0 != [0.0; 3] {
            assert_eq!(*got, want);
            kept += 1;
        } else if *got != want {
            changed += 1;
        }
    }
    assert!(changed > 500 && kept > 500, "{changed} changed, {kept} kept");
}

#[test]
fn windows_and_buffers_that_fit_nothing_are_refused() {
    let room = Room::new("cornell", 2);
    let film = room.looked_up(&lookups("icosahedron:20", 16), &settings(8, 1, 2));
    for window in [0, 33] {
        assert!(matches!(room.filtered(&film, window), Err(Error::InvalidInput { .. })));
    }
    let other = gbuffer(&room.backend, &room.resident, &room.scene, &room.camera, (8, 9)).unwrap();
    let refused = filter(&room.backend, &room.scene, &room.camera, &other, &film, 4);
    assert!(matches!(refused, Err(Error::InvalidInput { .. })));
}
