//! The picture with its indirect light averaged over neighbours, by the kernel `filter_indirect`.

use crate::reference::Film;
use twinlight_core::kernels::filter_indirect::{FilterIndirectParams, RadianceTexel};
use twinlight_core::kernels::shade_primary::GBufferTexel;
use twinlight_core::scene::{Camera, CompiledScene, MATERIAL_OPAQUE, MaterialRecord};
use twinlight_core::{Backend, Result};

/// Normals up to 26° apart are joined: a curved surface turns by less over a window, unless it is two windows across or less, and corners turn
/// by more. Irradiance changes by a tenth where normals turn by as much under light along one of them.
const LEAST_COSINE: f32 = 0.9;

/// A film's picture, filtered.
#[derive(Debug, Clone, PartialEq)]
pub struct Filtered {
    /// Mean radiance per pixel: that of [`Film::direct`] and [`Filtered::indirect`].
    pub radiance: Vec<[f32; 3]>,
    /// [`Film::indirect`], averaged where surfaces are diffuse.
    pub indirect: Vec<[f32; 3]>,
}

/// Averages a film's indirect light over windows of `window` × `window` pixels, 1 to
/// [`twinlight_core::kernels::filter_indirect::MAX_WINDOW`]: with as many as [`super::LookupSettings::interleave`], or a multiple, the noise of
/// interleaved patterns cancels. `gbuffer` is that of [`crate::gbuffer`] for the same camera and size. The film stays as it is, so
/// that others can be added to it.
///
/// # Errors
/// [`twinlight_core::Error::InvalidInput`] for a window out of range and for a G-buffer of another size; what the camera and the backend
/// refuse.
pub fn filter<B: Backend>(
    backend: &B,
    scene: &CompiledScene,
    camera: &Camera,
    gbuffer: &B::Buffer<GBufferTexel>,
    film: &Film,
    window: u32,
) -> Result<Filtered> {
    let params = FilterIndirectParams {
        width: film.width(),
        height: film.height(),
        window,
        least_cosine: LEAST_COSINE,
        footprint: footprint(scene, camera, film)?,
        padding: [0; 3],
    };
    let diffuse: Vec<u32> = scene.materials.iter().map(|material| u32::from(is_diffuse(material))).collect();
    let diffuse = backend.upload(&diffuse)?;
    let input: Vec<RadianceTexel> =
        film.indirect().into_iter().map(|rgb| RadianceTexel { rgb, padding: 0 }).collect();
    let mut output = backend.zeroed::<RadianceTexel>(input.len())?;
    let input = backend.upload(&input)?;
    backend.filter_indirect(gbuffer, &diffuse, &input, &params, &mut output)?;
    let indirect: Vec<[f32; 3]> = backend.download(&output)?.iter().map(|texel| texel.rgb).collect();
    let add = |(direct, indirect): ([f32; 3], &[f32; 3])| [0, 1, 2].map(|c| direct[c] + indirect[c]);
    let radiance = film.direct().into_iter().zip(&indirect).map(add).collect();
    Ok(Filtered { radiance, indirect })
}

/// Without its lobe, whose reflectance at grazing incidence is 0 for no other, an opaque material scatters alike to all sides.
fn is_diffuse(material: &MaterialRecord) -> bool {
    material.kind == MATERIAL_OPAQUE && material.specular_f90 == 0.0
}

/// Width of a pixel at depth 1.
fn footprint(scene: &CompiledScene, camera: &Camera, film: &Film) -> Result<f32> {
    let [x, y, z] = camera.record(film.width(), film.height(), scene.origin)?.step_x;
    Ok((x * x + y * y + z * z).sqrt())
}
