//! The light list and its alias table.

use super::super::compiled::*;
use super::super::{Light, Scene, Triangle};

use bytemuck::Zeroable;
use glam::{DVec3, Vec3};
use std::f64::consts::PI;

/// Radiance of 2 to this is what the film's quanta are fitted to at least: the moments' exponent stays in range.
const LEAST_MAGNITUDE: i32 = -40;

/// Lights with their powers, until the alias table is made.
pub(super) struct Listed {
    records: Vec<LightRecord>,
    powers: Vec<f64>,
    /// Radiance that samples of this scene are scaled by in the film.
    brightest: f64,
    pub(super) notices: Vec<String>,
}

pub(super) fn luminance(c: [f32; 3]) -> f64 {
    let [r, g, b] = c.map(f64::from);
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

fn peak(c: [f32; 3]) -> f64 {
    c.iter().fold(0.0, |a, &b| a.max(f64::from(b)))
}

/// Lists the scene's lights, spheres first, and writes each emissive triangle's light index into it.
pub(super) fn list(
    scene: &Scene,
    origin: DVec3,
    triangles: &mut [Triangle],
    materials: &[MaterialRecord],
    bounds: (Vec3, Vec3),
) -> Listed {
    let radius = scene_radius(bounds);
    let mut listed = Listed { records: Vec::new(), powers: Vec::new(), brightest: 0.0, notices: Vec::new() };
    let spheres = scene.lights.iter().filter(|l| matches!(l, Light::Sphere { .. }));
    let others = scene.lights.iter().filter(|l| !matches!(l, Light::Sphere { .. }));
    for light in spheres.chain(others) {
        listed.add(light, origin, radius);
    }
    let mut flat = 0_usize;
    // In id order, so that the list doesn't depend on the hierarchy.
    let mut slots: Vec<usize> = (0..triangles.len())
        .filter(|&s| peak(materials[triangles[s].material as usize].emission) > 0.0)
        .collect();
    slots.sort_by_key(|&s| triangles[s].id);
    for slot in slots {
        let material = &materials[triangles[slot].material as usize];
        match triangle_light(&triangles[slot], slot, material) {
            Some((record, power)) => {
                triangles[slot].light = listed.records.len() as u32;
                listed.push(record, power, peak(material.emission));
            }
            None => flat += 1,
        }
    }
    if flat > 0 {
        listed.notices.push(format!("{flat} emissive triangles have no area and give no light"));
    }
    listed
}

/// Half the diagonal of the bounds, at least a small positive number so that distant lights of an empty scene have
/// power.
pub(super) fn scene_radius(bounds: (Vec3, Vec3)) -> f64 {
    ((bounds.1.as_dvec3() - bounds.0.as_dvec3()).length() * 0.5).max(1e-6)
}

fn triangle_light(t: &Triangle, slot: usize, material: &MaterialRecord) -> Option<(LightRecord, f64)> {
    let [p0, p1, p2] = [t.p0, t.p1, t.p2].map(|p| Vec3::from(p).as_dvec3());
    let normal = (p1 - p0).cross(p2 - p0);
    let area = normal.length() * 0.5;
    // The sampler divides by the f32 area.
    if !((area as f32) > 1e-30) {
        return None;
    }
    let sides = if material.flags & EMITS_BOTH_SIDES == 0 { 1.0 } else { 2.0 };
    let record = LightRecord {
        kind: LIGHT_TRIANGLE,
        direction: normal.normalize().as_vec3().to_array(),
        emission: material.emission,
        triangle: slot as u32,
        flags: material.flags & EMITS_BOTH_SIDES,
        area: area as f32,
        ..LightRecord::zeroed()
    };
    Some((record, luminance(material.emission) * area * PI * sides))
}

impl Listed {
    pub(super) fn len(&self) -> usize {
        self.records.len()
    }

    pub(super) fn sphere_count(&self) -> u32 {
        self.records.iter().filter(|r| r.kind == LIGHT_SPHERE).count() as u32
    }

    pub(super) fn push(&mut self, record: LightRecord, power: f64, radiance: f64) {
        self.brightest = self.brightest.max(radiance);
        self.records.push(record);
        self.powers.push(power.max(f64::MIN_POSITIVE));
    }

    fn add(&mut self, light: &Light, origin: DVec3, radius: f64) {
        let place = |p: [f32; 3]| super::narrow(Vec3::from(p).as_dvec3() - origin);
        let unit = |d: [f32; 3]| Vec3::from(d).as_dvec3().normalize().as_vec3().to_array();
        // A point light's radiance on a white surface grows without bound nearby; a tenth of the scene's radius is the
        // distance at which the film's scale is set.
        let near = radius * 0.1;
        let base = LightRecord::zeroed();
        match *light {
            Light::Point { position, intensity } if peak(intensity) > 0.0 => {
                let record =
                    LightRecord { kind: LIGHT_POINT, position: place(position), emission: intensity, ..base };
                self.push(record, 4.0 * PI * luminance(intensity), peak(intensity) / (near * near));
            }
            Light::Spot { position, direction, intensity, inner_angle, outer_angle }
                if peak(intensity) > 0.0 =>
            {
                let (inner, outer) = (f64::from(inner_angle).cos(), f64::from(outer_angle).cos());
                let scale = 1.0 / (inner - outer).max(0.001);
                let record = LightRecord {
                    kind: LIGHT_SPOT,
                    position: place(position),
                    direction: unit(direction),
                    emission: intensity,
                    spot_scale: scale as f32,
                    spot_offset: (-outer * scale) as f32,
                    ..base
                };
                let power = 2.0 * PI * (1.0 - 0.5 * (inner + outer)) * luminance(intensity);
                self.push(record, power, peak(intensity) / (near * near));
            }
            Light::Directional { direction, irradiance } if peak(irradiance) > 0.0 => {
                let record = LightRecord {
                    kind: LIGHT_DIRECTIONAL,
                    direction: unit(direction),
                    emission: irradiance,
                    ..base
                };
                self.push(record, luminance(irradiance) * PI * radius * radius, peak(irradiance));
            }
            Light::Sphere { center, radius, radiance } if peak(radiance) > 0.0 => {
                let record = LightRecord {
                    kind: LIGHT_SPHERE,
                    position: place(center),
                    radius,
                    emission: radiance,
                    ..base
                };
                let area = 4.0 * PI * f64::from(radius) * f64::from(radius);
                self.push(record, luminance(radiance) * area * PI, peak(radiance));
            }
            // Rectangles are emissive triangles by now; lights of no power are left out.
            _ => {}
        }
    }

    /// Film and moment exponents: quanta of 2⁻³⁶ of the brightest radiance leave 27 bits of head-room for the sum
    /// over samples; squared luminance gets 2⁻³² of its square and saturates 31 bits above it.
    pub(super) fn film_exponents(&self) -> (i32, i32) {
        let magnitude = if self.brightest > 0.0 {
            (self.brightest.log2().ceil() as i32).clamp(LEAST_MAGNITUDE, 60)
        } else {
            0
        };
        (36 - magnitude, 32 - 2 * magnitude)
    }

    /// A notice where all light is so dim that the film's quanta don't follow it down.
    pub(super) fn dim(&self) -> Option<String> {
        let coarse = self.brightest > 0.0 && self.brightest.log2().ceil() < f64::from(LEAST_MAGNITUDE);
        let radiance = self.brightest;
        coarse.then(|| {
            format!("the brightest light has a radiance of {radiance:e}: the film rounds it; scale lights up")
        })
    }

    /// Fills in selection probabilities and the alias table (Vose 1991).
    pub(super) fn finish(mut self) -> Vec<LightRecord> {
        let table = alias_table(&self.powers);
        for (record, row) in self.records.iter_mut().zip(&table) {
            record.select_pdf = row.pdf;
            record.alias_threshold = row.threshold;
            record.alias = row.alias;
        }
        self.records
    }
}

/// A row of an alias table.
pub(super) struct AliasRow {
    /// Probability of the row's own index, by the table as quantised.
    pub(super) pdf: f32,
    /// Keep the own index below this 32-bit draw.
    pub(super) threshold: u32,
    /// Else take this index.
    pub(super) alias: u32,
}

/// Vose's alias method with 32-bit thresholds. Weights are ≥ 0 with a positive sum; a weight of 0 is never picked.
/// `pdf` is recomputed from the quantised thresholds, so that the estimator divides by the true probability.
pub(super) fn alias_table(weights: &[f64]) -> Vec<AliasRow> {
    let n = weights.len();
    let total: f64 = weights.iter().sum();
    let mut scaled: Vec<f64> = weights.iter().map(|w| w / total * n as f64).collect();
    let mut rows: Vec<(u64, u32)> = (0..n as u32).map(|i| (1 << 32, i)).collect();
    let (mut small, mut large): (Vec<usize>, Vec<usize>) = (0..n).partition(|&i| scaled[i] < 1.0);
    while let (Some(s), Some(&l)) = (small.pop(), large.last()) {
        rows[s] = ((scaled[s] * 4_294_967_296.0).floor() as u64, l as u32);
        scaled[l] -= 1.0 - scaled[s];
        if scaled[l] < 1.0 {
            large.pop();
            small.push(l);
        }
    }
    let mut share = vec![0_u64; n];
    for (i, row) in rows.iter_mut().enumerate() {
        // A threshold of 2³² doesn't fit: such a row keeps its own index on both branches.
        if row.0 > u64::from(u32::MAX) {
            *row = (u64::from(u32::MAX), i as u32);
        }
        share[i] += row.0;
        share[row.1 as usize] += (1 << 32) - row.0;
    }
    let whole = 4_294_967_296.0 * n as f64;
    let row = |(i, (threshold, alias)): (usize, (u64, u32))| AliasRow {
        pdf: (share[i] as f64 / whole) as f32,
        threshold: threshold as u32,
        alias,
    };
    rows.into_iter().enumerate().map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn alias_probabilities_are_the_weights() {
        let weights = [1.0, 0.0, 3.0, 4.0, 1e-9, 8.0];
        let table = alias_table(&weights);
        let total: f64 = weights.iter().sum();
        for (row, w) in table.iter().zip(weights) {
            // Thresholds are rounded to 2^-32 of a row.
            assert!((f64::from(row.pdf) - w / total).abs() < 1e-7, "{} for {w}", row.pdf);
        }
        assert_eq!(table[1].threshold, 0);
        assert!(table.iter().all(|r| r.alias != 1 || r.threshold == u32::MAX));
        assert_eq!(table[1].pdf, 0.0);
    }

    #[test]
    fn one_light_is_always_picked() {
        let table = alias_table(&[0.25]);
        assert_eq!((table[0].pdf, table[0].alias), (1.0, 0));
    }
}
