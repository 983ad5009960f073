//! How bright voxels may be: what their integers must hold.

use twinlight_core::scene::{
    CompiledScene, LIGHT_DIRECTIONAL, LIGHT_ENVIRONMENT, LIGHT_POINT, LIGHT_SPOT, LightRecord, NONE,
};

/// A point light this share of the scene's extent away is the nearest that is told apart: closer, voxels saturate.
const NEAREST: f32 = 1.0 / 64.0;

/// A bound of the radiance that a white voxel reflects of the scene's lights.
///
/// What comes from lamps of an area fills at most a hemisphere, which reflects at most their own radiance: the brightest counts. Light of the environment counts
/// by its mean over the sphere, four times of which is a bound of its irradiance over π. The others add up.
pub(super) fn brightest(scene: &CompiledScene) -> f32 {
    const INV_PI: f32 = twinlight_core::transport::INV_PI;
    let (low, high) = (glam::Vec3::from(scene.bounds.0), glam::Vec3::from(scene.bounds.1));
    let near = (high - low).length() * NEAREST;
    let (mut area, mut others) = (0.0_f32, 4.0 * environment(scene));
    for light in &scene.lights {
        let most = most_of(light.emission);
        match light.kind {
            LIGHT_ENVIRONMENT => {}
            LIGHT_DIRECTIONAL => others += most * INV_PI,
            LIGHT_POINT | LIGHT_SPOT => others += distant(light, near),
            _ => area = area.max(most),
        }
    }
    let bound = area + others;
    if bound.is_finite() && bound > 0.0 { bound } else { 1.0 }
}

fn distant(light: &LightRecord, near: f32) -> f32 {
    let squared = near * near;
    if squared > 0.0 { most_of(light.emission) / squared * twinlight_core::transport::INV_PI } else { 0.0 }
}

fn most_of(rgb: [f32; 3]) -> f32 {
    rgb.into_iter().fold(0.0, f32::max)
}

/// Mean radiance of the environment over the sphere, of its brightest channel.
fn environment(scene: &CompiledScene) -> f32 {
    let header = &scene.environment;
    if header.offset == NONE {
        return 0.0;
    }
    let (width, height) = (header.width as usize, header.height as usize);
    let words = &scene.words[header.offset as usize..];
    let value = |i: usize| f64::from(f32::from_bits(words[i]));
    let mut sum = [0.0; 3];
    for row in 0..height {
        // Rows are even in angle; cosines tell their share of the sphere.
        let share = (value(row) - value(row + 1)) * 0.5 / width as f64;
        for column in 0..width {
            let texel = height + 1 + 6 * (row * width + column);
            for (c, sum) in sum.iter_mut().enumerate() {
                *sum += value(texel + c) * share;
            }
        }
    }
    sum.into_iter().fold(0.0, f64::max) as f32
}
