//! Light from infinitely far away.

use glam::DMat3;

/// A latitude-longitude map. Row 0 touches +Y (the map's up), column 0 starts at direction −Z and columns proceed
/// towards +X as seen from inside: φ = 2π·x/width, direction = (sin θ sin φ, cos θ, −sin θ cos φ).
///
/// Radiance is constant over each texel, so that the light sampler's pdf follows it exactly.
#[derive(Debug, Clone, PartialEq)]
pub struct Environment {
    /// Texels per row, 1 to 16384.
    pub width: u32,
    /// Rows, 1 to 8192.
    pub height: u32,
    /// Radiance, W·sr⁻¹·m⁻², row-major from the top.
    pub texels: Vec<[f32; 3]>,
    /// Multiplies every texel.
    pub scale: f32,
    /// Map to world rotation.
    pub rotation: DMat3,
}

impl Environment {
    /// The same radiance from everywhere.
    pub fn constant(radiance: [f32; 3]) -> Self {
        Self { width: 1, height: 1, texels: vec![radiance], scale: 1.0, rotation: DMat3::IDENTITY }
    }

    /// Whether any texel gives light.
    pub fn is_bright(&self) -> bool {
        self.scale > 0.0 && self.texels.iter().flatten().any(|&x| x > 0.0)
    }
}
