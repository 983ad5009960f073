//! Apertures at their ends, floors that see nothing of themselves, directions with zeroes, borders.

use super::inputs::{Leaves, Lit, cone, filled, grid, plain, scattered, some_cone};
use super::{OPEN, STORAGES, agreed, agrees, same, traced};
use crate::oracle::reduce_mips::levels;
use crate::trial::{Check, Context, Listing, ensure, list_trials};
use twinlight_core::Backend;
use twinlight_core::kernels::reduce_mips::{ISOTROPIC, OPAQUE, VoxelLight};
use twinlight_core::kernels::trace_cones::{
    Cone, ConeLight, LEAST_TRANSMITTANCE, MAX_SINE, MAX_STEPS, SIXTY_DEGREES, TraceConesBlock,
};
use twinlight_core::math::morton::morton_code;
use twinlight_fixtures::random::Random;

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "trace_cones":
        m4_aperture_zero_is_a_march, m4_steps_are_bounded, m5_apertures_to_half_a_turn,
        m6_floors_see_nothing_of_themselves, m6_floors_see_what_stands_on_them, m8_zeroes_of_both_signs,
    );
}

/// Voxels along a row, met at their centres: opacities and channels whose products f32 has.
fn row(random: &mut Random, count: u32) -> Vec<VoxelLight> {
    let light = |random: &mut Random| VoxelLight {
        rgb: [(); 3].map(|()| random.index(1000) as u32),
        opacity: [0, 0, OPAQUE / 2, OPAQUE / 4][random.index(4)],
    };
    (0..count).map(|_| light(random)).collect()
}

/// A cone without a width takes voxel by voxel, with their integers and without a rounding.
fn m4_aperture_zero_is_a_march<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 41);
    for axis in 0..3 {
        let voxels = row(&mut random, 12);
        let mut dims = [3; 3];
        dims[axis] = 12;
        let place = |i: u32| [0, 1, 2].map(|a| if a == axis { i } else { 1 });
        let leaves: Leaves = (0..12).map(|i| (morton_code(place(i)), voxels[i as usize])).collect();
        let lit = Lit::new(dims, &leaves, ISOTROPIC);
        let mut direction = [0.0; 3];
        direction[axis] = 1.0;
        let cones: Vec<Cone> =
            (0..12).map(|i| cone(place(i).map(|c| c as f32 + 0.5), direction, 0.0)).collect();
        let want: Vec<ConeLight> = (0..12).map(|i| marched(&voxels[i..])).collect();
        let light = agreed(cx, &lit, &plain(ISOTROPIC), &cones)?;
        // A division by what is opaque has 2.5 ulp elsewhere, and then all is within the oracle's interval.
        if cx.backend.info().strict {
            same(&format!("along axis {axis}"), &light, &want)?;
        }
    }
    Ok(())
}

/// Front to back through voxels of level 0.
fn marched(voxels: &[VoxelLight]) -> ConeLight {
    let (mut rgb, mut left) = ([0.0; 3], 1.0);
    for voxel in voxels {
        if left <= f64::from(LEAST_TRANSMITTANCE) {
            break;
        }
        rgb = [0, 1, 2].map(|c| rgb[c] + left * f64::from(voxel.rgb[c]));
        left *= 1.0 - f64::from(voxel.opacity) / f64::from(OPAQUE);
    }
    ConeLight { rgb: rgb.map(|c| c as f32), transmittance: left as f32 }
}

/// A ray that never leaves its voxel ends; one through the longest row sees all of it.
fn m4_steps_are_bounded<B: Backend>(cx: &Context<'_, B>) -> Check {
    let count = |dims: [u32; 3], direction: [f32; 3]| {
        let box_of = grid(dims);
        let codes = filled([0; 3], dims, VoxelLight::default()).into_keys().collect();
        let levels = levels(box_of.padded(), &codes);
        let values = [1, 0, 0, 0].repeat(levels.active.len());
        let lit = Lit::made_up(box_of, levels, values, ISOTROPIC);
        Ok(traced(cx.backend, &lit, &plain(ISOTROPIC), &[cone([0.5; 3], direction, 0.0)])?[0].rgb[0])
    };
    let found: super::Checked<[f32; 2]> =
        count([1; 3], [0.0; 3]).and_then(|stays| Ok([stays, count([512, 1, 1], [1.0, 0.0, 0.0])?]));
    let found = found?;
    ensure(found == [MAX_STEPS as f32, 512.0], || format!("samples: {found:?}"))
}

/// Every sine up to that of a quarter turn and beyond, and what is none.
fn m5_apertures_to_half_a_turn<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 42);
    let dims = [16, 9, 16];
    for storage in STORAGES {
        let lit = Lit::new(dims, &scattered(&mut random, dims, 60), storage);
        let block = plain(storage);
        let base = cone([3.2, 4.1, 5.7], [0.6, 0.48, 0.64], 0.0);
        let sweep: Vec<Cone> = (0..=64).map(|i| Cone { sine: i as f32 / 64.0, ..base }).collect();
        agrees(cx, &lit, &block, &sweep)?;
        let tiny: Vec<Cone> = [1e-30, 1e-7, 1e-3, 0.03125].map(|sine| Cone { sine, ..base }).to_vec();
        agrees(cx, &lit, &block, &tiny)?;
        let of = |sines: &[f32]| {
            let cones: Vec<Cone> = sines.iter().map(|&sine| Cone { sine, ..base }).collect();
            traced(cx.backend, &lit, &block, &cones)
        };
        let widest = of(&[MAX_SINE])?;
        same("beyond the widest", &of(&[0.99, 1.0, 7.0, f32::INFINITY])?, &[widest[0]; 4])?;
        let narrowest = of(&[0.0])?;
        same("below nothing", &of(&[-0.0, -0.5, f32::NEG_INFINITY])?, &[narrowest[0]; 3])?;
        // Only strict mode may be asked what compares with NaN.
        if cx.backend.info().strict {
            same("no number", &of(&[f32::NAN])?, &narrowest)?;
        }
    }
    Ok(())
}

/// Cones from a point of a plane, in every direction above it, of every kind.
fn from_plane(
    random: &mut Random,
    block: &TraceConesBlock,
    dims: [u32; 3],
    origin: [f32; 3],
    normal: [f32; 3],
) -> Vec<Cone> {
    let upward = |mut cone: Cone| {
        let cosine: f32 = (0..3).map(|a| cone.direction[a] * normal[a]).sum();
        if cosine < 0.0 {
            cone.direction = cone.direction.map(|c| -c);
        }
        Cone { origin, normal, ..cone }
    };
    (0..24).map(|_| upward(some_cone(random, block, dims))).collect()
}

/// The voxels that a plane through `point` goes through.
fn plane_of(dims: [u32; 3], point: [f32; 3], normal: [f32; 3]) -> Leaves {
    let light = VoxelLight { rgb: [100_000, 2, 65_536], opacity: OPAQUE };
    let meets = |code: u32| {
        let voxel = twinlight_core::math::morton::morton_voxel(code);
        let height: f32 = (0..3).map(|a| (voxel[a] as f32 + 0.5 - point[a]) * normal[a]).sum();
        height.abs() <= 0.5 * normal.map(f32::abs).iter().sum::<f32>()
    };
    filled([0; 3], dims, light).into_iter().filter(|(code, _)| meets(*code)).collect()
}

/// A flat floor takes nothing of its own light or opacity, however it lies, and on no level.
fn m6_floors_see_nothing_of_themselves<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 43);
    let dims = [12, 16, 11];
    let level: Vec<[f32; 3]> = (0..6)
        .map(|i| [0, 1, 2].map(|a| if a == i / 2 { 1.0 - 2.0 * (i % 2) as f32 } else { 0.0 }))
        .collect();
    let tilted = [(); 3].map(|()| random.direction().as_vec3().to_array());
    for normal in level.into_iter().chain(tilted) {
        let origin = dims.map(|n| (random.between(0.3, 0.7) * f64::from(n)) as f32);
        let leaves = plane_of(dims, origin, normal);
        for storage in STORAGES {
            let lit = Lit::new(dims, &leaves, storage);
            for flags in [0, SIXTY_DEGREES] {
                let block = TraceConesBlock { flags, ..plain(storage) };
                let cones = from_plane(&mut random, &block, dims, origin, normal);
                let light = traced(cx.backend, &lit, &block, &cones)?;
                let what = format!("{lit:?} with a floor along {normal:?}");
                same(&what, &light, &vec![OPEN; cones.len()])?;
            }
        }
    }
    Ok(())
}

/// A wall on the floor is seen, and the floor beside it isn't.
fn m6_floors_see_what_stands_on_them<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 44);
    let dims = [16, 12, 10];
    let mut leaves = filled([0; 3], [16, 12, 1], VoxelLight { rgb: [0, 700_000, 0], opacity: OPAQUE });
    leaves.extend(filled([11, 0, 1], [12, 12, 9], VoxelLight { rgb: [90_000, 0, 0], opacity: OPAQUE }));
    for storage in STORAGES {
        let lit = Lit::new(dims, &leaves, storage);
        for flags in [0, SIXTY_DEGREES] {
            let block = TraceConesBlock { flags, ..plain(storage) };
            let (origin, normal) = ([4.3, 5.1, 0.6], [0.0, 0.0, 1.0]);
            let cones = from_plane(&mut random, &block, dims, origin, normal);
            agrees(cx, &lit, &block, &cones)?;
            let towards = Cone { origin, normal, ..cone(origin, [0.8, 0.0, 0.6], 0.4) };
            let light = agreed(cx, &lit, &block, &[towards])?[0];
            ensure(light.rgb[0] > 9_000.0 && light.transmittance < 0.9, || format!("{lit:?}: {light:?}"))?;
        }
    }
    Ok(())
}

/// Components that are 0, −0 or below what devices keep are all the same.
fn m8_zeroes_of_both_signs<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 45);
    let dims = [9, 8, 10];
    for storage in STORAGES {
        let lit = Lit::new(dims, &scattered(&mut random, dims, 150), storage);
        for flags in [0, SIXTY_DEGREES] {
            let block = TraceConesBlock { flags, ..plain(storage) };
            for direction in [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.6, 0.0, -0.8], [0.0, 0.8, 0.6]] {
                let base = cone([4.3, 3.6, 5.2], direction, 0.2);
                let want = agreed(cx, &lit, &block, &[base])?;
                for zero in [-0.0, 1e-40, -1e-40] {
                    let direction = direction.map(|c: f32| if c == 0.0 { zero } else { c });
                    let found = traced(cx.backend, &lit, &block, &[Cone { direction, ..base }])?;
                    // Where a channel is nothing, a subnormal may be left of it.
                    let flushed = |light: &ConeLight| ConeLight {
                        rgb: light.rgb.map(|c| if c < 1e-30 { 0.0 } else { c }),
                        ..*light
                    };
                    same(&format!("{lit:?} with {zero:e}"), &[flushed(&found[0])], &[flushed(&want[0])])?;
                }
            }
        }
    }
    Ok(())
}
