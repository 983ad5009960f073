// kernel family: reduce_mips
// contract core/src/kernels/reduce_mips.rs
// cpu backend-cpu/src/kernels/reduce_mips.rs
// gpu backend-gpu/src/kernels/reduce_mips.wgsl
// oracle conformance/src/oracle/reduce_mips.rs
//! Cases and laws of `reduce_mips`. Voxels are made up, so that a wrong level is this kernel's own, and values are made of the oracle's
//! levels. Everything is compared exactly.

mod cases;
mod foreign;
mod hard;
pub(crate) mod inputs;
mod laws;

use crate::compare::{Shape, exact};
use crate::oracle::reduce_mips::{Levels, levels, reduce};
use crate::trial::{Check, Context, Failure, Listing, ensure};
use inputs::Field;
use twinlight_core::Backend;
use twinlight_core::kernels::reduce_mips::{
    ANISOTROPIC, HARMONICS, HARMONICS_8, ISOTROPIC, RANGES, ReduceMipsParams, SUMS, VoxelLevelBuffers,
    VoxelLevels, VoxelLight,
};
use twinlight_core::kernels::voxelize::{VoxelBuffers, Voxels};
use twinlight_core::lattice::VoxelGrid;

/// Lists the trials.
pub fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    cases::list(list);
    hard::list(list);
    laws::list(list);
    foreign::list(list);
}

type Checked<T> = Result<T, Failure>;

/// Every storage by its name.
const STORAGES: [(u32, &str); 6] = [
    (ISOTROPIC, "isotropic"),
    (ANISOTROPIC, "anisotropic"),
    (HARMONICS, "harmonics"),
    (HARMONICS_8, "harmonics in bytes"),
    (SUMS, "sums"),
    (RANGES, "ranges"),
];

/// A field on a device, with what the oracle makes of its mask.
struct Resident<'a, B: Backend> {
    field: &'a Field,
    want: Levels,
    voxels: Voxels<B>,
    levels: VoxelLevels<B>,
    leaves: B::Buffer<VoxelLight>,
}

impl<'a, B: Backend> Resident<'a, B> {
    fn new(cx: &Context<'_, B>, field: &'a Field) -> Checked<Self> {
        let want = levels(field.grid.padded(), &field.codes());
        let voxels = uploaded_voxels(cx, field, &want)?;
        let levels = uploaded(cx, field.grid, &want)?;
        let leaves = cx.backend.upload(&field.lights())?;
        Ok(Self { field, want, voxels, levels, leaves })
    }

    /// The levels that the backend makes of the voxels.
    fn levels_agree(&self, cx: &Context<'_, B>) -> Check {
        let found = cx.backend.voxel_levels(&self.voxels)?;
        ensure(found.grid == self.field.grid, || format!("{:?} of {:?}", found.grid, self.field.grid))?;
        same_levels(cx, &downloaded(cx, &found)?, &self.want)?;
        let first = |buffer: &B::Buffer<u32>| cx.backend.download(buffer);
        let words = self.field.grid.mask_words();
        exact(cx, "input mask", &first(&self.voxels.mask)?, &self.want.mask[..words], Shape::Line)
    }

    /// The backend's values of a storage.
    fn values(&self, cx: &Context<'_, B>, storage: u32) -> Checked<Vec<u32>> {
        let params = ReduceMipsParams { storage };
        Ok(cx.backend.download(&cx.backend.reduce_mips(&self.levels, &self.leaves, &params)?)?)
    }

    /// Those, which are the oracle's.
    fn agreed(&self, cx: &Context<'_, B>, (storage, name): (u32, &str)) -> Checked<Vec<u32>> {
        let values = self.values(cx, storage)?;
        let want = reduce(self.field.grid.padded(), &self.field.leaves, storage);
        exact(cx, name, &values, &want, Shape::Line)?;
        Ok(values)
    }

    fn inputs_are_kept(&self, cx: &Context<'_, B>) -> Check {
        same_levels(cx, &downloaded(cx, &self.levels)?, &self.want).map_err(|f| f.within("input"))?;
        let kept = cx.backend.download(&self.leaves)? == self.field.lights();
        ensure(kept, || "leaves have changed".into())
    }
}

/// Levels and values of every storage are the oracle's.
fn agrees<B: Backend>(cx: &Context<'_, B>, field: &Field) -> Check {
    let check = || {
        let resident = Resident::new(cx, field)?;
        resident.levels_agree(cx)?;
        for storage in STORAGES {
            resident.agreed(cx, storage)?;
        }
        resident.inputs_are_kept(cx)
    };
    check().map_err(|f: Failure| f.within(&format!("{field:?}")))
}

/// Ranks, codes and the values of every storage that a backend makes of a field's voxels, by name.
pub(crate) fn all_of<B: Backend>(
    cx: &Context<'_, B>,
    field: &Field,
) -> Checked<Vec<(&'static str, Vec<u32>)>> {
    let resident = Resident::new(cx, field)?;
    let levels = cx.backend.voxel_levels(&resident.voxels)?;
    let found = downloaded(cx, &levels)?;
    let mut all = vec![("ranks", found.ranks), ("active", found.active)];
    for (storage, name) in STORAGES {
        let params = ReduceMipsParams { storage };
        let values = cx.backend.reduce_mips(&levels, &resident.leaves, &params)?;
        all.push((name, cx.backend.download(&values)?));
    }
    Ok(all)
}

fn uploaded_voxels<B: Backend>(cx: &Context<'_, B>, field: &Field, want: &Levels) -> Checked<Voxels<B>> {
    let words = field.grid.mask_words();
    let upload = |words: &[u32]| cx.backend.upload(words);
    let first = |level: usize| want.starts[level] as usize;
    let parents = if want.starts.len() > 2 { &want.active[first(1)..first(2)] } else { &[] };
    Ok(VoxelBuffers {
        grid: field.grid,
        small: upload(&[])?,
        large: upload(&[])?,
        mask: upload(&want.mask[..words])?,
        ranks: upload(&want.ranks[..=words])?,
        active: upload(&want.active[..first(1)])?,
        parents: upload(parents)?,
    })
}

fn uploaded<B: Backend>(cx: &Context<'_, B>, grid: VoxelGrid, levels: &Levels) -> Checked<VoxelLevels<B>> {
    Ok(VoxelLevelBuffers {
        grid,
        starts: levels.starts.clone(),
        mask: cx.backend.upload(&levels.mask)?,
        ranks: cx.backend.upload(&levels.ranks)?,
        active: cx.backend.upload(&levels.active)?,
    })
}

fn downloaded<B: Backend>(cx: &Context<'_, B>, levels: &VoxelLevels<B>) -> Checked<Levels> {
    Ok(Levels {
        starts: levels.starts.clone(),
        mask: cx.backend.download(&levels.mask)?,
        ranks: cx.backend.download(&levels.ranks)?,
        active: cx.backend.download(&levels.active)?,
    })
}

fn same_levels<B>(cx: &Context<'_, B>, got: &Levels, want: &Levels) -> Check {
    exact(cx, "mask", &got.mask, &want.mask, Shape::Line)?;
    exact(cx, "ranks", &got.ranks, &want.ranks, Shape::Line)?;
    exact(cx, "active", &got.active, &want.active, Shape::Line)?;
    exact(cx, "starts", &got.starts, &want.starts, Shape::Line)
}
