//! Counts, symmetry, cells, names.

use super::*;
use crate::circle::angle_between;
use std::f64::consts::{FRAC_PI_2, PI};

#[test]
fn names_give_sizes_and_back() {
    for (text, name, count) in [
        ("20", "icosahedron:20", 20),
        ("1280", "icosahedron:1280", 1280),
        ("8", "octahedron:8", 8),
        ("128", "octahedron:128", 128),
        ("50", "halton:50", 50),
        ("1", "halton:1", 1),
        ("halton:320", "halton:320", 320),
        ("uv:8x16", "uv:8x16", 128),
        ("uv:1x2", "uv:1x2", 2),
    ] {
        let set: DirectionSet = text.parse().unwrap();
        assert_eq!((set.to_string().as_str(), set.len()), (name, count));
        assert_eq!(set.to_string().parse::<DirectionSet>().unwrap(), set);
    }
}

#[test]
fn names_that_mean_nothing_are_refused() {
    let error = "dodecahedron:12".parse::<DirectionSet>().unwrap_err().to_string();
    assert_eq!(
        error,
        "directions: `dodecahedron:12` is none of icosahedron:N (N = 20, 80, 320, 1280), octahedron:N (8, 32, 128, \
         512, 2048), halton:N (1 to 4096), uv:ROWSxCOLUMNS (even COLUMNS, at most 4096 in all), N"
    );
    for text in
        ["", "many", "-8", "icosahedron:21", "octahedron:20", "halton:", "uv:8", "uv:8x", "uv:x8", "20:20"]
    {
        let error = text.parse::<DirectionSet>().unwrap_err().to_string();
        assert!(error.starts_with(&format!("directions: `{text}` is none of")), "{error}");
    }
    for (text, part) in [
        ("0", "0 directions"),
        ("uv:0x8", "0 directions"),
        ("uv:8x0", "0 directions"),
        ("uv:8x15", "15 columns"),
        ("4097", "needs 4097, the limit is 4096"),
        ("uv:4294967295x4294967294", "the limit is 4096"),
    ] {
        let error = text.parse::<DirectionSet>().unwrap_err().to_string();
        assert!(error.contains(part), "{error}");
    }
    assert!(DirectionSet::icosahedron(4).is_err());
    assert!(DirectionSet::octahedron(u32::MAX).is_err());
}

#[test]
fn directions_are_distinct_unit_vectors() {
    for set in every_set() {
        let d = set.directions();
        for (i, a) in d.iter().enumerate() {
            assert!((a.length_squared() - 1.0).abs() < 1e-15, "{set}: {a}");
            // The closest of all of these: neighbours of an equator that nearly touch.
            assert!(d[..i].iter().all(|b| angle_between(*a, *b) > 0.02), "{set}: {i}");
        }
    }
}

#[test]
fn opposites_are_exact_and_share_a_line() {
    for set in every_set() {
        let alone = set.len() % 2;
        assert_eq!(set.lines().len(), set.len() / 2 + alone, "{set}");
        let mut sides = vec![[0; 2]; set.lines().len()];
        for (d, on) in set.directions().iter().zip(set.on_lines()) {
            let line = set.lines()[on.line as usize];
            assert_eq!(*d, if on.reversed { -line } else { line });
            sides[on.line as usize][usize::from(on.reversed)] += 1;
        }
        let last = sides.len() - alone;
        assert!(
            sides[..last].iter().all(|s| *s == [1, 1]) && sides[last..].iter().all(|s| *s == [1, 0]),
            "{set}"
        );
        let sum: DVec3 = set.directions().iter().sum();
        assert!((sum.length() - alone as f64).abs() < 1e-12, "{set}: {sum}");
    }
}

#[test]
fn cells_share_the_sphere() {
    for set in every_set() {
        let sum: f64 = set.solid_angles().iter().sum();
        assert!((sum / (4.0 * PI) - 1.0).abs() < 1e-12, "{set}: {sum}");
        let mut counts = vec![0_u32; set.len()];
        let samples = 100_000;
        random_directions(samples).for_each(|q| counts[nearest_by_search(&set, q)] += 1);
        for (count, solid_angle) in counts.iter().zip(set.solid_angles()) {
            let share = solid_angle / (4.0 * PI);
            let sigma = (f64::from(samples) * share * (1.0 - share).max(0.0)).sqrt();
            // One in 10⁷ is beyond 5.3 σ; there are 2000 cells.
            let off = f64::from(*count) - f64::from(samples) * share;
            assert!(off.abs() <= 5.3 * sigma + 1e-6, "{set}: {off} with σ = {sigma}");
        }
    }
}

#[test]
fn nothing_is_farther_than_the_covering_radius() {
    for set in every_set() {
        let angle = |q: DVec3| angle_between(q, set.directions()[nearest_by_search(&set, q)]);
        let farthest = random_directions(100_000).map(angle).fold(0.0, f64::max);
        let radius = set.covering_radius();
        assert!(farthest <= radius && farthest > 0.95 * radius, "{set}: {farthest} of {radius}");
    }
}

#[test]
fn covering_radii_of_regular_sets() {
    let radius = |name: &str| name.parse::<DirectionSet>().unwrap().covering_radius();
    // The corners of a dodecahedron and of a cube: from a corner to the middle of a face of the dual.
    let golden = (1.0 + 5.0_f64.sqrt()) / 2.0;
    assert!(
        (radius("icosahedron:20") - (golden * golden / (3.0 * (golden + 2.0)).sqrt()).acos()).abs() < 1e-14
    );
    assert!((radius("octahedron:8") - (1.0 / 3.0_f64.sqrt()).acos()).abs() < 1e-14);
    assert_eq!(radius("halton:1"), PI);
    assert!((radius("halton:2") - FRAC_PI_2).abs() < 1e-14);
}
