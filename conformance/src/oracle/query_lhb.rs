// kernel family: query_lhb
// contract core/src/kernels/query_lhb.rs
// cpu backend-cpu/src/kernels/query_lhb.rs
// gpu backend-gpu/src/kernels/query_lhb.wgsl
// oracle conformance/src/oracle/query_lhb.rs
//! Oracle of `query_lhb`: the whole list, element by element, in 128 bits, where nothing can overflow. Screen coordinates are
//! those of the oracle of `rasterize_lhb`; planes are rounded without a float.

use super::rasterize_lhb::{Lists, on_screen};
use twinlight_core::kernels::query_lhb::{CLEARANCE, LhbQuery, NO_ELEMENT};
use twinlight_core::kernels::rasterize_lhb::LhbElement;
use twinlight_core::lattice::{LatticeMesh, View};

/// What depths are counted from.
const ORIGIN: i128 = 1 << 29;

/// What a query meets that meets nothing.
pub const NOTHING: LhbElement = LhbElement { surface: NO_ELEMENT, depth: 0 };

/// A plane on the lattice.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Plane {
    /// The unit normal times 2¹³, each component rounded to the nearest integer.
    pub normal: [i128; 3],
    /// The normal's product with the corners' mean, rounded down.
    pub offset: i128,
}

impl Plane {
    /// The plane of a triangle. Which half-way a component falls on never matters: 2¹⁴·n/|n| is no odd integer, because a
    /// rational |n|, its common factors with n taken out, is odd.
    pub fn of(corners: [[i16; 3]; 3]) -> Self {
        let [a, b, c] = corners.map(|p| p.map(i128::from));
        let [e, f] = [b, c].map(|p| [p[0] - a[0], p[1] - a[1], p[2] - a[2]]);
        let n = [e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2], e[0] * f[1] - e[1] * f[0]];
        let squared = dot(n, n);
        let normal = n.map(|n| n.signum() * rounded(n.abs(), squared));
        let offset = (dot(normal, a) + dot(normal, b) + dot(normal, c)).div_euclid(3);
        Self { normal, offset }
    }

    /// Positive on the side on which the corners run counter-clockwise.
    pub fn side(&self, point: [i128; 3]) -> i128 {
        dot(self.normal, point) - self.offset
    }
}

/// The k for which 2¹³·n/√`squared` is between k − ½ and k + ½: by squares, which have less than 100 bits.
fn rounded(n: i128, squared: i128) -> i128 {
    let (mut low, mut high) = (0, 1 << 13);
    while low < high {
        let k = (low + high) / 2;
        let beyond = squared * (2 * k + 1) * (2 * k + 1) < (n << 14) * (n << 14);
        (low, high) = if beyond { (k + 1, high) } else { (low, k) };
    }
    low
}

fn dot(a: [i128; 3], b: [i128; 3]) -> i128 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// What a query says, taken apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Looking {
    /// Number of the view.
    pub view: usize,
    /// Whether it looks towards the viewer.
    pub reversed: bool,
    /// Column and row.
    pub pixel: [usize; 2],
    /// Depth of the position, as elements count it.
    pub depth: i128,
}

impl Looking {
    /// The line that a query looks along; `None` beyond the views.
    pub fn of(query: &LhbQuery, views: &[View], size: u32) -> Option<Self> {
        let view = (query.ray / 2) as usize;
        // Positions are within reach, where 16 bits hold them.
        let point = query.position.map(|c| c as i16);
        let [x, y, z] = on_screen(views.get(view)?, size, point);
        let last = i128::from(size) - 1;
        let pixel = [(x, query.offset[0]), (y, query.offset[1])].map(|(at, offset)| {
            let at = at + i128::from(offset);
            at.div_euclid(subpixels(size)).clamp(0, last) as usize
        });
        Some(Self { view, reversed: query.ray % 2 == 1, pixel, depth: z + ORIGIN })
    }

    /// How far ahead of the position an element is.
    pub fn ahead(&self, element: LhbElement) -> i128 {
        let beyond = i128::from(element.depth) - self.depth;
        if self.reversed { -beyond } else { beyond }
    }

    /// Whether the query sees the element's front.
    pub fn sees_front(&self, element: LhbElement) -> bool {
        (element.surface % 2 == 1) != self.reversed
    }

    /// Number of the line's list.
    pub fn list(&self, size: u32) -> usize {
        let size = size as usize;
        (self.view * size + self.pixel[1]) * size + self.pixel[0]
    }
}

/// Sub-pixels per pixel: 2¹⁵ of them hold the least power of two of pixels that is not below the size.
fn subpixels(size: u32) -> i128 {
    let pixels = (0..).map(|bits| 1_i128 << bits).find(|&pixels| pixels >= i128::from(size));
    (1 << 15) / pixels.unwrap_or(1)
}

/// What the contract promises for queries within the lattice's reach and lists of `size`.
pub fn query(
    mesh: &LatticeMesh,
    lists: &Lists,
    size: u32,
    views: &[View],
    queries: &[LhbQuery],
) -> Vec<LhbElement> {
    let corners = |triangle: &[u32; 3]| triangle.map(|v| mesh.vertices()[v as usize]);
    let planes: Vec<Plane> = mesh.triangles().iter().map(|t| Plane::of(corners(t))).collect();
    let lists: Vec<&[LhbElement]> = lists.each().collect();
    queries
        .iter()
        .map(|query| {
            let Some(looking) = Looking::of(query, views, size) else { return NOTHING };
            let mut list = lists[looking.list(size)].to_vec();
            if looking.reversed {
                list.reverse();
            }
            let is_hit = |e: &&LhbElement| {
                let ahead = looking.ahead(**e);
                let window = i128::from(query.window);
                ahead > window || (ahead >= -window && entered(query, &looking, **e, &planes))
            };
            let facing = u32::from(looking.reversed);
            list.iter().find(is_hit).map_or(NOTHING, |e| LhbElement { surface: e.surface ^ facing, ..*e })
        })
        .collect()
}

/// Whether the position is before the element, on the side that the query is on of what it leaves.
fn entered(query: &LhbQuery, looking: &Looking, element: LhbElement, planes: &[Plane]) -> bool {
    let front = looking.sees_front(element);
    let side = planes[element.triangle() as usize].side(query.position.map(i128::from));
    let before = if front { side } else { -side };
    element.triangle() != query.leaves / 2
        && front == (query.leaves % 2 == 1)
        && before > i128::from(CLEARANCE)
}

#[cfg(test)]
mod tests;
