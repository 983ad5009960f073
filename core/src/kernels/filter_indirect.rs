// kernel family: filter_indirect
// contract core/src/kernels/filter_indirect.rs
// cpu backend-cpu/src/kernels/filter_indirect.rs
// gpu backend-gpu/src/kernels/filter_indirect.wgsl
// oracle conformance/src/oracle/filter_indirect.rs
//! `filter_indirect`: the discontinuity buffer. Indirect light is averaged over the neighbours of a pixel that show the same diffuse
//! surface, because it varies slowly there, and its noise doesn't.
//!
//! *Shapes.* `gbuffer[width * height]` of [`crate::kernels::shade_primary`], `diffuse[m]` (1 for a material whose reflection does not
//! depend on the viewer, else 0), `input[width * height]`; `output[width * height]`. Row-major from the top-left pixel. *Units.*
//! Radiance in, radiance out.
//!
//! *Meaning.* For the pixel p at (x, y), window n = [`FilterIndirectParams::window`]:
//! 1. Where p shows nothing, or a material m with `diffuse[m]` 0 or without an entry, `output` is `input`.
//! 2. Neighbours are the pixels q at (x+i, y+j) of the image with 2|i| ≤ n and 2|j| ≤ n, p among them. Their weight is w(i)·w(j), w being 1
//!    where 2|i| < n and ½ where 2|i| = n: each of n × n interleaved patterns has the same weight in a window that lies in the image.
//! 3. A neighbour is *joined* when it shows the material of p, `shading_normal`ₚ·`shading_normal`_q ≥
//!    [`FilterIndirectParams::least_cosine`], and q's position is near p's plane:
//!    |`geometric_normal`ₚ·(`position`_q − `position`ₚ)| ≤ ([`FilterIndirectParams::footprint`]·n)·`depth`ₚ, which is what a surface at 45° to the
//!    line of sight rises over the window.
//! 4. Per channel c with `albedo`ₚ\[c\] ≥ [`LEAST_ALBEDO`]: `output`\[c\] = `albedo`ₚ\[c\] · (Σ W·(`input`_q\[c\] / `albedo`_q\[c\])) / Σ W, over the joined
//!    neighbours with `albedo`_q\[c\] ≥ [`LEAST_ALBEDO`]. So textures stay sharp. Other channels are copied.
//!
//! *Order.* Sums run row by row, from left to right; products associate as written, dot products as x·x' + y·y' + z·z' from the left, W is
//! w(j)·w(i).
//! *Edge cases.* n = 1 copies, but for the rounding of 4: p is its only neighbour. A p that meets no limit even beside itself (its depth is
//! negative, or no number) is not joined with itself; channels for which no neighbour counts are copied. No pixels: nothing. Radiance that is
//! not finite spreads to joined neighbours, and reaches no others.
//! *Error.* A bias of the order of the second derivative of irradiance over the window; contact shadows are blurred over it. A pixel that
//! shows two surfaces counts as the one at its centre, so that silhouettes bleed by up to half a window. Noise falls with the
//! number of joined neighbours.
//! *Source.* Keller, "Instant radiosity", 1997 and Keller and Heidrich, "Interleaved sampling", 2001 (the discontinuity buffer); Yu, layered
//! hit buffers, which removes structured noise so.

use crate::accuracy::Accuracy;
use crate::error::{Error, Result};
use bytemuck::{Pod, Zeroable};

/// Whether a neighbour is joined is decided by floats.
pub const ACCURACY: Accuracy = Accuracy::Interval {
    because: "exact in strict mode; elsewhere sums of some dozens of terms round otherwise, and a neighbour at a limit is joined or not",
};

/// Albedo below which light is not divided by it.
pub const LEAST_ALBEDO: f32 = 1.0 / 1024.0;

/// Widest window.
pub const MAX_WINDOW: u32 = 32;

/// A pixel's radiance.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct RadianceTexel {
    /// Linear RGB.
    pub rgb: [f32; 3],
    /// Unused, 0.
    pub padding: u32,
}

/// Parameters of one call.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
pub struct FilterIndirectParams {
    /// Pixels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// n: pixels per row and column of the window, 1 to [`MAX_WINDOW`].
    pub window: u32,
    /// Least cosine between normals.
    pub least_cosine: f32,
    /// Width of a pixel at depth 1, world units.
    pub footprint: f32,
    /// Unused, 0.
    pub padding: [u32; 3],
}

impl FilterIndirectParams {
    /// The number of pixels, if the call is sound; lengths are those of `gbuffer`, `input` and `output`.
    ///
    /// # Errors
    /// [`Error::InvalidInput`] for lengths other than `width * height`, a window of 0 or beyond [`MAX_WINDOW`], and limits that are not
    /// finite.
    pub fn check(&self, lengths: [usize; 3]) -> Result<usize> {
        let pixels = u64::from(self.width) * u64::from(self.height);
        for (name, length) in ["gbuffer", "input", "output"].into_iter().zip(lengths) {
            if length as u64 != pixels {
                let what = format!("has {length} elements where {pixels} are needed");
                return Err(Error::invalid(format!("filter_indirect {name}"), what));
            }
        }
        if !(1..=MAX_WINDOW).contains(&self.window) {
            let what = format!("{} is none of 1 to {MAX_WINDOW}", self.window);
            return Err(Error::invalid("filter_indirect window", what));
        }
        if !self.least_cosine.is_finite() || !self.footprint.is_finite() {
            let what = format!("limits {} and {} are not finite", self.least_cosine, self.footprint);
            return Err(Error::invalid("filter_indirect", what));
        }
        Ok(pixels as usize)
    }
}
