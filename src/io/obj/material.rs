//! What the keys of an MTL material mean in terms of [`Material`].
//!
//! MTL describes appearance loosely, so every choice is stated here:
//! - *Diffuse*: `Kd`; without it 1 under `map_Kd`, 0 beside `Ks` or `Ke`, else 0.5. `illum 0` and `1` leave the lobe out.
//! - *Roughness*: `Pr` is perceptual (α = Pr²). Else α = √(2 / (Ns + 2)), the Phong exponent's usual GGX partner. Without
//!   both, reflection is sharp for `illum 3` and `5`, and fully rough otherwise.
//! - *Metals*: with `Pm` m, f0 = mix(d, c, m) and albedo = Kd·(1 − m), where d is `Ks` (0.04 without one) and c is `Kd`, or
//!   `Ks` where `Kd` is black: exporters differ in which of the two carries a metal's colour.
//! - *Mirror*: `illum 3` or `5` with `Ks`, no diffuse part above 0.02 and sharp reflection (`Pr 0`, or no `Pr` and `Ns` absent
//!   or ≥ 1000). Mixtures of matte and mirror stay opaque with a lobe of the least roughness.
//! - *Glass*: `illum 4, 6, 7, 9`, or transparency (`d` < 1; `Tr` > 0 counts only without `d`, as some exporters write
//!   `Tr 1` for opaque) with `Ni` > 1. Index `Ni`, 1.5 without a usable one.
//! - *Energy*: channels where albedo + f0 exceeds 1 are scaled down to 1.
//! - *Emission*: `Ke`, from the front (counter-clockwise) side, as other renderers read it.

use super::mtl::MtlMaterial;
use twinlight_core::scene::{Material, MaterialKind};

/// Diffuse share beside a perfect mirror that is dropped.
const NEGLIGIBLE_DIFFUSE: f32 = 0.02;
/// Phong exponent from which reflection with `illum 3` or `5` is a perfect mirror.
const MIRROR_EXPONENT: f32 = 1000.0;
/// Reflectance at normal incidence of common plastics and glass, for physically based keys without `Ks`.
const PLASTIC_F0: f32 = 0.04;
/// Index of refraction of glass.
const GLASS_IOR: f32 = 1.5;

/// A material, and what had to be adjusted.
#[derive(Debug, Default)]
pub(super) struct Adjustments {
    /// Materials scaled down because they reflected more than they receive.
    pub scaled: usize,
    /// Transparent materials without a usable index of refraction.
    pub opaque_instead: Vec<String>,
}

/// The material an MTL block describes, without its texture.
pub(super) fn convert(mtl: &MtlMaterial, adjustments: &mut Adjustments) -> Material {
    let albedo = base_color(mtl);
    let mut material =
        Material { emission: mtl.ke.unwrap_or_default(), ..Material::diffuse(&mtl.name, albedo) };
    if let Some(ior) = glass(mtl, adjustments) {
        material.kind = MaterialKind::Dielectric { ior };
        material.albedo = [0.0; 3];
        material.roughness = 0.0;
        return material;
    }
    material.specular_f0 = specular(mtl, albedo);
    material.roughness = roughness(mtl);
    let metal = mtl.pm.unwrap_or(0.0);
    material.albedo = albedo.map(|a| a * (1.0 - metal));
    if is_mirror(mtl, &material) {
        material.kind = MaterialKind::Mirror;
        material.albedo = [0.0; 3];
        material.specular_f0 = material.specular_f0.map(|f| f.min(1.0));
        return material;
    }
    adjustments.scaled += usize::from(conserve_energy(&mut material));
    material
}

fn is_bright(color: [f32; 3]) -> bool {
    color.iter().any(|&c| c > 0.0)
}

fn base_color(mtl: &MtlMaterial) -> [f32; 3] {
    let instead = if mtl.map_kd.is_some() {
        1.0
    } else if mtl.ks.is_some_and(is_bright) || mtl.ke.is_some_and(is_bright) {
        0.0
    } else {
        0.5
    };
    mtl.kd.unwrap_or([instead; 3])
}

fn specular(mtl: &MtlMaterial, base: [f32; 3]) -> [f32; 3] {
    let physical = mtl.pr.is_some() || mtl.pm.is_some();
    if !physical && mtl.illum.is_some_and(|i| i < 2.0) {
        return [0.0; 3];
    }
    let plain = mtl.ks.unwrap_or(if physical { [PLASTIC_F0; 3] } else { [0.0; 3] });
    let metal = mtl.pm.unwrap_or(0.0);
    let color = if is_bright(base) { base } else { plain };
    std::array::from_fn(|i| plain[i] * (1.0 - metal) + color[i] * metal)
}

fn has_sharp_model(mtl: &MtlMaterial) -> bool {
    matches!(mtl.illum, Some(i) if i == 3.0 || i == 5.0)
}

fn roughness(mtl: &MtlMaterial) -> f32 {
    match (mtl.pr, mtl.ns) {
        (Some(pr), _) => pr,
        (None, Some(ns)) => (2.0 / (ns + 2.0)).sqrt().sqrt().min(1.0),
        (None, None) if has_sharp_model(mtl) => 0.0,
        (None, None) => 1.0,
    }
}

fn is_mirror(mtl: &MtlMaterial, material: &Material) -> bool {
    let sharp = mtl.pr.map_or(mtl.ns.is_none_or(|ns| ns >= MIRROR_EXPONENT), |pr| pr == 0.0);
    let diffuse = material.albedo.iter().any(|&a| a > NEGLIGIBLE_DIFFUSE) || mtl.map_kd.is_some();
    has_sharp_model(mtl) && sharp && !diffuse && is_bright(material.specular_f0)
}

/// The index of refraction when the block describes glass.
fn glass(mtl: &MtlMaterial, adjustments: &mut Adjustments) -> Option<f32> {
    let ior = mtl.ni.filter(|n| (0.25..=4.0).contains(n));
    let refracts = matches!(mtl.illum, Some(i) if i == 4.0 || i == 6.0 || i == 7.0 || i == 9.0);
    if refracts {
        return Some(ior.unwrap_or(GLASS_IOR));
    }
    let opacity = mtl.d.or(mtl.tr.map(|tr| 1.0 - tr)).unwrap_or(1.0);
    if opacity >= 1.0 {
        return None;
    }
    let refracting = ior.filter(|&n| n > 1.0);
    if refracting.is_none() {
        adjustments.opaque_instead.push(mtl.name.clone());
    }
    refracting
}

/// Scales channels that would reflect more than they receive; says whether there were any.
fn conserve_energy(material: &mut Material) -> bool {
    let mut scaled = false;
    for i in 0..3 {
        let (albedo, f0) = (&mut material.albedo[i], &mut material.specular_f0[i]);
        // In f64: the sum of two large f32 may be infinite.
        let sum = f64::from(*albedo) + f64::from(*f0);
        if sum <= 1.0 {
            continue;
        }
        scaled = true;
        *albedo = (f64::from(*albedo) / sum) as f32;
        *f0 = (f64::from(*f0) / sum) as f32;
        // Rounding may leave the sum one step above 1, which would create light.
        while f64::from(*albedo) + f64::from(*f0) > 1.0 {
            let larger = if *albedo > *f0 { &mut *albedo } else { &mut *f0 };
            *larger = larger.next_down();
        }
    }
    scaled
}
