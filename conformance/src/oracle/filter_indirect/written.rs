//! The contract's formula, in f32 and in its order.

use super::Picture;
use glam::Vec3;
use twinlight_core::kernels::filter_indirect::{LEAST_ALBEDO, RadianceTexel};
use twinlight_core::kernels::shade_primary::GBufferTexel;
use twinlight_core::kernels::trace::NO_HIT;

/// Every pixel's light. What is computed and is no number is [`f32::NAN`]: which NaN it is, nobody promises.
pub fn as_written(picture: &Picture) -> Vec<RadianceTexel> {
    (0..picture.gbuffer.len()).map(|at| texel(picture, at)).collect()
}

fn texel(picture: &Picture, at: usize) -> RadianceTexel {
    let mut texel = picture.input[at];
    if !picture.is_diffuse(at) {
        return texel;
    }
    let albedo = picture.gbuffer[at].albedo;
    let joined: Vec<(usize, f32)> = picture
        .window(at)
        .into_iter()
        .filter(|(other, _)| is_joined(picture, &picture.gbuffer[at], &picture.gbuffer[*other]))
        .map(|(other, quarters)| (other, quarters as f32 * 0.25))
        .collect();
    for c in (0..3).filter(|c| albedo[*c] >= LEAST_ALBEDO) {
        let (mut light, mut weights) = (0.0_f32, 0.0_f32);
        for &(other, weight) in &joined {
            let shared = picture.gbuffer[other].albedo[c];
            if shared >= LEAST_ALBEDO {
                light += weight * (picture.input[other].rgb[c] / shared);
                weights += weight;
            }
        }
        if weights > 0.0 {
            let mean = albedo[c] * light / weights;
            texel.rgb[c] = if mean.is_nan() { f32::NAN } else { mean };
        }
    }
    texel
}

fn is_joined(picture: &Picture, p: &GBufferTexel, q: &GBufferTexel) -> bool {
    let params = &picture.params;
    let dot = |a: Vec3, b: Vec3| a.x * b.x + a.y * b.y + a.z * b.z;
    let cosine = dot(p.shading_normal.into(), q.shading_normal.into());
    let height = dot(p.geometric_normal.into(), Vec3::from(q.position) - Vec3::from(p.position)).abs();
    let limit = params.footprint * params.window as f32 * p.depth;
    q.triangle != NO_HIT && q.material == p.material && cosine >= params.least_cosine && height <= limit
}
