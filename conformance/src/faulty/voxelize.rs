//! Bugs in `voxelize`: the oracle, wrong in one step.

use super::FaultyMesh;
use crate::faults::Fault;
use crate::oracle::voxelize::{Occupied, Placed, Triple, code, is_apart, voxel};
use std::collections::BTreeSet;
use twinlight_core::kernels::voxelize::{CONSERVATIVE, MARGIN, THIN, VoxelBuffers, VoxelizeParams, Voxels};
use twinlight_core::lattice::{LatticeMesh, VoxelGrid};
use twinlight_core::{Backend, Result};

pub(super) fn voxelize<B: Backend>(
    inner: &B,
    fault: Fault,
    mesh: &FaultyMesh<B::Mesh>,
    grid: &VoxelGrid,
    params: &VoxelizeParams,
) -> Result<Voxels<B>> {
    let fit = params.check(grid, mesh.host.triangles().len()).is_ok();
    let occupied = match fault {
        Fault::VoxelAcceptsAnything if !fit => Occupied::default(),
        _ if fault.sits_in("voxelize") && fit => Broken { fault, grid, params, mesh: &mesh.host }.occupied(),
        _ => return inner.voxelize(&mesh.inner, grid, params),
    };
    Ok(VoxelBuffers {
        grid: *grid,
        small: inner.upload(&occupied.small)?,
        large: inner.upload(&occupied.large)?,
        mask: inner.upload(&occupied.mask)?,
        ranks: inner.upload(&occupied.ranks)?,
        active: inner.upload(&occupied.active)?,
        parents: inner.upload(&occupied.parents)?,
    })
}

struct Broken<'a> {
    fault: Fault,
    grid: &'a VoxelGrid,
    params: &'a VoxelizeParams,
    mesh: &'a LatticeMesh,
}

impl Broken<'_> {
    fn occupied(&self) -> Occupied {
        let (mut codes, mut classes) = (BTreeSet::new(), [Vec::new(), Vec::new()]);
        let count = self.mesh.triangles().len();
        for number in 0..count {
            let placed = self.placed(number);
            let large = self.is_large(&placed);
            if let Some(large) = large {
                classes[usize::from(large)].push(number as u32);
            }
            let lost = match self.fault {
                Fault::VoxelLosesLarge => large == Some(true),
                Fault::VoxelLosesLastTriangle => number >= 1_024 && number == count - 1,
                Fault::VoxelUnclamped => self.leaves_box(number),
                _ => false,
            };
            if !lost {
                let met = placed.around(self.grid.dims).filter(|&voxel| self.meets(&placed, voxel, large));
                codes.extend(met.map(|voxel| self.code(voxel)));
            }
        }
        let [small, mut large] = classes;
        if self.fault == Fault::VoxelLargeBackwards {
            large.reverse();
        }
        self.lists(Occupied { small, large, ..Occupied::of_codes(&codes, self.grid) })
    }

    fn placed(&self, number: usize) -> Placed {
        let half = if self.fault == Fault::VoxelRoundsTwice { 1 << 13 } else { 0 };
        let offset = self.grid.offset.map(|o| (o + half).min(1 << 30));
        let mut placed = Placed::of(self.mesh, &VoxelGrid { offset, ..*self.grid }, number);
        let sizes = placed.normal.map(i128::abs);
        if self.fault == Fault::VoxelDominantLast {
            placed.dominant = (0..3).rfind(|&axis| sizes[axis] == sizes[placed.dominant]).unwrap_or(0);
        }
        if self.fault == Fault::VoxelAlongZ && sizes[2] > 0 {
            placed.dominant = 2;
        }
        placed
    }

    fn leaves_box(&self, number: usize) -> bool {
        let place = |v: u32, axis: usize| {
            let point = i64::from(self.mesh.vertices()[v as usize][axis]);
            (i64::from(self.grid.scale) * point + i64::from(self.grid.offset[axis])) >> 14
        };
        let inside = |v: u32| {
            (0..3).all(|axis| {
                (0..i64::from(self.grid.dims[axis]) << self.grid.subvoxel_bits).contains(&place(v, axis))
            })
        };
        !self.mesh.triangles()[number].iter().all(|&v| inside(v))
    }

    /// Whether a triangle is large, if it has a class.
    fn is_large(&self, placed: &Placed) -> Option<bool> {
        let is_empty = self.params.separation == THIN && placed.normal == [0; 3];
        if is_empty && self.fault != Fault::VoxelClassesEmpty {
            return None;
        }
        let cells = match self.fault {
            Fault::VoxelCellsOfBounds => {
                (0..3).map(|axis| placed.span(axis)[1] - placed.span(axis)[0] + 1).product()
            }
            _ => placed.cells(self.grid.dims, self.params.separation),
        };
        let cutoff = i128::from(self.params.cutoff);
        Some(if self.fault == Fault::VoxelCutoffOff { cells >= cutoff } else { cells > cutoff })
    }

    fn meets(&self, placed: &Placed, voxel: Triple, large: Option<bool>) -> bool {
        let is_last = |axis: usize| voxel[axis] == i128::from(self.grid.dims[axis]) - 1;
        let row = (placed.dominant + 2) % 3;
        let conservative = match self.fault {
            Fault::VoxelLosesLast if self.grid.dims[0] > 1 && is_last(0) => return false,
            Fault::VoxelLosesRow if large == Some(true) && voxel[row] == placed.span(row)[1] => return false,
            Fault::VoxelAlwaysThin => false,
            Fault::VoxelAlwaysConservative => true,
            _ => self.params.separation == CONSERVATIVE,
        };
        if conservative { self.touches(placed, voxel) } else { self.separates(placed, voxel) }
    }

    fn separates(&self, placed: &Placed, voxel: Triple) -> bool {
        placed.normal != [0; 3]
            && placed.spans(voxel)
            && self.is_at_height(placed, voxel)
            && (0..3).all(|axis| self.is_within_edges(placed, axis, voxel))
    }

    fn is_at_height(&self, placed: &Placed, voxel: Triple) -> bool {
        let at = match self.fault {
            Fault::VoxelHeightsOnEdges => voxel.map(|i| i * placed.width),
            _ => placed.centre(voxel),
        };
        let [height, unit] = placed.height(at);
        let low = voxel[placed.dominant] * placed.width * unit;
        let high = low + placed.width * unit;
        match self.fault {
            Fault::VoxelDepthClosed => low <= height && height <= high,
            Fault::VoxelDepthUpper => low < height && height <= high,
            _ => low <= height && height < high,
        }
    }

    fn is_within_edges(&self, placed: &Placed, axis: usize, voxel: Triple) -> bool {
        let of = match self.fault {
            Fault::VoxelNoEdges => return true,
            Fault::VoxelDominantEdges if axis != placed.dominant => return true,
            Fault::VoxelOtherEdges if axis == 0 => 1,
            _ => axis,
        };
        placed.edges(of, placed.centre(voxel)).iter().all(|&[dx, dy, e]| {
            let [dx, dy] = [dx.abs(), dy.abs()];
            let e = match self.fault {
                Fault::VoxelTurned => e * if placed.normal[of] < 0 { -1 } else { 1 },
                Fault::VoxelEdgeWraps => wrapped(e, 30),
                Fault::VoxelEdgeWrapsEarly => wrapped(e, 17),
                _ => e,
            };
            let reach = match self.fault {
                Fault::VoxelNarrowEdges => dx.min(dy),
                Fault::VoxelSharpEdges => 0,
                Fault::VoxelWideEdges => dx + dy,
                _ => dx.max(dy),
            };
            2 * e + placed.width * reach >= 0
        })
    }

    fn touches(&self, placed: &Placed, voxel: Triple) -> bool {
        let centre = placed.centre(voxel);
        let corners = placed.corners.map(|corner| [0, 1, 2].map(|i| corner[i] - centre[i]));
        let margin = match self.fault {
            Fault::VoxelNoMargin => 0,
            Fault::VoxelWideMargin => 2,
            _ => i128::from(MARGIN),
        };
        let half = placed.width / 2 + margin;
        let flat = placed.normal == [0; 3];
        placed.axes.iter().enumerate().all(|(i, &axis)| match self.fault {
            Fault::VoxelNoPlane if i == 0 => true,
            Fault::VoxelNoProducts if i > 3 => true,
            Fault::VoxelLosesSegments if flat => false,
            Fault::VoxelOneSided => {
                let reach = half * axis.iter().map(|a| a.abs()).sum::<i128>();
                corners.iter().any(|c| (0..3).map(|i| c[i] * axis[i]).sum::<i128>() <= reach)
            }
            // Open cubes: those a little smaller.
            Fault::VoxelOpenCubes => {
                let [corners, axis] = [corners.map(|c| c.map(|x| 2 * x)), [axis; 3]];
                !is_apart(corners, axis[0], 2 * half - 1)
            }
            _ => !is_apart(corners, axis, half),
        })
    }

    fn code(&self, [x, y, z]: Triple) -> u32 {
        code(if self.fault == Fault::VoxelSwapsAxes { [y, x, z] } else { [x, y, z] })
    }

    /// What follows from what is met.
    fn lists(&self, mut occupied: Occupied) -> Occupied {
        match self.fault {
            Fault::VoxelParentTwice => {
                let twice = occupied.parents.first().copied();
                occupied.parents.splice(0..0, twice);
            }
            Fault::VoxelActiveByRows => occupied.active.sort_by_key(|&code| {
                let [x, y, z] = voxel(code);
                [z, y, x]
            }),
            Fault::VoxelActiveLosesLast => occupied.active.truncate(occupied.active.len().saturating_sub(1)),
            Fault::VoxelMirrorsBits => {
                occupied.mask.iter_mut().for_each(|word| *word = word.reverse_bits());
            }
            Fault::VoxelRanksInclusive => {
                occupied.ranks.remove(0);
                occupied.ranks.extend(occupied.ranks.last().copied());
            }
            Fault::VoxelRanksWithoutTotal => {
                occupied.ranks.pop();
                occupied.ranks.push(0);
            }
            _ => {}
        }
        occupied
    }
}

/// A number in so many bits, the highest of which is its sign.
fn wrapped(e: i128, bits: u32) -> i128 {
    let half = 1 << (bits - 1);
    (e + half).rem_euclid(2 * half) - half
}
