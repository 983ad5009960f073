use super::bounds::{Term, interval};
use super::*;
use crate::kernels::filter_indirect::inputs::{radiance, wall};

fn terms(values: &[f64]) -> Vec<Term> {
    values.iter().map(|value| Term { weight: 1.0, value: *value }).collect()
}

fn ends(allowed: Allowed) -> (f64, f64) {
    match allowed {
        Allowed::Within { low, high } => (low, high),
        other => panic!("{other:?}"),
    }
}

#[test]
fn windows_weigh_their_square() {
    for window in 1..=9 {
        let picture = wall(23, 21, window);
        let middle = picture.window(10 * 23 + 11);
        let quarters: u32 = middle.iter().map(|(_, quarters)| quarters).sum();
        assert_eq!(quarters, 4 * window * window, "window {window}");
        let border = if window % 2 == 0 { 1 } else { 4 };
        assert_eq!((middle[0].1, middle[middle.len() / 2].1), (border, 4), "window {window}");
    }
}

#[test]
fn windows_end_with_the_picture() {
    let picture = wall(3, 2, 32);
    let pixels: Vec<usize> = picture.window(4).into_iter().map(|(at, _)| at).collect();
    assert_eq!(pixels, [0, 1, 2, 3, 4, 5]);
    assert_eq!(wall(3, 2, 2).window(0), [(0, 4), (1, 2), (3, 2), (4, 1)]);
}

#[test]
fn doubtful_neighbours_widen_the_interval_to_every_subset() {
    let (low, high) = ends(interval(1.0, &terms(&[3.0]), &terms(&[1.0, 9.0, 2.0, 5.0])));
    // 3, 1 and 2 have the least mean, 3, 9 and 5 a lower one than 3 and 9.
    assert!((low - 2.0).abs() < 1e-5 && (high - 6.0).abs() < 1e-5, "{low} to {high}");
}

#[test]
fn the_interval_grows_with_the_number_of_terms() {
    let width = |count: usize| {
        let (low, high) = ends(interval(0.5, &terms(&vec![1.0; count]), &[]));
        assert!(low < 0.5 && high > 0.5);
        high - low
    };
    assert!(width(1) < 1e-6 && width(1_000) > 100.0 * width(1) && width(1_000) < 2e-4);
}

#[test]
fn what_is_not_finite_or_has_no_terms_is_said_so() {
    assert_eq!(interval(1.0, &terms(&[1.0, f64::INFINITY]), &[]), Allowed::NotFinite);
    assert_eq!(interval(1.0, &terms(&[f64::NAN]), &[]), Allowed::NotFinite);
    assert_eq!(interval(1.0, &terms(&[1.0]), &terms(&[f64::NAN])), Allowed::Any);
    assert_eq!(interval(1.0, &[], &[]), Allowed::Copied);
    assert_eq!(interval(1.0, &[], &terms(&[1.0])), Allowed::Any);
    assert_eq!(interval(1.0, &terms(&[1e38; 9]), &[]), Allowed::Any);
}

#[test]
fn a_neighbour_at_a_limit_is_in_doubt() {
    let mut picture = wall(2, 1, 2);
    picture.input = vec![radiance([0.0; 3]), radiance([3.0; 3])];
    let limit = picture.params.footprint * 2.0 * picture.gbuffer[0].depth;
    let mut undecided = |rise: f32| {
        picture.gbuffer[1].position[2] = picture.gbuffer[0].position[2] + rise;
        (possible(&picture, 0).undecided, as_written(&picture)[0].rgb[0])
    };
    assert_eq!(undecided(0.0), (0, 1.0));
    assert_eq!(undecided(limit), (1, 1.0));
    assert_eq!(undecided(1.5 * limit), (0, 0.0));
    assert_eq!(undecided(f32::NAN), (0, 0.0));
}
