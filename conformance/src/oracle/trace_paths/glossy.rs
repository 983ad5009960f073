//! Directional albedo of opaque materials by the midpoint rule, in f64.

use std::f64::consts::PI;

/// ∫ f(o, i) (n·i) di for a viewer at cosine `co`, with f = ρ/π (1 − F(n·o))(1 − F(n·i)) + F(o·h) D G / (4 (n·o)(n·i)).
///
/// The specular part is integrated over half vectors, where it is smooth: di = 4 (o·h) dh. θ_h is spaced by the
/// distribution's own quantiles, tan²θ = α²ξ/(1 − ξ), so that D·cos θ_h is constant.
pub(super) fn albedo(roughness: f64, f0: f64, diffuse: f64, co: f64) -> f64 {
    let (alpha, k) = (roughness * roughness, (roughness + 1.0).powi(2) / 8.0);
    let f90 = (50.0 * f0).min(1.0);
    let fresnel = |c: f64| f0 + (f90 - f0) * (1.0 - c).powi(5);
    let so = (1.0 - co * co).sqrt();
    let g1 = |c: f64| c / (c * (1.0 - k) + k);
    let (rings, spokes) = (600, 600);
    let mut specular = 0.0;
    for ring in 0..rings {
        let xi = (f64::from(ring) + 0.5) / f64::from(rings);
        let tan2 = alpha * alpha * xi / (1.0 - xi);
        let ch = 1.0 / (1.0 + tan2).sqrt();
        let sh = (1.0 - ch * ch).sqrt();
        for spoke in 0..spokes {
            let phi = (f64::from(spoke) + 0.5) / f64::from(spokes) * 2.0 * PI;
            let oh = so * sh * phi.cos() + co * ch;
            let ci = 2.0 * oh * ch - co;
            if oh > 0.0 && ci > 0.0 {
                // D dh = dξ dφ/(2π) / cos θ_h; the (n·i) of the integral cancels that of the BRDF.
                specular += fresnel(oh) * g1(co) * g1(ci) * oh / (co * ch);
            }
        }
    }
    specular /= f64::from(rings * spokes);
    let mut kept = 0.0;
    for ring in 0..rings {
        // cos² spaced evenly: the cosine-weighted hemisphere.
        let ci = ((f64::from(ring) + 0.5) / f64::from(rings)).sqrt();
        kept += (1.0 - fresnel(ci)) / f64::from(rings);
    }
    let lambert = if f90 == 0.0 { diffuse } else { diffuse * (1.0 - fresnel(co)) * kept };
    lambert + specular
}

#[cfg(test)]
mod tests {
    use super::albedo;

    #[test]
    fn without_specular_it_is_lambert() {
        assert!((albedo(0.5, 0.0, 0.7, 0.5) - 0.7).abs() < 1e-9);
    }

    #[test]
    fn a_smooth_conductor_reflects_by_its_fresnel_and_shadowing() {
        // α → 0: h = n, so F(co)·G₁(co)² / co·co … with n·o = n·i = co.
        let (co, k) = (0.8_f64, 1.0 / 8.0);
        let g1 = co / (co * (1.0 - k) + k);
        let fresnel = 0.9 + 0.1 * (1.0 - co).powi(5);
        let got = albedo(1e-4, 0.9, 0.0, co);
        assert!((got - fresnel * g1 * g1).abs() < 1e-3, "{got}");
    }
}
