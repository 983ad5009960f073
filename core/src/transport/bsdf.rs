//! Scattering at a surface, in the frame of the shading normal (z up). Twin: `backend-gpu/src/shared/bsdf.wgsl`.
//!
//! Opaque materials: f = ρ/π·(1 − F(n·o))(1 − F(n·i)) + F(o·h)·D·G / (4 (n·o)(n·i)), with the GGX D, Schlick F (grazing
//! reflectance f90) and Smith-Schlick G of Karis 2013. The two Fresnel factors of the diffuse part keep the sum
//! reciprocal and below 1 (Ashikhmin & Shirley 2000); with f0 = 0 the whole is exactly ρ/π. Sampling of D: visible
//! normals by spherical caps (Dupuy & Benyoub 2023), whose pdf uses the exact Smith G₁.

use super::INV_PI;
use crate::math::trig::sin_cos_turns;
use crate::math::vector::{concentric_disc, normalized};
use crate::scene::MaterialRecord;
use glam::Vec3;

/// A value f·|n·i| and the solid-angle pdf of sampling it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BsdfValue {
    /// f·|n·i|, RGB.
    pub f_cos: Vec3,
    /// Probability density over solid angle, sr⁻¹.
    pub pdf: f32,
}

/// A sampled direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BsdfSample {
    /// Unit direction away from the surface; 0 0 0 when nothing is scattered.
    pub direction: Vec3,
    /// f·|n·i| / pdf.
    pub weight: Vec3,
    /// Density over solid angle; 0 for mirror-like directions.
    pub pdf: f32,
}

const NOTHING: BsdfSample = BsdfSample { direction: Vec3::ZERO, weight: Vec3::ZERO, pdf: 0.0 };

/// Schlick's reflectance at cosine `c`.
#[inline(always)]
fn schlick(material: &MaterialRecord, c: f32) -> Vec3 {
    let f0 = Vec3::from(material.specular_f0);
    let clamped = if c < 1.0 { c } else { 1.0 };
    let m = 1.0 - clamped;
    let m2 = m * m;
    f0 + (Vec3::splat(material.specular_f90) - f0) * (m2 * m2 * m)
}

#[inline(always)]
fn average(c: Vec3) -> f32 {
    ((c.x + c.y) + c.z) * 0.333_333_34
}

/// Probability of sampling the specular lobe for a viewer at cosine `c`.
#[inline(always)]
fn specular_probability(material: &MaterialRecord, albedo: Vec3, c: f32) -> f32 {
    if material.specular_f90 == 0.0 {
        return 0.0;
    }
    let f = average(schlick(material, c));
    let d = average(albedo) * (1.0 - f);
    let sum = f + d;
    if sum > 0.0 { f / sum } else { 1.0 }
}

/// GGX distribution of half vectors, from the squared slope so that no digits cancel near the normal.
#[inline(always)]
fn distribution(alpha: f32, h: Vec3) -> f32 {
    let alpha_squared = alpha * alpha;
    let d = (h.x * h.x + h.y * h.y) + alpha_squared * (h.z * h.z);
    alpha_squared * INV_PI / (d * d)
}

/// Value and pdf of an opaque material for unit directions in the shading frame; zeros below the horizon.
#[inline(always)]
pub fn evaluate(material: &MaterialRecord, albedo: Vec3, wo: Vec3, wi: Vec3) -> BsdfValue {
    if !(wo.z > 0.0 && wi.z > 0.0) {
        return BsdfValue { f_cos: Vec3::ZERO, pdf: 0.0 };
    }
    let cosine_pdf = wi.z * INV_PI;
    if material.specular_f90 == 0.0 {
        return BsdfValue { f_cos: albedo * cosine_pdf, pdf: cosine_pdf };
    }
    let kept = (Vec3::ONE - schlick(material, wo.z)) * (Vec3::ONE - schlick(material, wi.z));
    let h = normalized(wo + wi);
    let d = distribution(material.alpha, h);
    let k = material.smith_k;
    // G / ((n·o)(n·i)): each factor n·v/((n·v)(1−k)+k) without its n·v, finite at grazing angles.
    let visibility = 1.0 / ((wo.z * (1.0 - k) + k) * (wi.z * (1.0 - k) + k));
    let specular = schlick(material, wo.dot(h)) * (d * visibility * 0.25);
    let alpha_squared = material.alpha * material.alpha;
    let root = (alpha_squared + (1.0 - alpha_squared) * (wo.z * wo.z)).sqrt();
    let specular_pdf = d / (2.0 * (wo.z + root));
    let p = specular_probability(material, albedo, wo.z);
    BsdfValue {
        f_cos: albedo * kept * cosine_pdf + specular * wi.z,
        pdf: (1.0 - p) * cosine_pdf + p * specular_pdf,
    }
}

/// A direction for an opaque material: `lobe` picks the lobe, (u, v) the direction.
#[inline(always)]
pub fn sample_opaque(
    material: &MaterialRecord,
    albedo: Vec3,
    wo: Vec3,
    lobe: f32,
    u: f32,
    v: f32,
) -> BsdfSample {
    if material.specular_f90 == 0.0 {
        let diffuse = cosine_hemisphere(u, v);
        let above = wo.z > 0.0 && diffuse.z > 0.0;
        // f·cos/pdf is ρ: no rounding, no division.
        let sample = BsdfSample { direction: diffuse, weight: albedo, pdf: diffuse.z * INV_PI };
        return if above { sample } else { NOTHING };
    }
    let specular = lobe < specular_probability(material, albedo, wo.z);
    let wi = if specular { reflect_visible(material.alpha, wo, u, v) } else { cosine_hemisphere(u, v) };
    let value = evaluate(material, albedo, wo, wi);
    if !(value.pdf > 0.0) {
        return NOTHING;
    }
    let inverse = 1.0 / value.pdf;
    BsdfSample { direction: wi, weight: value.f_cos * inverse, pdf: value.pdf }
}

/// Cosine-weighted direction (Malley).
#[inline(always)]
pub fn cosine_hemisphere(u: f32, v: f32) -> Vec3 {
    let (x, y) = concentric_disc(u, v);
    let squared = 1.0 - (x * x + y * y);
    Vec3::new(x, y, if squared > 0.0 { squared.sqrt() } else { 0.0 })
}

/// The mirror image of `wo` about a visible GGX normal.
#[inline(always)]
fn reflect_visible(alpha: f32, wo: Vec3, u: f32, v: f32) -> Vec3 {
    let stretched = normalized(Vec3::new(wo.x * alpha, wo.y * alpha, wo.z));
    let (s, c) = sin_cos_turns(u);
    let z = (1.0 - v) * (1.0 + stretched.z) - stretched.z;
    let squared = 1.0 - z * z;
    let r = if squared > 0.0 { squared.sqrt() } else { 0.0 };
    let cap = Vec3::new(r * c, r * s, z) + stretched;
    let h = normalized(Vec3::new(cap.x * alpha, cap.y * alpha, cap.z));
    h * (2.0 * wo.dot(h)) - wo
}

/// The perfect mirror.
#[inline(always)]
pub fn sample_mirror(material: &MaterialRecord, wo: Vec3) -> BsdfSample {
    BsdfSample {
        direction: Vec3::new(-wo.x, -wo.y, wo.z),
        weight: Vec3::from(material.specular_f0),
        pdf: 0.0,
    }
}

/// A smooth dielectric seen from the front (outside) or back: reflects when `choice` is below the Fresnel reflectance,
/// else refracts (direction.z < 0). Radiance that enters a medium is scaled by the squared ratio of indices.
#[inline(always)]
pub fn sample_dielectric(material: &MaterialRecord, front: bool, wo: Vec3, choice: f32) -> BsdfSample {
    // Index on the viewer's side over the index on the other side.
    let eta = if front { 1.0 / material.ior } else { material.ior };
    let sine_squared = eta * eta * (1.0 - wo.z * wo.z);
    let mut reflectance = 1.0;
    let mut cosine = 0.0;
    if sine_squared < 1.0 {
        cosine = (1.0 - sine_squared).sqrt();
        let s = (eta * wo.z - cosine) / (eta * wo.z + cosine);
        let p = (wo.z - eta * cosine) / (wo.z + eta * cosine);
        reflectance = (s * s + p * p) * 0.5;
    }
    if choice < reflectance {
        return BsdfSample { direction: Vec3::new(-wo.x, -wo.y, wo.z), weight: Vec3::ONE, pdf: 0.0 };
    }
    let direction = normalized(Vec3::new(-(wo.x * eta), -(wo.y * eta), -cosine));
    BsdfSample { direction, weight: Vec3::splat(eta * eta), pdf: 0.0 }
}
