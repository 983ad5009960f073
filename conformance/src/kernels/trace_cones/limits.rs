//! What opacity may do, constant light, and the grid's border.

use super::inputs::{Leaves, Lit, cone, filled, plain, scattered, some_block, some_cone};
use super::{OPEN, STORAGES, agreed, agrees, same, traced};
use crate::kernels::property;
use crate::trial::{Check, Context, Listing, ensure, list_trials};
use proptest::prelude::*;
use twinlight_core::Backend;
use twinlight_core::kernels::reduce_mips::{ANISOTROPIC, OPAQUE, VoxelLight};
use twinlight_core::kernels::trace_cones::{
    Cone, ConeLight, LEAST_TRANSMITTANCE, MAX_STEPS, SIXTY_DEGREES, TraceConesBlock,
};
use twinlight_fixtures::random::Random;

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "trace_cones":
        m7_more_opacity_lets_no_more_through, constant_light_is_seen_as_it_is, thin_walls_hold_on_every_level,
        m9_borders_are_clamped, m9_outside_is_open, m9_closed_rooms_let_nothing_through,
    );
}

/// What rounding (1 − u) / o and its product can add to what is let through: of each sample's opacity, at most 1, eight ulp.
const ROUNDING: f32 = MAX_STEPS as f32 * 8.0 / 8_388_608.0;

/// What is let through is in [0, 1], and never more where voxels let less through.
fn m7_more_opacity_lets_no_more_through<B: Backend>(cx: &Context<'_, B>) -> Check {
    let inputs = (prop::array::uniform3(1..=20_u32), 1..150_usize, any::<u64>());
    property::hold(cx, inputs, |(dims, count, seed)| {
        let mut random = Random::new(seed);
        let thin = scattered(&mut random, dims, count);
        let more = |light: &VoxelLight| VoxelLight {
            opacity: light.opacity + (OPAQUE - light.opacity) / 3,
            ..*light
        };
        let dense: Leaves = thin.iter().map(|(&code, light)| (code, more(light))).collect();
        for storage in STORAGES {
            let block = some_block(&mut random, storage, 20.0);
            let cones: Vec<Cone> = (0..8).map(|_| some_cone(&mut random, &block, dims)).collect();
            let light = [&thin, &dense]
                .map(|leaves| traced(cx.backend, &Lit::new(dims, leaves, storage), &block, &cones));
            let [thin, dense] = light;
            for ((thin, dense), cone) in thin?.iter().zip(&dense?).zip(&cones) {
                let inside = [thin, dense].iter().all(|light| (0.0..=1.0).contains(&light.transmittance));
                // A cone that is done with ends, at whatever is left.
                let most = thin.transmittance.max(LEAST_TRANSMITTANCE) + ROUNDING;
                ensure(inside && dense.transmittance <= most, || {
                    format!("storage {storage}, {cone:?}: {thin:?}, denser {dense:?}")
                })?;
            }
        }
        Ok(())
    })
}

/// In an opaque field of one light every cone that begins at a voxel's centre ends at once with it, on every level.
fn constant_light_is_seen_as_it_is<B: Backend>(cx: &Context<'_, B>) -> Check {
    let leaves = filled([0; 3], [16; 3], VoxelLight { rgb: [200, 100, 3], opacity: OPAQUE });
    for storage in STORAGES {
        let lit = Lit::new([16; 3], &leaves, storage);
        let block = TraceConesBlock { flags: SIXTY_DEGREES, unit: 0.5, ..plain(storage) };
        for level in 0..5 {
            let width = (1 << level) as f32;
            let centre = [5.5_f32, 9.5, 7.5].map(|c| ((c / width).floor() + 0.5) * width);
            for axis in 0..3 {
                let is_far = centre[axis] >= width;
                let mut direction = [0.0; 3];
                direction[axis] = if is_far { 1.0 } else { -1.0 };
                let mut origin = centre;
                // Apices are in the grid: the one voxel of the last level is met at its end.
                origin[axis] = if is_far { origin[axis] - width } else { (origin[axis] + width).min(16.0) };
                let cone = Cone { start: width, ..cone(origin, direction, 0.0) };
                let light = agreed(cx, &lit, &block, &[cone])?;
                // A division by what is opaque has 2.5 ulp elsewhere.
                if cx.backend.info().strict {
                    let want = ConeLight { rgb: [100.0, 50.0, 1.5], transmittance: 0.0 };
                    same(&format!("{lit:?} on level {level}"), &light, &[want])?;
                }
            }
        }
    }
    Ok(())
}

/// A wall one voxel thick lets a wide cone see no further than a narrow one: little is left of it, and little of what is behind.
fn thin_walls_hold_on_every_level<B: Backend>(cx: &Context<'_, B>) -> Check {
    let dims = [32; 3];
    let mut leaves = filled([16, 0, 0], [17, 32, 32], VoxelLight { rgb: [1000, 0, 0], opacity: OPAQUE });
    leaves.extend(filled([28, 0, 0], [29, 32, 32], VoxelLight { rgb: [0, 1000, 0], opacity: OPAQUE }));
    for storage in STORAGES {
        let lit = Lit::new(dims, &leaves, storage);
        for flags in [0, SIXTY_DEGREES] {
            let block = TraceConesBlock { flags, ..plain(storage) };
            for sine in [0.0, 0.1, 0.5] {
                let light = agreed(cx, &lit, &block, &[cone([4.0, 16.3, 15.2], [1.0, 0.0, 0.0], sine)])?[0];
                ensure(light.transmittance <= 0.5 && light.rgb[1] <= 500.0, || {
                    format!("{lit:?}, {sine}: {light:?}")
                })?;
            }
        }
    }
    Ok(())
}

/// Within half a voxel of the border on any level, samples are those of the voxels there are.
fn m9_borders_are_clamped<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 51);
    for dims in [[8, 8, 8], [7, 5, 1], [1, 1, 9]] {
        let leaves = filled([0; 3], dims, VoxelLight { rgb: [5000, 9, 77], opacity: OPAQUE / 16 });
        for storage in STORAGES {
            let lit = Lit::new(dims, &leaves, storage);
            let at_border = |random: &mut Random| {
                let origin = dims.map(|n| {
                    let beside = random.between(1e-4, 0.5);
                    (if random.index(2) == 0 { beside } else { f64::from(n) - beside }) as f32
                });
                let direction = random.direction().as_vec3().to_array();
                Cone { start: 0.0, ..cone(origin, direction, random.unit() as f32) }
            };
            let cones: Vec<Cone> = (0..24).map(|_| at_border(&mut random)).collect();
            agrees(cx, &lit, &plain(storage), &cones)?;
            // The first sample is of the border's voxel alone: all of it.
            let first = TraceConesBlock { reach: 0.0, ..plain(storage) };
            for light in agreed(cx, &lit, &first, &cones)? {
                ensure(light.transmittance < 0.95, || format!("{lit:?}: {light:?}"))?;
            }
        }
    }
    Ok(())
}

/// Where a cone's apex is outside, there is nothing, whatever is ahead.
fn m9_outside_is_open<B: Backend>(cx: &Context<'_, B>) -> Check {
    let dims = [4, 6, 5];
    let leaves = filled([0; 3], dims, VoxelLight { rgb: [900, 9, 77], opacity: OPAQUE });
    for storage in STORAGES {
        let lit = Lit::new(dims, &leaves, storage);
        let mut cones = Vec::new();
        for axis in 0..3 {
            for beyond in
                [-1e-3, -3.0, dims[axis] as f32 + 1e-3, dims[axis] as f32 + 9.0, f32::INFINITY, f32::MAX]
            {
                let (mut origin, mut direction) = ([2.0, 3.0, 2.5], [0.0; 3]);
                origin[axis] = beyond;
                direction[axis] = if beyond < 0.0 { 1.0 } else { -1.0 };
                cones.push(cone(origin, direction, 0.3));
            }
        }
        let light = traced(cx.backend, &lit, &plain(storage), &cones)?;
        same(&format!("{lit:?}"), &light, &vec![OPEN; cones.len()])?;
    }
    Ok(())
}

/// What a sample within its radius of the border may leave open: between two levels, (2 − m)·(m − 1)/2 of the finer one's weight at most; and eight
/// roundings of weights.
const BESIDE_BORDER: f32 = 0.125 + 8.0 / 8_388_608.0;

/// Walls of one voxel along the grid's border: however wide a cone along an axis is, and wherever it begins, it ends there.
fn m9_closed_rooms_let_nothing_through<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 52);
    let mut leaves = filled([0; 3], [16; 3], VoxelLight { rgb: [900, 9, 77], opacity: OPAQUE });
    let inside = filled([1; 3], [15; 3], VoxelLight::default());
    leaves.retain(|code, _| !inside.contains_key(code));
    let lit = Lit::new([16; 3], &leaves, ANISOTROPIC);
    for flags in [0, SIXTY_DEGREES] {
        let block = TraceConesBlock { flags, ..plain(ANISOTROPIC) };
        let along_axis = |i: usize| {
            let mut direction = [0.0; 3];
            direction[i % 3] = if i.is_multiple_of(2) { 1.0 } else { -1.0 };
            cone([(); 3].map(|()| random.between(2.0, 14.0) as f32), direction, random.unit() as f32)
        };
        let cones: Vec<Cone> = (0..120).map(along_axis).collect();
        let most = if flags == 0 { BESIDE_BORDER } else { LEAST_TRANSMITTANCE };
        for (light, cone) in agreed(cx, &lit, &block, &cones)?.iter().zip(&cones) {
            ensure(light.transmittance <= most, || format!("{flags}: {cone:?} lets {light:?} through"))?;
        }
    }
    Ok(())
}
