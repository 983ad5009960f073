//! KHR_lights_punctual.

use super::Document;
use ::gltf::json::Index;
use ::gltf::json::extensions::scene::khr_lights_punctual::{Light as JsonLight, Type};
use ::gltf::json::validation::Checked;
use glam::DVec3;
use std::f32::consts::{FRAC_PI_2, FRAC_PI_4};
use twinlight_core::Result;
use twinlight_core::scene::{Light, Transform};

impl Document<'_> {
    /// A light as its node places it: at the node's origin, shining along its −Z axis. Candela and lux stand for W/sr and
    /// W/m².
    pub fn light(&self, index: Index<JsonLight>, node: &Transform, path: &str) -> Result<Light> {
        let lights = self.root.extensions.as_ref().and_then(|e| e.khr_lights_punctual.as_ref());
        let lights = lights.map_or(&[][..], |l| &l.lights);
        let light = self.get(lights, index, "light", path)?;
        let path = format!("extensions.KHR_lights_punctual.lights[{}]", index.value());
        let power = light.color.map(|c| c * light.intensity);
        let position = node.translation.as_vec3().to_array();
        let axis = (node.linear * DVec3::NEG_Z).normalize_or_zero();
        let direction = axis.as_vec3().to_array();
        if light.range.is_some() {
            self.note("lights without the range that ends them", &path);
        }
        match light.type_ {
            Checked::Valid(Type::Point) => Ok(Light::Point { position, intensity: power }),
            Checked::Valid(Type::Directional) => Ok(Light::Directional { direction, irradiance: power }),
            Checked::Valid(Type::Spot) => {
                let (inner_angle, outer_angle) = light
                    .spot
                    .as_ref()
                    .map_or((0.0, FRAC_PI_4), |s| (s.inner_cone_angle, s.outer_cone_angle));
                if !(inner_angle >= 0.0 && inner_angle < outer_angle && outer_angle <= FRAC_PI_2) {
                    let what = format!(
                        "cone angles {inner_angle}, {outer_angle} don't satisfy 0 ≤ inner < outer ≤ π/2"
                    );
                    return Err(self.invalid(&path, what));
                }
                Ok(Light::Spot { position, direction, intensity: power, inner_angle, outer_angle })
            }
            Checked::Invalid => Err(self.invalid(&path, "has no valid type")),
        }
    }
}
