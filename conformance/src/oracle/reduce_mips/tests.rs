use super::*;
use std::f64::consts::PI;
use twinlight_core::kernels::reduce_mips as contract;
use twinlight_core::math::morton::morton_voxel;
use twinlight_fixtures::random::Random;

fn light(rgb: [u32; 3], opacity: u32) -> VoxelLight {
    VoxelLight { rgb, opacity }
}

#[test]
fn constants_are_the_contracts() {
    let signed = |x: u32| i128::from(x);
    assert_eq!([signed(contract::NEAR_LESS_FAR), signed(contract::TWO_THIRDS)], [NEAR_LESS_FAR, TWO_THIRDS]);
}

#[test]
fn one_voxel_rises_through_its_octants() {
    let found = levels(4, &BTreeSet::from([0b101_011]));
    assert_eq!(found.starts, [0, 1, 2, 3]);
    assert_eq!(found.active, [0b101_011, 0b101, 0]);
    assert_eq!(found.mask, [0, 1 << 11, 1 << 5, 1]);
    assert_eq!(found.ranks, [0, 0, 1, 2, 3]);
    assert_eq!(levels(1, &BTreeSet::new()).ranks, [0, 0]);
}

#[test]
fn columns_let_through_what_is_not_covered() {
    // Two children along x: the upper one covers three quarters of the lower one.
    let leaves = BTreeMap::from([(0, light([400, 0, 0], OPAQUE)), (1, light([100, 0, 0], 3 * OPAQUE / 4))]);
    let values = reduce(2, &leaves, ANISOTROPIC);
    let face = |face: usize| &values[48 + 4 * face..][..4];
    assert_eq!(face(0), [(100 + 100 + 2) / 4, 0, 0, OPAQUE / 4]);
    assert_eq!(face(1), [(400 + 2) / 4, 0, 0, OPAQUE / 4]);
    // Neither is before the other in these.
    for other in 2..6 {
        assert_eq!(face(other), [(500 + 2) / 4, 0, 0, (7 * OPAQUE / 4 + 2) / 4]);
    }
}

#[test]
fn bytes_have_the_least_exponent() {
    let with = |a: [i128; 4]| {
        let mut value = vec![0; 13];
        value[0] = 77;
        value[5..9].copy_from_slice(&a);
        packed(&value)
    };
    assert_eq!(with([255, 127, -127, 0]), [77, 0, 0x0081_7fff, 0]);
    assert_eq!(with([-9, 1, 0, 0]), [77, 0, 0x0000_0100, 0]);
    // 256 and 128 need half the digits.
    assert_eq!(with([256, 0, 0, -3]), [77 | 1 << 24, 0, 0xfe00_0080, 0]);
    assert_eq!(with([0, 0, -128, 0]), [77 | 1 << 24, 0, 0x00c0_0000, 0]);
    // 511 would round to 256, and 255 to 128.
    assert_eq!(with([511, 0, 0, 0]), [77 | 2 << 24, 0, 0x0000_0080, 0]);
    assert_eq!(with([0, 255, 0, 0]), [77 | 2 << 24, 0, 0x0000_4000, 0]);
}

/// The solid angle of a rectangle that begins at the foot of the perpendicular of length `d`.
fn corner(a: f64, b: f64, d: f64) -> f64 {
    (a * b / (d * (a * a + b * b + d * d).sqrt())).atan()
}

/// The solid angle of a unit cube's face, seen from the centre of one of its eighths, at the distance `d`.
fn face(d: f64) -> f64 {
    [(0.25, 0.25), (0.25, 0.75), (0.75, 0.25), (0.75, 0.75)].iter().map(|&(a, b)| corner(a, b, d)).sum()
}

/// The mean of f over the sphere, times `weight`: a lattice whose heights are equal in area.
fn mean(f: impl Fn([f64; 3]) -> f64) -> f64 {
    const STEPS: i32 = 400;
    let mut total = 0.0;
    for i in 0..STEPS {
        let z = (2.0 * f64::from(i) + 1.0) / f64::from(STEPS) - 1.0;
        let r = (1.0 - z * z).sqrt();
        for j in 0..STEPS {
            let phi = 2.0 * PI * (f64::from(j) + 0.5) / f64::from(STEPS);
            total += f([r * phi.cos(), r * phi.sin(), z]);
        }
    }
    total / f64::from(STEPS * STEPS)
}

/// A cosine lobe around +z in the basis (1, ωx, ωy, ωz): least squares, whose normal equations are diagonal.
fn lobe() -> [f64; 4] {
    let cosine = |w: [f64; 3]| w[2].max(0.0);
    // The mean of ωᵢ² is a third.
    [
        mean(cosine),
        3.0 * mean(|w| w[0] * cosine(w)),
        3.0 * mean(|w| w[1] * cosine(w)),
        3.0 * mean(|w| w[2] * cosine(w)),
    ]
}

#[test]
fn the_matrix_is_that_of_six_faces() {
    let (near, far) = (face(0.25), face(0.75));
    // The contract has four digits.
    assert!((near - 3.1140).abs() < 1e-4 && (far - 1.0748).abs() < 1e-4, "{near} {far}");
    assert!((3.0 * (near + far) - 4.0 * PI).abs() < 1e-12, "all around");
    let [constant, x, y, linear] = lobe();
    // The midpoint rule over 400 steps misses a function of this curvature by less.
    assert!((constant - 0.25).abs() < 1e-4 && (linear - 0.5).abs() < 1e-4 && x.abs() + y.abs() < 1e-9);
    let parent = |a: [f64; 4], signs: [f64; 3]| six_faces(a, signs, near, far);
    let unit = 16_384.0;
    // Half a unit of rounding, and four digits of the solid angles: 10⁻⁴ / 2π of 2¹⁴, less than half a unit too.
    let close = |got: f64, want: i128| assert!((got * unit - want as f64).abs() < 1.0, "{got} is not {want}");
    for octant in 0..8 {
        let signs = [0, 1, 2].map(|axis| if octant >> axis & 1 == 1 { 1.0 } else { -1.0 });
        let of_constant = parent([1.0, 0.0, 0.0, 0.0], signs);
        close(of_constant[0], 1 << 14);
        for axis in 0..3 {
            close(of_constant[1 + axis] * signs[axis], 2 * NEAR_LESS_FAR);
            let mut a = [0.0; 4];
            a[1 + axis] = 1.0;
            let of_linear = parent(a, signs);
            close(of_linear[0] * signs[axis], NEAR_LESS_FAR);
            for other in 0..3 {
                close(of_linear[1 + other], if other == axis { TWO_THIRDS } else { 0 });
            }
        }
    }
}

/// What a child's function (a₀, a) becomes: each face sees it along its normal, under its solid angle, and emits a cosine lobe / π.
fn six_faces(a: [f64; 4], signs: [f64; 3], near: f64, far: f64) -> [f64; 4] {
    let mut result = [0.0; 4];
    for axis in 0..3 {
        for side in [-1.0, 1.0] {
            let solid_angle = if side == signs[axis] { near } else { far };
            let passes = solid_angle * (a[0] + side * a[1 + axis]) / PI;
            result[0] += passes * 0.25;
            result[1 + axis] += passes * 0.5 * side;
        }
    }
    result
}

/// Harmonics in f64 with a bound of what the integers may differ by, level by level.
#[test]
fn harmonics_stay_close_to_six_faces_in_f64() {
    let mut random = Random::new(5);
    let leaves: BTreeMap<u32, VoxelLight> = (0..400)
        .map(|_| (random.index(4096) as u32, light([(); 3].map(|()| random.index(1 << 22) as u32), OPAQUE)))
        .collect();
    let exact = reduce(16, &leaves, HARMONICS);
    let levels = codes(16, &leaves.keys().copied().collect());
    let (near, far) = (face(0.25), face(0.75));
    let mut below: BTreeMap<u32, [f64; 4]> =
        leaves.iter().map(|(&code, leaf)| (code, [f64::from(leaf.rgb[1]), 0.0, 0.0, 0.0])).collect();
    let (mut at, mut allowed) = (leaves.len(), 0.0);
    // No coefficient is greater than 2²² · (1 + 3κ)ˡ.
    let (growth, mut greatest) = (1.0 + 3.0 * (near - far) / (4.0 * PI), f64::from(contract::MAX_RADIANCE));
    for codes in &levels[1..] {
        let mut level: BTreeMap<u32, [f64; 4]> = BTreeMap::new();
        for (code, a) in &below {
            let signs = morton_voxel(code % 8).map(|upper| 2.0 * f64::from(upper) - 1.0);
            let sums = level.entry(code / 8).or_default();
            six_faces(*a, signs, near, far).iter().zip(sums).for_each(|(part, sum)| *sum += part / 8.0);
        }
        // What the children miss by, grown; a coefficient of the matrix misses by at most 2⁻¹⁴ and three of them meet; each product
        // loses at most 1, and three of them meet; the last division rounds by a half.
        allowed = growth * allowed + 3.0 * greatest / 16_384.0 + 3.0 + 0.5;
        greatest *= growth;
        for (code, a) in &level {
            assert!(codes.contains(code));
            for (k, want) in a.iter().enumerate() {
                let got = f64::from(exact[13 * at + 5 + k].cast_signed());
                assert!((got - want).abs() <= allowed, "{code} [{k}]: {got}, want {want} ± {allowed}");
            }
            at += 1;
        }
        below = level;
    }
    assert_eq!(13 * at, exact.len());
}

#[test]
fn sums_and_ranges_look_at_leaves() {
    let leaves =
        BTreeMap::from([(9, light([1, 2, 3], 9)), (10, light([4, 0, 0], 9)), (63, light([9, 9, 9], 9))]);
    assert_eq!(reduce(4, &leaves, SUMS), [6, 0, 4, 0, 27, 0, 10, 0, 27, 0, 37, 0]);
    assert_eq!(reduce(4, &leaves, RANGES), [6, 6, 4, 4, 27, 27, 4, 6, 27, 27, 4, 27]);
}
