//! Materials and textures.

/// How a surface scatters.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum MaterialKind {
    /// Diffuse base under an optional GGX lobe.
    #[default]
    Opaque,
    /// Perfect mirror; reflectance is [`Material::specular_f0`].
    Mirror,
    /// Smooth clear dielectric; both faces refract.
    Dielectric {
        /// Index of refraction of the inside (the side the normals point away from) over the outside, > 1/4, < 4.
        ior: f32,
    },
}

/// A surface description. Colours are linear RGB.
#[derive(Debug, Clone, PartialEq)]
pub struct Material {
    /// For messages.
    pub name: String,
    /// Diffuse albedo, each in [0, 1].
    pub albedo: [f32; 3],
    /// Multiplies the albedo; index into [`super::Scene::textures`].
    pub albedo_texture: Option<u32>,
    /// Specular reflectance at normal incidence, each in [0, 1]. 0 0 0 leaves the lobe out: exactly Lambertian.
    pub specular_f0: [f32; 3],
    /// Perceptual roughness in [0, 1]; GGX α is its square, at least 2⁻¹⁰.
    pub roughness: f32,
    /// Kind of scattering.
    pub kind: MaterialKind,
    /// Exitant radiance, W·sr⁻¹·m⁻².
    pub emission: [f32; 3],
    /// Whether the back face emits too.
    pub emits_both_sides: bool,
}

impl Default for Material {
    fn default() -> Self {
        Self::diffuse("default", [0.5; 3])
    }
}

impl Material {
    /// A Lambertian material.
    pub fn diffuse(name: impl Into<String>, albedo: [f32; 3]) -> Self {
        Self {
            name: name.into(),
            albedo,
            albedo_texture: None,
            specular_f0: [0.0; 3],
            roughness: 1.0,
            kind: MaterialKind::Opaque,
            emission: [0.0; 3],
            emits_both_sides: false,
        }
    }

    /// A black emitter whose front face emits `radiance`.
    pub fn emitter(name: impl Into<String>, radiance: [f32; 3]) -> Self {
        Self { emission: radiance, ..Self::diffuse(name, [0.0; 3]) }
    }
}

/// What happens outside the unit square.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Wrap {
    /// The picture repeats.
    #[default]
    Repeat,
    /// The border texel continues.
    Clamp,
}

/// An 8-bit sRGB picture, row-major from the top-left texel; filtered bilinearly after decoding.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Texture {
    /// For messages.
    pub name: String,
    /// Texels per row, 1 to 16384.
    pub width: u32,
    /// Rows, 1 to 16384.
    pub height: u32,
    /// R, G, B, A in sRGB, `width * height` of them. Alpha is kept, not used.
    pub texels: Vec<[u8; 4]>,
    /// Outside behaviour, both axes.
    pub wrap: Wrap,
}
