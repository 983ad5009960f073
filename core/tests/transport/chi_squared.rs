//! Pearson's χ² test of direction samplers against their densities.

use glam::{DVec3, Vec3};
use std::f64::consts::{PI, TAU};

/// Rows (cos θ) and columns (φ) of the histogram over the sphere.
const ROWS: usize = 24;
const COLUMNS: usize = 48;

/// Points per cell and axis at which the density is integrated.
const QUADRATURE: usize = 24;

fn cell_of(d: Vec3) -> usize {
    let row = ((f64::from(d.z) + 1.0) * 0.5 * ROWS as f64) as usize;
    let phi = f64::from(d.y).atan2(f64::from(d.x));
    let column = ((phi + PI) / TAU * COLUMNS as f64) as usize;
    row.min(ROWS - 1) * COLUMNS + column.min(COLUMNS - 1)
}

/// Expected share of samples per cell: the density integrated by midpoints, uniform in (cos θ, φ).
fn expected_shares(pdf: &dyn Fn(Vec3) -> f64) -> Vec<f64> {
    let solid_angle = 2.0 / ROWS as f64 * TAU / COLUMNS as f64;
    let mut shares = vec![0.0; ROWS * COLUMNS];
    for (cell, share) in shares.iter_mut().enumerate() {
        let (row, column) = (cell / COLUMNS, cell % COLUMNS);
        for i in 0..QUADRATURE * QUADRATURE {
            let at = |k: usize| (k as f64 + 0.5) / QUADRATURE as f64;
            let z = (row as f64 + at(i / QUADRATURE)) / ROWS as f64 * 2.0 - 1.0;
            let phi = (column as f64 + at(i % QUADRATURE)) / COLUMNS as f64 * TAU - PI;
            let r = (1.0 - z * z).sqrt();
            let direction = DVec3::new(r * phi.cos(), r * phi.sin(), z).as_vec3();
            *share += pdf(direction) * solid_angle / (QUADRATURE * QUADRATURE) as f64;
        }
    }
    shares
}

/// Upper tail of χ² with many degrees of freedom (Wilson & Hilferty 1931), as a standard normal deviate.
fn deviate(statistic: f64, freedom: f64) -> f64 {
    let scale = 2.0 / (9.0 * freedom);
    ((statistic / freedom).cbrt() - (1.0 - scale)) / scale.sqrt()
}

/// Draws `count` samples and holds them against `pdf`. `sample` may return the zero vector for "nothing". Cells that
/// expect fewer than 10 samples are pooled. Panics beyond 4.5 standard deviations (one in 300 000 by chance, and the
/// draws are fixed).
pub fn check(name: &str, count: u32, sample: &dyn Fn(u32) -> Vec3, pdf: &dyn Fn(Vec3) -> f64) {
    let mut seen = vec![0_u32; ROWS * COLUMNS];
    let mut nothing = 0_u32;
    for i in 0..count {
        let d = sample(i);
        if d == Vec3::ZERO {
            nothing += 1;
        } else {
            seen[cell_of(d)] += 1;
        }
    }
    let shares = expected_shares(pdf);
    let total: f64 = shares.iter().sum();
    let (mut statistic, mut cells) = (0.0, 0.0);
    let mut add = |observed: f64, expected: f64| {
        statistic += (observed - expected) * (observed - expected) / expected;
        cells += 1.0;
    };
    let (mut pooled_seen, mut pooled_expected) =
        (f64::from(nothing), (1.0 - total).max(0.0) * f64::from(count));
    for (&n, &share) in seen.iter().zip(&shares) {
        let expected = share * f64::from(count);
        if expected < 10.0 {
            pooled_seen += f64::from(n);
            pooled_expected += expected;
        } else {
            add(f64::from(n), expected);
        }
    }
    if pooled_expected >= 10.0 {
        add(pooled_seen, pooled_expected);
    } else {
        assert!(pooled_seen <= 40.0, "{name}: {pooled_seen} samples where {pooled_expected} are expected");
    }
    let z = deviate(statistic, cells - 1.0);
    assert!(z < 4.5, "{name}: chi squared {statistic:.1} over {cells} cells, {z:.1} standard deviations");
    assert!(total < 1.01, "{name}: density integrates to {total}");
}
