//! Laws: what order, orientation, company and place don't change.

use super::inputs::{some_grid, some_mesh};
use super::{CUTOFFS, Case, SEPARATIONS, same_voxels};
use crate::kernels::property::hold;
use crate::oracle::voxelize::{code, voxel};
use crate::trial::{Check, Context, Listing, ensure, list_trials};
use proptest::prelude::*;
use twinlight_core::Backend;
use twinlight_core::lattice::{LatticeMesh, VoxelGrid};
use twinlight_fixtures::random::Random;

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "voxelize":
        triangle_order_is_free, corner_order_is_free, thin_is_conservative, meshes_add_up, shifts_shift, calls_repeat,
    );
}

fn some_case(seed: u64, count: usize, kind: usize) -> Case {
    let mut random = Random::new(seed);
    let grid = some_grid(&mut random);
    let mesh = some_mesh(&mut random, &grid, count);
    Case::new(mesh, grid, SEPARATIONS[kind / 4]).cut(CUTOFFS[kind % 4])
}

/// Inputs of [`some_case`].
fn shape() -> impl Strategy<Value = (u64, usize, usize)> {
    (any::<u64>(), 1..300_usize, 0..8_usize)
}

/// In another order, classes hold the new numbers of what they held, and nothing else changes.
fn triangle_order_is_free<B: Backend>(cx: &Context<'_, B>) -> Check {
    hold(cx, shape(), |(seed, count, kind)| {
        let case = some_case(seed, count, kind);
        let mut random = Random::new(seed ^ 21);
        let mut order: Vec<(u64, u32)> =
            (0..case.mesh.triangles().len() as u32).map(|i| (random.next_u64(), i)).collect();
        order.sort_unstable();
        let triangles = order.iter().map(|&(_, i)| case.mesh.triangles()[i as usize]).collect();
        let mesh = LatticeMesh::new(case.mesh.vertices().to_vec(), triangles)?;
        let (found, want) = (Case { mesh, ..case }.found(cx)?, case.found(cx)?);
        same_voxels(cx, &found, &want)?;
        for (got, want) in [(&found.small, &want.small), (&found.large, &want.large)] {
            let mut before: Vec<u32> = got.iter().map(|&i| order[i as usize].1).collect();
            before.sort_unstable();
            ensure(&before == want, || format!("{before:?}, want {want:?}"))?;
        }
        Ok(())
    })
}

/// Rotated corners and triangles turned over have the same plane, edges and bounds.
fn corner_order_is_free<B: Backend>(cx: &Context<'_, B>) -> Check {
    hold(cx, shape(), |(seed, count, kind)| {
        let case = some_case(seed, count, kind);
        let mut random = Random::new(seed ^ 22);
        let mut mixed = |&[p, q, r]: &[u32; 3]| {
            [[p, q, r], [q, r, p], [r, p, q], [p, r, q], [r, q, p], [q, p, r]][random.index(6)]
        };
        let triangles = case.mesh.triangles().iter().map(&mut mixed).collect();
        let mesh = LatticeMesh::new(case.mesh.vertices().to_vec(), triangles)?;
        super::same(cx, &Case { mesh, ..case }.found(cx)?, &case.found(cx)?)
    })
}

/// The plane of a thin voxel passes through its cube, and no edge of any projection has all of the cube outside.
fn thin_is_conservative<B: Backend>(cx: &Context<'_, B>) -> Check {
    hold(cx, shape(), |(seed, count, kind)| {
        let case = some_case(seed, count, kind);
        let [thin, touched] = SEPARATIONS.map(|separation| {
            Case::new(case.mesh.clone(), case.grid, separation).cut(case.params.cutoff).found(cx)
        });
        let (thin, touched) = (thin?, touched?);
        let stray = thin.active.iter().find(|code| touched.active.binary_search(code).is_err());
        ensure(stray.is_none(), || format!("{:?} is not touched", stray.map(|&code| voxel(code))))
    })
}

/// Of two meshes together: all voxels of either.
fn meshes_add_up<B: Backend>(cx: &Context<'_, B>) -> Check {
    hold(cx, shape(), |(seed, count, kind)| {
        let case = some_case(seed, count, kind);
        let added = some_mesh(&mut Random::new(seed ^ 23), &case.grid, 1 + count / 2);
        let before = case.mesh.triangles().len() as u32;
        let both = Case { mesh: case.mesh.followed_by(&added)?, ..case }.found(cx)?;
        let (kept, added) = (case.found(cx)?, Case { mesh: added, ..case }.found(cx)?);
        let mask: Vec<u32> = kept.mask.iter().zip(&added.mask).map(|(a, b)| a | b).collect();
        ensure(both.mask == mask, || "bits are not those of either".into())?;
        for (both, kept, added) in
            [(both.small, kept.small, added.small), (both.large, kept.large, added.large)]
        {
            let want: Vec<u32> = kept.into_iter().chain(added.into_iter().map(|i| i + before)).collect();
            ensure(both == want, || format!("{both:?}, want {want:?}"))?;
        }
        Ok(())
    })
}

/// Whole voxels farther on, everything is whole voxels farther on.
fn shifts_shift<B: Backend>(cx: &Context<'_, B>) -> Check {
    hold(cx, (any::<u64>(), 1..200_usize, 0..8_usize), |(seed, count, kind)| {
        let mut random = Random::new(seed);
        // Nothing is moved into the box before or after: the mesh is well within it.
        let (subvoxel_bits, dims) = (8 + random.index(3) as u32, [24, 20, 30]);
        let (scale, width) = ([1 << 14, 9_999, 12_345][random.index(3)], 1_i64 << subvoxel_bits);
        let middle = dims.map(|n| ((i64::from(n) << subvoxel_bits >> 1) << 14) as i32);
        let grid = VoxelGrid { dims, scale, offset: middle, subvoxel_bits };
        let within = VoxelGrid { dims: [8; 3], offset: [((4 * width) << 14) as i32; 3], ..grid };
        let mut mesh = some_mesh(&mut random, &within, count);
        let reach = ((4 * width) << 14) / i64::from(scale);
        let vertices = mesh.vertices().iter().map(|v| v.map(|c| c.clamp(-reach as i16, reach as i16)));
        mesh = LatticeMesh::new(vertices.collect(), mesh.triangles().to_vec())?;
        let by = [0, 1, 2].map(|_| random.index(9) as i64 - 4);
        let offset = [0, 1, 2].map(|axis| (i64::from(middle[axis]) + ((by[axis] * width) << 14)) as i32);
        let case = Case::new(mesh, grid, SEPARATIONS[kind / 4]).cut(CUTOFFS[kind % 4]);
        let moved = Case { grid: VoxelGrid { offset, ..grid }, ..case.clone() }.found(cx)?;
        let found = case.found(cx)?;
        let shifted = |&of: &u32| {
            let voxel = voxel(of);
            code([0, 1, 2].map(|axis| voxel[axis] + i128::from(by[axis])))
        };
        let mut want: Vec<u32> = found.active.iter().map(shifted).collect();
        want.sort_unstable();
        ensure(moved.active == want, || format!("{:?}, want {want:?}, moved by {by:?}", moved.active))?;
        let classes = (moved.small, moved.large) == (found.small, found.large);
        ensure(classes, || format!("moved by {by:?}, classes are others"))
    })
}

/// The same mesh again, after others and in other grids: the same voxels.
fn calls_repeat<B: Backend>(cx: &Context<'_, B>) -> Check {
    let cases: Vec<Case> =
        (0..4).map(|i| some_case(cx.options.seed ^ (24 + i), 60, i as usize * 2)).collect();
    let resident = cx.backend.upload_mesh(&cases[0].mesh)?;
    for case in cases.iter().chain(&cases) {
        let grid = &case.grid;
        let again = Case { mesh: cases[0].mesh.clone(), ..case.clone() };
        let found = cx.backend.voxelize(&resident, grid, &case.params)?;
        super::same(cx, &super::downloaded(cx, &found)?, &again.agreed(cx)?)?;
        case.agrees(cx)?;
    }
    Ok(())
}
