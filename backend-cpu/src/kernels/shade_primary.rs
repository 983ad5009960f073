// kernel family: shade_primary
// contract core/src/kernels/shade_primary.rs
// cpu backend-cpu/src/kernels/shade_primary.rs
// gpu backend-gpu/src/kernels/shade_primary.wgsl
// oracle conformance/src/oracle/shade_primary.rs
//! `shade_primary`: one ray per pixel centre, shaded by the functions that paths use.

use crate::bvh8::NO_SLOT;
use crate::parallel::{RAYS, fill_chunks};
use crate::scene::SceneData;
use crate::simd::{Isa, Kernel, Width};
use bytemuck::Zeroable;
use glam::Vec3;
use twinlight_core::kernels::shade_primary::{GBufferTexel, ShadePrimaryParams};
use twinlight_core::kernels::trace::NO_HIT;
use twinlight_core::scene::NONE;
use twinlight_core::transport::SceneView;
use twinlight_core::transport::light::{FAR, nearest_sphere};
use twinlight_core::transport::surface::{camera_direction, surface_at};

/// What the camera sees through every pixel centre. `gbuffer` has `width * height` texels.
pub(crate) fn shade_primary(
    isa: Isa,
    scene: &SceneData,
    params: &ShadePrimaryParams,
    gbuffer: &mut [GBufferTexel],
) {
    fill_chunks(isa, RAYS, gbuffer, |first, texels| Primary { scene, params, first, texels });
}

struct Primary<'a> {
    scene: &'a SceneData,
    params: &'a ShadePrimaryParams,
    first: usize,
    texels: &'a mut [GBufferTexel],
}

impl Kernel for Primary<'_> {
    type Output = ();

    #[inline(always)]
    fn run<W: Width>(self, width: W) {
        let view = self.scene.view();
        for (i, texel) in self.texels.iter_mut().enumerate() {
            let pixel = (self.first + i) as u32;
            let (column, row) = (pixel % self.params.width, pixel / self.params.width);
            *texel = shade_pixel(width, self.scene, &view, self.params, column, row);
        }
    }
}

#[inline(always)]
fn shade_pixel<W: Width>(
    width: W,
    scene: &SceneData,
    view: &SceneView<'_>,
    params: &ShadePrimaryParams,
    column: u32,
    row: u32,
) -> GBufferTexel {
    // [1] ray through the pixel's centre
    let origin = Vec3::from(params.camera.position);
    let direction = camera_direction(&params.camera, column as f32 + 0.5, row as f32 + 0.5);
    // [2] what it meets first; a sphere light is no surface, and hides what is behind it
    let hit = scene.bvh.closest(width, origin, direction, 0.0, FAR);
    if hit.slot == NO_SLOT || nearest_sphere(view, origin, direction, hit.t).light != NONE {
        return GBufferTexel { triangle: NO_HIT, ..GBufferTexel::zeroed() };
    }
    // [3] the surface
    let surface = surface_at(view, hit.slot, hit.u, hit.v, direction);
    GBufferTexel {
        position: surface.position.to_array(),
        depth: (surface.position - origin).dot(Vec3::from(params.camera.forward)),
        geometric_normal: surface.geometric_normal.to_array(),
        triangle: scene.triangles[hit.slot as usize].id,
        shading_normal: surface.shading_normal.to_array(),
        material: surface.material,
        albedo: surface.albedo.to_array(),
        padding: 0,
    }
}
