//! The pinhole camera.

use super::{COORDINATE_LIMIT, Scene};
use crate::error::{Error, Result};
use crate::kernels::trace_paths::CameraRecord;
use glam::DVec3;

/// A pinhole camera.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    /// Eye, world units.
    pub position: [f64; 3],
    /// A point on the view axis.
    pub target: [f64; 3],
    /// Roughly upwards; need not be perpendicular to the axis.
    pub up: [f64; 3],
    /// Full vertical field of view, degrees, in (0, 180).
    pub vfov_degrees: f64,
}

impl Camera {
    /// A camera that sees the whole of `bounds` from a little above, on their +Z side.
    pub fn framing(bounds: (DVec3, DVec3)) -> Self {
        Self::framing_from(bounds, DVec3::Z)
    }

    /// A camera that sees the whole of `bounds` from the side that `side`, a unit vector, points to; a little aslant,
    /// so that depth shows.
    pub fn framing_from(bounds: (DVec3, DVec3), side: DVec3) -> Self {
        let center = (bounds.0 + bounds.1) * 0.5;
        let radius = ((bounds.1 - bounds.0).length() * 0.5).max(1e-6);
        let vfov_degrees: f64 = 40.0;
        let distance = radius / (vfov_degrees.to_radians() * 0.5).sin() * 1.05;
        let eye = center + aslant(side).normalize() * distance;
        // Scenes about as large as they may be leave no room to step back.
        let eye = eye.clamp(DVec3::splat(-COORDINATE_LIMIT), DVec3::splat(COORDINATE_LIMIT));
        Self { position: eye.to_array(), target: center.to_array(), up: [0.0, 1.0, 0.0], vfov_degrees }
    }

    /// The camera of a scene, or one that frames it.
    pub fn of_scene(scene: &Scene) -> Option<Self> {
        scene.camera.or_else(|| scene.bounds().map(Self::framing))
    }

    /// The record kernels take, for an image of `width` by `height` square pixels, relative to `origin`
    /// ([`super::CompiledScene::origin`]).
    ///
    /// # Errors
    /// [`Error::InvalidInput`] when the eye is the target, `up` is parallel to the axis, the field of view is outside
    /// (0, 180), a coordinate is beyond [`COORDINATE_LIMIT`] or a number is not finite.
    pub fn record(&self, width: u32, height: u32, origin: [f64; 3]) -> Result<CameraRecord> {
        let invalid = |what: String| Err(Error::invalid("camera", what));
        if width == 0 || height == 0 {
            return invalid(format!("image size {width}x{height} has no pixels"));
        }
        let mut points = self.position.iter().chain(&self.target);
        if let Some(bad) = points.find(|x| !(x.abs() <= COORDINATE_LIMIT)) {
            return invalid(format!("coordinate {bad:?} of position or target is not a number within ±2^40"));
        }
        if let Some(bad) = self.up.iter().chain([&self.vfov_degrees]).find(|x| !x.is_finite()) {
            return invalid(format!("{bad} is not a finite number"));
        }
        if !(self.vfov_degrees > 0.0 && self.vfov_degrees < 180.0) {
            return invalid(format!(
                "vertical field of view {} is not within 0 and 180 degrees",
                self.vfov_degrees
            ));
        }
        let position = DVec3::from(self.position);
        let axis = DVec3::from(self.target) - position;
        if axis.length() == 0.0 {
            return invalid(format!("position and target are the same point {:?}", self.position));
        }
        let forward = axis.normalize();
        let right = forward.cross(DVec3::from(self.up));
        if right.length() < 1e-9 * DVec3::from(self.up).length() || right.length() == 0.0 {
            return invalid(format!("up {:?} is parallel to the view axis", self.up));
        }
        let right = right.normalize();
        let down = forward.cross(right);
        let half_height = (self.vfov_degrees.to_radians() * 0.5).tan();
        let half_width = half_height * f64::from(width) / f64::from(height);
        let narrow = |v: DVec3| v.as_vec3().to_array();
        Ok(CameraRecord {
            position: narrow(position - DVec3::from(origin)),
            padding_a: 0.0,
            corner: narrow(forward - right * half_width - down * half_height),
            padding_b: 0.0,
            step_x: narrow(right * (2.0 * half_width / f64::from(width))),
            padding_c: 0.0,
            step_y: narrow(down * (2.0 * half_height / f64::from(height))),
            padding_d: 0.0,
            forward: narrow(forward),
            padding_e: 0.0,
        })
    }
}

/// `side`, and something to the right and upwards of it.
fn aslant(side: DVec3) -> DVec3 {
    // Near the vertical, right and upwards turn with every rounding: from there fixed directions count. Half-way up,
    // where one looks over the wall of an open box, and at what stands on a floor rather than down on it.
    if side.y.abs() > 0.9 {
        return DVec3::new(0.35, side.y.signum(), 1.0);
    }
    let right = DVec3::Y.cross(side).normalize();
    side + right * 0.35 + side.cross(right) * 0.3
}
