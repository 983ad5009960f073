// kernel family: rasterize_lhb
// contract core/src/kernels/rasterize_lhb.rs
// cpu backend-cpu/src/kernels/rasterize_lhb.rs
// gpu backend-gpu/src/kernels/rasterize_lhb.wgsl
// oracle conformance/src/oracle/rasterize_lhb.rs
//! `rasterize_lhb`: layered hit buffers, every surface along every pixel's line, for many orthographic views at once.
//!
//! *Shapes.* A [`crate::lattice::LatticeMesh`] and V views of N × N pixels in; out, [`LhbBuffers`]: `offsets[V·N² + 1]` and
//! `elements[offsets[V·N²]]`. The list of view v and pixel (column x, row y) is
//! `elements[offsets[i]..offsets[i + 1]]`, i = (v·N + y)·N + x, and is sorted by ([`LhbElement::depth`], triangle).
//! Nothing is lost: every triangle that covers a pixel's centre is in its list, once.
//! *Units.* Lattice steps; screen coordinates in 2⁻ˢ pixels, s = [`crate::lattice::subpixel_bits`]`(N)`; depths in 2⁻¹⁴ steps, away from
//! the viewer, [`crate::lattice::DEPTH_ORIGIN`] at the lattice's centre.
//!
//! *Meaning.* All of it in integers; `>>` rounds down, as does ⌊ ⌋.
//! 1. Vertex p has x, y as in [`View`] and z = forward·p.
//! 2. A = (x₁−x₀)(y₂−y₀) − (y₁−y₀)(x₂−x₀). A triangle with A = 0 covers nothing. Where A < 0, it shows its front (its
//!    vertices run counter-clockwise as the viewer sees them; y grows downwards), and vertices 1 and 2 change places, so that
//!    A > 0 below.
//! 3. Pixel (i, j) has its centre at X = i·2ˢ + 2ˢ⁻¹, Y likewise. It is covered when for each of the edges a→b = 0→1, 1→2,
//!    2→0, with dx = x_b − x_a and dy = y_b − y_a, E = dx·(Y−y_a) − dy·(X−x_a) is positive, or is 0 and the edge is a top
//!    or left one: dy < 0, or dy = 0 and dx > 0.
//! 4. Depth. (i₀, j₀) is the first column and row whose centres are not before the least x and y of the vertices, (X₀, Y₀) its
//!    centre.
//!    With n_x = (z₁−z₀)(y₂−y₀) − (z₂−z₀)(y₁−y₀) and n_y = (z₂−z₀)(x₁−x₀) − (z₁−z₀)(x₂−x₀), and r(n) = ⌊(n + ⌊A/2⌋) / A⌋:
//!    z(i, j) = z₀ + r(n_x·(X₀−x₀) + n_y·(Y₀−y₀)) + (i−i₀)·r(n_x·2ˢ) + (j−j₀)·r(n_y·2ˢ), clamped to the range of the vertices'
//!    z. `depth` = z + [`crate::lattice::DEPTH_ORIGIN`].
//!
//! *How 32 bits suffice.* At pixel centres of the image, E is twice the area of a triangle on the image, at most 2³⁰; beyond it E
//! may leave 32 bits, so that no path looks there. n_x and n_y are below 2⁴⁶ and the arguments of r below 2⁶², once per triangle; the
//! sums are taken modulo 2³²: the exact z of a covered pixel is within the vertices' range, inside (−2²⁹, 2²⁹), and rounding
//! moves it by at most ½ + ½(i−i₀) + ½(j−j₀) < 2¹⁰.
//! *Accuracy of depth.* Against the plane through the vertices as they are on the screen: those roundings, at most 2⁻⁴ lattice
//! steps at 1024² and 2⁻⁷ at 128².
//!
//! *Paths.* Small triangles (few pixels in their bounds) are tested pixel by pixel. Large ones are cut into 4 × 4 blocks which
//! are outside, inside or on an edge; into runs of pixels; or into spans between their edges. [`RasterizeLhbParams::path`]
//! forces one of them for all triangles. All give the same bits.
//! *Cap.* With [`RasterizeLhbParams::layer_cap`] K > 0, each list keeps the K elements that come first ([`CAP_NEAR`]) or last
//! ([`CAP_FAR`]) in its order, and `left_out[i]` counts the rest. Without a cap `left_out` is empty.
//! *Opposite views.* A list read backwards, with facing inverted, stands for that of the opposite direction, which need not be
//! drawn. Drawn, it has the same surfaces in mirrored columns, except where a centre is on an edge or a coordinate half-way
//! between two, and depths within 2(N−1) + 1 units.
//! *Edge cases.* No triangles, no views: no elements, `offsets` is V·N² + 1 zeros. Equal depths: the lower triangle first.
//! *Limits.* V·N² < [`crate::kernels::scan::MAX_LEN`]; fewer than 2³² elements after the cap; both are checked
//! before elements are allocated.
//! *Source.* Yu, layered hit buffers; Pineda, "A parallel algorithm for polygon rasterization", 1988; top-left rule of
//! Direct3D 11 §3.4.2.1. Deviation from Yu: lists of any length, in an order of their own, and back faces are kept.

use crate::accuracy::Accuracy;
use crate::backend::Backend;
use crate::error::{Error, Result};
use crate::kernels::scan;
use crate::lattice::View;
use bytemuck::{Pod, Zeroable};
use std::fmt;

/// Every output is decided by integers.
pub const ACCURACY: Accuracy = Accuracy::Exact {
    because: "coverage, depth and order are integer arithmetic, and lists are sorted by keys that differ",
};

/// Most triangles of a mesh: their number and the facing share a word.
pub const MAX_TRIANGLES: usize = (1 << 31) - 1;

/// [`RasterizeLhbParams::path`]: whichever suits the triangle's size.
pub const PATH_AUTO: u32 = 0;
/// [`RasterizeLhbParams::path`]: pixel by pixel.
pub const PATH_MICRO: u32 = 1;
/// [`RasterizeLhbParams::path`]: 4 × 4 blocks.
pub const PATH_BLOCKS: u32 = 2;
/// [`RasterizeLhbParams::path`]: runs of pixels of the bounds, row after row.
pub const PATH_LINEAR: u32 = 3;
/// [`RasterizeLhbParams::path`]: one span per row.
pub const PATH_SPANS: u32 = 4;

/// [`RasterizeLhbParams::cap_side`]: keep what is nearest to the viewer.
pub const CAP_NEAR: u32 = 0;
/// [`RasterizeLhbParams::cap_side`]: keep what is farthest.
pub const CAP_FAR: u32 = 1;

/// Parameters of one call.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
pub struct RasterizeLhbParams {
    /// Pixels per row and column of every view.
    pub size: u32,
    /// One of the `PATH_…` constants.
    pub path: u32,
    /// Most elements per pixel, 0 for all.
    pub layer_cap: u32,
    /// One of the `CAP_…` constants.
    pub cap_side: u32,
}

/// One surface on a pixel's line.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
pub struct LhbElement {
    /// Twice the triangle's number, plus 1 where it shows the viewer its front.
    pub surface: u32,
    /// Distance from the viewer, 2⁻¹⁴ lattice steps.
    pub depth: u32,
}

impl LhbElement {
    /// Number of the triangle in its mesh.
    pub fn triangle(self) -> u32 {
        self.surface >> 1
    }

    /// Whether the viewer sees the side on which the vertices run counter-clockwise.
    pub fn is_front(self) -> bool {
        self.surface & 1 == 1
    }
}

/// Layered hit buffers on a device: `O` holds `u32`, `E` holds [`LhbElement`].
#[derive(Clone)]
pub struct LhbBuffers<O, E> {
    /// Pixels per row and column of every view.
    pub size: u32,
    /// Number of views.
    pub view_count: u32,
    /// Where each pixel's list begins, and the number of elements.
    pub offsets: O,
    /// The lists.
    pub elements: E,
    /// How many elements the cap left out, per pixel; empty without a cap.
    pub left_out: O,
}

impl<O, E> fmt::Debug for LhbBuffers<O, E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "LhbBuffers({} views of {}x{})", self.view_count, self.size, self.size)
    }
}

impl<O, E> LhbBuffers<O, E> {
    /// The number of lists that the size and the views stand for. Anyone can put buffers together: whoever reads them asks this
    /// before it multiplies.
    ///
    /// # Errors
    /// [`Error::InvalidInput`] for a size of 0, [`Error::LimitExceeded`] for a size or a number of lists beyond the limits.
    pub fn lists(&self) -> Result<usize> {
        lists(self.view_count.into(), self.size)
    }
}

/// [`LhbBuffers`] in a backend's buffers.
pub type Lhb<B> = LhbBuffers<<B as Backend>::Buffer<u32>, <B as Backend>::Buffer<LhbElement>>;

impl RasterizeLhbParams {
    /// All layers of views of `size` by `size` pixels.
    pub fn new(size: u32) -> Self {
        Self { size, path: PATH_AUTO, layer_cap: 0, cap_side: CAP_NEAR }
    }

    /// The number of lists, if the call is sound.
    ///
    /// # Errors
    /// [`Error::InvalidInput`] for a size of 0, a view out of its budget or an unknown path or side;
    /// [`Error::LimitExceeded`] for a size or a number of lists beyond the limits. Views are not checked for being
    /// right-handed: facing is by the sign of A.
    pub fn check(&self, views: &[View]) -> Result<usize> {
        if self.path > PATH_SPANS {
            return Err(Error::invalid("path", format!("{} is none of 0 to {PATH_SPANS}", self.path)));
        }
        if self.cap_side > CAP_FAR {
            return Err(Error::invalid("cap_side", format!("{} is neither 0 nor 1", self.cap_side)));
        }
        let lists = lists(views.len() as u64, self.size)?;
        for (i, view) in views.iter().enumerate() {
            view.check(self.size)
                .map_err(|error| Error::invalid(format!("views[{i}]"), error.to_string()))?;
        }
        Ok(lists)
    }
}

/// The number of lists of `views` views of `size` by `size` pixels, if there may be such views.
pub(crate) fn lists(views: u64, size: u32) -> Result<usize> {
    crate::lattice::check_size(size)?;
    let lists = views.saturating_mul(u64::from(size) * u64::from(size));
    let limit = scan::MAX_LEN as u64 - 1;
    if lists > limit {
        return Err(Error::limit("pixels of all views", lists, limit));
    }
    Ok(lists as usize)
}

/// The number of elements as `offsets` can hold it.
///
/// # Errors
/// [`Error::LimitExceeded`] for 2³² and more.
pub fn check_elements(count: u64) -> Result<u32> {
    let limit = u64::from(u32::MAX);
    u32::try_from(count).map_err(|_| Error::limit("elements of layered hit buffers", count, limit))
}
