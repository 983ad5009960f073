//! All roads against the definition in `core`.

use crate::CpuBackend;
use crate::simd::Isa;
use proptest::prelude::*;
use twinlight_core::Backend;
use twinlight_core::kernels::voxelize::{CONSERVATIVE, NO_CUTOFF, THIN, VoxelizeParams};
use twinlight_core::lattice::{LatticeMesh, VoxelGrid, VoxelTriangle};
use twinlight_core::math::morton::morton_code;

/// What [`VoxelTriangle::for_each`] visits, as a mask.
fn wanted(mesh: &LatticeMesh, grid: &VoxelGrid, separation: u32) -> Vec<u32> {
    let mut mask = vec![0; grid.mask_words()];
    for triangle in mesh.triangles() {
        let corners = triangle.map(|v| grid.place(mesh.vertices()[v as usize]));
        VoxelTriangle::new(grid, corners, separation).for_each(|voxel| {
            let code = morton_code(voxel.map(|i| i as u32));
            mask[(code >> 5) as usize] |= 1 << (code & 31);
        });
    }
    mask
}

/// Triangles of a size, around points of the lattice; a few of its corners on a coarse grid.
fn mesh(reach: i16, size: i16) -> impl Strategy<Value = LatticeMesh> {
    let point = prop::array::uniform3(-reach..=reach);
    let triangle = (point, prop::array::uniform3(prop::array::uniform3(-size..=size)), any::<bool>());
    prop::collection::vec(triangle, 1..80).prop_map(move |triangles| {
        let corner = |centre: [i16; 3], step: [i16; 3], coarse: bool| {
            let p = [0, 1, 2].map(|i| centre[i].saturating_add(step[i]).clamp(-reach, reach));
            if coarse { p.map(|c| c / 64 * 64) } else { p }
        };
        let corners =
            triangles.iter().flat_map(|&(centre, steps, coarse)| steps.map(|s| corner(centre, s, coarse)));
        let vertices: Vec<_> = corners.collect();
        let triangles = (0..triangles.len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
        LatticeMesh::new(vertices, triangles).expect("in reach")
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn all_roads_meet_the_same_voxels(
        mesh in prop_oneof![mesh(18_000, 150), mesh(18_000, 2_000), mesh(18_000, 20_000), mesh(300, 300)],
        resolution in prop_oneof![1_u32..=16, 100_u32..=140, 256_u32..=300],
        reach in prop_oneof![Just(300_i16), Just(18_000)],
        separation in THIN..=CONSERVATIVE,
    ) {
        let grid = VoxelGrid::over([-reach; 3], [reach, reach, reach / 2], resolution).unwrap();
        let wanted = wanted(&mesh, &grid, separation);
        for isa in Isa::ALL {
            let backend = CpuBackend::new().with_isa(isa);
            let resident = backend.upload_mesh(&mesh).unwrap();
            for cutoff in [0, 3, 64, NO_CUTOFF] {
                let params = VoxelizeParams { separation, cutoff };
                let voxels = backend.voxelize(&resident, &grid, &params).unwrap();
                prop_assert_eq!(voxels.mask.as_slice(), &wanted[..]);
            }
        }
    }
}
