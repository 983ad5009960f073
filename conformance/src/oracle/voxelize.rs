// kernel family: voxelize
// contract core/src/kernels/voxelize.rs
// cpu backend-cpu/src/kernels/voxelize.rs
// gpu backend-gpu/src/kernels/voxelize.wgsl
// oracle conformance/src/oracle/voxelize.rs
//! Oracle of `voxelize`: every voxel of a triangle's bounds and one more to all sides is tried, in 128 bits, where nothing can overflow.
//! Heights are fractions, bits go into codes one by one, and both sides of all 13 axes are compared. Places in the grid are computed
//! anew from their documentation.

use std::collections::BTreeSet;
use twinlight_core::kernels::voxelize::{CONSERVATIVE, MARGIN, THIN, VoxelizeParams};
use twinlight_core::lattice::{LatticeMesh, VoxelGrid};

/// Numbers of a voxel, or coordinates, per axis.
pub type Triple = [i128; 3];

/// What is met, on the host.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Occupied {
    /// As [`twinlight_core::kernels::voxelize::VoxelBuffers::small`].
    pub small: Vec<u32>,
    /// As [`twinlight_core::kernels::voxelize::VoxelBuffers::large`].
    pub large: Vec<u32>,
    /// As [`twinlight_core::kernels::voxelize::VoxelBuffers::mask`].
    pub mask: Vec<u32>,
    /// As [`twinlight_core::kernels::voxelize::VoxelBuffers::ranks`].
    pub ranks: Vec<u32>,
    /// As [`twinlight_core::kernels::voxelize::VoxelBuffers::active`].
    pub active: Vec<u32>,
    /// As [`twinlight_core::kernels::voxelize::VoxelBuffers::parents`].
    pub parents: Vec<u32>,
}

impl Occupied {
    /// What follows from the codes of met voxels; no classes.
    pub fn of_codes(codes: &BTreeSet<u32>, grid: &VoxelGrid) -> Self {
        let mut side = 1_usize;
        while grid.dims.iter().any(|&n| n as usize > side) {
            side *= 2;
        }
        let mut mask = vec![0_u32; (side * side * side).div_ceil(32)];
        for &code in codes {
            mask[code as usize / 32] |= 1 << (code % 32);
        }
        let mut ranks = vec![0];
        for word in &mask {
            ranks.push(ranks[ranks.len() - 1] + word.count_ones());
        }
        let parents: BTreeSet<u32> = codes.iter().map(|code| code / 8).collect();
        Self {
            mask,
            ranks,
            active: codes.iter().copied().collect(),
            parents: parents.into_iter().collect(),
            ..Self::default()
        }
    }
}

/// What the contract promises for sound parameters.
pub fn voxelize(mesh: &LatticeMesh, grid: &VoxelGrid, params: &VoxelizeParams) -> Occupied {
    let mut codes = BTreeSet::new();
    each_fragment(mesh, grid, params.separation, |_, _, voxel| {
        codes.insert(code(voxel));
    });
    let mut occupied = Occupied::of_codes(&codes, grid);
    for number in 0..mesh.triangles().len() {
        let placed = Placed::of(mesh, grid, number);
        if params.separation == THIN && placed.normal == [0; 3] {
            continue;
        }
        let small = placed.cells(grid.dims, params.separation) <= i128::from(params.cutoff);
        let class = if small { &mut occupied.small } else { &mut occupied.large };
        class.push(number as u32);
    }
    occupied
}

/// Calls `visit` with every triangle, its number first, and every voxel that it meets.
pub fn each_fragment(
    mesh: &LatticeMesh,
    grid: &VoxelGrid,
    separation: u32,
    mut visit: impl FnMut(usize, &Placed, Triple),
) {
    for number in 0..mesh.triangles().len() {
        let placed = Placed::of(mesh, grid, number);
        for voxel in placed.around(grid.dims) {
            if placed.meets(voxel, separation) {
                visit(number, &placed, voxel);
            }
        }
    }
}

/// The code of a voxel of fewer than 2¹⁰ to an axis.
pub fn code(voxel: Triple) -> u32 {
    let mut code = 0;
    for bit in 0..10 {
        for (axis, number) in voxel.iter().enumerate() {
            if number / (1 << bit) % 2 == 1 {
                code += 1 << (3 * bit + axis);
            }
        }
    }
    code
}

/// The voxel of a code.
pub fn voxel(code: u32) -> Triple {
    let mut voxel = [0; 3];
    for bit in 0..30 {
        if code / (1 << bit) % 2 == 1 {
            voxel[bit % 3] += 1 << (bit / 3);
        }
    }
    voxel
}

/// Grid coordinates of a lattice point.
pub fn place(grid: &VoxelGrid, point: [i16; 3]) -> Triple {
    [0, 1, 2].map(|axis| {
        let sum = i128::from(grid.scale) * i128::from(point[axis]) + i128::from(grid.offset[axis]);
        let last = i128::from(grid.dims[axis]) * 2_i128.pow(grid.subvoxel_bits) - 1;
        sum.div_euclid(2_i128.pow(14)).max(0).min(last)
    })
}

/// A triangle in units of which a voxel has `width` to a side.
#[derive(Debug, Clone, Copy)]
pub struct Placed {
    /// Coordinates.
    pub corners: [Triple; 3],
    /// v of the contract, an even number.
    pub width: i128,
    /// n of the contract.
    pub normal: Triple,
    /// The dominant axis.
    pub dominant: usize,
    /// The axes that can separate a triangle from a cube.
    pub axes: [Triple; 13],
}

impl Placed {
    /// The triangle of that number.
    pub fn of(mesh: &LatticeMesh, grid: &VoxelGrid, number: usize) -> Self {
        let corner = |v: u32| place(grid, mesh.vertices()[v as usize]);
        Self::new(mesh.triangles()[number].map(corner), 2_i128.pow(grid.subvoxel_bits))
    }

    /// A triangle of these corners.
    pub fn new(corners: [Triple; 3], width: i128) -> Self {
        let [p, q, r] = corners;
        let normal = cross(minus(q, p), minus(r, p));
        let is_greatest = |axis: &usize| normal.iter().all(|n| n.abs() <= normal[*axis].abs());
        let dominant = (0..3).find(is_greatest).unwrap_or(0);
        let mut axes = [normal; 13];
        for (i, unit) in [[1, 0, 0], [0, 1, 0], [0, 0, 1]].into_iter().enumerate() {
            axes[1 + i] = unit;
            for (j, edge) in [minus(q, p), minus(r, q), minus(p, r)].into_iter().enumerate() {
                axes[4 + 3 * i + j] = cross(edge, unit);
            }
        }
        Self { corners, width, normal, dominant, axes }
    }

    /// The first and the last voxel of an axis that hold a part of the triangle.
    pub fn span(&self, axis: usize) -> [i128; 2] {
        let of = self.corners.map(|corner| corner[axis].div_euclid(self.width));
        [of[0].min(of[1]).min(of[2]), of[0].max(of[1]).max(of[2])]
    }

    /// Cells of the bounds in the projection along the dominant axis.
    pub fn cells(&self, dims: [u32; 3], separation: u32) -> i128 {
        let wide = |axis: usize| {
            let [first, last] = self.span(axis);
            if separation == THIN {
                return last - first + 1;
            }
            let of = self.corners.map(|corner| corner[axis]);
            let [low, high] = [of[0].min(of[1]).min(of[2]), of[0].max(of[1]).max(of[2])];
            let margin = i128::from(MARGIN);
            let reaches = |i: &i128| i * self.width - margin <= high && (i + 1) * self.width + margin >= low;
            (0..i128::from(dims[axis])).filter(reaches).count() as i128
        };
        wide((self.dominant + 1) % 3) * wide((self.dominant + 2) % 3)
    }

    /// The voxels of the bounds, and one more to all sides, as far as there are any.
    pub fn around(&self, dims: [u32; 3]) -> impl Iterator<Item = Triple> + use<> {
        let ranges = [0, 1, 2].map(|axis| {
            let [first, last] = self.span(axis);
            (first - 1).max(0)..=(last + 1).min(i128::from(dims[axis]) - 1)
        });
        let [xs, ys, zs] = ranges;
        zs.flat_map(move |z| {
            let xs = xs.clone();
            ys.clone().flat_map(move |y| xs.clone().map(move |x| [x, y, z]))
        })
    }

    /// The middle of a voxel.
    pub fn centre(&self, voxel: Triple) -> Triple {
        voxel.map(|i| i * self.width + self.width / 2)
    }

    /// Of the projection along an axis, per edge: dx, dy and E at a point.
    pub fn edges(&self, axis: usize, at: Triple) -> [Triple; 3] {
        let (b, c) = ((axis + 1) % 3, (axis + 2) % 3);
        let sign = if self.normal[axis] < 0 { -1 } else { 1 };
        [(0, 1), (1, 2), (2, 0)].map(|(from, to)| {
            let (p, q) = (self.corners[from], self.corners[to]);
            let (dx, dy) = (q[b] - p[b], q[c] - p[c]);
            [dx, dy, sign * (dx * (at[c] - p[c]) - dy * (at[b] - p[b]))]
        })
    }

    /// Where the plane is on the line along its dominant axis through a point: the height's numerator and its denominator, which is
    /// positive. Not for triangles without area.
    pub fn height(&self, at: Triple) -> [i128; 2] {
        let (n, axis) = (self.normal, self.dominant);
        let rest: i128 = (0..3).filter(|&i| i != axis).map(|i| n[i] * at[i]).sum();
        let numerator = dot(n, self.corners[0]) - rest;
        [numerator * n[axis].signum(), n[axis].abs()]
    }

    /// Whether the voxel is met.
    pub fn meets(&self, voxel: Triple, separation: u32) -> bool {
        if separation == CONSERVATIVE {
            self.touches(voxel, i128::from(MARGIN))
        } else {
            self.separates(voxel)
        }
    }

    /// Whether a thin surface needs the voxel.
    pub fn separates(&self, voxel: Triple) -> bool {
        self.normal != [0; 3]
            && self.spans(voxel)
            && self.is_at_height(voxel)
            && (0..3).all(|axis| self.is_within_edges(axis, voxel))
    }

    /// Whether the bounds reach into the voxel.
    pub fn spans(&self, voxel: Triple) -> bool {
        (0..3).all(|axis| (self.span(axis)[0]..=self.span(axis)[1]).contains(&voxel[axis]))
    }

    /// Whether the plane crosses the voxel's part of the line through its centre.
    pub fn is_at_height(&self, voxel: Triple) -> bool {
        let [height, unit] = self.height(self.centre(voxel));
        let low = voxel[self.dominant] * self.width;
        low * unit <= height && height < (low + self.width) * unit
    }

    /// Whether the centre is inside of all edges of a projection, or not too far outside.
    pub fn is_within_edges(&self, axis: usize, voxel: Triple) -> bool {
        let reach = |dx: i128, dy: i128| self.width * dx.abs().max(dy.abs());
        self.edges(axis, self.centre(voxel)).iter().all(|&[dx, dy, e]| 2 * e + reach(dx, dy) >= 0)
    }

    /// Whether the triangle has a point in common with the voxel's closed cube, enlarged by `margin`.
    pub fn touches(&self, voxel: Triple, margin: i128) -> bool {
        let centre = self.centre(voxel);
        let corners = self.corners.map(|corner| minus(corner, centre));
        let half = self.width / 2 + margin;
        !self.axes.iter().any(|&axis| is_apart(corners, axis, half))
    }
}

/// Whether all corners are on one side of a cube around the origin, seen along an axis.
pub fn is_apart(corners: [Triple; 3], axis: Triple, half: i128) -> bool {
    let at = corners.map(|corner| dot(axis, corner));
    let reach = half * axis.iter().map(|a| a.abs()).sum::<i128>();
    at.iter().all(|&a| a > reach) || at.iter().all(|&a| a < -reach)
}

fn minus(a: Triple, b: Triple) -> Triple {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: Triple, b: Triple) -> i128 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Triple, b: Triple) -> Triple {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[cfg(test)]
mod tests;
