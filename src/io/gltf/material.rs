//! Metallic-rough materials to the scene's surface model.

use super::Document;
use super::texture::{Mean, TextureUse, Textures};
use ::gltf::json;
use ::gltf::json::extensions::material::Specular;
use ::gltf::json::material::AlphaMode;
use ::gltf::json::texture::Info;
use ::gltf::json::validation::Checked;
use twinlight_core::Result;
use twinlight_core::scene::{Material, MaterialKind};

/// Index of refraction where the file gives none: reflectance 0.04.
const DEFAULT_IOR: f32 = 1.5;

/// A material, and the texture its primitives need coordinates for.
pub(super) struct ReadMaterial {
    pub material: Material,
    pub texture: Option<TextureUse>,
}

/// Reads materials; `index` is for names and messages.
pub(super) fn read(
    document: &Document,
    textures: &mut Textures,
    material: &json::Material,
    index: Option<usize>,
) -> Result<ReadMaterial> {
    let path = index.map_or_else(|| "default material".into(), |i| format!("materials[{i}]"));
    let name = material.name.clone().unwrap_or_else(|| path.clone());
    note_alpha(document, material, &path)?;
    let pbr = &material.pbr_metallic_roughness;
    let mut mean = |info: &Option<Info>, part: &str| -> Result<Option<Mean>> {
        match info {
            Some(info) => textures.mean(document, info, &format!("{path}.{part}")),
            None => Ok(None),
        }
    };
    let surface = mean(&pbr.metallic_roughness_texture, "metallicRoughnessTexture")?;
    if surface.is_some() {
        document.note("materials with the mean of their metallic and roughness texture", &name);
    }
    // Roughness is stored in green, metalness in blue.
    let metallic = pbr.metallic_factor.0 * surface.map_or(1.0, |m| m.stored[2]);
    let roughness = pbr.roughness_factor.0 * surface.map_or(1.0, |m| m.stored[1]);
    let glow = mean(&material.emissive_texture, "emissiveTexture")?;
    if glow.is_some() {
        document.note("materials with the mean of their emission texture", &name);
    }
    // Metals have the colour of their base texture in the reflectance, which has no texture of its own.
    let tint = if metallic > 0.0 { mean(&pbr.base_color_texture, "baseColorTexture")? } else { None };
    let texture = match &pbr.base_color_texture {
        Some(info) => textures.albedo(document, info, &format!("{path}.baseColorTexture"))?,
        None => None,
    };

    let extensions = material.extensions.as_ref();
    let ior = extensions.and_then(|e| e.ior.as_ref()).map_or(DEFAULT_IOR, |i| i.ior.0);
    let [r, g, b, _] = pbr.base_color_factor.0;
    let base = [r, g, b];
    let metal = tint.map_or(base, |m| product(base, m.linear));
    let dielectric = dielectric_f0(ior, extensions.and_then(|e| e.specular.as_ref()));
    let strength =
        extensions.and_then(|e| e.emissive_strength.as_ref()).map_or(1.0, |e| e.emissive_strength.0);
    let emission = material.emissive_factor.0.map(|e| e * strength);
    let transmission =
        extensions.and_then(|e| e.transmission.as_ref()).map_or(0.0, |t| t.transmission_factor.0);
    let kind = if transmission >= 0.5 {
        document.note("transmitting materials read as smooth clear dielectrics", &name);
        MaterialKind::Dielectric { ior }
    } else if metallic >= 1.0 && roughness == 0.0 {
        MaterialKind::Mirror
    } else {
        MaterialKind::Opaque
    };
    let material = Material {
        name,
        albedo: base.map(|c| c * (1.0 - metallic)),
        albedo_texture: texture.as_ref().map(|t| t.texture),
        specular_f0: [0, 1, 2].map(|c| dielectric[c] * (1.0 - metallic) + metal[c] * metallic),
        roughness,
        kind,
        emission: glow.map_or(emission, |m| product(emission, m.linear)),
        emits_both_sides: material.double_sided,
    };
    Ok(ReadMaterial { material, texture })
}

fn product(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [a[0] * b[0], a[1] * b[1], a[2] * b[2]]
}

/// Reflectance at normal incidence of a non-metal: Fresnel's, tinted and weakened by KHR_materials_specular.
fn dielectric_f0(ior: f32, specular: Option<&Specular>) -> [f32; 3] {
    // An index of 0 stands for infinity in the extension, where everything is reflected: the formula gives 1.
    let root = (ior - 1.0) / (ior + 1.0);
    let (color, factor) =
        specular.map_or(([1.0; 3], 1.0), |s| (s.specular_color_factor.0, s.specular_factor.0));
    color.map(|c| (root * root * c).min(1.0) * factor)
}

fn note_alpha(document: &Document, material: &json::Material, path: &str) -> Result<()> {
    match material.alpha_mode {
        Checked::Valid(AlphaMode::Opaque) => {}
        Checked::Valid(_) => document.note("materials shown opaque, though they have alpha", path),
        Checked::Invalid => return Err(document.invalid(path, "has no valid alpha mode")),
    }
    if material.normal_texture.is_some() {
        document.note("normal maps ignored", path);
    }
    if material.extensions.as_ref().is_some_and(|e| e.unlit.is_some()) {
        document.note("unlit materials lit like the others", path);
    }
    Ok(())
}
