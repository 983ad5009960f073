//! D8: the same bits for any thread count, run, pool, range of samples and band of pixels.

use crate::{film, film_on, settings};
use twinlight_backend_cpu::CpuBackend;
use twinlight_core::Backend;
use twinlight_core::kernels::trace_paths::{FilmTexel, TracePathsParams};
use twinlight_core::scene::{Camera, Limits, compile};
use twinlight_fixtures::scenes::builtin;
use twinlight_methods::reference::{Film, Settings};

#[test]
fn d8_threads_and_runs() {
    for name in ["cornell", "materials", "environment", "lights"] {
        let scene = builtin(name).unwrap();
        let settings = Settings { width: 24, height: 17, samples: 3, ..Settings::default() };
        let expected = film(&scene, &settings);
        for threads in [1, 2, 3, 8] {
            let backend = CpuBackend::with_threads(threads).unwrap();
            for run in 0..2 {
                assert!(
                    film_on(&backend, &scene, &settings) == expected,
                    "{name}: {threads} threads, run {run}"
                );
            }
        }
    }
}

/// Shards: films of disjoint sample ranges add up to the whole picture's film, in any order.
#[test]
fn shards_add_up() {
    let scene = builtin("cornell").unwrap();
    let range = |first, samples| Settings { first_sample: first, ..settings(20, samples) };
    let whole = film(&scene, &range(0, 21));
    for cuts in [vec![0, 21], vec![0, 10, 21], vec![0, 1, 20, 21], vec![0, 3, 6, 9, 12, 15, 18, 21]] {
        let mut shards: Vec<Film> =
            cuts.windows(2).map(|w| film(&scene, &range(w[0], w[1] - w[0]))).collect();
        shards.rotate_left(1);
        let mut sum = shards.pop().unwrap();
        for shard in &shards {
            sum.merge(shard).unwrap();
        }
        assert!(sum == whole, "cuts {cuts:?}");
    }
    let other = film(&scene, &settings(21, 1));
    assert!(film(&scene, &range(0, 1)).merge(&other).is_err(), "other sizes are refused");
}

/// Tiles: any order and size of pixel bands gives the whole picture's film.
#[test]
fn bands_add_up() {
    let scene = builtin("cornell").unwrap();
    let compiled = compile(&scene, &Limits::default()).unwrap();
    let backend = CpuBackend::new();
    let resident = backend.upload_scene(&compiled).unwrap();
    let camera = Camera::of_scene(&scene).unwrap().record(19, 13, compiled.origin).unwrap();
    let params = TracePathsParams {
        camera,
        width: 19,
        height: 13,
        pixel_begin: 0,
        pixel_count: 19 * 13,
        sample_begin: 0,
        sample_count: 4,
        seed: 9,
        max_bounces: 3,
        roulette_begin: 4,
        sampler: 0,
        film_exponent: compiled.film_exponent,
        moment_exponent: compiled.moment_exponent,
    };
    let traced = |bands: &mut dyn Iterator<Item = (u32, u32)>| -> Vec<FilmTexel> {
        let mut film = backend.zeroed(19 * 13).unwrap();
        for (pixel_begin, pixel_count) in bands {
            let band = TracePathsParams { pixel_begin, pixel_count, ..params };
            backend.trace_paths(&resident, &band, &mut film).unwrap();
        }
        backend.download(&film).unwrap()
    };
    let whole = traced(&mut [(0, 19 * 13)].into_iter());
    for tile in [1, 7, 8, 64] {
        let mut bands: Vec<(u32, u32)> =
            (0..19 * 13).step_by(tile).map(|b| (b, (tile as u32).min(19 * 13 - b))).collect();
        bands.reverse();
        assert!(traced(&mut bands.into_iter()) == whole, "bands of {tile}");
    }
}

#[test]
fn seeds_and_samplers_change_the_picture() {
    let scene = builtin("cornell").unwrap();
    let base = film(&scene, &settings(8, 2));
    assert!(film(&scene, &Settings { seed: 1, ..settings(8, 2) }) != base);
    assert!(film(&scene, &Settings { sampler: Default::default(), ..settings(8, 2) }) != base);
}
