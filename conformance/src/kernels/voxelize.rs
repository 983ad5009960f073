// kernel family: voxelize
// contract core/src/kernels/voxelize.rs
// cpu backend-cpu/src/kernels/voxelize.rs
// gpu backend-gpu/src/kernels/voxelize.wgsl
// oracle conformance/src/oracle/voxelize.rs
//! Cases and laws of `voxelize`. Everything is compared exactly: classes, bits, ranks and lists.

mod cases;
mod closed;
pub(super) mod foreign;
mod hard;
pub(super) mod inputs;
mod laws;
mod unsnapped;

use crate::compare::{Shape, exact};
use crate::oracle::voxelize::{Occupied, voxelize};
use crate::trial::{Check, Context, Failure, Listing, ensure};
use twinlight_core::Backend;
use twinlight_core::kernels::voxelize::{CONSERVATIVE, NO_CUTOFF, THIN, VoxelizeParams, Voxels};
use twinlight_core::lattice::{LatticeMesh, VoxelGrid};

/// Lists the trials.
pub fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    cases::list(list);
    hard::list(list);
    laws::list(list);
    closed::list(list);
    unsnapped::list(list);
    foreign::list(list);
}

pub(super) type Checked<T> = Result<T, Failure>;

pub(super) const SEPARATIONS: [u32; 2] = [THIN, CONSERVATIVE];

/// All small, all large, and both.
const CUTOFFS: [u32; 4] = [NO_CUTOFF, 0, 1, 64];

/// One call.
#[derive(Debug, Clone)]
pub(super) struct Case {
    pub mesh: LatticeMesh,
    pub grid: VoxelGrid,
    pub params: VoxelizeParams,
}

impl Case {
    /// Every triangle small.
    pub(super) fn new(mesh: LatticeMesh, grid: VoxelGrid, separation: u32) -> Self {
        Self { mesh, grid, params: VoxelizeParams { separation, cutoff: NO_CUTOFF } }
    }

    /// The same voxels in other classes.
    pub(super) fn cut(self, cutoff: u32) -> Self {
        Self { params: VoxelizeParams { cutoff, ..self.params }, ..self }
    }

    /// The backend's voxels.
    pub(super) fn voxels<B: Backend>(&self, cx: &Context<'_, B>) -> Checked<Voxels<B>> {
        let resident = cx.backend.upload_mesh(&self.mesh)?;
        let voxels = cx.backend.voxelize(&resident, &self.grid, &self.params)?;
        ensure(voxels.grid == self.grid, || format!("{voxels:?} of {:?}", self.grid))?;
        Ok(voxels)
    }

    fn found<B: Backend>(&self, cx: &Context<'_, B>) -> Checked<Occupied> {
        downloaded(cx, &self.voxels(cx)?)
    }

    /// The backend's voxels, which are the oracle's.
    fn agreed<B: Backend>(&self, cx: &Context<'_, B>) -> Checked<Occupied> {
        let check = || {
            let found = self.found(cx)?;
            same(cx, &found, &voxelize(&self.mesh, &self.grid, &self.params))?;
            Ok(found)
        };
        check().map_err(|f: Failure| {
            let triangles = self.mesh.triangles().len();
            f.within(&format!("{triangles} triangles, {:?}, {:?}", self.grid, self.params))
        })
    }

    fn agrees<B: Backend>(&self, cx: &Context<'_, B>) -> Check {
        self.agreed(cx).map(|_| ())
    }
}

pub(super) fn downloaded<B: Backend>(cx: &Context<'_, B>, voxels: &Voxels<B>) -> Checked<Occupied> {
    Ok(Occupied {
        small: cx.backend.download(&voxels.small)?,
        large: cx.backend.download(&voxels.large)?,
        mask: cx.backend.download(&voxels.mask)?,
        ranks: cx.backend.download(&voxels.ranks)?,
        active: cx.backend.download(&voxels.active)?,
        parents: cx.backend.download(&voxels.parents)?,
    })
}

fn same<B>(cx: &Context<'_, B>, got: &Occupied, want: &Occupied) -> Check {
    exact(cx, "small", &got.small, &want.small, Shape::Line)?;
    exact(cx, "large", &got.large, &want.large, Shape::Line)?;
    same_voxels(cx, got, want)
}

fn same_voxels<B>(cx: &Context<'_, B>, got: &Occupied, want: &Occupied) -> Check {
    exact(cx, "mask", &got.mask, &want.mask, Shape::Line)?;
    exact(cx, "ranks", &got.ranks, &want.ranks, Shape::Line)?;
    exact(cx, "active", &got.active, &want.active, Shape::Line)?;
    exact(cx, "parents", &got.parents, &want.parents, Shape::Line)
}

/// The grid over a mesh's own bounds.
pub(crate) fn over(mesh: &LatticeMesh, resolution: u32) -> twinlight_core::Result<VoxelGrid> {
    let end = |axis: usize, greatest: bool| {
        let all = mesh.vertices().iter().map(|v| v[axis]);
        if greatest { all.max() } else { all.min() }.unwrap_or(0)
    };
    VoxelGrid::over([0, 1, 2].map(|axis| end(axis, false)), [0, 1, 2].map(|axis| end(axis, true)), resolution)
}
