//! The sample of a level.

use super::value::{Sample, seen};
use super::{Pyramid, Within};
use twinlight_core::kernels::trace_cones::PLANE_MARGIN;

const ZERO: Within = Within::exactly(0.0);
const ONE: Within = Within::exactly(1.0);

/// The plane of a surface: where it is, in voxels, and its normal.
#[derive(Debug, Clone, Copy)]
pub struct Plane {
    /// A point of it.
    pub place: [Within; 3],
    /// Its normal, exactly.
    pub normal: [f64; 3],
}

impl Plane {
    /// How far a point is along the normal.
    fn along(&self, point: [Within; 3]) -> Within {
        let [x, y, z] = [0, 1, 2].map(|axis| Within::exactly(self.normal[axis]) * point[axis]);
        x + y + z
    }
}

/// One of the eight voxels of a sample.
struct Corner {
    weight: Within,
    value: Sample,
    /// `None` where a rounding decides.
    counts: Option<bool>,
}

/// S(l) at a place in voxels.
pub fn sample(
    pyramid: &Pyramid,
    level: u32,
    place: [Within; 3],
    direction: [f64; 3],
    plane: Option<&Plane>,
) -> Sample {
    let side = f64::from(level).exp2();
    let axes = place.map(|p| cells(p.scaled(1.0 / side) - Within::exactly(0.5)));
    let mut found: Option<Sample> = None;
    for x in &axes[0] {
        for y in &axes[1] {
            for z in &axes[2] {
                let corners = corners(pyramid, level, [*x, *y, *z], direction, plane);
                let of_cell = weighed(&corners);
                found = Some(found.map_or(of_cell, |found| hull(found, of_cell)));
            }
        }
    }
    found.unwrap_or([ZERO; 4])
}

/// Every ⌊q⌋ that roundings allow, with what is left of q.
fn cells(q: Within) -> Vec<(i64, Within)> {
    let left = |i: i64| {
        let from = |end: f64| (end - i as f64).clamp(0.0, 1.0);
        (i, Within { low: from(q.low), high: from(q.high) })
    };
    (q.low.floor() as i64..=q.high.floor() as i64).map(left).collect()
}

fn corners(
    pyramid: &Pyramid,
    level: u32,
    cell: [(i64, Within); 3],
    direction: [f64; 3],
    plane: Option<&Plane>,
) -> Vec<Corner> {
    let counts = pyramid.counts(level);
    let steps = (0..2).flat_map(|z| (0..2).flat_map(move |y| (0..2).map(move |x| [x, y, z])));
    let corner = |step: [i64; 3]| {
        let along = |axis: usize| {
            let (_, g) = cell[axis];
            if step[axis] == 1 { g } else { ONE - g }
        };
        let voxel =
            [0, 1, 2].map(|axis| (cell[axis].0 + step[axis]).clamp(0, i64::from(counts[axis]) - 1) as u32);
        let value = pyramid
            .value(level, voxel)
            .map_or([ZERO; 4], |words| seen(words, pyramid.storage, level, direction));
        Corner {
            weight: along(0) * along(1) * along(2),
            value,
            counts: plane.map_or(Some(true), |plane| is_in_front(plane, level, voxel)),
        }
    };
    steps.map(corner).collect()
}

fn is_in_front(plane: &Plane, level: u32, voxel: [u32; 3]) -> Option<bool> {
    let side = f64::from(level).exp2();
    let centre = voxel.map(|i| Within::exactly((f64::from(i) + 0.5) * side));
    let height = plane.along(centre) - plane.along(plane.place);
    let [x, y, z] = plane.normal.map(|n| Within::exactly(n).abs());
    let span = (x + y + z).scaled(0.5 * side);
    height.is_more(span + Within::exactly(f64::from(PLANE_MARGIN)))
}

/// The mean of what counts; spans every choice of what is in doubt.
fn weighed(corners: &[Corner]) -> Sample {
    let doubtful: Vec<usize> = (0..corners.len()).filter(|&i| corners[i].counts.is_none()).collect();
    let mut found: Option<Sample> = None;
    for choice in 0..1_u32 << doubtful.len() {
        let is_chosen = |i: usize| match doubtful.iter().position(|&d| d == i) {
            Some(bit) => choice >> bit & 1 == 1,
            None => corners[i].counts == Some(true),
        };
        let chosen: Vec<&Corner> =
            (0..corners.len()).filter(|&i| is_chosen(i)).map(|i| &corners[i]).collect();
        let mean = mean(&chosen);
        found = Some(found.map_or(mean, |found| hull(found, mean)));
    }
    found.unwrap_or([ZERO; 4])
}

fn sum(corners: &[&Corner]) -> Sample {
    let add = |sum: Sample, c: &&Corner| [0, 1, 2, 3].map(|w| sum[w] + c.weight * c.value[w]);
    corners.iter().fold([ZERO; 4], add)
}

/// A mean is never beyond what it is the mean of, but for roundings of both.
fn mean(corners: &[&Corner]) -> Sample {
    let Some(first) = corners.first() else { return [ZERO; 4] };
    let weights = corners.iter().fold(ZERO, |sum, c| sum + c.weight);
    let all = corners.iter().fold(first.value, |all, c| hull(all, c.value));
    // Sums of eight products, of their weights, and a division.
    let all = all.map(|v| v.rounded_often(24));
    let sums = sum(corners);
    let found = [0, 1, 2, 3].map(|w| sums[w].over(weights).common(all[w]));
    if weights.low <= 0.0 { hull(found, [ZERO; 4]) } else { found }
}

fn hull(a: Sample, b: Sample) -> Sample {
    [0, 1, 2, 3].map(|w| a[w].hull(b[w]))
}
