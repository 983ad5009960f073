//! Bugs in `sum_voxels`: the oracle, wrong in one step.

use super::FaultyMesh;
use crate::faults::Fault;
use crate::oracle::sum_voxels::{
    Sums, WHITE, WHOLE, colour, component, fragment, rgb, texel_number, texture_size, weights,
};
use crate::oracle::voxelize::{Placed, Triple, code, each_fragment};
use std::collections::BTreeMap;
use twinlight_core::kernels::sum_voxels::{CLAMP, NONE, VoxelSums, VoxelSurface};
use twinlight_core::kernels::voxelize::{THIN, VoxelizeParams, Voxels};
use twinlight_core::lattice::{LatticeMesh, VoxelGrid};
use twinlight_core::{Backend, Error, Result};

pub(super) fn sum_voxels<B: Backend>(
    inner: &B,
    fault: Fault,
    mesh: &FaultyMesh<B::Mesh>,
    voxels: &Voxels<B>,
    surfaces: &B::Buffer<VoxelSurface>,
    texels: &B::Buffer<u32>,
    params: &VoxelizeParams,
) -> Result<B::Buffer<VoxelSums>> {
    let sound = inner.sum_voxels(&mesh.inner, voxels, surfaces, texels, params);
    match (&sound, fault) {
        (Err(Error::InvalidInput { .. }), Fault::SumAcceptsAnything)
        | (Err(Error::LimitExceeded { .. }), Fault::SumAcceptsOverflow) => {
            return inner.zeroed(inner.len(&voxels.active));
        }
        (Ok(_), _) if fault.sits_in("sum_voxels") && fault != Fault::SumAcceptsOverflow => {}
        _ => return sound,
    }
    let (surfaces, texels) = (inner.download(surfaces)?, inner.download(texels)?);
    let broken = Broken { fault, mesh: &mesh.host, grid: &voxels.grid, params, surfaces, texels };
    let active = inner.download(&voxels.active)?;
    // Bugs must show in sound calls: those with voxels or texels of other origin are left to the sound backend.
    match broken.is_sound(&active) {
        true => inner.upload(&broken.sums(&active)),
        false => sound,
    }
}

struct Broken<'a> {
    fault: Fault,
    mesh: &'a LatticeMesh,
    grid: &'a VoxelGrid,
    params: &'a VoxelizeParams,
    surfaces: Vec<VoxelSurface>,
    texels: Vec<u32>,
}

impl Broken<'_> {
    fn is_sound(&self, active: &[u32]) -> bool {
        let fits = |s: &VoxelSurface| {
            let [width, height] = texture_size(s);
            s.texture == NONE || i128::from(s.texture) + width * height <= self.texels.len() as i128
        };
        let mut met = BTreeMap::new();
        each_fragment(self.mesh, self.grid, self.params.separation, |_, _, voxel| {
            met.insert(code(voxel), ());
        });
        self.surfaces.iter().all(fits) && active.iter().eq(met.keys())
    }

    fn sums(&self, active: &[u32]) -> Vec<VoxelSums> {
        let mut sums: BTreeMap<u32, Sums> = BTreeMap::new();
        let separation = if self.fault == Fault::SumThin { THIN } else { self.params.separation };
        each_fragment(self.mesh, self.grid, separation, |number, placed, voxel| {
            let weights = self.weights(placed, placed.centre(voxel));
            let fragment = self.fragment(&self.surfaces[number], weights);
            let sums = sums.entry(code(voxel)).or_default();
            match self.fault {
                Fault::SumLastFragment => *sums = fragment,
                Fault::SumEmissionOnce if sums.count > 0 => sums.add(&Sums { emission: [0; 3], ..fragment }),
                _ => sums.add(&fragment),
            }
            let cells = placed.cells(self.grid.dims, self.params.separation);
            if self.fault == Fault::SumDoublesLarge && cells > i128::from(self.params.cutoff) {
                sums.add(&fragment);
            }
        });
        let records = active.iter().map(|code| self.record(sums.get(code).copied().unwrap_or_default()));
        let mut records: Vec<VoxelSums> = records.collect();
        if self.fault == Fault::SumLosesLast && records.len() > 64 {
            records.last_mut().into_iter().for_each(|last| *last = VoxelSums::default());
        }
        records
    }

    fn record(&self, mut sums: Sums) -> VoxelSums {
        match self.fault {
            Fault::SumCountSaturates => sums.count = sums.count.min(65_535),
            Fault::SumAverages => {
                let count = sums.count.max(1);
                sums.albedo = sums.albedo.map(|a| a / count);
                sums.normal = sums.normal.map(|n| n / count);
            }
            _ => {}
        }
        let padding = if self.fault == Fault::SumPadding { sums.count as u32 } else { 0 };
        VoxelSums { padding, ..sums.record() }
    }

    fn weights(&self, placed: &Placed, centre: Triple) -> Triple {
        let axis = if self.fault == Fault::SumAlongZ { 2 } else { placed.dominant };
        let weighed = |kept: u32| {
            let signed = self.fault == Fault::SumNegativeWeights;
            let [of_2, of_0, of_1] =
                placed.edges(axis, centre).map(|[_, _, e]| if signed { e } else { e.max(0) });
            let areas = [of_0, of_1, of_2];
            let mut unit = 1;
            while areas.iter().sum::<i128>() / unit >= 1 << kept {
                unit *= 2;
            }
            let areas = areas.map(|a| a.div_euclid(unit));
            (areas, areas.iter().sum::<i128>().max(1))
        };
        let whole_less = |a: i128, b: i128| WHOLE - a - b;
        match self.fault {
            Fault::SumNoAreaUnweighed if placed.normal == [0; 3] => [WHOLE, 0, 0],
            Fault::SumAlongZ | Fault::SumNegativeWeights => rest_first(weighed(17)),
            Fault::SumShortWeights => rest_first(weighed(16)),
            Fault::SumLongWeights => rest_first(weighed(18)),
            Fault::SumRoundsWeights => {
                let (areas, whole) = weighed(17);
                let [w1, w2] = [areas[1], areas[2]].map(|a| (2 * WHOLE * a + whole) / (2 * whole));
                [whole_less(w1, w2), w1, w2]
            }
            Fault::SumRestToLast => {
                let (areas, whole) = weighed(17);
                let [w0, w1] = [areas[0], areas[1]].map(|a| WHOLE * a / whole);
                [w0, w1, whole_less(w0, w1)]
            }
            Fault::SumTurnsCorners => {
                let [w0, w1, w2] = weights(placed, centre);
                [w2, w0, w1]
            }
            _ => weights(placed, centre),
        }
    }

    fn fragment(&self, surface: &VoxelSurface, weights: Triple) -> Sums {
        let mut surface = *surface;
        match self.fault {
            Fault::SumWraps => surface.flags &= !CLAMP,
            Fault::SumClamps => surface.flags |= CLAMP,
            Fault::SumFirstCorner => surface.normals = [surface.normals[0]; 3],
            _ => {}
        }
        let sound = fragment(&surface, weights, &self.texels);
        let texel = self.texel(&surface, weights);
        let tint = if self.fault == Fault::SumIgnoresTint { [4095; 3] } else { colour(surface.tint) };
        let albedo = [0, 1, 2].map(|c| match self.fault {
            Fault::SumAlbedoDown => tint[c] * texel[c] / WHITE,
            Fault::SumWhiteIs1024 => (tint[c] * texel[c] + 512) / 1024,
            _ => (tint[c] * texel[c] + 511) / WHITE,
        });
        let normal = [0, 1, 2].map(|axis| {
            let unsigned = self.fault == Fault::SumUnsignedNormals;
            let of = |i: usize| component(surface.normals[i], axis) & if unsigned { 255 } else { -1 };
            let sum: i128 = (0..3).map(|i| weights[i] * of(i)).sum();
            match self.fault {
                Fault::SumNormalsDown => sum.div_euclid(WHOLE),
                Fault::SumNormalsToZero => sum / WHOLE,
                Fault::SumUnsignedNormals => (sum + WHOLE / 2).div_euclid(WHOLE),
                _ => sound.normal[axis],
            }
        });
        Sums { albedo, normal, ..sound }
    }

    fn texel(&self, surface: &VoxelSurface, weights: Triple) -> Triple {
        let Some(number) = texel_number(surface, weights) else {
            return if self.fault == Fault::SumUntexturedIsBlack { [0; 3] } else { [WHITE; 3] };
        };
        let [width, height] = texture_size(surface);
        let first = i128::from(surface.texture);
        let place = number as i128 - first;
        let moved = |by: i128| {
            let moved = surface.texcoords.map(|t| t.map(|c| c + by as i32));
            texel_number(&VoxelSurface { texcoords: moved, ..*surface }, weights).unwrap_or(0) as i128
        };
        let number = match self.fault {
            Fault::SumTransposesTexels => first + place % width * height + place / width,
            Fault::SumFirstTexture => place,
            Fault::SumRoundsTexels => moved(32),
            Fault::SumTexelsUp => moved(63),
            _ => number as i128,
        };
        let [r, g, b] = rgb(self.texels.get(number as usize).copied().unwrap_or(0));
        if self.fault == Fault::SumSwapsChannels { [b, g, r] } else { [r, g, b] }
    }
}

/// Weights of areas; the first corner has what rounding leaves.
fn rest_first((areas, whole): (Triple, i128)) -> Triple {
    let [w1, w2] = [areas[1], areas[2]].map(|a| (WHOLE * a).div_euclid(whole));
    [WHOLE - w1 - w2, w1, w2]
}
