//! The promise: what was drawn apart and merged is what is drawn together, bit for bit, on the device where it is used.

use super::{SIDES, all_from, downloaded, merged, same};
use crate::kernels::property::hold;
use crate::kernels::rasterize_lhb::inputs::{
    Case, aligned, any_mesh, case, duplicates, front, lattice_directions, snapped, some_directions, views,
};
use crate::oracle::rasterize_lhb::{Lists, rasterize};
use crate::trial::{Check, Context, Failure, Listing, ensure, list_trials};
use glam::DVec3;
use proptest::prelude::*;
use twinlight_core::Backend;
use twinlight_core::kernels::merge_lhb::MergeLhbParams;
use twinlight_core::kernels::rasterize_lhb::{Lhb, LhbElement, RasterizeLhbParams};
use twinlight_core::lattice::{LatticeMesh, View};
use twinlight_fixtures::meshes;

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "merge_lhb":
        drawn_apart_as_drawn_together, aligned_meshes, g7_copies_across_meshes, every_size_and_direction, repeated,
    );
}

/// A mesh's buffers on the device.
pub(super) fn drawn<B: Backend>(
    cx: &Context<'_, B>,
    mesh: &LatticeMesh,
    views: &[View],
    params: &RasterizeLhbParams,
) -> Result<Lhb<B>, Failure> {
    Ok(cx.backend.rasterize_lhb(&cx.backend.upload_mesh(mesh)?, views, params)?)
}

/// What merges such buffers with those of a mesh of `first_triangle` triangles.
pub(super) fn merge_params(drawn: &RasterizeLhbParams, first_triangle: usize) -> MergeLhbParams {
    let RasterizeLhbParams { layer_cap, cap_side, .. } = *drawn;
    MergeLhbParams { layer_cap, cap_side, ..all_from(first_triangle as u32) }
}

/// Draws two meshes, merges them, and compares with the oracle's lists of both together.
fn promised<B: Backend>(
    cx: &Context<'_, B>,
    meshes: [&LatticeMesh; 2],
    views: &[View],
    params: &RasterizeLhbParams,
) -> Result<Lists, Failure> {
    let [kept, added] = meshes.map(|mesh| drawn(cx, mesh, views, params));
    let merge = merge_params(params, meshes[0].triangles().len());
    let got = downloaded(cx, &merged(cx, &kept?, &added?, &merge)?)?;
    let want = rasterize(&meshes[0].followed_by(meshes[1])?, views, params);
    let [a, b] = meshes.map(|mesh| mesh.triangles().len());
    same(cx, params.size, &got, &want)
        .map_err(|f| f.within(&format!("{a} and {b} triangles, {} views, {params:?}", views.len())))?;
    Ok(got)
}

/// A cap for every other case.
fn cap() -> impl Strategy<Value = (u32, u32)> {
    (prop_oneof![Just(0_u32), 1..7_u32], 0..2_u32)
}

fn holds_for<B: Backend>(
    cx: &Context<'_, B>,
    kept: impl Strategy<Value = LatticeMesh>,
    added: impl Strategy<Value = LatticeMesh>,
) -> Check {
    hold(cx, (case(kept), added, cap()), |(Case { mesh, views, params }, added, (layer_cap, cap_side))| {
        let params = RasterizeLhbParams { layer_cap, cap_side, ..params };
        promised(cx, [&mesh, &added], &views, &params).map(|_| ())
    })
}

fn drawn_apart_as_drawn_together<B: Backend>(cx: &Context<'_, B>) -> Check {
    holds_for(cx, any_mesh(), any_mesh())
}

/// Corners, edges and planes of both on each other.
fn aligned_meshes<B: Backend>(cx: &Context<'_, B>) -> Check {
    holds_for(cx, aligned(), aligned())?;
    // On pixel centres, all depths of few.
    let pair = (aligned(), aligned(), 0..6_u32, cap());
    hold(cx, pair, |(kept, added, power, (layer_cap, cap_side))| {
        let params = RasterizeLhbParams { layer_cap, cap_side, ..RasterizeLhbParams::new(1 << power) };
        promised(cx, [&kept, &added], &[front()], &params).map(|_| ())
    })
}

/// The same triangles on both sides: every element ties with a copy of another number. Pictures are small, because a pixel may
/// have hundreds of them.
fn g7_copies_across_meshes<B: Backend>(cx: &Context<'_, B>) -> Check {
    let shape = (duplicates(), 1..=24_u32, any::<u64>(), any::<bool>());
    hold(cx, (shape, cap()), |((mesh, size, seed, reversed), (layer_cap, cap_side))| {
        let params = RasterizeLhbParams { layer_cap, cap_side, ..RasterizeLhbParams::new(size) };
        let mut triangles = mesh.triangles().to_vec();
        if reversed {
            triangles.reverse();
        }
        let added = LatticeMesh::new(mesh.vertices().to_vec(), triangles)?;
        promised(cx, [&mesh, &added], &views(&some_directions(2, seed), size), &params).map(|_| ())
    })
}

/// Closed bodies through each other, whole and with caps of either side, from axes and from anywhere.
fn every_size_and_direction<B: Backend>(cx: &Context<'_, B>) -> Check {
    let body = meshes::displaced_sphere(4, DVec3::new(0.1, 0.2, -0.1), 0.7, 0.3, cx.options.seed);
    let (kept, added) = (snapped(&body), snapped(&meshes::cube()));
    for (size, count) in [(1, 8), (2, 3), (9, 3), (16, 2), (33, 1), (64, 1), (100, 1)] {
        let mut directions = some_directions(count, 31 ^ u64::from(size));
        let axes = lattice_directions();
        directions
            .extend(axes.into_iter().step_by(if cx.full() { 1 } else { 7 }).take(48 / size as usize + 1));
        let views = views(&directions, size);
        let whole = RasterizeLhbParams::new(size);
        let lists = promised(cx, [&kept, &added], &views, &whole)?;
        let both = |list: &[LhbElement]| {
            let of_kept = list.iter().filter(|e| (e.triangle() as usize) < kept.triangles().len()).count();
            of_kept > 0 && of_kept < list.len()
        };
        let shared = lists.each().filter(|list| both(list)).count();
        ensure(shared > 0, || format!("no pixel of {size}² shows both bodies"))?;
        for cap_side in SIDES {
            let layer_cap = 1 + size % 3;
            promised(cx, [&kept, &added], &views, &RasterizeLhbParams { layer_cap, cap_side, ..whole })?;
        }
    }
    Ok(())
}

fn repeated<B: Backend>(cx: &Context<'_, B>) -> Check {
    let of = |seed| snapped(&meshes::soup(300, 0.3, seed ^ cx.options.seed));
    let views = views(&some_directions(3, 37), 40);
    let params = RasterizeLhbParams::new(40);
    let (kept, added) = (drawn(cx, &of(41), &views, &params)?, drawn(cx, &of(43), &views, &params)?);
    let merge = || downloaded(cx, &merged(cx, &kept, &added, &merge_params(&params, 300))?);
    let first = merge()?;
    for _ in 0..3 {
        same(cx, 40, &merge()?, &first)?;
    }
    Ok(())
}
