//! Bugs in `shade_primary`.

use super::FaultyScene;
use crate::faults::Fault;
use bytemuck::Zeroable;
use glam::Vec3;
use twinlight_core::kernels::shade_primary::{GBufferTexel, ShadePrimaryParams};
use twinlight_core::kernels::trace::NO_HIT;
use twinlight_core::{Backend, Result};

pub(super) fn shade_primary<B: Backend>(
    inner: &B,
    fault: Fault,
    scene: &FaultyScene<B::Scene>,
    params: &ShadePrimaryParams,
    gbuffer: &mut B::Buffer<GBufferTexel>,
) -> Result<()> {
    let mut params = *params;
    let camera = &mut params.camera;
    if fault == Fault::ShadeCornerOfPixel {
        // Through the pixel's corner: half a step back in both directions.
        for axis in 0..3 {
            camera.corner[axis] -= 0.5 * (camera.step_x[axis] + camera.step_y[axis]);
        }
    }
    if fault == Fault::ShadeUpsideDown {
        for axis in 0..3 {
            camera.corner[axis] += camera.step_y[axis] * params.height as f32;
            camera.step_y[axis] = -camera.step_y[axis];
        }
    }
    if fault == Fault::ShadeAcceptsLengths && inner.len(gbuffer) != (params.width * params.height) as usize {
        return Ok(());
    }
    inner.shade_primary(&scene.inner, &params, gbuffer)?;
    let mut texels = inner.download(gbuffer)?;
    for texel in &mut texels {
        *texel = broken(fault, scene, &params, *texel);
    }
    *gbuffer = inner.upload(&texels)?;
    Ok(())
}

fn broken<S>(
    fault: Fault,
    scene: &FaultyScene<S>,
    params: &ShadePrimaryParams,
    texel: GBufferTexel,
) -> GBufferTexel {
    let negated = |n: [f32; 3]| n.map(|x| -x);
    let triangle = scene.host.triangles.iter().find(|t| t.id == texel.triangle);
    let Some(triangle) = triangle else {
        let far = GBufferTexel { depth: f32::INFINITY, ..texel };
        return if fault == Fault::ShadeNothingIsFar { far } else { texel };
    };
    let [p0, p1, p2] = [triangle.p0, triangle.p1, triangle.p2].map(Vec3::from);
    let winding = (p1 - p0).cross(p2 - p0);
    match fault {
        Fault::ShadeNormalFollowsWinding if winding.dot(Vec3::from(texel.geometric_normal)) < 0.0 => {
            GBufferTexel { geometric_normal: negated(texel.geometric_normal), ..texel }
        }
        Fault::ShadeNormalAway => GBufferTexel { shading_normal: negated(texel.shading_normal), ..texel },
        Fault::ShadeFlat => GBufferTexel { shading_normal: texel.geometric_normal, ..texel },
        Fault::ShadeLongNormals => {
            GBufferTexel { shading_normal: texel.shading_normal.map(|x| x * 1.01), ..texel }
        }
        Fault::ShadeWrongMaterial => GBufferTexel { material: texel.material + 1, ..texel },
        Fault::ShadeDistanceForDepth => {
            let along = Vec3::from(texel.position) - Vec3::from(params.camera.position);
            GBufferTexel { depth: along.dot(along).sqrt(), ..texel }
        }
        Fault::ShadeUntextured => {
            let albedo = scene.host.materials[texel.material as usize].albedo;
            GBufferTexel { albedo, ..texel }
        }
        Fault::ShadeGamma => GBufferTexel { albedo: texel.albedo.map(f32::sqrt), ..texel },
        Fault::ShadeMissesTriangles if texel.triangle % 7 == 6 => {
            GBufferTexel { triangle: NO_HIT, ..GBufferTexel::zeroed() }
        }
        _ => texel,
    }
}
