//! The camera, and the light from infinitely far away.

use super::document::{CameraTable, EnvironmentTable};
use super::source::Source;
use super::value::OneOrThree;
use crate::io::image;
use glam::DMat3;
use toml::Spanned;
use twinlight_core::scene::{Camera, Environment, Limits, Scene};
use twinlight_core::{Error, Result};

/// The camera of a table.
pub(super) fn camera(table: &Spanned<CameraTable>, source: &Source<'_>) -> Result<Camera> {
    let CameraTable { position, target, up, vfov } = *table.get_ref();
    let camera = Camera { position, target, up, vfov_degrees: vfov };
    match camera.record(1, 1, [0.0; 3]) {
        Ok(_) => Ok(camera),
        Err(Error::InvalidInput { what, .. }) => Err(source.error(&table.span(), what)),
        Err(other) => Err(other),
    }
}

/// The environment of a table, whose file `read` gives.
pub(super) fn environment(
    table: &Spanned<EnvironmentTable>,
    source: &Source<'_>,
    limits: &Limits,
    read: impl Fn(&Spanned<String>) -> Result<Vec<u8>>,
) -> Result<Environment> {
    let t = table.get_ref();
    let mut environment = match (&t.file, t.radiance) {
        (Some(file), None) => {
            let bytes = read(file)?;
            image::read_exr_environment(&bytes, file.get_ref(), limits)?
        }
        (None, Some(radiance)) => Environment::constant(radiance.narrow()),
        _ => {
            return Err(source.error(&table.span(), "an environment needs either 'file' or 'radiance'"));
        }
    };
    environment.scale = t.scale.unwrap_or(1.0);
    environment.rotation = DMat3::from_rotation_y(t.rotation.unwrap_or(0.0).to_radians());
    // A picture's texels are left to the compiler: a copy of them, only to check them here, may be large.
    let without_picture = Environment {
        scale: environment.scale,
        rotation: environment.rotation,
        ..Environment::constant(t.radiance.map_or([0.0; 3], OneOrThree::narrow))
    };
    source.check(&table.span(), Scene { environment: Some(without_picture), ..Scene::default() })?;
    Ok(environment)
}
