//! The way along a cone.

use super::filter::{Plane, sample};
use super::value::Sample;
use super::{Possible, Pyramid, Within};
use twinlight_core::kernels::reduce_mips::OPAQUE;
use twinlight_core::kernels::trace_cones::{
    Cone, LEAST_TRANSMITTANCE, MAX_SINE, MAX_STEPS, SIXTY_DEGREES, TraceConesBlock,
};

const ZERO: Within = Within::exactly(0.0);
const HALF: Within = Within::exactly(0.5);
const ONE: Within = Within::exactly(1.0);

/// Every light that the contract allows for one cone of finite numbers.
pub fn possible(pyramid: &Pyramid, block: &TraceConesBlock, cone: &Cone) -> Vec<Possible> {
    let scale = known(block.frame.voxels_per_unit);
    let origin = [0, 1, 2].map(|axis| (known(cone.origin[axis]) - known(block.frame.corner[axis])) * scale);
    let normal = cone.normal.map(f64::from);
    let march = March {
        pyramid,
        origin,
        direction: cone.direction.map(f64::from),
        sine: known(cone.sine).max(ZERO).min(known(MAX_SINE)),
        reach: known(block.reach) * scale,
        is_sixty: block.flags & SIXTY_DEGREES != 0,
        plane: (normal != [0.0; 3]).then_some(Plane { place: origin, normal }),
    };
    let unit = known(block.unit);
    let ends = march.ends(known(cone.start) * scale).into_iter();
    ends.map(|(rgb, transmittance)| Possible { rgb: rgb.map(|c| c * unit), transmittance }).collect()
}

fn known(x: f32) -> Within {
    Within::exactly(f64::from(x))
}

struct March<'a> {
    pyramid: &'a Pyramid,
    origin: [Within; 3],
    direction: [f64; 3],
    sine: Within,
    reach: Within,
    is_sixty: bool,
    plane: Option<Plane>,
}

impl March<'_> {
    /// Light and transmittance at every place where the cone may end.
    fn ends(&self, start: Within) -> Vec<([Within; 3], Within)> {
        // Where a rounding makes two powers of two of the first distance, each has its own march.
        let starts = if self.is_sixty { powers(start.max(ONE)) } else { vec![start] };
        starts.into_iter().flat_map(|start| self.ends_from(start)).collect()
    }

    fn ends_from(&self, start: Within) -> Vec<([Within; 3], Within)> {
        let mut ends = Vec::new();
        let (mut d, mut rgb, mut left) = (start, [ZERO; 3], ONE);
        let mut was_outside = self.is_outside(&self.origin);
        for _ in 0..MAX_STEPS {
            let place = [0, 1, 2].map(|a| self.origin[a] + d * Within::exactly(self.direction[a]));
            let is_spent = known(LEAST_TRANSMITTANCE).is_at_least(left);
            let radius = if self.is_sixty { d.scaled(0.5) } else { (d * self.sine).max(HALF) };
            let is_over = any([was_outside, self.misses(&place, radius), d.is_more(self.reach), is_spent]);
            if is_over != Some(false) {
                ends.push((rgb, left));
            }
            if is_over == Some(true) {
                return ends;
            }
            was_outside = self.is_outside(&place);
            let seen = self.seen(self.brought_in(place), radius.scaled(2.0));
            let opacity = seen[3].scaled(1.0 / f64::from(OPAQUE)).min(ONE);
            rgb = [0, 1, 2].map(|c| rgb[c] + left * seen[c]);
            left = left * (ONE - opacity);
            d = self.next(d, radius);
        }
        ends.push((rgb, left));
        ends
    }

    fn next(&self, d: Within, radius: Within) -> Within {
        if self.is_sixty {
            return d.scaled(2.0);
        }
        (d + radius.scaled(2.0)).max((d + radius).over(ONE - self.sine))
    }

    fn is_outside(&self, place: &[Within; 3]) -> Option<bool> {
        let beyond = |axis: usize| any([ZERO.is_more(place[axis]), place[axis].is_more(self.count(axis))]);
        any([beyond(0), beyond(1), beyond(2)])
    }

    /// Whether a sphere has no part in the grid.
    fn misses(&self, place: &[Within; 3], radius: Within) -> Option<bool> {
        let beyond = |axis: usize| {
            let (low, high) = (ZERO - radius, self.count(axis) + radius);
            any([low.is_at_least(place[axis]), place[axis].is_at_least(high)])
        };
        any([beyond(0), beyond(1), beyond(2)])
    }

    fn brought_in(&self, place: [Within; 3]) -> [Within; 3] {
        [0, 1, 2].map(|axis| place[axis].max(ZERO).min(self.count(axis)))
    }

    /// Voxels along an axis.
    fn count(&self, axis: usize) -> Within {
        known(self.pyramid.dims[axis] as f32)
    }

    /// The sample of a sphere of some width, which is at least 1.
    fn seen(&self, place: [Within; 3], width: Within) -> Sample {
        let mut found: Option<Sample> = None;
        let (least, most) = (level_of(width.low), level_of(width.high));
        for level in least..=most.min(least.max(self.pyramid.last)) {
            let of_level = self.between(place, level, width);
            found = Some(found.map_or(of_level, |found| [0, 1, 2, 3].map(|w| found[w].hull(of_level[w]))));
        }
        found.unwrap_or([ZERO; 4])
    }

    /// The same, if its width is of `level`.
    fn between(&self, place: [Within; 3], level: u32, width: Within) -> Sample {
        let of = |level| sample(self.pyramid, level, place, self.direction, self.plane.as_ref());
        let last = self.pyramid.last;
        if level >= last {
            return of(last);
        }
        let power = f64::from(level).exp2();
        let f = Within { low: (width.low / power).max(1.0) - 1.0, high: (width.high / power).min(2.0) - 1.0 };
        let (fine, coarse) = (of(level), of(level + 1));
        [0, 1, 2, 3].map(|w| (ONE - f) * fine[w] + f * coarse[w])
    }
}

/// l of w = m·2ˡ, by doubling.
fn level_of(width: f64) -> u32 {
    let (mut level, mut power) = (0, 1.0);
    while power * 2.0 <= width && level < 1000 {
        (level, power) = (level + 1, power * 2.0);
    }
    level
}

/// The least powers of two that are at least what is within `d`.
fn powers(d: Within) -> Vec<Within> {
    let least = |d: f64| {
        let mut power = 1.0;
        while power < d {
            power *= 2.0;
        }
        power
    };
    let (first, last) = (least(d.low), least(d.high));
    if first == last {
        vec![Within::exactly(first)]
    } else {
        vec![Within::exactly(first), Within::exactly(last)]
    }
}

/// Whether any of some statements holds; `None` where a rounding decides.
fn any<const N: usize>(all: [Option<bool>; N]) -> Option<bool> {
    if all.contains(&Some(true)) {
        Some(true)
    } else if all.contains(&None) {
        None
    } else {
        Some(false)
    }
}
