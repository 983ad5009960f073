//! Indirect light of what the camera sees.

use super::cones::{Bundle, hemisphere};
use super::surfaces::mean_reflectance;
use super::{Lit, VoxelSettings};
use crate::reference::Film;
use glam::Vec3;
use twinlight_core::kernels::shade_primary::GBufferTexel;
use twinlight_core::kernels::trace::NO_HIT;
use twinlight_core::kernels::trace_cones::{Cone, ConeLight, TraceConesBlock};
use twinlight_core::math::vector::normalized;
use twinlight_core::scene::{Camera, CompiledScene, MATERIAL_DIELECTRIC, MATERIAL_OPAQUE, MaterialRecord};
use twinlight_core::transport::INV_PI;
use twinlight_core::{Backend, Error, Result};

/// A film's direct light, and indirect light through cones.
#[derive(Debug, Clone, PartialEq)]
pub struct Gathered {
    /// Mean radiance per pixel: the sum of both.
    pub radiance: Vec<[f32; 3]>,
    /// What came through cones.
    pub indirect: Vec<[f32; 3]>,
}

/// Adds indirect light to a film of direct light (one bounce): diffuse light through the cones of a hemisphere, glossy light through one whose
/// aperture is the lobe's. `gbuffer` is that of [`crate::gbuffer`] for the same camera and size.
///
/// Glass passes no light on, and mirrors reflect voxels.
///
/// # Errors
/// [`Error::InvalidInput`] for a G-buffer of another size; what the backend refuses.
pub fn gather<B: Backend>(
    backend: &B,
    scene: &CompiledScene,
    lit: &Lit<B>,
    camera: &Camera,
    gbuffer: &[GBufferTexel],
    film: &Film,
    settings: &VoxelSettings,
) -> Result<Gathered> {
    if gbuffer.len() != film.texels().len() {
        let what = format!("{} texels of {} pixels", gbuffer.len(), film.texels().len());
        return Err(Error::invalid("G-buffer", what));
    }
    let eye = Vec3::from(camera.record(film.width(), film.height(), scene.origin)?.position);
    let mut indirect = vec![[0.0; 3]; gbuffer.len()];
    if settings.bounces > 1 {
        diffuse(backend, scene, lit, gbuffer, eye, settings, &mut indirect)?;
        if settings.shining {
            glossy(backend, scene, lit, gbuffer, eye, &mut indirect)?;
        }
    }
    let add = |(direct, indirect): ([f32; 3], &[f32; 3])| [0, 1, 2].map(|c| direct[c] + indirect[c]);
    let radiance = film.direct().into_iter().zip(&indirect).map(add).collect();
    Ok(Gathered { radiance, indirect })
}

/// Cones that are traced together: 48 bytes each, here and on the device.
pub(crate) const CONES_AT_ONCE: usize = 1 << 20;

/// Pixels whose surface's material is as asked.
fn pixels<'a>(
    scene: &'a CompiledScene,
    gbuffer: &'a [GBufferTexel],
    wanted: impl Fn(&MaterialRecord) -> bool + 'a,
) -> impl Iterator<Item = usize> + 'a {
    let is_wanted = move |texel: &GBufferTexel| {
        texel.triangle != NO_HIT && scene.materials.get(texel.material as usize).is_some_and(&wanted)
    };
    gbuffer.iter().enumerate().filter(move |(_, texel)| is_wanted(texel)).map(|(i, _)| i)
}

fn diffuse<B: Backend>(
    backend: &B,
    scene: &CompiledScene,
    lit: &Lit<B>,
    gbuffer: &[GBufferTexel],
    eye: Vec3,
    settings: &VoxelSettings,
    indirect: &mut [[f32; 3]],
) -> Result<()> {
    let pixels: Vec<usize> = pixels(scene, gbuffer, |m| m.kind == MATERIAL_OPAQUE).collect();
    let (lobes, flags) = hemisphere(settings.cones);
    for pixels in pixels.chunks((CONES_AT_ONCE / lobes.len()).max(1)) {
        let mut bundle = Bundle::new(lobes.clone(), pixels.len());
        for &pixel in pixels {
            let texel = &gbuffer[pixel];
            bundle.push(texel.position.into(), texel.shading_normal.into(), lit.voxel);
        }
        let light = traced(backend, lit, &bundle.cones, flags)?;
        for (&pixel, irradiance) in pixels.iter().zip(bundle.sums(&light)) {
            let texel = &gbuffer[pixel];
            let material = &scene.materials[texel.material as usize];
            let view = normalized(eye - Vec3::from(texel.position));
            let (outwards, inwards) =
                (schlick(material, Vec3::from(texel.shading_normal).dot(view)), mean_reflectance(material));
            // What is reflected on the way in or out is not scattered.
            let share = |c: usize| (1.0 - inwards[c]) * (1.0 - outwards[c]);
            indirect[pixel] = [0, 1, 2].map(|c| irradiance[c] * (texel.albedo[c] * INV_PI * share(c)));
        }
    }
    Ok(())
}

fn glossy<B: Backend>(
    backend: &B,
    scene: &CompiledScene,
    lit: &Lit<B>,
    gbuffer: &[GBufferTexel],
    eye: Vec3,
    indirect: &mut [[f32; 3]],
) -> Result<()> {
    let shines = |m: &MaterialRecord| m.kind != MATERIAL_DIELECTRIC && m.specular_f90 > 0.0;
    let pixels: Vec<usize> = pixels(scene, gbuffer, shines).collect();
    for pixels in pixels.chunks(CONES_AT_ONCE) {
        let mut cones = Vec::with_capacity(pixels.len());
        let mut reflectances = Vec::with_capacity(pixels.len());
        for &pixel in pixels {
            let texel = &gbuffer[pixel];
            let material = &scene.materials[texel.material as usize];
            let (cone, cosine) = reflected(texel, material, eye, lit.voxel);
            cones.push(cone);
            reflectances.push(schlick(material, cosine));
        }
        let light = traced(backend, lit, &cones, 0)?;
        for ((&pixel, light), reflectance) in pixels.iter().zip(&light).zip(&reflectances) {
            for c in 0..3 {
                indirect[pixel][c] += light.rgb[c] * reflectance[c];
            }
        }
    }
    Ok(())
}

fn traced<B: Backend>(backend: &B, lit: &Lit<B>, cones: &[Cone], flags: u32) -> Result<Vec<ConeLight>> {
    let mut light = backend.zeroed::<ConeLight>(cones.len())?;
    let call = TraceConesBlock { flags, ..lit.call };
    backend.trace_cones(&lit.levels, &lit.values, &backend.upload(cones)?, &call, &mut light)?;
    backend.download(&light)
}

/// The cone of a surface's reflection, and the cosine between its normal and the way to the eye.
///
/// Half of a GGX lobe's microfacets are within atan α of the normal, and turn reflections by twice that. A disc with the same median has a radius √2 times as
/// large: half the aperture.
fn reflected(texel: &GBufferTexel, material: &MaterialRecord, eye: Vec3, voxel: f32) -> (Cone, f32) {
    let (position, normal) = (Vec3::from(texel.position), Vec3::from(texel.shading_normal));
    let view = normalized(eye - position);
    let cosine = normal.dot(view);
    let direction = normalized(normal * (2.0 * cosine) - view);
    let alpha = if material.kind == MATERIAL_OPAQUE { material.alpha } else { 0.0 };
    // Along a surface the way out of its own voxels is longer.
    let start = voxel / normal.dot(direction).max(0.25);
    let origin = (position + normal * voxel).to_array();
    (
        Cone {
            origin,
            sine: lobe_sine(alpha),
            direction: direction.to_array(),
            start,
            normal: normal.to_array(),
            padding: 0,
        },
        cosine,
    )
}

/// sin(2√2·atan α) for half-angles up to 90°, then 1: α is at most 1, so that atan α = α·(1 − α²/3 + …) is taken by Padé's α/(1 + 0.28α²), to
/// half a percent of a right angle.
fn lobe_sine(alpha: f32) -> f32 {
    let half = 2.0 * std::f32::consts::SQRT_2 * alpha / (1.0 + 0.28 * alpha * alpha);
    if half >= std::f32::consts::FRAC_PI_2 {
        return 1.0;
    }
    let turns = half / std::f32::consts::TAU;
    twinlight_core::math::trig::sin_cos_turns(turns).0
}

/// What a surface reflects without scattering: by Schlick, but mirrors the same at every angle, as [`twinlight_core::transport::bsdf`] has them.
fn schlick(material: &MaterialRecord, cosine: f32) -> [f32; 3] {
    if material.kind != MATERIAL_OPAQUE {
        return material.specular_f0;
    }
    let c = (1.0 - cosine).clamp(0.0, 1.0);
    let fifth = (c * c) * (c * c) * c;
    material.specular_f0.map(|f0| f0 + (material.specular_f90 - f0) * fifth)
}
