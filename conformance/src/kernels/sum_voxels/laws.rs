//! Laws: what order, classes, company and place don't change.

use super::inputs::{painted, some_painted};
use super::{Checked, Painted};
use crate::compare::{Shape, exact};
use crate::kernels::property::hold;
use crate::kernels::voxelize::Case;
use crate::kernels::voxelize::inputs::some_mesh;
use crate::trial::{Check, Context, Listing, ensure, list_trials};
use proptest::prelude::*;
use std::collections::BTreeMap;
use twinlight_core::Backend;
use twinlight_core::kernels::sum_voxels::VoxelSums;
use twinlight_core::kernels::voxelize::NO_CUTOFF;
use twinlight_core::lattice::LatticeMesh;
use twinlight_fixtures::random::Random;

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "sum_voxels":
        triangle_order_is_free, classes_are_free, sums_of_meshes_add_up, copies_count_each,
    );
}

/// Inputs of [`some_painted`].
fn shape() -> impl Strategy<Value = (u64, usize, usize)> {
    (any::<u64>(), 1..300_usize, 0..2_usize)
}

fn triangle_order_is_free<B: Backend>(cx: &Context<'_, B>) -> Check {
    hold(cx, shape(), |(seed, count, kind)| {
        let painted = some_painted(seed, count, kind);
        let mut random = Random::new(seed ^ 21);
        let mut order: Vec<(u64, usize)> =
            (0..painted.surfaces.len()).map(|i| (random.next_u64(), i)).collect();
        order.sort_unstable();
        let Case { mesh, .. } = &painted.case;
        let triangles = order.iter().map(|&(_, i)| mesh.triangles()[i]).collect();
        let surfaces = order.iter().map(|&(_, i)| painted.surfaces[i]).collect();
        let mesh = LatticeMesh::new(mesh.vertices().to_vec(), triangles)?;
        let case = Case { mesh, ..painted.case.clone() };
        let (_, got) = Painted { case, surfaces, texels: painted.texels.clone() }.found(cx)?;
        exact(cx, "sums", &got, &painted.found(cx)?.1, Shape::Line)
    })
}

/// Sums are the same, whether triangles are small or large.
fn classes_are_free<B: Backend>(cx: &Context<'_, B>) -> Check {
    hold(cx, shape(), |(seed, count, kind)| {
        let painted = some_painted(seed, count, kind);
        let of = |cutoff: u32| -> Checked<Vec<VoxelSums>> {
            Ok(Painted { case: painted.case.clone().cut(cutoff), ..painted.clone() }.found(cx)?.1)
        };
        let want = of(NO_CUTOFF)?;
        [0, 1, 64].into_iter().try_for_each(|cutoff| exact(cx, "sums", &of(cutoff)?, &want, Shape::Line))
    })
}

/// By the voxels' codes.
fn by_code((active, sums): (Vec<u32>, Vec<VoxelSums>)) -> BTreeMap<u32, VoxelSums> {
    active.into_iter().zip(sums).collect()
}

fn plus(a: &VoxelSums, b: &VoxelSums) -> VoxelSums {
    let sum = |i: usize| [a.albedo[i] + b.albedo[i], a.emission[i] + b.emission[i]];
    VoxelSums {
        albedo: [0, 1, 2].map(|i| sum(i)[0]),
        count: a.count + b.count,
        normal: [0, 1, 2].map(|i| a.normal[i] + b.normal[i]),
        emission: [0, 1, 2].map(|i| sum(i)[1]),
        ..VoxelSums::default()
    }
}

/// Of two meshes together: the sums of either.
fn sums_of_meshes_add_up<B: Backend>(cx: &Context<'_, B>) -> Check {
    hold(cx, shape(), |(seed, count, kind)| {
        let one = some_painted(seed, count, kind);
        let mut random = Random::new(seed ^ 22);
        let (grid, separation) = (one.case.grid, one.case.params.separation);
        let mesh = some_mesh(&mut random, &grid, 1 + count / 2);
        let other = Painted { texels: one.texels.clone(), ..painted(&mut random, mesh, grid, separation) };
        let both = Painted {
            case: Case::new(one.case.mesh.followed_by(&other.case.mesh)?, grid, separation),
            surfaces: [one.surfaces.as_slice(), &other.surfaces].concat(),
            texels: one.texels.clone(),
        };
        let mut want = by_code(one.found(cx)?);
        for (code, sums) in by_code(other.found(cx)?) {
            let before = want.entry(code).or_default();
            *before = plus(before, &sums);
        }
        let (active, sums) = both.found(cx)?;
        ensure(active.iter().eq(want.keys()), || "voxels are not those of either".into())?;
        let want: Vec<VoxelSums> = want.into_values().collect();
        exact(cx, "sums", &sums, &want, Shape::Line)
    })
}

/// Three of each triangle are three times everything, emission included.
fn copies_count_each<B: Backend>(cx: &Context<'_, B>) -> Check {
    let one = some_painted(cx.options.seed ^ 23, 120, 0);
    let (mesh, surfaces) = (&one.case.mesh, &one.surfaces);
    let thrice = LatticeMesh::new(mesh.vertices().to_vec(), mesh.triangles().repeat(3))?;
    let case = Case { mesh: thrice, ..one.case.clone() };
    let (_, got) = Painted { case, surfaces: surfaces.repeat(3), texels: one.texels.clone() }.found(cx)?;
    let want: Vec<VoxelSums> = one.found(cx)?.1.iter().map(|s| plus(s, &plus(s, s))).collect();
    exact(cx, "sums", &got, &want, Shape::Line)
}
