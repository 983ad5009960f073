//! The environment's words: row cosines, radiance, pdf and alias table.

use super::super::Scene;
use super::super::compiled::*;
use super::lights::{Listed, alias_table, luminance, scene_radius};
use bytemuck::Zeroable;
use glam::Vec3;
use std::f64::consts::PI;

/// Appends the environment to `words` and `listed`, and returns the header (with the light counts in any case).
pub(super) fn append(
    scene: &Scene,
    bounds: (Vec3, Vec3),
    words: &mut Vec<u32>,
    listed: &mut Listed,
) -> EnvironmentHeader {
    let mut header = EnvironmentHeader {
        offset: NONE,
        light: NONE,
        sphere_count: listed.sphere_count(),
        light_count: listed.len() as u32,
        ..EnvironmentHeader::zeroed()
    };
    let Some(map) = scene.environment.as_ref().filter(|e| e.is_bright()) else { return header };
    let (width, height) = (map.width as usize, map.height as usize);
    header.offset = words.len() as u32;
    header.light = listed.len() as u32;
    header.light_count += 1;
    (header.width, header.height) = (map.width, map.height);
    let inverse = map.rotation.transpose();
    header.world_to_map = [0, 1, 2].map(|r| inverse.row(r).as_vec3().extend(0.0).to_array());

    let cosines: Vec<f64> = (0..=height).map(|r| (PI * r as f64 / height as f64).cos()).collect();
    words.extend(cosines.iter().map(|&c| (c as f32).to_bits()));
    let radiance: Vec<[f32; 3]> = map.texels.iter().map(|t| t.map(|x| x * map.scale)).collect();
    // Solid angles from the rounded cosines, which are the ones the sampler interpolates between.
    let solid_angle = |row: usize| {
        let between = f64::from(cosines[row] as f32) - f64::from(cosines[row + 1] as f32);
        between * 2.0 * PI / width as f64
    };
    let weights: Vec<f64> =
        radiance.iter().enumerate().map(|(i, &l)| luminance(l) * solid_angle(i / width)).collect();
    let table = alias_table(&weights);
    words.reserve(table.len() * 6);
    for (i, (row, l)) in table.iter().zip(&radiance).enumerate() {
        words.extend(l.map(f32::to_bits));
        words.push(((f64::from(row.pdf) / solid_angle(i / width)) as f32).to_bits());
        words.extend([row.threshold, row.alias]);
    }
    let radius = scene_radius(bounds);
    let power = weights.iter().sum::<f64>() * PI * radius * radius;
    let brightest = radiance.iter().flatten().fold(0.0_f32, |a, &b| a.max(b));
    let record = LightRecord { kind: LIGHT_ENVIRONMENT, ..LightRecord::zeroed() };
    listed.push(record, power, f64::from(brightest));
    header
}
