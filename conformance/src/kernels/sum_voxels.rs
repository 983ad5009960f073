// kernel family: sum_voxels
// contract core/src/kernels/sum_voxels.rs
// cpu backend-cpu/src/kernels/sum_voxels.rs
// gpu backend-gpu/src/kernels/sum_voxels.wgsl
// oracle conformance/src/oracle/sum_voxels.rs
//! Cases and laws of `sum_voxels`. Every sum is compared exactly. Voxels are the backend's own, which `voxelize` answers for.

mod cases;
mod foreign;
mod hard;
mod inputs;
mod laws;

use super::voxelize::{Case, Checked};
use crate::compare::{Shape, exact};
use crate::oracle::sum_voxels::sum_voxels;
use crate::trial::{Check, Context, Failure, Listing};
use inputs::{some_surface, some_texels};
use twinlight_core::Backend;
use twinlight_core::kernels::sum_voxels::{VoxelSums, VoxelSurface};
use twinlight_core::kernels::voxelize::Voxels;
use twinlight_fixtures::random::Random;

/// Lists the trials.
pub fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    cases::list(list);
    hard::list(list);
    laws::list(list);
    foreign::list(list);
}

/// A mesh in a grid, and what its surfaces are.
#[derive(Debug, Clone)]
struct Painted {
    case: Case,
    surfaces: Vec<VoxelSurface>,
    texels: Vec<u32>,
}

impl Painted {
    /// The backend's sums in voxels it found before.
    fn summed_in<B: Backend>(&self, cx: &Context<'_, B>, voxels: &Voxels<B>) -> Checked<Vec<VoxelSums>> {
        Ok(cx.backend.download(&self.buffer(cx, voxels)??)?)
    }

    /// What the backend makes of the call.
    fn buffer<B: Backend>(
        &self,
        cx: &Context<'_, B>,
        voxels: &Voxels<B>,
    ) -> Checked<twinlight_core::Result<B::Buffer<VoxelSums>>> {
        let mesh = cx.backend.upload_mesh(&self.case.mesh)?;
        let surfaces = cx.backend.upload(&self.surfaces)?;
        let texels = cx.backend.upload(&self.texels)?;
        Ok(cx.backend.sum_voxels(&mesh, voxels, &surfaces, &texels, &self.case.params))
    }

    /// The backend's voxels and their sums.
    fn found<B: Backend>(&self, cx: &Context<'_, B>) -> Checked<(Vec<u32>, Vec<VoxelSums>)> {
        let voxels = self.case.voxels(cx)?;
        let sums = self.summed_in(cx, &voxels)?;
        Ok((cx.backend.download(&voxels.active)?, sums))
    }

    /// The backend's sums, which are the oracle's.
    fn agreed<B: Backend>(&self, cx: &Context<'_, B>) -> Checked<Vec<VoxelSums>> {
        let Self { case: Case { mesh, grid, params }, surfaces, texels } = self;
        let check = || {
            let (_, sums) = self.found(cx)?;
            let want = sum_voxels(mesh, grid, params.separation, surfaces, texels);
            exact(cx, "sums", &sums, &want, Shape::Line)?;
            Ok(sums)
        };
        check().map_err(|f: Failure| {
            f.within(&format!("{} triangles, {grid:?}, {params:?}", mesh.triangles().len()))
        })
    }

    fn agrees<B: Backend>(&self, cx: &Context<'_, B>) -> Check {
        self.agreed(cx).map(|_| ())
    }
}

/// As many surfaces, and texels that their textures are in.
pub(crate) fn some_surfaces(count: usize, seed: u64) -> (Vec<VoxelSurface>, Vec<u32>) {
    let mut random = Random::new(seed);
    ((0..count).map(|_| some_surface(&mut random)).collect(), some_texels(&mut random))
}
