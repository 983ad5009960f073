//! Pictures to filter.

use crate::oracle::filter_indirect::Picture;
use crate::oracle::shade_primary;
use crate::scenes::compiled;
use crate::trial::Failure;
use glam::{DVec3, Vec3};
use twinlight_core::kernels::filter_indirect::{FilterIndirectParams, RadianceTexel};
use twinlight_core::kernels::shade_primary::{GBufferTexel, ShadePrimaryParams};
use twinlight_core::kernels::trace::NO_HIT;
use twinlight_core::scene::{Camera, Scene};
use twinlight_fixtures::random::Random;

/// A pixel's light.
pub(crate) fn radiance(rgb: [f32; 3]) -> RadianceTexel {
    RadianceTexel { rgb, padding: 0 }
}

/// Light that differs from pixel to pixel and from channel to channel, from 0.1 to 2.
pub(crate) fn noise(random: &mut Random, count: usize) -> Vec<RadianceTexel> {
    (0..count).map(|_| radiance([(); 3].map(|()| random.between(0.1, 2.0) as f32))).collect()
}

/// A white wall across the line of sight, in the dark.
pub(crate) fn wall(width: u32, height: u32, window: u32) -> Picture {
    let params =
        FilterIndirectParams { width, height, window, least_cosine: 0.9, footprint: 0.125, padding: [0; 3] };
    let places = (0..height).flat_map(|y| (0..width).map(move |x| [x as f32, -(y as f32), -8.0]));
    let gbuffer: Vec<GBufferTexel> = places.map(of_wall).collect();
    let input = vec![radiance([0.0; 3]); gbuffer.len()];
    Picture { params, gbuffer, diffuse: vec![1], input }
}

fn of_wall(position: [f32; 3]) -> GBufferTexel {
    GBufferTexel {
        position,
        depth: 8.0,
        geometric_normal: [0.0, 0.0, 1.0],
        triangle: 3,
        shading_normal: [0.0, 0.0, 1.0],
        material: 0,
        albedo: [1.0; 3],
        padding: 0,
    }
}

/// A wall in light that differs from pixel to pixel.
pub(crate) fn noisy_wall(random: &mut Random, width: u32, height: u32, window: u32) -> Picture {
    let wall = wall(width, height, window);
    Picture { input: noise(random, wall.input.len()), ..wall }
}

/// Albedo that differs from pixel to pixel, from 0.05 to 1.
pub(crate) fn textured(random: &mut Random, picture: &mut Picture) {
    for texel in &mut picture.gbuffer {
        texel.albedo = [(); 3].map(|()| random.between(0.05, 1.0) as f32);
    }
}

/// Patches of surfaces that differ in material, normal and plane, some of them about as much as is joined, with textures, holes,
/// black channels, glossy materials and materials without an entry.
pub(crate) fn patchwork(random: &mut Random, width: u32, height: u32, window: u32) -> Picture {
    let mut picture = noisy_wall(random, width, height, window);
    picture.diffuse = vec![1, 1, 0, 1];
    picture.params.footprint = 0.01;
    let seed = random.next_u64();
    for at in 0..picture.gbuffer.len() {
        let [x, y] = picture.place(at);
        let patch = (y / 5 * 1_000 + x / 7) as u64;
        picture.gbuffer[at] = of_patch(random, &mut Random::new(seed ^ patch), window);
    }
    picture
}

/// A pixel of a patch: what a patch has in common is drawn from a sequence of its own.
fn of_patch(random: &mut Random, patch: &mut Random, window: u32) -> GBufferTexel {
    if random.index(20) == 0 {
        return GBufferTexel { triangle: NO_HIT, ..of_wall([0.0; 3]) };
    }
    let material = [0, 0, 0, 1, 1, 2, 3, 4][patch.index(8)];
    let normal = [DVec3::Z, DVec3::Z, DVec3::new(0.6, 0.0, 0.8)][patch.index(3)];
    let depth = patch.between(2.0, 9.0);
    let step = 0.01 * f64::from(window) * depth;
    let plane = [0.0, 0.0, 0.7, 3.0][patch.index(4)];
    // Pixels beside each other in a plane, and off it by up to what is joined just so.
    let side = DVec3::new(random.between(-1.0, 1.0), random.between(-1.0, 1.0), 0.0);
    let position = side - normal * normal.dot(side) + normal * step * (plane + random.between(-0.6, 0.6));
    let tilted = |random: &mut Random, by: f64| (normal + random.direction() * by).normalize().as_vec3();
    let albedo = [(); 3].map(|()| if random.index(9) == 0 { 0.0 } else { random.between(0.05, 1.0) as f32 });
    GBufferTexel {
        position: position.as_vec3().to_array(),
        depth: depth as f32,
        geometric_normal: tilted(random, 0.02).to_array(),
        triangle: random.index(1_000) as u32,
        shading_normal: tilted(random, 0.35).to_array(),
        material,
        albedo,
        padding: 0,
    }
}

/// Noise in a picture of a scene, of which every fifth material is glossy.
pub(crate) fn in_scene(
    scene: &Scene,
    gbuffer: Vec<GBufferTexel>,
    shown: &ShadePrimaryParams,
    window: u32,
) -> Picture {
    let params = FilterIndirectParams {
        width: shown.width,
        height: shown.height,
        window,
        least_cosine: 0.9,
        footprint: Vec3::from(shown.camera.step_y).length(),
        padding: [0; 3],
    };
    let diffuse = (0..scene.materials.len()).map(|material| u32::from(material % 5 != 4)).collect();
    let input = noise(&mut Random::new(u64::from(window)), gbuffer.len());
    Picture { params, gbuffer, diffuse, input }
}

/// What a camera sees of a scene.
pub(crate) fn shown(scene: &Scene, width: u32, height: u32) -> Result<ShadePrimaryParams, Failure> {
    let camera = Camera::of_scene(scene).ok_or_else(|| Failure::Mismatch("no camera".into()))?;
    let camera = camera.record(width, height, compiled(scene).origin)?;
    Ok(ShadePrimaryParams { camera, width, height, padding: [0; 2] })
}

/// Noise in a picture of a scene, without a backend.
pub(crate) fn rendered(scene: &Scene, width: u32, height: u32, window: u32) -> Result<Picture, Failure> {
    let (compiled, params) = (compiled(scene), shown(scene, width, height)?);
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let gbuffer = pixels.map(|(x, y)| shade_primary::as_written(&compiled, &params, x, y)).collect();
    Ok(in_scene(scene, gbuffer, &params, window))
}
