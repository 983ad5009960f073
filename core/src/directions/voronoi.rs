//! Voronoi cells on the sphere: each octant is cut by the planes half-way to the other directions. Their corners give
//! the covering radius, their triangles the solid angles.

use super::OnLine;
use crate::circle::{angle_between, solid_angle};
use glam::DVec3;

/// What cosines may be off by after a few operations.
const SLACK: f64 = 1e-12;

/// Solid angle per direction, and the covering radius.
///
/// A cell's farthest point is a corner only where the cell lies within a hemisphere around its direction. It does with
/// two opposite directions in the set, so in every set but that of one.
pub(super) fn measure(directions: &[DVec3], on_lines: &[OnLine], line_count: usize) -> (Vec<f64>, f64) {
    let symmetric = directions.len() == 2 * line_count;
    let mut by_line = vec![0.0; line_count];
    let mut solid_angles = Vec::with_capacity(directions.len());
    let mut radius = if directions.len() == 1 { std::f64::consts::PI } else { 0.0_f64 };
    for (i, on_line) in on_lines.iter().enumerate() {
        let known = &mut by_line[on_line.line as usize];
        // A cell and its mirror image, the opposite's cell, are measured once.
        if !(symmetric && on_line.reversed) {
            let pieces = cell(directions, i);
            *known = pieces.iter().map(|piece| area(piece)).sum();
            let angles = pieces.iter().flatten().map(|&corner| angle_between(directions[i], corner));
            radius = angles.fold(radius, f64::max);
        }
        solid_angles.push(*known);
    }
    (solid_angles, radius)
}

fn area(polygon: &[DVec3]) -> f64 {
    polygon.windows(2).skip(1).map(|side| solid_angle(polygon[0], side[0], side[1])).sum()
}

/// The cell of a direction, as convex polygons within an octant each.
fn cell(directions: &[DVec3], index: usize) -> Vec<Vec<DVec3>> {
    let centre = directions[index];
    let mut others: Vec<(f64, usize)> = directions
        .iter()
        .enumerate()
        .filter(|&(j, _)| j != index)
        .map(|(j, d)| (centre.dot(*d), j))
        .collect();
    others.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    let mut pieces = octants();
    for (cosine, j) in others {
        let farthest = pieces.iter().flatten().map(|corner| corner.dot(centre)).fold(1.0, f64::min);
        // Twice as far away as the farthest corner, a direction takes nothing from the cell.
        if farthest > 0.0 && cosine < 2.0 * farthest * farthest - 1.0 - SLACK {
            break;
        }
        let normal = centre - directions[j];
        pieces.iter_mut().for_each(|piece| *piece = cut(piece, normal));
        pieces.retain(|piece| piece.len() > 2);
    }
    pieces
}

fn octants() -> Vec<Vec<DVec3>> {
    let sign = |octant: u32, bit: u32| if octant >> bit & 1 == 0 { 1.0 } else { -1.0 };
    let corners = |o: u32| vec![DVec3::X * sign(o, 0), DVec3::Y * sign(o, 1), DVec3::Z * sign(o, 2)];
    (0..8).map(corners).collect()
}

/// The part of a convex polygon where the product with `normal` isn't negative. Sutherland & Hodgman 1974.
fn cut(polygon: &[DVec3], normal: DVec3) -> Vec<DVec3> {
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (k, &a) in polygon.iter().enumerate() {
        let b = polygon[(k + 1) % polygon.len()];
        let (side_a, side_b) = (a.dot(normal), b.dot(normal));
        if side_a >= 0.0 {
            kept.push(a);
        }
        if (side_a >= 0.0) != (side_b >= 0.0) {
            kept.push((a * side_b.abs() + b * side_a.abs()).normalize());
        }
    }
    kept
}
