//! Perspective cameras.

use super::Document;
use ::gltf::json::{self, Index};
use glam::DVec3;
use twinlight_core::Result;
use twinlight_core::scene::{COORDINATE_LIMIT, Camera, Transform};

impl Document<'_> {
    /// The camera as its node places it, looking along −Z with +Y up; `None` for an orthographic one.
    pub fn camera(&self, index: Index<json::Camera>, node: &Transform, path: &str) -> Result<Option<Camera>> {
        let camera = self.get(&self.root.cameras, index, "camera", path)?;
        let path = format!("cameras[{}]", index.value());
        let Some(perspective) = &camera.perspective else {
            self.note("cameras that are not perspective ignored", path);
            return Ok(None);
        };
        let vfov_degrees = f64::from(perspective.yfov).to_degrees();
        let forward = (node.linear * DVec3::NEG_Z).normalize_or_zero();
        let up = (node.linear * DVec3::Y).normalize_or_zero();
        if !(vfov_degrees > 0.0 && vfov_degrees < 180.0) {
            let what = format!("yfov {} is not within 0 and π", perspective.yfov);
            return Err(self.invalid(&path, what));
        }
        if forward == DVec3::ZERO || up == DVec3::ZERO {
            self.note("cameras whose nodes have no extent ignored", path);
            return Ok(None);
        }
        let position = node.translation;
        if let Some(bad) = position.to_array().into_iter().find(|x| !(x.abs() <= COORDINATE_LIMIT)) {
            let what =
                format!("its node places it at coordinate {bad:?}, which is not a number within ±2^40");
            return Err(self.invalid(&path, what));
        }
        Ok(Some(Camera {
            position: position.to_array(),
            target: (position + forward).to_array(),
            up: up.to_array(),
            vfov_degrees,
        }))
    }
}
