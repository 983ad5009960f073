//! What is refused, and voxels, surfaces and texels that don't belong together.

use super::Painted;
use super::inputs::some_painted;
use crate::kernels::voxelize::Checked;
use crate::kernels::voxelize::foreign::{impossible_grids, refused};
use crate::trial::{Check, Context, Listing, ensure, list_trials};
use twinlight_core::Backend;
use twinlight_core::kernels::sum_voxels::{MAX_FRAGMENTS, VoxelSums, VoxelSurface, check_fragments};
use twinlight_core::kernels::voxelize::{VoxelBuffers, Voxels};
use twinlight_core::lattice::VoxelGrid;
use twinlight_fixtures::random::Random;

pub(super) fn list<B: Backend + Sync>(list: &mut Listing<'_, B>) {
    list_trials!(list, "sum_voxels":
        unlike_lengths_are_refused, bad_parameters_are_refused, voxels_of_other_origin, texels_beyond_the_buffer,
    );
}

/// Words that are a backend's voxels, however they came about.
#[derive(Debug, Clone)]
struct Words {
    grid: VoxelGrid,
    mask: Vec<u32>,
    ranks: Vec<u32>,
    active: Vec<u32>,
    small: Vec<u32>,
    large: Vec<u32>,
}

impl Words {
    fn of<B: Backend>(cx: &Context<'_, B>, voxels: &Voxels<B>) -> Checked<Self> {
        Ok(Self {
            grid: voxels.grid,
            mask: cx.backend.download(&voxels.mask)?,
            ranks: cx.backend.download(&voxels.ranks)?,
            active: cx.backend.download(&voxels.active)?,
            small: cx.backend.download(&voxels.small)?,
            large: cx.backend.download(&voxels.large)?,
        })
    }

    fn uploaded<B: Backend>(&self, cx: &Context<'_, B>) -> Checked<Voxels<B>> {
        Ok(VoxelBuffers {
            grid: self.grid,
            small: cx.backend.upload(&self.small)?,
            large: cx.backend.upload(&self.large)?,
            mask: cx.backend.upload(&self.mask)?,
            ranks: cx.backend.upload(&self.ranks)?,
            active: cx.backend.upload(&self.active)?,
            parents: cx.backend.upload(&[])?,
        })
    }
}

fn some<B: Backend>(cx: &Context<'_, B>) -> Checked<(Painted, Words)> {
    let painted = some_painted(cx.options.seed ^ 31, 90, 0);
    let painted = Painted { case: painted.case.cut(4), ..painted };
    let words = Words::of(cx, &painted.case.voxels(cx)?)?;
    Ok((painted, words))
}

/// Words and surfaces that are one too few or too many.
fn unlike_lengths_are_refused<B: Backend>(cx: &Context<'_, B>) -> Check {
    let (painted, words) = some(cx)?;
    let sums = painted.agreed(cx)?;
    let sound = words.uploaded(cx)?;
    for count in [0, painted.surfaces.len() - 1, painted.surfaces.len() + 1] {
        let mut other = painted.clone();
        other.surfaces.resize(count, painted.surfaces[0]);
        refused(other.buffer(cx, &sound)?).map_err(|f| f.within(&format!("{count} surfaces")))?;
    }
    let (mask, ranks) = (words.mask.len(), words.ranks.len());
    for (mask, ranks) in
        [(mask - 1, ranks), (mask + 1, ranks), (mask, mask), (mask, ranks + 1), (0, 0), (0, 1)]
    {
        let mut other = words.clone();
        other.mask.resize(mask, 0);
        other.ranks.resize(ranks, 0);
        let found = painted.buffer(cx, &other.uploaded(cx)?)?;
        refused(found).map_err(|f| f.within(&format!("{mask} words, {ranks} ranks")))?;
    }
    is_as_before(cx, &painted, &sound, &sums)
}

fn bad_parameters_are_refused<B: Backend>(cx: &Context<'_, B>) -> Check {
    let (painted, words) = some(cx)?;
    let sums = painted.agreed(cx)?;
    let sound = words.uploaded(cx)?;
    for separation in [2, u32::MAX] {
        let mut other = painted.clone();
        other.case.params.separation = separation;
        refused(other.buffer(cx, &sound)?).map_err(|f| f.within(&format!("separation {separation}")))?;
    }
    for grid in impossible_grids() {
        let voxels = Words { grid, ..words.clone() }.uploaded(cx)?;
        refused(painted.buffer(cx, &voxels)?).map_err(|f| f.within(&format!("{grid:?}")))?;
    }
    let limits = [check_fragments(MAX_FRAGMENTS).is_ok(), check_fragments(MAX_FRAGMENTS + 1).is_err()];
    ensure(limits == [true; 2], || format!("{limits:?} at the most fragments"))?;
    is_as_before(cx, &painted, &sound, &sums)
}

/// A refused call leaves its inputs and the backend as they were.
fn is_as_before<B: Backend>(
    cx: &Context<'_, B>,
    painted: &Painted,
    voxels: &Voxels<B>,
    want: &[VoxelSums],
) -> Check {
    let sums = painted.summed_in(cx, voxels)?;
    crate::compare::exact(cx, "sums", &sums, want, crate::compare::Shape::Line)
}

/// Some sums, as many as active voxels, or an error.
fn survives<B: Backend>(cx: &Context<'_, B>, painted: &Painted, words: &Words) -> Check {
    match painted.buffer(cx, &words.uploaded(cx)?)? {
        Ok(sums) => {
            let (found, want) = (cx.backend.download(&sums)?.len(), words.active.len());
            ensure(found == want, || format!("{found} sums of {want} active voxels"))
        }
        Err(_) => Ok(()),
    }
}

/// Masks, ranks and lists of another mesh, of none, of all, and of random bits.
fn voxels_of_other_origin<B: Backend>(cx: &Context<'_, B>) -> Check {
    let (painted, words) = some(cx)?;
    let sums = painted.agreed(cx)?;
    let mut random = Random::new(cx.options.seed ^ 32);
    let mut noise = |count: usize| -> Vec<u32> { (0..count).map(|_| random.next_u32()).collect() };
    let (mask, ranks, active) = (words.mask.len(), words.ranks.len(), words.active.len());
    for other in [
        Words { mask: vec![0; mask], ..words.clone() },
        Words { mask: vec![u32::MAX; mask], ..words.clone() },
        Words { mask: noise(mask), ranks: noise(ranks), ..words.clone() },
        Words { ranks: vec![u32::MAX; ranks], ..words.clone() },
        Words { ranks: vec![0; ranks], ..words.clone() },
        Words { active: Vec::new(), ..words.clone() },
        Words { active: noise(active / 2), ..words.clone() },
        Words { active: noise(3 * active), mask: vec![u32::MAX; mask], ..words.clone() },
        Words { small: noise(500), large: noise(500), ..words.clone() },
        Words { small: Vec::new(), large: Vec::new(), ..words.clone() },
        Words { small: vec![0; 2_000], large: vec![u32::MAX; 300], ..words.clone() },
    ] {
        survives(cx, &painted, &other)?;
    }
    is_as_before(cx, &painted, &words.uploaded(cx)?, &sums)
}

/// Textures that begin or end behind the buffer, of which there may be nothing.
fn texels_beyond_the_buffer<B: Backend>(cx: &Context<'_, B>) -> Check {
    let (painted, words) = some(cx)?;
    let sums = painted.agreed(cx)?;
    for (texture, texture_size) in [
        (2_999, 40 | 50 << 16),
        (3_000, 1 | 1 << 16),
        (u32::MAX - 1, 2 | 2 << 16),
        (1 << 31, 65_535 | 65_535 << 16),
    ] {
        let beyond = |s: &VoxelSurface| VoxelSurface { texture, texture_size, ..*s };
        let other = Painted { surfaces: painted.surfaces.iter().map(beyond).collect(), ..painted.clone() };
        survives(cx, &other, &words)?;
    }
    survives(cx, &Painted { texels: Vec::new(), ..painted.clone() }, &words)?;
    is_as_before(cx, &painted, &words.uploaded(cx)?, &sums)
}
