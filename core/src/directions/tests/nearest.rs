//! The map against searches.

use super::*;
use crate::circle::angle_between;
use crate::math::octahedral::{INDEX, LAST, quantised};
use glam::Vec3;
use proptest::prelude::*;
use proptest::test_runner::TestCaseResult;
use std::sync::LazyLock;

/// What the map means: the first of the greatest products of integers.
fn nearest_by_integers(set: &DirectionSet, direction: Vec3) -> u32 {
    let q = quantised(direction).as_i64vec3();
    let product = |d: &DVec3| (*d * 32_767.0).to_array().map(f64::round_ties_even);
    let products = set.directions().iter().map(|d| {
        let [x, y, z] = product(d).map(|c| c as i64);
        x * q.x + y * q.y + z * q.z
    });
    let all: Vec<i64> = products.collect();
    let best = *all.iter().max().unwrap();
    all.iter().position(|&p| p == best).unwrap() as u32
}

static SETS: LazyLock<Vec<(DirectionSet, Vec<NearestMap>)>> = LazyLock::new(|| {
    let maps = |set: DirectionSet| {
        let other = |resolution| NearestMap::with_resolution(&set, resolution).unwrap();
        let maps = vec![NearestMap::new(&set), other(2), other(6), other(22), other(64)];
        (set, maps)
    };
    every_set().map(maps).collect()
});

/// Where cells and components change sign, and where they meet.
fn hard_directions() -> Vec<Vec3> {
    let values = [0.0, -0.0, 1e-30, -1e-30, 3e-5, -3e-5, 0.5, -0.5, 1.0, -1.0];
    let all = values.map(|x| values.map(|y| values.map(|z| Vec3::new(x, y, z))));
    all.as_flattened().as_flattened().iter().filter(|v| v.length() > 1e-3).map(|v| v.normalize()).collect()
}

#[test]
fn every_resolution_finds_what_the_search_finds() {
    let random = random_directions(3000).map(|q| q.as_vec3());
    let queries: Vec<Vec3> = random.chain(hard_directions()).collect();
    for (set, maps) in SETS.iter() {
        let own = set.directions().iter().map(|d| d.as_vec3());
        for q in queries.iter().copied().chain(own) {
            let want = nearest_by_integers(set, q);
            for map in maps {
                assert_eq!(map.nearest(q), want, "{set} at {}: {q}", map.resolution());
            }
        }
    }
}

proptest! {
    #[test]
    fn errors_are_within_the_bound(
        set in 0..NAMES.len(), x in -1.0_f32..1.0, y in -1.0_f32..1.0, z in -1.0_f32..1.0,
    ) {
        let q = Vec3::new(x, y, z);
        prop_assume!(q.length() > 1e-3);
        let (set, maps) = &SETS[set];
        check_error(set, &maps[0], q.normalize())?;
    }

    /// Between two neighbours, which is where the map can be wrong.
    #[test]
    fn errors_are_within_the_bound_on_borders(
        set in 0..NAMES.len(), a: prop::sample::Index, x in -0.01_f64..0.01, y in -0.01_f64..0.01,
    ) {
        let (set, maps) = &SETS[set];
        let d = set.directions();
        let a = a.index(d.len());
        let others = (0..d.len()).filter(|&i| i != a);
        let Some(b) = others.max_by(|&i, &j| d[i].dot(d[a]).total_cmp(&d[j].dot(d[a]))) else { return Ok(()) };
        let q = d[a] + d[b] + DVec3::new(x, y, x - y) * 1e-2;
        prop_assume!(q.length() > 1e-3);
        check_error(set, &maps[0], q.normalize().as_vec3())?;
    }

    /// Whatever the bits, the index is one of the set's.
    #[test]
    fn any_bits_find_a_direction(set in 0..NAMES.len(), x: u32, y: u32, z: u32) {
        let (set, maps) = &SETS[set];
        let q = Vec3::new(f32::from_bits(x), f32::from_bits(y), f32::from_bits(z));
        prop_assert!((maps[0].nearest(q) as usize) < set.len());
    }

    /// A direction and its opposite read one line, wherever one direction is the nearest.
    #[test]
    fn opposites_find_opposites(x in -1.0_f32..1.0, y in -1.0_f32..1.0, z in -1.0_f32..1.0) {
        let q = Vec3::new(x, y, z);
        prop_assume!(q.length() > 1e-3 && x * y * z != 0.0);
        let (set, maps) = &SETS[2];
        let (there, back) = (maps[0].nearest(q.normalize()), maps[0].nearest(-q.normalize()));
        let product = |i: u32| set.directions()[i as usize].dot(q.normalize().as_dvec3());
        let same = set.on_lines()[there as usize].line == set.on_lines()[back as usize].line;
        prop_assert!(same || (product(there) + product(back)).abs() < 1e-4);
    }
}

fn check_error(set: &DirectionSet, map: &NearestMap, q: Vec3) -> TestCaseResult {
    let angle = |i: usize| angle_between(q.as_dvec3().normalize(), set.directions()[i]);
    let q64 = q.as_dvec3();
    let error = angle(map.nearest(q) as usize) - angle(nearest_by_search(set, q64));
    prop_assert!(error <= set.nearest_error(), "{set}: {error} for {q}");
    Ok(())
}

#[test]
fn a_direction_finds_itself() {
    for (set, maps) in SETS.iter() {
        for (i, d) in set.directions().iter().enumerate() {
            assert_eq!(maps[0].nearest(d.as_vec3()), i as u32, "{set}");
        }
    }
}

#[test]
fn lists_are_short_and_in_bounds() {
    for (set, maps) in SETS.iter() {
        for map in maps {
            let cells = (map.resolution() * map.resolution()) as usize;
            let (firsts, lists) = map.words().split_at(cells);
            assert!(firsts.iter().all(|&at| at as usize >= cells && (at as usize) + 1 < map.words().len()));
            assert!(lists.chunks(2).all(|c| ((c[1] & INDEX) as usize) < set.len()));
            assert_eq!(lists.last().unwrap() & LAST, LAST);
        }
    }
}

#[test]
fn bad_resolutions_are_refused() {
    let set = DirectionSet::octahedron(0).unwrap();
    let error = |resolution| NearestMap::with_resolution(&set, resolution).unwrap_err().to_string();
    assert_eq!(error(0), "resolution: 0 cells per row of a map; an even number is needed");
    assert_eq!(error(7), "resolution: 7 cells per row of a map; an even number is needed");
    assert_eq!(error(4098), "cells per row of a map of directions: needs 4098, the limit is 4096");
}
