//! Bugs in `trace_paths`: in the parameters, in the film, and in the scene's records, where a wrong formula and a wrong
//! record show alike.

use super::FaultyScene;
use crate::faults::Fault;
use twinlight_core::kernels::trace_paths::{FilmTexel, TracePathsParams, UNLIMITED_BOUNCES};
use twinlight_core::scene::{CompiledScene, LIGHT_SPOT, LIGHT_TRIANGLE, MATERIAL_MIRROR, MATERIAL_OPAQUE};
use twinlight_core::{Backend, Result};

/// The scene that a kernel with the bug would effectively render.
pub(super) fn broken_scene(fault: Fault, scene: &CompiledScene) -> CompiledScene {
    let mut scene = scene.clone();
    if fault == Fault::PathsShadowsAnyway {
        scene.environment.flags = 0;
    }
    for material in &mut scene.materials {
        match fault {
            Fault::PathsAlbedoBias => material.albedo = material.albedo.map(|a| a * 0.97),
            Fault::PathsMirrorWithoutTint if material.kind == MATERIAL_MIRROR => {
                material.specular_f0 = [1.0; 3]
            }
            Fault::PathsFixedIor => material.ior = if material.ior > 1.0 { 1.5 } else { material.ior },
            Fault::PathsWrongLobe if material.kind == MATERIAL_OPAQUE => material.smith_k *= 0.5,
            Fault::PathsNoGrazing if material.kind == MATERIAL_OPAQUE => {
                material.specular_f90 = material.specular_f0[0];
            }
            Fault::PathsEmitterBias => material.emission = material.emission.map(|e| e * 1.03),
            _ => {}
        }
    }
    for triangle in &mut scene.triangles {
        match fault {
            Fault::PathsNoOffset => triangle.offset = 0.0,
            // A few per cent of the triangle's extent.
            Fault::PathsLongOffset => triangle.offset *= 2e4,
            _ => {}
        }
    }
    for light in &mut scene.lights {
        match fault {
            Fault::PathsLightPdf => light.select_pdf *= 0.9,
            Fault::PathsTriangleArea if light.kind == LIGHT_TRIANGLE => light.area *= 1.2,
            Fault::PathsHardSpot if light.kind == LIGHT_SPOT => {
                (light.spot_scale, light.spot_offset) = (1e6, 1.0 - 1e6 * 0.9);
            }
            Fault::PathsSphereRadius => light.radius *= 0.97,
            _ => {}
        }
    }
    scene
}

pub(super) fn trace_paths<B: Backend>(
    inner: &B,
    fault: Fault,
    scene: &FaultyScene<B::Scene>,
    params: &TracePathsParams,
    film: &mut B::Buffer<FilmTexel>,
) -> Result<()> {
    let mut asked = *params;
    match fault {
        Fault::PathsAcceptAnything if params.check(inner.len(film)).is_err() => return Ok(()),
        _ => params.check(inner.len(film))?,
    }
    match fault {
        Fault::PathsLoseBounce if params.max_bounces != UNLIMITED_BOUNCES => {
            asked.max_bounces = params.max_bounces.saturating_sub(1);
        }
        Fault::PathsStopEarly => asked.max_bounces = params.max_bounces.min(3),
        Fault::PathsIgnoreFirstSample => asked.sample_begin = 0,
        Fault::PathsIgnoreSeed => asked.seed = 0,
        Fault::PathsIgnoreSampler => asked.sampler = 1,
        Fault::PathsWholeImage => (asked.pixel_begin, asked.pixel_count) = (0, params.width * params.height),
        _ => {}
    }
    let before = inner.download(film)?;
    inner.trace_paths(&scene.inner, &asked, film)?;
    let mut after = inner.download(film)?;
    for (texel, old) in after.iter_mut().zip(&before) {
        *texel = broken(fault, *texel, old);
    }
    *film = inner.upload(&after)?;
    Ok(())
}

fn broken(fault: Fault, texel: FilmTexel, old: &FilmTexel) -> FilmTexel {
    let wide = |w: [u32; 2]| u64::from(w[1]) << 32 | u64::from(w[0]);
    let words = |x: u64| [x as u32, (x >> 32) as u32];
    let added = |new: [u32; 2], old: [u32; 2]| wide(new).wrapping_sub(wide(old));
    let each = |new: [[u32; 2]; 3], old: [[u32; 2]; 3], f: &dyn Fn([u32; 2], [u32; 2]) -> [u32; 2]| {
        [0, 1, 2].map(|c| f(new[c], old[c]))
    };
    let doubled = |new, old| words(wide(new).wrapping_add(added(new, old)));
    // The low words' sum without its carry.
    let uncarried = |new: [u32; 2], old: [u32; 2]| {
        let sum = words(added(new, old));
        [old[0].wrapping_add(sum[0]), old[1].wrapping_add(sum[1])]
    };
    match fault {
        Fault::PathsDoubleDirect => FilmTexel { direct: each(texel.direct, old.direct, &doubled), ..texel },
        Fault::PathsDropIndirect => FilmTexel { indirect: old.indirect, ..texel },
        Fault::PathsOverwriteFilm => {
            let fresh = |new, old| words(added(new, old));
            FilmTexel {
                direct: each(texel.direct, old.direct, &fresh),
                indirect: each(texel.indirect, old.indirect, &fresh),
                ..texel
            }
        }
        Fault::PathsLoseCarry => FilmTexel {
            direct: each(texel.direct, old.direct, &uncarried),
            indirect: each(texel.indirect, old.indirect, &uncarried),
            ..texel
        },
        Fault::PathsLoseSpread => FilmTexel { luminance_squared: old.luminance_squared, ..texel },
        Fault::PathsCountTwice => FilmTexel { samples: texel.samples + 1, ..texel },
        Fault::PathsSwapChannels => {
            let [r, g, b] = texel.direct;
            FilmTexel { direct: [b, g, r], ..texel }
        }
        Fault::PathsReject => FilmTexel { rejected: texel.rejected + 1, ..texel },
        Fault::PathsBias => {
            let dimmed = |new: [u32; 2], old: [u32; 2]| words(wide(old) + added(new, old) / 50 * 49);
            FilmTexel {
                direct: each(texel.direct, old.direct, &dimmed),
                indirect: each(texel.indirect, old.indirect, &dimmed),
                ..texel
            }
        }
        _ => texel,
    }
}
