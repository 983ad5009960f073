//! Vectors beyond sums and products. Twin: `backend-gpu/src/shared/vector.wgsl`.

use super::trig::sin_cos_octant;
use glam::Vec3;
use std::f32::consts::FRAC_PI_4;

/// v / |v| for vectors of ordinary length (about 10⁻¹⁵ to 10¹⁵); 0 for 0.
#[inline(always)]
pub fn normalized(v: Vec3) -> Vec3 {
    let squared = v.dot(v);
    if !(squared > 0.0) {
        return Vec3::ZERO;
    }
    v * (1.0 / squared.sqrt())
}

/// Two vectors that complete the unit vector n to a right-handed orthonormal basis. Duff et al., "Building an
/// orthonormal basis, revisited", JCGT 6(1) 2017: no branch on n.z but its sign, accurate at both poles.
#[inline(always)]
pub fn basis(n: Vec3) -> (Vec3, Vec3) {
    let sign = if n.z < 0.0 { -1.0_f32 } else { 1.0 };
    let a = -1.0 / (sign + n.z);
    let b = n.x * n.y * a;
    (Vec3::new(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x), Vec3::new(b, sign + n.y * n.y * a, -n.y))
}

/// `t·v.x + b·v.y + n·v.z`.
#[inline(always)]
pub fn to_world(t: Vec3, b: Vec3, n: Vec3, v: Vec3) -> Vec3 {
    t * v.x + b * v.y + n * v.z
}

/// `a` where the mask is all ones, `b` where it is 0.
#[inline(always)]
fn pick(mask: u32, a: f32, b: f32) -> f32 {
    f32::from_bits((a.to_bits() & mask) | (b.to_bits() & !mask))
}

/// The point of the unit disc for a point of the unit square (Shirley & Chiu 1997), area-preserving.
#[inline(always)]
pub fn concentric_disc(u: f32, v: f32) -> (f32, f32) {
    let x = 2.0 * u - 1.0;
    let y = 2.0 * v - 1.0;
    if x == 0.0 && y == 0.0 {
        return (0.0, 0.0);
    }
    // All ones where |x| > |y|, else 0: compilers make a branch of the comparison, mispredicted every other time.
    let horizontal = ((y.abs() - x.abs()).to_bits() as i32 >> 31) as u32;
    let radius = pick(horizontal, x, y);
    let ratio = pick(horizontal, y, x) / radius;
    let (s, c) = sin_cos_octant(ratio * FRAC_PI_4);
    // Around the vertical axis the angle counts from that axis, which exchanges sine and cosine.
    (radius * pick(horizontal, c, s), radius * pick(horizontal, s, c))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bases_are_orthonormal_at_the_poles_too() {
        let just_above = f32::from_bits((-1.0_f32).to_bits() - 1);
        let mut normals = vec![Vec3::Z, -Vec3::Z, Vec3::X, Vec3::Y];
        normals.push(normalized(Vec3::new(1e-4, 0.0, just_above)));
        normals.extend((0..1000).map(|i| {
            let [a, b, c] = [17, 31, 53].map(|k| ((i * k) % 101) as f32 - 50.0);
            normalized(Vec3::new(a, b, c + 0.5))
        }));
        for n in normals {
            let (t, b) = basis(n);
            for dot in [t.dot(b), t.dot(n), b.dot(n)] {
                assert!(dot.abs() < 1e-6, "{n}: {dot}");
            }
            for v in [t, b] {
                assert!((v.dot(v) - 1.0).abs() < 1e-6, "{n}");
            }
            assert!(t.cross(b).dot(n) > 0.999);
        }
    }

    #[test]
    fn ordinary_lengths_normalize() {
        for scale in [1e-15_f32, 1e-3, 1.0, 1e3, 1e15] {
            let v = normalized(Vec3::new(3.0, -4.0, 12.0) * scale);
            assert!((v.dot(v) - 1.0).abs() < 1e-6, "{scale}");
        }
        assert_eq!(normalized(Vec3::ZERO), Vec3::ZERO);
    }
}
