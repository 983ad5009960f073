//! Materials as their tables describe them.

use super::document::{KindName, MaterialTable};
use super::source::Source;
use super::value::OneOrThree;
use toml::Spanned;
use twinlight_core::Result;
use twinlight_core::scene::{Material, MaterialKind, Scene};

/// Index of refraction without `ior`: glass.
const GLASS_IOR: f32 = 1.5;

/// The material of a table, without its texture.
pub(super) fn material(table: &Spanned<MaterialTable>, source: &Source<'_>) -> Result<Material> {
    let (span, t) = (table.span(), table.get_ref());
    if t.ior.is_some() && t.kind != KindName::Dielectric {
        return Err(source.error(&span, "ior is for kind = \"dielectric\""));
    }
    let color = |value: Option<OneOrThree>, default: f32| value.map_or([default; 3], OneOrThree::narrow);
    let is_mirror = t.kind == KindName::Mirror;
    let material = Material {
        albedo_texture: None,
        specular_f0: color(t.specular, if is_mirror { 1.0 } else { 0.0 }),
        roughness: t.roughness.unwrap_or(if t.kind == KindName::Opaque { 1.0 } else { 0.0 }),
        kind: match t.kind {
            KindName::Opaque => MaterialKind::Opaque,
            KindName::Mirror => MaterialKind::Mirror,
            KindName::Dielectric => MaterialKind::Dielectric { ior: t.ior.unwrap_or(GLASS_IOR) },
        },
        emission: color(t.emission, 0.0),
        emits_both_sides: t.emits_both_sides,
        ..Material::diffuse(
            t.name.get_ref(),
            color(t.albedo, if t.kind == KindName::Opaque { 0.5 } else { 0.0 }),
        )
    };
    source.check(&span, Scene { materials: vec![material.clone()], ..Scene::default() })?;
    Ok(material)
}
