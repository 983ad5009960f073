//! Lights as their tables describe them.

use super::document::{LightTable, LightType};
use super::source::Source;
use toml::Spanned;
use twinlight_core::Result;
use twinlight_core::scene::{Light, Scene};

/// Half-angle of a spot's edge without `outer_angle`, degrees.
const OUTER_ANGLE: f32 = 45.0;

/// The light of a table.
pub(super) fn light(table: &Spanned<LightTable>, source: &Source<'_>) -> Result<Light> {
    let (span, t) = (table.span(), table.get_ref());
    let (label, keys) = keys_of(t.kind);
    if let Some(extra) = present(t).into_iter().find(|key| !keys.contains(key)) {
        let what = format!("a {label} light has no '{extra}'; its keys are {}", keys.join(", "));
        return Err(source.error(&span, what));
    }
    let missing = |key: &str| source.error(&span, format!("a {label} light needs '{key}'"));
    let vector = |value: Option<[f32; 3]>, key: &str| value.ok_or_else(|| missing(key));
    let color = |value: Option<super::value::OneOrThree>, key: &str| {
        value.map(super::value::OneOrThree::narrow).ok_or_else(|| missing(key))
    };
    let light = match t.kind {
        LightType::Point => Light::Point {
            position: vector(t.position, "position")?,
            intensity: color(t.intensity, "intensity")?,
        },
        LightType::Spot => Light::Spot {
            position: vector(t.position, "position")?,
            direction: vector(t.direction, "direction")?,
            intensity: color(t.intensity, "intensity")?,
            inner_angle: t.inner_angle.unwrap_or(0.0).to_radians(),
            outer_angle: t.outer_angle.unwrap_or(OUTER_ANGLE).to_radians(),
        },
        LightType::Directional => Light::Directional {
            direction: vector(t.direction, "direction")?,
            irradiance: color(t.irradiance, "irradiance")?,
        },
        LightType::Rectangle => Light::Rectangle {
            corner: vector(t.corner, "corner")?,
            edge_u: vector(t.edge_u, "edge_u")?,
            edge_v: vector(t.edge_v, "edge_v")?,
            radiance: color(t.radiance, "radiance")?,
        },
        LightType::Sphere => Light::Sphere {
            center: vector(t.center, "center")?,
            radius: t.radius.ok_or_else(|| missing("radius"))?,
            radiance: color(t.radiance, "radiance")?,
        },
    };
    source.check(&span, Scene { lights: vec![light], ..Scene::default() })?;
    Ok(light)
}

/// The name of a kind and its keys.
fn keys_of(kind: LightType) -> (&'static str, &'static [&'static str]) {
    match kind {
        LightType::Point => ("point", &["position", "intensity"]),
        LightType::Spot => ("spot", &["position", "direction", "intensity", "inner_angle", "outer_angle"]),
        LightType::Directional => ("directional", &["direction", "irradiance"]),
        LightType::Rectangle => ("rectangle", &["corner", "edge_u", "edge_v", "radiance"]),
        LightType::Sphere => ("sphere", &["center", "radius", "radiance"]),
    }
}

/// The keys a table has, beside its type.
fn present(t: &LightTable) -> Vec<&'static str> {
    let keys = [
        ("position", t.position.is_some()),
        ("direction", t.direction.is_some()),
        ("intensity", t.intensity.is_some()),
        ("irradiance", t.irradiance.is_some()),
        ("radiance", t.radiance.is_some()),
        ("inner_angle", t.inner_angle.is_some()),
        ("outer_angle", t.outer_angle.is_some()),
        ("corner", t.corner.is_some()),
        ("edge_u", t.edge_u.is_some()),
        ("edge_v", t.edge_v.is_some()),
        ("center", t.center.is_some()),
        ("radius", t.radius.is_some()),
    ];
    keys.into_iter().filter(|(_, is_there)| *is_there).map(|(key, _)| key).collect()
}
