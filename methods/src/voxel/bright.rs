//! How bright voxels may be: what their integers must hold.

use twinlight_core::scene::{
    CompiledScene, LIGHT_DIRECTIONAL, LIGHT_ENVIRONMENT, LIGHT_POINT, LIGHT_SPHERE, LIGHT_SPOT, NONE,
};
use twinlight_core::transport::{INV_PI, PI};

/// A point light this share of the scene's extent away is the nearest that is told apart: closer, voxels saturate.
const NEAREST: f32 = 1.0 / 64.0;

/// What is left for light that is scattered more than once, and for both sides of a voxel that are lit.
const HEADROOM: f32 = 4.0;

/// About the most radiance that a white voxel reflects of the scene's lights: voxels that are brighter saturate, and are counted.
///
/// A lamp of an area A reflects in a surface at the distance d at most L·A/(π·d²), and at most L: all lamps together at most twice the brightest of them, on
/// both sides. Points are lamps at the nearest distance. Light of the environment counts by its mean over the sphere, four times of which is a
/// bound of its irradiance over π.
pub(super) fn brightest(scene: &CompiledScene) -> f32 {
    let (low, high) = (glam::Vec3::from(scene.bounds.0), glam::Vec3::from(scene.bounds.1));
    let near = (high - low).length() * NEAREST;
    let (mut area, mut most_area, mut others) = (0.0_f32, 0.0_f32, 4.0 * environment(scene));
    for light in &scene.lights {
        let most = most_of(light.emission);
        match light.kind {
            LIGHT_ENVIRONMENT => {}
            LIGHT_DIRECTIONAL => others += most * INV_PI,
            LIGHT_POINT | LIGHT_SPOT => others += distant(most, near),
            kind => {
                let facing = if kind == LIGHT_SPHERE { PI * light.radius * light.radius } else { light.area };
                let reflected = distant(most * facing, near);
                area += if reflected < most { reflected } else { most };
                most_area = if most > most_area { most } else { most_area };
            }
        }
    }
    let twice = most_area + most_area;
    let bound = ((if area < twice { area } else { twice }) + others) * HEADROOM;
    if bound > LEAST { if bound < MOST { bound } else { MOST } } else { LEAST }
}

/// Bounds whose units and their inverses are normal numbers.
const LEAST: f32 = 1e-25;
const MOST: f32 = 1e30;

/// Radiance of a white surface at a distance `near` from what has the intensity `most`.
fn distant(most: f32, near: f32) -> f32 {
    let squared = near * near;
    if squared > 0.0 { most / squared * INV_PI } else { most }
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
