//! Bugs in `trace_cones`: a march on the host in f32, wrong in one step.

use crate::faults::{FAULTS, Fault};
use crate::oracle::trace_cones::Pyramid;
use twinlight_core::kernels::reduce_mips::{ANISOTROPIC, HARMONICS, ISOTROPIC, OPAQUE, VoxelLevels};
use twinlight_core::kernels::trace_cones::{
    Cone, ConeLight, LEAST_TRANSMITTANCE, MAX_SINE, MAX_STEPS, PLANE_MARGIN, SIXTY_DEGREES, TraceConesBlock,
};
use twinlight_core::{Backend, Result};

/// rgb and opacity.
type Sample = [f32; 4];
type Point = [f32; 3];

pub(super) fn trace_cones<B: Backend>(
    inner: &B,
    fault: Fault,
    levels: &VoxelLevels<B>,
    values: &B::Buffer<u32>,
    cones: &B::Buffer<Cone>,
    block: &TraceConesBlock,
    light: &mut B::Buffer<ConeLight>,
) -> Result<()> {
    let before = inner.download(light)?;
    let sound = inner.trace_cones(levels, values, cones, block, light);
    if fault == Fault::ConesAcceptAnything {
        return Ok(());
    }
    let is_ours = FAULTS.iter().any(|(of, kernel, _)| *of == fault && *kernel == "trace_cones");
    let active = inner.download(&levels.active)?;
    // Bugs must show in sound levels: codes that nobody made are left to the sound backend.
    if sound.is_err() || !is_ours || active.contains(&u32::MAX) {
        return sound;
    }
    let words = inner.download(values)?;
    let pyramid = Pyramid::new(levels.grid.dims, block.storage, &levels.starts, &active, &words);
    let cones = inner.download(cones)?;
    let march = Broken { fault, pyramid: &pyramid, block };
    let mut found: Vec<ConeLight> = cones.iter().map(|cone| march.light(cone)).collect();
    match fault {
        Fault::ConesLoseLast if found.len() > 64 => found[cones.len() - 1] = before[cones.len() - 1],
        Fault::ConesNeighbour if found.len() > 256 => found[256] = found[0],
        _ => {}
    }
    *light = inner.upload(&found)?;
    Ok(())
}

struct Broken<'a> {
    fault: Fault,
    pyramid: &'a Pyramid,
    block: &'a TraceConesBlock,
}

fn dot(a: Point, b: Point) -> f32 {
    (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2]
}

impl Broken<'_> {
    fn has(&self, fault: Fault) -> bool {
        self.fault == fault
    }

    fn light(&self, cone: &Cone) -> ConeLight {
        let frame = &self.block.frame;
        let origin = [0, 1, 2].map(|a| (cone.origin[a] - frame.corner[a]) * frame.voxels_per_unit);
        let is_sixty = self.block.flags & SIXTY_DEGREES != 0;
        let most = if self.has(Fault::ConesAnySine) { 1.0 } else { MAX_SINE };
        let sine = if cone.sine > 0.0 { cone.sine.min(most) } else { 0.0 };
        let reach = self.block.reach * frame.voxels_per_unit;
        let reach = if self.has(Fault::ConesIgnoreReach) { f32::INFINITY } else { reach };
        let start = if self.has(Fault::ConesIgnoreStart) { 0.0 } else { cone.start };
        let mut d = start * frame.voxels_per_unit;
        if is_sixty {
            let least = if d > 1.0 { d } else { 1.0 };
            let power = f32::from_bits((least.to_bits() + 0x7f_ffff) & 0x7f80_0000);
            d = if self.has(Fault::ConesSixtyUnaligned) { least } else { power };
        }
        let least = if self.has(Fault::ConesEndEarly) { 0.0625 } else { LEAST_TRANSMITTANCE };
        let (mut rgb, mut left) = ([0.0; 3], 1.0);
        let mut is_inside = self.is_in_grid(origin);
        for _ in 0..if self.has(Fault::ConesFewSteps) { 256 } else { MAX_STEPS } {
            let place = [0, 1, 2].map(|a| origin[a] + cone.direction[a] * d);
            let wide = d * sine;
            let radius = if is_sixty {
                d * 0.5
            } else if wide > 0.5 {
                wide
            } else {
                0.5
            };
            if !is_inside || !self.meets_grid(place, radius) || !(d <= reach) || !(left > least) {
                break;
            }
            is_inside = self.is_in_grid(place) || self.has(Fault::ConesGoOnOutside);
            let found = self.sample(cone, origin, self.brought_in(place), radius + radius);
            let opacity = found[3] * (1.0 / OPAQUE as f32);
            let weight = if self.has(Fault::ConesUnattenuated) { 1.0 } else { left };
            rgb = [0, 1, 2].map(|c| rgb[c] + found[c] * weight);
            left *= 1.0 - if opacity < 1.0 || self.has(Fault::ConesAnyOpacity) { opacity } else { 1.0 };
            d = self.next(d, radius, sine, is_sixty);
        }
        let unit = if self.has(Fault::ConesIgnoreUnit) { 1.0 } else { self.block.unit };
        ConeLight { rgb: rgb.map(|c| c * unit), transmittance: left }
    }

    fn next(&self, d: f32, radius: f32, sine: f32, is_sixty: bool) -> f32 {
        if is_sixty {
            return if self.has(Fault::ConesSixtyTriples) { d * 3.0 } else { d + d };
        }
        let beyond = if self.has(Fault::ConesOverlap) { d + radius } else { d + (radius + radius) };
        let touching = (d + radius) / (1.0 - sine);
        if touching > beyond && !self.has(Fault::ConesSpheresApart) { touching } else { beyond }
    }

    fn is_in_grid(&self, place: Point) -> bool {
        (0..3).all(|a| place[a] >= 0.0 && place[a] <= self.pyramid.dims[a] as f32)
    }

    fn meets_grid(&self, place: Point, radius: f32) -> bool {
        if self.has(Fault::ConesEndAtBorder) {
            return self.is_in_grid(place);
        }
        (0..3).all(|a| place[a] > -radius && place[a] < self.pyramid.dims[a] as f32 + radius)
    }

    fn brought_in(&self, place: Point) -> Point {
        if self.has(Fault::ConesLookOutside) {
            return place;
        }
        [0, 1, 2].map(|a| place[a].clamp(0.0, self.pyramid.dims[a] as f32))
    }

    fn sample(&self, cone: &Cone, origin: Point, place: Point, width: f32) -> Sample {
        let last = self.pyramid.last;
        let level = (width.to_bits() >> 23) - 127;
        let level = if self.has(Fault::ConesTooFine) { level.saturating_sub(1) } else { level };
        let bits = if self.has(Fault::ConesWrongBits) { width.to_bits() << 1 } else { width.to_bits() };
        let f = f32::from_bits((bits & 0x7f_ffff) | 0x3f80_0000) - 1.0;
        if level >= last {
            return self.filtered(cone, origin, place, last);
        }
        let fine = self.filtered(cone, origin, place, level);
        if !(f > 0.0) || self.has(Fault::ConesOneLevel) {
            return fine;
        }
        let coarse = self.filtered(cone, origin, place, level + 1);
        [0, 1, 2, 3].map(|w| fine[w] * (1.0 - f) + coarse[w] * f)
    }

    fn filtered(&self, cone: &Cone, origin: Point, place: Point, level: u32) -> Sample {
        let width = (1 << level) as f32;
        let half = if self.has(Fault::ConesHalfAVoxelOff) { 0.0 } else { 0.5 };
        let q = place.map(|p| p * (1.0 / width) - half);
        let mut g = q.map(|q| q - q.floor());
        if self.has(Fault::ConesSwapAxes) {
            g.swap(0, 2);
        }
        let (mut sum, mut weight) = ([0.0; 4], 0.0);
        for corner in 0..8 {
            let bit = [corner & 1, corner >> 1 & 1, corner >> 2];
            let at = [0, 1, 2].map(|a| q[a].floor() as i32 + bit[a]);
            let counts = self.pyramid.counts(level);
            let voxel = [0, 1, 2].map(|a| at[a].clamp(0, counts[a] as i32 - 1) as u32);
            let along = [0, 1, 2].map(|a| if bit[a] == 1 { g[a] } else { 1.0 - g[a] });
            let share = (along[0] * along[1]) * along[2];
            if !self.counts(cone, origin, voxel, width) {
                continue;
            }
            weight += share;
            if self.has(Fault::ConesEmptyBorder) && (0..3).any(|a| at[a] != voxel[a] as i32) {
                continue;
            }
            let value = self.value(level, voxel, cone.direction);
            sum = [0, 1, 2, 3].map(|w| sum[w] + value[w] * share);
        }
        let weight = if self.has(Fault::ConesNotDivided) { 1.0 } else { weight };
        if weight > 0.0 { sum.map(|s| s * (1.0 / weight)) } else { [0.0; 4] }
    }

    fn counts(&self, cone: &Cone, origin: Point, voxel: [u32; 3], width: f32) -> bool {
        if cone.normal == [0.0; 3] || self.has(Fault::ConesLightThemselves) {
            return true;
        }
        let height = dot(cone.normal, voxel.map(|i| (i as f32 + 0.5) * width)) - dot(cone.normal, origin);
        let span = 0.5 * ((cone.normal[0].abs() + cone.normal[1].abs()) + cone.normal[2].abs());
        let own = if self.has(Fault::ConesCentresOnly) { 0.0 } else { span * width };
        height > own + PLANE_MARGIN
    }

    fn value(&self, level: u32, voxel: [u32; 3], direction: Point) -> Sample {
        let Some(words) = self.pyramid.value(level, voxel) else { return [0.0; 4] };
        let found = match self.block.storage {
            ISOTROPIC => [0, 1, 2, 3].map(|w| words[w] as f32),
            ANISOTROPIC => self.through_faces(words, direction),
            HARMONICS => {
                let lobe = |c: usize| [1, 2, 3, 4].map(|w| words[4 * c + w] as i32 as f32);
                self.of_lobes([lobe(0), lobe(1), lobe(2)], words[0], direction)
            }
            _ => self.of_lobes(
                [1, 2, 3].map(|w| self.bytes(words[w], words[0] >> 24)),
                words[0] & 0xff_ffff,
                direction,
            ),
        };
        let is_mean = self.block.storage != ANISOTROPIC || self.has(Fault::ConesLayersForAll);
        if is_mean && !self.has(Fault::ConesNoLayers) { self.layered(found, level) } else { found }
    }

    fn bytes(&self, word: u32, exponent: u32) -> [f32; 4] {
        let bytes = word.to_le_bytes();
        let signed =
            |b: u8| if self.has(Fault::ConesUnsignedBytes) { f32::from(b) } else { f32::from(b as i8) };
        let exponent = if self.has(Fault::ConesIgnoreExponent) { 0 } else { exponent };
        let q = [f32::from(bytes[0]), signed(bytes[1]), signed(bytes[2]), signed(bytes[3])];
        q.map(|q| q * f32::from_bits((127 + (exponent & 31)) << 23))
    }

    fn through_faces(&self, words: &[u32], direction: Point) -> Sample {
        let mut sum = [0.0; 4];
        for (axis, c) in direction.into_iter().enumerate() {
            let other = self.has(Fault::ConesSwapFaces);
            let face = 2 * axis + usize::from((c < 0.0) == other);
            let weight = if self.has(Fault::ConesUnsquared) { c.abs() } else { c * c };
            sum = [0, 1, 2, 3].map(|w| sum[w] + words[4 * face + w] as f32 * weight);
        }
        sum
    }

    fn of_lobes(&self, lobes: [[f32; 4]; 3], opacity: u32, direction: Point) -> Sample {
        let of = |a: [f32; 4]| {
            let along = dot([a[1], a[2], a[3]], direction);
            let sum = if self.has(Fault::ConesAlong) { a[0] + along } else { a[0] - along };
            if sum > 0.0 || self.has(Fault::ConesNegative) { sum } else { 0.0 }
        };
        [of(lobes[0]), of(lobes[1]), of(lobes[2]), opacity as f32]
    }

    fn layered(&self, value: Sample, level: u32) -> Sample {
        let mean = value[3] * (1.0 / OPAQUE as f32);
        if !(mean > 0.0) {
            return value;
        }
        let mut open = if mean < 1.0 { 1.0 - mean } else { 0.0 };
        for _ in 0..level {
            open *= open;
        }
        let factor = (1.0 - open) / mean;
        if self.has(Fault::ConesLayersDarken) {
            return [value[0], value[1], value[2], value[3] * factor];
        }
        value.map(|v| v * factor)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernels::trace_cones::{STORAGES, inputs};
    use twinlight_fixtures::random::Random;

    /// Without a bug the march is the kernel: what is caught is the bug.
    #[test]
    fn without_a_bug_it_is_the_oracles_light() {
        for storage in STORAGES {
            let (lit, block, cones) = inputs::some_call(&mut Random::new(5), storage);
            let march = Broken { fault: Fault::None, pyramid: &lit.pyramid, block: &block };
            let light: Vec<ConeLight> = cones.iter().map(|cone| march.light(cone)).collect();
            crate::kernels::trace_cones::possible_light(&lit, &block, &cones, &light).expect("sound");
        }
    }
}
