//! The nearest direction in constant time.

use super::{DirectionSet, OnLine};
use crate::error::{Error, Result};
use crate::math::octahedral::{INDEX, LAST, STEPS, nearest_direction};
use glam::{DVec3, Vec3};
use std::collections::HashMap;

/// Largest number of cells per row and column.
pub const MAX_RESOLUTION: u32 = 4096;

/// Length of a candidate's vector: the most that 16 bits hold.
const SCALE: f64 = 32_767.0;

/// How far rounding moves the tip of a candidate's vector at most, unit length.
const CANDIDATE_ERROR: f64 = 0.866_025_403_784_438_6 / SCALE;

/// How far quantisation moves the tip of a unit vector in f32 at most: a unit per component, and its own rounding.
const QUERY_ERROR: f64 = 1.732_050_807_568_877_2 / STEPS as f64 + 1.0 / 4_194_304.0;

/// An octahedral map of short lists: from a vector in f32 to the direction nearest to it, with the same result on every
/// backend ([`crate::math::octahedral::nearest_direction`]).
///
/// *Meaning.* Vector and directions are rounded to multiples of about 2⁻¹⁵; the nearest direction is the one with the
/// greatest scalar product of integers, the first of equals. The resolution has no part in it: a cell of the map lists
/// every direction that can win in it, and only decides how few products there are to compare.
///
/// *Why lists.* One direction per cell is wrong by up to twice a cell's radius, 8.5/resolution radians: 2 % of the
/// covering radius of 320 directions would take 2450 × 2450 cells, 23 MiB where 97 KiB do.
///
/// *Words.* First one per cell, row after row ([`crate::math::octahedral::nearest_cell`]): the place of its list among
/// the words. Then the lists, each once. A candidate is two words, the direction times 32767 and its index: y in the
/// upper and x in the lower half of the first, z in the upper half of the second over one bit, set in the last of a
/// list, and 15 bits of index. Candidates come by index.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NearestMap {
    resolution: u32,
    words: Vec<u32>,
    most_candidates: u32,
}

impl NearestMap {
    /// The map of a set, with about 32 to 128 cells per direction, so that a cell has less than two candidates on
    /// average: 128 × 128 for 320 directions.
    pub fn new(set: &DirectionSet) -> Self {
        let root = (32 * set.len()).isqrt() as u32;
        Self::with_even_resolution(set, root.next_power_of_two().max(16))
    }

    /// The map of a set with `resolution` × `resolution` cells.
    ///
    /// # Errors
    /// [`Error::InvalidInput`] for a resolution that is 0 or odd, [`Error::LimitExceeded`] beyond [`MAX_RESOLUTION`].
    pub fn with_resolution(set: &DirectionSet, resolution: u32) -> Result<Self> {
        if resolution == 0 || !resolution.is_multiple_of(2) {
            let what = format!("{resolution} cells per row of a map; an even number is needed");
            return Err(Error::invalid("resolution", what));
        }
        if resolution > MAX_RESOLUTION {
            let what = "cells per row of a map of directions";
            return Err(Error::limit(what, resolution.into(), MAX_RESOLUTION.into()));
        }
        Ok(Self::with_even_resolution(set, resolution))
    }

    fn with_even_resolution(set: &DirectionSet, resolution: u32) -> Self {
        let lists = lists(set.directions(), resolution);
        let most_candidates = lists.iter().map(Vec::len).max().unwrap_or(0) as u32;
        let mut words = vec![0; lists.len()];
        let mut places = HashMap::new();
        for (cell, list) in lists.into_iter().enumerate() {
            words[cell] = *places.entry(list).or_insert_with_key(|list| {
                let at = words.len() as u32;
                push_list(&mut words, set.directions(), list);
                at
            });
        }
        Self { resolution, words, most_candidates }
    }

    /// Index of the direction that is nearest to a unit vector.
    #[inline(always)]
    pub fn nearest(&self, direction: Vec3) -> u32 {
        nearest_direction(&self.words, self.resolution, direction)
    }

    /// Cells per row and column.
    pub fn resolution(&self) -> u32 {
        self.resolution
    }

    /// The map as backends read it.
    pub fn words(&self) -> &[u32] {
        &self.words
    }

    /// The words of a map that finds rays of layered hit buffers: twice the number of the line, plus 1 where the direction runs
    /// against it.
    pub fn ray_words(&self, set: &DirectionSet) -> Vec<u32> {
        let cells = self.resolution as usize * self.resolution as usize;
        let mut words = self.words.clone();
        for word in words[cells..].iter_mut().skip(1).step_by(2) {
            let on_line = set.on_lines()[(*word & INDEX) as usize];
            *word = *word & !INDEX | on_line.line << 1 | u32::from(on_line.reversed);
        }
        words
    }

    /// What [`crate::kernels::walk_lhb`] gathers along: for each direction of the set its ray, as in [`NearestMap::ray_words`], and the bits
    /// of its solid angle in f32.
    pub fn gather_words(set: &DirectionSet) -> Vec<u32> {
        let ray = |on_line: &OnLine| on_line.line << 1 | u32::from(on_line.reversed);
        let words = set.on_lines().iter().zip(set.solid_angles());
        words.flat_map(|(on_line, &angle)| [ray(on_line), (angle as f32).to_bits()]).collect()
    }

    /// Length of the longest list: the most products that one call compares.
    pub fn most_candidates(&self) -> u32 {
        self.most_candidates
    }
}

impl DirectionSet {
    /// How much larger the angle to what [`NearestMap`] finds can be than the angle to the nearest direction, radians,
    /// for unit vectors in f32.
    ///
    /// Rounding makes j win over a nearer i only where it outweighs q·(dᵢ − dⱼ): the errors of dᵢ and dⱼ, and q's times
    /// |dᵢ − dⱼ| = c. That bounds the difference of the cosines, 2·sin(e/2) times the sine of the mean of the two
    /// angles, which is at least c/2 because i and j are no closer to each other than through q. So e ≤ 2·(q's error) +
    /// 4·(d's error)/c. But e ≤ c as well, so c below where the two cross need not be looked at.
    pub fn nearest_error(&self) -> f64 {
        let d = self.directions();
        let pairs =
            d.iter().enumerate().flat_map(|(i, a)| d[..i].iter().map(move |b| a.distance_squared(*b)));
        let closest = pairs.fold(f64::INFINITY, f64::min).sqrt();
        let crossing = QUERY_ERROR + (QUERY_ERROR * QUERY_ERROR + 4.0 * CANDIDATE_ERROR).sqrt();
        let bound = 2.0 * QUERY_ERROR + 4.0 * CANDIDATE_ERROR / closest.max(crossing);
        // Arcs over chords, and products of errors: less than 1e-4 of the bound, which is at most 0.011.
        bound * 1.001
    }
}

/// For each cell the directions that can win in it, in order. What can't win in the four times larger cell around it is
/// not looked at again.
fn lists(directions: &[DVec3], resolution: u32) -> Vec<Vec<u32>> {
    let cells = 0..resolution * resolution;
    if !resolution.is_multiple_of(4) {
        let all: Vec<u32> = (0..directions.len() as u32).collect();
        return cells.map(|cell| candidates(directions, &all, cell, resolution)).collect();
    }
    let coarse = lists(directions, resolution / 2);
    let around = |cell: u32| cell / resolution / 2 * (resolution / 2) + cell % resolution / 2;
    cells.map(|cell| candidates(directions, &coarse[around(cell) as usize], cell, resolution)).collect()
}

/// Those of `among` that can have the greatest product with a quantised vector in the cell: which are not behind the
/// one nearest to its middle at all corners. What is behind there is behind everywhere in the cell, whose vectors are
/// sums of its corners with weights that are not negative and not less than 1 together.
fn candidates(directions: &[DVec3], among: &[u32], cell: u32, resolution: u32) -> Vec<u32> {
    let (row, column) = (cell / resolution, cell % resolution);
    let centre = unfolded(2 * column + 1, 2 * row + 1, resolution);
    let corners = [0, 1, 2, 3].map(|i| unfolded(2 * (column + i % 2), 2 * (row + i / 2), resolution));
    let product = |i: u32| centre.dot(directions[i as usize]);
    let middle = among.iter().copied().reduce(|a, b| if product(b) > product(a) { b } else { a });
    let middle = middle.map_or(DVec3::ZERO, |i| directions[i as usize]);
    // Both candidates' errors, and what is rounded here.
    let slack = 2.0 * CANDIDATE_ERROR + 1e-9;
    let wins = |i: &u32| corners.iter().any(|corner| corner.dot(directions[*i as usize] - middle) > -slack);
    among.iter().copied().filter(wins).collect()
}

/// The unit vector at a point of the map, in half cells from its corner.
fn unfolded(u: u32, v: u32, resolution: u32) -> DVec3 {
    let half = f64::from(resolution);
    let (u, v) = (f64::from(u) / half - 1.0, f64::from(v) / half - 1.0);
    let z = 1.0 - u.abs() - v.abs();
    if z < 0.0 {
        return DVec3::new((1.0 - v.abs()).copysign(u), (1.0 - u.abs()).copysign(v), z).normalize();
    }
    DVec3::new(u, v, z).normalize()
}

fn push_list(lists: &mut Vec<u32>, directions: &[DVec3], list: &[u32]) {
    for (k, &i) in list.iter().enumerate() {
        let d = directions[i as usize].to_array().map(|c| (c * SCALE).round_ties_even() as i32 as u32);
        let last = if k + 1 == list.len() { LAST } else { 0 };
        lists.extend([d[0] & 0xffff | d[1] << 16, d[2] << 16 | last | i]);
    }
}
