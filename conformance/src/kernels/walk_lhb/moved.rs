//! Hard cases of scene intake that leave a walk as it is: the lattice, the lookups and the rays move with the scene.

use super::laws::{LINE, SIZE};
use super::{Prepared, walked};
use crate::compare::exact;
use crate::kernels::strict_only;
use crate::kernels::trace_paths::params;
use crate::scenes::compiled;
use crate::trial::{Check, Context, Failure, Listing, list_trials};
use glam::DVec3;
use twinlight_core::Backend;
use twinlight_core::kernels::trace_paths::FilmTexel;
use twinlight_core::scene::{Scene, Transform};
use twinlight_fixtures::{meshes, scenes};

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "walk_lhb": g11_shifted_exactly, g12_scaled_by_powers_of_two);
}

/// The Cornell box on multiples of 1/16 millimetre, which shifts by 2²⁰ keep.
fn boxed() -> Scene {
    let mut scene = scenes::cornell();
    scene.meshes = scene.meshes.into_iter().map(|mesh| meshes::snapped(mesh, 1.0 / 16.0)).collect();
    scene
}

/// A scene with its camera somewhere else.
fn moved(mut scene: Scene, factor: f64, shift: DVec3) -> Scene {
    let transform = Transform::scale_translate(factor, shift);
    for instance in &mut scene.instances {
        instance.transform = transform.then_inner(&instance.transform);
    }
    if let Some(camera) = &mut scene.camera {
        let at = |p: [f64; 3]| (DVec3::from(p) * factor + shift).to_array();
        (camera.position, camera.target) = (at(camera.position), at(camera.target));
    }
    scene
}

fn film<B: Backend>(cx: &Context<'_, B>, scene: &Scene) -> Result<Vec<FilmTexel>, Failure> {
    let compiled = compiled(scene);
    let call = params(scene, &compiled, SIZE, 6, None)?;
    walked(cx.backend, &Prepared::new(cx.backend, &compiled, "icosahedron:80", 24)?, &call)
}

/// 2²⁰ from the origin by an exact shift: the same bits, in every mode, because nothing on the device changes.
fn g11_shifted_exactly<B: Backend>(cx: &Context<'_, B>) -> Check {
    let far = DVec3::new(1_048_576.0, -2_097_152.0, 4_194_304.0);
    exact(cx, "film", &film(cx, &moved(boxed(), 1.0, far))?, &film(cx, &boxed())?, LINE)
}

/// Scaled by 2ᵏ: radiance has no length in it.
fn g12_scaled_by_powers_of_two<B: Backend>(cx: &Context<'_, B>) -> Check {
    strict_only(cx)?;
    let want = film(cx, &boxed())?;
    for factor in [1_024.0, 1.0 / 1_024.0] {
        let scaled = film(cx, &moved(boxed(), factor, DVec3::ZERO))?;
        exact(cx, "film", &scaled, &want, LINE).map_err(|f| f.within(&format!("scale {factor}")))?;
    }
    Ok(())
}
