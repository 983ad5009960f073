//! Edge ladders, fragments whose sums are known, and meshes, grids and surfaces of every kind.

use super::Painted;
use super::inputs::{channels, normal, painted, plain, some_painted, some_texels};
use crate::kernels::property::hold;
use crate::kernels::voxelize::inputs::{Point, in_units, some_mesh, unit_grid};
use crate::kernels::voxelize::{Case, SEPARATIONS};
use crate::trial::{Check, Context, Listing, ensure, list_trials};
use proptest::prelude::*;
use twinlight_core::Backend;
use twinlight_core::kernels::sum_voxels::{CLAMP, VoxelSums, VoxelSurface, texel_word};
use twinlight_core::kernels::voxelize::{CONSERVATIVE, THIN};
use twinlight_core::lattice::LatticeMesh;
use twinlight_fixtures::random::Random;

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "sum_voxels":
        nothing_to_sum, one_fragment, random_surfaces, areas_of_every_length, textures_to_their_borders, no_area_is_weighed_too,
        triangle_ladder, many_triangles,
    );
}

/// No triangles, and triangles that meet nothing.
fn nothing_to_sum<B: Backend>(cx: &Context<'_, B>) -> Check {
    let grid = unit_grid([4, 1, 3], 8);
    for mesh in [LatticeMesh::default(), in_units(&[[[9; 3]; 3], [[0; 3], [9; 3], [90; 3]]])] {
        let surfaces = vec![plain(); mesh.triangles().len()];
        let nothing = Painted { case: Case::new(mesh, grid, THIN), surfaces, texels: Vec::new() };
        let sums = nothing.agreed(cx)?;
        ensure(sums.is_empty(), || format!("{sums:?}"))?;
    }
    Ok(())
}

/// A triangle whose weights at the voxel's centre are a half and two quarters.
fn one_fragment<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mesh = in_units(&[[[0, 0, 32], [128, 0, 32], [0, 128, 32]]]);
    let case = Case::new(mesh, unit_grid([1; 3], 7), THIN);
    // The voxel is 128 units wide, its centre on the third edge: weights are 0, a half and a half.
    let half = VoxelSurface {
        normals: [normal([1, 2, 3]), normal([0, 127, -127]), normal([1, -127, -126])],
        texture: 3,
        texcoords: [[0, 0], [2 << 6, 64], [0, 3 << 6]],
        texture_size: 3 | 4 << 16,
        tint: channels([4095, 1000, 1]),
        emission: channels([4095, 2, 77]),
        ..plain()
    };
    let mut texels = vec![0; 3 + 12];
    // u = 1, v = 2.
    texels[3 + 2 * 3 + 1] = texel_word([1023, 500, 512]);
    for (surface, albedo, normal) in [
        // Half a unit goes up: 0.5 to 1, −126.5 to −126.
        (half, [4095, (1000 * 500 + 511) / 1023, 1], [1, 0, -126]),
        (plain(), [4095; 3], [0, 0, 127]),
    ] {
        let sums =
            Painted { case: case.clone(), surfaces: vec![surface], texels: texels.clone() }.agreed(cx)?;
        let emission = if surface == half { [4095, 2, 77] } else { [0; 3] };
        let want = VoxelSums { albedo, count: 1, normal, emission, ..VoxelSums::default() };
        ensure(sums == [want], || format!("{sums:?}, want {want:?}"))?;
    }
    Ok(())
}

fn random_surfaces<B: Backend>(cx: &Context<'_, B>) -> Check {
    hold(cx, (any::<u64>(), 1..250_usize, 0..2_usize, 0..40_u32), |(seed, count, kind, cutoff)| {
        let painted = some_painted(seed, count, kind);
        Painted { case: painted.case.cut(cutoff), ..painted }.agrees(cx)
    })
}

/// Twice the area of 1 bit to 30: just what the weights keep, one bit more, and all there are. Wide triangles cover voxels in
/// every part of them.
fn areas_of_every_length<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 1);
    let mut triangles: Vec<[Point; 3]> = Vec::new();
    for bits in 0..=15 {
        for beside in [-1, 0, 1] {
            let leg = ((1 << bits) + beside).clamp(1, (1 << 15) - 1);
            let from = [(); 3].map(|()| random.index(((1 << 15) - leg) as usize) as i32);
            let [x, y, z] = from;
            triangles.push([from, [x + leg, y, z], [x, y + leg, z]]);
            triangles.push([from, [x, y, z + leg], [x, y + leg, z + leg / 2]]);
            triangles.push([[x + leg, y, z], from, [x, y + 1, z + leg]]);
        }
    }
    let mesh = in_units(&triangles);
    for (grid, separation) in
        [([1; 3], THIN), ([4, 8, 2], CONSERVATIVE), ([16, 16, 16], THIN), ([16, 9, 14], CONSERVATIVE)].map(
            |(dims, separation)| {
                let longest: u32 = dims.into_iter().fold(1, u32::max);
                (unit_grid(dims, 15 - longest.next_power_of_two().trailing_zeros()), separation)
            },
        )
    {
        painted(&mut random, mesh.clone(), grid, separation).agrees(cx)?;
    }
    Ok(())
}

/// One texture of 5 × 3 different texels, whole triangles of it in turn, before it and behind: wrapped and clamped.
fn textures_to_their_borders<B: Backend>(cx: &Context<'_, B>) -> Check {
    let texels: Vec<u32> = (0..15).map(|i| texel_word([60 * i, 1023 - 60 * i, 7 * i])).collect();
    let mut triangles = Vec::new();
    let mut surfaces = Vec::new();
    let places = [-6, -5, -4, -1, 0, 1, 2, 3, 4, 5, 6];
    for (i, (u, v)) in places.into_iter().flat_map(|u| places.map(|v| (u, v))).enumerate() {
        for beside in [-1, 0, 63] {
            for flags in [0, CLAMP] {
                let row = surfaces.len() as i32;
                let at = [64 * (i as i32 % 64) + 8, 64 * (row % 23) + 8, 64 * (row / 23 % 40) + 8];
                triangles.push([at, [at[0] + 40, at[1], at[2]], [at[0], at[1] + 40, at[2]]]);
                let texcoords = [[64 * u + beside, 64 * v + beside]; 3];
                let texture_size = 5 | 3 << 16;
                surfaces.push(VoxelSurface { texture: 0, texcoords, texture_size, flags, ..plain() });
            }
        }
    }
    let case = Case::new(in_units(&triangles), unit_grid([64, 23, 40], 6), THIN);
    Painted { case, surfaces, texels }.agrees(cx)
}

/// Segments and points, which conservative voxels have.
fn no_area_is_weighed_too<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 2);
    let mut triangles: Vec<[Point; 3]> = Vec::new();
    for _ in 0..100 {
        let mut point = || [(); 3].map(|()| 2 * random.index(1_000) as i32);
        let (p, q) = (point(), point());
        let between = [0, 1, 2].map(|axis| (p[axis] + q[axis]) / 2);
        triangles.push([[p, q, between], [between, q, p], [p, p, q], [q, q, q]][random.index(4)]);
    }
    let mesh = in_units(&triangles);
    painted(&mut random, mesh, unit_grid([16; 3], 7), CONSERVATIVE).agrees(cx)
}

/// Numbers of triangles around every chunk or workgroup size a backend is likely to use.
fn triangle_ladder<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 3);
    let grid = unit_grid([10, 19, 7], 10);
    for (i, count) in [1, 63, 64, 65, 255, 256, 257, 1_023, 1_024, 1_025].into_iter().enumerate() {
        let mesh = some_mesh(&mut random, &grid, count);
        let triangles = mesh.triangles()[..count].to_vec();
        let mesh = LatticeMesh::new(mesh.vertices().to_vec(), triangles)?;
        painted(&mut random, mesh, grid, SEPARATIONS[i % 2]).agrees(cx)?;
    }
    Ok(())
}

/// So many that most voxels have several, and one has thousands.
fn many_triangles<B: Backend>(cx: &Context<'_, B>) -> Check {
    let mut random = Random::new(cx.options.seed ^ 4);
    let grid = unit_grid([32; 3], 10);
    let mesh = some_mesh(&mut random, &grid, if cx.full() { 30_000 } else { 10_000 });
    let tiny = |i: i32| [[100 + i % 900, 500, 30], [101 + i % 900, 500, 40], [100 + i % 900, 501, 50]];
    let heap = in_units(&(0..3_000).map(tiny).collect::<Vec<_>>());
    let both = painted(&mut random, mesh.followed_by(&heap)?, grid, THIN);
    let sums = Painted { texels: some_texels(&mut random), ..both }.agreed(cx)?;
    let most = sums.iter().map(|s| s.count).max().unwrap_or(0);
    ensure(most >= 3_000, || format!("at most {most} fragments"))
}
