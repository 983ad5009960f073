//! Rays that leave a triangle don't meet it again, however it lies, however large it is.

use glam::Vec3;
use twinlight_core::math::hash::{mix_pair, to_unit};
use twinlight_core::math::vector::{basis, normalized, to_world};
use twinlight_core::scene::Triangle;
use twinlight_core::transport::bsdf::cosine_hemisphere;
use twinlight_core::transport::intersect::{ray_frame, triangle};
use twinlight_core::transport::offset::offset_origin;

fn number(i: u32, k: u32) -> f32 {
    to_unit(mix_pair(i, k))
}

fn vector(i: u32, k: u32) -> Vec3 {
    Vec3::new(number(i, k), number(i, k + 1), number(i, k + 2)) * 2.0 - 1.0
}

/// Triangles in general position, in a coordinate plane through the origin, far from it, and needles of 10³ : 1 to 10⁶ : 1.
fn corners(i: u32, scale: f32) -> [Vec3; 3] {
    let mut p = [vector(i, 0), vector(i, 3), vector(i, 6)];
    match i % 4 {
        1 => p.iter_mut().for_each(|p| p.y = 0.0),
        2 => p.iter_mut().for_each(|p| *p += Vec3::new(37.0, -11.0, 53.0)),
        3 => p[2] = p[0] + (p[1] - p[0]) * 0.5 + vector(i, 9) * [1e-3, 1e-4, 1e-5, 1e-6][i as usize / 4 % 4],
        _ => {}
    }
    p.map(|p| p * scale)
}

/// T6: 10⁵ triangles at every scale, a quarter of them needles of 10³ : 1 to 10⁶ : 1, directions down to the horizon.
#[test]
fn t6_no_triangle_meets_its_own_rays() {
    for scale in [1e-3, 1.0, 1e3, 1e6] {
        let mut met = 0;
        for i in 0..100_000 {
            let [p0, p1, p2] = corners(i, scale);
            let record = Triangle::new([p0, p1, p2].map(|p| p.to_array()), 0, 0);
            let (x, y) = (number(i, 20), number(i, 21));
            let (u, v) = if x + y > 1.0 { (1.0 - x, 1.0 - y) } else { (x, y) };
            let (a, b, c) = (p0 * ((1.0 - u) - v), p1 * u, p2 * v);
            let position = (a + b) + c;
            let normal = Vec3::from(record.normal);
            let mut local = cosine_hemisphere(number(i, 22), number(i, 23));
            if i.is_multiple_of(3) {
                // Grazing: a thousandth of the height.
                local = normalized(Vec3::new(local.x, local.y, local.z * 1e-3));
            }
            let (t, s) = basis(normal);
            let direction = to_world(t, s, normal, local);
            for side in [direction, -direction] {
                let origin = offset_origin(position, record.offset, normal, side);
                let again = triangle(&ray_frame(origin, side), &record, 0.0, 1e30).is_some();
                met += u32::from(again);
            }
        }
        assert_eq!(met, 0, "scale {scale}: {met} of 200000 rays meet the triangle they leave");
    }
}

/// The offset is as small as the bound: it never reaches a millionth part of the coordinates and extents more.
#[test]
fn offsets_are_small() {
    for i in 0..10_000 {
        let [p0, p1, p2] = corners(i, 1.0);
        let record = Triangle::new([p0, p1, p2].map(|p| p.to_array()), 0, 0);
        let (a, b, c) = (p0 * 0.2, p1 * 0.3, p2 * 0.5);
        let position = (a + b) + c;
        let normal = Vec3::from(record.normal);
        let moved = offset_origin(position, record.offset, normal, normal);
        let size = p0.length() + p1.length() + p2.length();
        assert!((moved - position).length() < 1e-5 * size, "{} for size {size}", (moved - position).length());
    }
}
