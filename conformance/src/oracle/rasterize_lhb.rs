// kernel family: rasterize_lhb
// contract core/src/kernels/rasterize_lhb.rs
// cpu backend-cpu/src/kernels/rasterize_lhb.rs
// gpu backend-gpu/src/kernels/rasterize_lhb.wgsl
// oracle conformance/src/oracle/rasterize_lhb.rs
//! Oracle of `rasterize_lhb`: every pixel of every triangle's bounds, one after the other, in 128 bits, where nothing can
//! overflow. The lattice's arithmetic is done anew from its documentation.
//!
//! Depth has two oracles: the contract's formula ([`Shown::depth`]) and the exact plane ([`Shown::is_near_plane`]), which
//! knows no anchor, no gradient and no order of roundings.

use twinlight_core::kernels::rasterize_lhb::{CAP_NEAR, LhbElement, RasterizeLhbParams};
use twinlight_core::lattice::{LatticeMesh, View};

/// What depths are counted from.
const ORIGIN: i128 = 1 << 29;

/// Lists on the host.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Lists {
    /// As [`twinlight_core::kernels::rasterize_lhb::Lhb::offsets`].
    pub offsets: Vec<u32>,
    /// As [`twinlight_core::kernels::rasterize_lhb::Lhb::elements`].
    pub elements: Vec<LhbElement>,
    /// As [`twinlight_core::kernels::rasterize_lhb::Lhb::left_out`].
    pub left_out: Vec<u32>,
}

impl Lists {
    /// The lists, one after the other.
    pub fn each(&self) -> impl Iterator<Item = &[LhbElement]> {
        self.offsets.windows(2).map(|w| &self.elements[w[0] as usize..w[1] as usize])
    }

    /// One list after the other; nothing left out.
    pub fn of<'a>(lists: impl IntoIterator<Item = &'a [LhbElement]>) -> Self {
        let mut joined = Self { offsets: vec![0], ..Self::default() };
        for list in lists {
            joined.elements.extend_from_slice(list);
            joined.offsets.push(joined.elements.len() as u32);
        }
        joined
    }

    /// What a cap makes of whole lists.
    pub fn capped(&self, params: &RasterizeLhbParams) -> Self {
        if params.layer_cap == 0 {
            return self.clone();
        }
        let kept = |list: &[LhbElement]| list.len().min(params.layer_cap as usize);
        let left_out = self.each().map(|list| (list.len() - kept(list)) as u32).collect();
        let near = params.cap_side == CAP_NEAR;
        let cut =
            self.each().map(|list| if near { &list[..kept(list)] } else { &list[list.len() - kept(list)..] });
        Self { left_out, ..Self::of(cut) }
    }
}

/// What the contract promises for sound parameters.
pub fn rasterize(mesh: &LatticeMesh, views: &[View], params: &RasterizeLhbParams) -> Lists {
    let size = params.size as usize;
    let mut lists = vec![Vec::new(); views.len() * size * size];
    for (v, view) in views.iter().enumerate() {
        for triangle in 0..mesh.triangles().len() {
            let Some(shown) = Shown::new(mesh, triangle, view, params.size) else { continue };
            for (column, row) in shown.pixels() {
                if shown.covers(column, row) {
                    lists[(v * size + row) * size + column].push(shown.element(column, row));
                }
            }
        }
    }
    for list in &mut lists {
        list.sort_by_key(|e| (e.depth, e.surface / 2));
    }
    Lists::of(lists.iter().map(Vec::as_slice)).capped(params)
}

/// A point in a view: x and y in sub-pixels, then the product with `forward`.
pub fn on_screen(view: &View, size: u32, point: [i16; 3]) -> [i128; 3] {
    let dot = |row: [i32; 4]| (0..3).map(|c| i128::from(row[c]) * i128::from(point[c])).sum::<i128>();
    // size·2^(s+14) is half the image in units of 2^-15 sub-pixels.
    let middle = i128::from(size) * subpixels(size) * (1 << 14);
    let axis = |row| (dot(row) + middle + (1 << 14)).div_euclid(1 << 15);
    [axis(view.right), axis(view.down), dot(view.forward)]
}

/// Sub-pixels per pixel: 2¹⁵ of them hold the least power of two of pixels that is not below the size.
fn subpixels(size: u32) -> i128 {
    let mut pixels = 1;
    while pixels < i128::from(size) {
        pixels *= 2;
    }
    (1 << 15) / pixels
}

/// A triangle in a view, its corners in the order that makes its area positive.
#[derive(Debug, Clone)]
pub struct Shown {
    triangle: usize,
    front: bool,
    corners: [[i128; 3]; 3],
    area: i128,
    size: usize,
    subpixels: i128,
    /// First column and row whose centres are not before the bounds.
    first: [usize; 2],
    /// Depths of the contract: in the first column and row, less there per column, per row.
    depths: [i128; 3],
}

impl Shown {
    /// The triangle of that number; `None` where it has no area on the screen.
    pub fn new(mesh: &LatticeMesh, triangle: usize, view: &View, size: u32) -> Option<Self> {
        let corner = |v: u32| on_screen(view, size, mesh.vertices()[v as usize]);
        Self::of(mesh.triangles()[triangle].map(corner), triangle, size)
    }

    /// A triangle of given screen coordinates and depths.
    pub fn of(mut corners: [[i128; 3]; 3], triangle: usize, size: u32) -> Option<Self> {
        let doubled =
            |[p, q, r]: &[[i128; 3]; 3]| (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
        let front = doubled(&corners) < 0;
        if front {
            corners.swap(1, 2);
        }
        let area = doubled(&corners);
        if area == 0 {
            return None;
        }
        let subpixels = subpixels(size);
        let centre = |i: usize| i as i128 * subpixels + subpixels / 2;
        let first = [0, 1].map(|axis| {
            let least = corners.iter().map(|c| c[axis]).min().unwrap_or(0);
            (0..size as usize).find(|&i| centre(i) >= least).unwrap_or(size as usize)
        });
        let [p, q, r] = corners;
        let (dq, dr) = ([0, 1, 2].map(|i| q[i] - p[i]), [0, 1, 2].map(|i| r[i] - p[i]));
        let (n_x, n_y) = (dq[2] * dr[1] - dr[2] * dq[1], dr[2] * dq[0] - dq[2] * dr[0]);
        let rounded = |n: i128| (n + area / 2).div_euclid(area);
        let at_first = rounded(n_x * (centre(first[0]) - p[0]) + n_y * (centre(first[1]) - p[1]));
        let depths = [p[2] + at_first, rounded(n_x * subpixels), rounded(n_y * subpixels)];
        Some(Self { triangle, front, corners, area, size: size as usize, subpixels, first, depths })
    }

    fn centre(&self, i: usize) -> i128 {
        i as i128 * self.subpixels + self.subpixels / 2
    }

    /// Pixels whose centres lie in the bounds.
    pub fn pixels(&self) -> impl Iterator<Item = (usize, usize)> {
        let [columns, rows] = [0, 1].map(|axis| {
            let most = self.corners.iter().map(|c| c[axis]).max().unwrap_or(0);
            let from = self.first[axis];
            from..(from..self.size).find(|&i| self.centre(i) > most).unwrap_or(self.size)
        });
        rows.flat_map(move |row| columns.clone().map(move |column| (column, row)))
    }

    /// dx, dy and the edge function at the pixel's centre, of the edges 0→1, 1→2, 2→0.
    pub fn edges(&self, column: usize, row: usize) -> [[i128; 3]; 3] {
        let (x, y) = (self.centre(column), self.centre(row));
        [(0, 1), (1, 2), (2, 0)].map(|(a, b)| {
            let (a, b) = (self.corners[a], self.corners[b]);
            let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
            [dx, dy, dx * (y - a[1]) - dy * (x - a[0])]
        })
    }

    /// Whether the pixel's centre belongs to the triangle.
    pub fn covers(&self, column: usize, row: usize) -> bool {
        self.edges(column, row).iter().all(|&[dx, dy, e]| {
            let top_or_left = dy < 0 || (dy == 0 && dx > 0);
            e > 0 || (e == 0 && top_or_left)
        })
    }

    /// The contract's z at a pixel, before it is clamped.
    pub fn unclamped(&self, column: usize, row: usize) -> i128 {
        let (i, j) = (column as i128 - self.first[0] as i128, row as i128 - self.first[1] as i128);
        self.depths[0] + i * self.depths[1] + j * self.depths[2]
    }

    /// The contract's depth at a pixel.
    pub fn depth(&self, column: usize, row: usize) -> u32 {
        let zs = self.corners.map(|c| c[2]);
        let (low, high) = (zs[0].min(zs[1]).min(zs[2]), zs[0].max(zs[1]).max(zs[2]));
        (self.unclamped(column, row).clamp(low, high) + ORIGIN) as u32
    }

    /// What the list of a covered pixel holds.
    pub fn element(&self, column: usize, row: usize) -> LhbElement {
        let surface = 2 * self.triangle as u32 + u32::from(self.front);
        LhbElement { surface, depth: self.depth(column, row) }
    }

    /// Whether a depth is as near to the plane through the corners as three roundings allow, which is half a unit each, the
    /// gradients' times the pixels from the first column and row. The plane comes from the corners' weights, the edge
    /// functions that face them.
    pub fn is_near_plane(&self, column: usize, row: usize, depth: u32) -> bool {
        let [to_1, to_2, to_0] = self.edges(column, row).map(|[_, _, e]| e);
        let plane = to_2 * self.corners[0][2] + to_0 * self.corners[1][2] + to_1 * self.corners[2][2];
        let error = (i128::from(depth) - ORIGIN) * self.area - plane;
        let roundings = 1 + (column - self.first[0]) + (row - self.first[1]);
        2 * error.abs() <= roundings as i128 * self.area
    }

    /// Whether the triangle shows its front.
    pub fn is_front(&self) -> bool {
        self.front
    }

    /// x and y in sub-pixels and z of the corners; 1 and 2 have changed places on a front.
    pub fn corners(&self) -> &[[i128; 3]; 3] {
        &self.corners
    }
}

#[cfg(test)]
mod tests;
