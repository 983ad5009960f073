//! Lights that are not emissive meshes or environments.

/// A light. Colours are linear RGB.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Light {
    /// A point that radiates evenly.
    Point {
        /// World position.
        position: [f32; 3],
        /// Radiant intensity, W·sr⁻¹.
        intensity: [f32; 3],
    },
    /// A point with a cone; the falloff is that of glTF's KHR_lights_punctual.
    Spot {
        /// World position.
        position: [f32; 3],
        /// Axis, any length but 0.
        direction: [f32; 3],
        /// Radiant intensity on the axis, W·sr⁻¹.
        intensity: [f32; 3],
        /// Half-angle of full intensity, radians.
        inner_angle: f32,
        /// Half-angle of the cone's edge, radians, > inner, ≤ π/2.
        outer_angle: f32,
    },
    /// Parallel light from infinitely far away.
    Directional {
        /// Direction the light travels, any length but 0.
        direction: [f32; 3],
        /// Irradiance on a plane facing the light, W·m⁻².
        irradiance: [f32; 3],
    },
    /// A parallelogram whose front face (along `edge_u × edge_v`) emits. It is visible and blocks light.
    Rectangle {
        /// A corner, world units.
        corner: [f32; 3],
        /// From the corner along one side.
        edge_u: [f32; 3],
        /// From the corner along the other side.
        edge_v: [f32; 3],
        /// Exitant radiance, W·sr⁻¹·m⁻².
        radiance: [f32; 3],
    },
    /// An exact sphere that emits outwards. It is visible and blocks light.
    Sphere {
        /// Centre, world units.
        center: [f32; 3],
        /// Radius, world units, > 0.
        radius: f32,
        /// Exitant radiance, W·sr⁻¹·m⁻².
        radiance: [f32; 3],
    },
}
