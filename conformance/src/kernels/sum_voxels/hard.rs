//! Hard cases: as many fragments as sums have room for and one more, and normals that cancel.

use super::Painted;
use super::inputs::{channels, normal, plain, some_normal};
use crate::kernels::rasterize_lhb::inputs::{snapped, turned};
use crate::kernels::voxelize::inputs::{in_units, unit_grid};
use crate::kernels::voxelize::{Case, SEPARATIONS};
use crate::oracle::sum_voxels::component;
use crate::trial::{Check, Context, Failure, Listing, ensure, list_trials};
use twinlight_core::kernels::sum_voxels::{ALBEDO_ONE, MAX_FRAGMENTS, VoxelSums, VoxelSurface};
use twinlight_core::kernels::voxelize::THIN;
use twinlight_core::lattice::{LatticeMesh, VoxelGrid};
use twinlight_core::{Backend, Error};
use twinlight_fixtures::meshes;
use twinlight_fixtures::random::Random;

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "sum_voxels": v9_opposite_normals_cancel, v8_most_fragments);
}

/// As many copies of one triangle as there may be fragments, white and as bright as can be; one more is refused.
fn v8_most_fragments<B: Backend>(cx: &Context<'_, B>) -> Check {
    let brightest = channels([ALBEDO_ONE; 3]);
    let surface = VoxelSurface { normals: [normal([-127, 127, -1]); 3], emission: brightest, ..plain() };
    let one = in_units(&[[[70, 80, 90], [100, 80, 91], [75, 110, 92]]]);
    let grid = unit_grid([3; 3], 6);
    let copies = |count: u32| -> twinlight_core::Result<Painted> {
        let mesh = LatticeMesh::new(one.vertices().to_vec(), vec![[0, 1, 2]; count as usize])?;
        let surfaces = vec![surface; count as usize];
        Ok(Painted { case: Case::new(mesh, grid, THIN).cut(0), surfaces, texels: Vec::new() })
    };
    let (_, sums) = copies(MAX_FRAGMENTS)?.found(cx)?;
    let (all, most) = (MAX_FRAGMENTS * ALBEDO_ONE, MAX_FRAGMENTS as i32);
    let normal = [-127 * most, 127 * most, -most];
    let sum = VoxelSums {
        albedo: [all; 3],
        count: MAX_FRAGMENTS,
        normal,
        emission: [all; 3],
        ..Default::default()
    };
    ensure(sums == [sum], || format!("{sums:?}, want {sum:?}"))?;

    let more = copies(MAX_FRAGMENTS + 1)?;
    match more.buffer(cx, &more.case.voxels(cx)?)? {
        Err(Error::LimitExceeded { .. }) => copies(2)?.agrees(cx),
        Err(other) => Err(other.into()),
        Ok(_) => Err(Failure::Mismatch("more fragments than there may be are summed".into())),
    }
}

/// A sheet and its back: the normals of flat surfaces add up to nothing, those of smooth ones to a rounding of each fragment.
fn v9_opposite_normals_cancel<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 11);
    let opposite = |word: u32| normal([0, 1, 2].map(|axis| -component(word, axis) as i8));
    for (mesh, flat) in [(meshes::grid(9, 7), true), (meshes::icosphere(3), true), (meshes::fan(11), false)] {
        let front = snapped(&turned(mesh, 7));
        let sheet = front.followed_by(&front)?;
        let mut surfaces: Vec<VoxelSurface> = Vec::new();
        for _ in front.triangles() {
            let of_all = some_normal(&mut random);
            let normals = [(); 3].map(|()| if flat { of_all } else { some_normal(&mut random) });
            surfaces.push(VoxelSurface { normals, ..plain() });
        }
        let backs: Vec<VoxelSurface> =
            surfaces.iter().map(|s| VoxelSurface { normals: s.normals.map(opposite), ..*s }).collect();
        surfaces.extend(backs);
        let grid = VoxelGrid::over([-32_760; 3], [32_760; 3], 16)?;
        for separation in SEPARATIONS {
            let case = Case::new(sheet.clone(), grid, separation);
            let sums = Painted { case, surfaces: surfaces.clone(), texels: Vec::new() }.agreed(cx)?;
            // Where it is not whole, the sum of a front's and a back's component is rounded up at halves.
            let most = |s: &VoxelSums| if flat { 0 } else { s.count / 2 };
            let left = sums.iter().find(|s| s.normal.iter().any(|n| n.unsigned_abs() > most(s)));
            ensure(left.is_none() && !sums.is_empty(), || format!("{left:?} of opposite normals"))?;
        }
    }
    Ok(())
}
