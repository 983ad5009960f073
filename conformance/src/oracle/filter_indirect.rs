// kernel family: filter_indirect
// contract core/src/kernels/filter_indirect.rs
// cpu backend-cpu/src/kernels/filter_indirect.rs
// gpu backend-gpu/src/kernels/filter_indirect.wgsl
// oracle conformance/src/oracle/filter_indirect.rs
//! Oracle of `filter_indirect`, twice.
//!
//! [`as_written`] is the contract's formula in f32 and in its order: what strict mode must give bit for bit. [`possible`] is the third
//! road: quotients and sums in f64, weights counted in quarters, and around the mean the interval that WGSL's accuracy leaves to f32.
//! Whether a neighbour is joined has a band of doubt, in which either answer is right: the interval then spans all means that such
//! neighbours, each taken or left, can bring about.

mod bounds;
mod written;

pub use bounds::{Allowed, Pixel, possible};
pub use written::as_written;

use twinlight_core::kernels::filter_indirect::{FilterIndirectParams, RadianceTexel};
use twinlight_core::kernels::shade_primary::GBufferTexel;
use twinlight_core::kernels::trace::NO_HIT;

/// What a call is given.
#[derive(Debug, Clone)]
pub struct Picture {
    /// Parameters.
    pub params: FilterIndirectParams,
    /// What every pixel shows.
    pub gbuffer: Vec<GBufferTexel>,
    /// Which materials are diffuse.
    pub diffuse: Vec<u32>,
    /// Light of every pixel.
    pub input: Vec<RadianceTexel>,
}

impl Picture {
    /// Column and row of a pixel.
    pub fn place(&self, at: usize) -> [i64; 2] {
        let width = self.params.width as usize;
        [(at % width) as i64, (at / width) as i64]
    }

    /// The pixel at a column and row, if the picture has it.
    pub fn pixel(&self, x: i64, y: i64) -> Option<usize> {
        let (width, height) = (i64::from(self.params.width), i64::from(self.params.height));
        ((0..width).contains(&x) && (0..height).contains(&y)).then_some((y * width + x) as usize)
    }

    /// Whether a pixel's light is averaged at all.
    pub fn is_diffuse(&self, at: usize) -> bool {
        let texel = &self.gbuffer[at];
        let entry = self.diffuse.get(texel.material as usize);
        texel.triangle != NO_HIT && entry.is_some_and(|entry| *entry != 0)
    }

    /// The pixels of the window around a pixel, row by row and from left to right, each with four times its weight: two halves per
    /// direction, of which the border of an even window has one.
    pub fn window(&self, at: usize) -> Vec<(usize, u32)> {
        let n = i64::from(self.params.window);
        let [x, y] = self.place(at);
        let halves = |step: i64| match (2 * step.abs()).cmp(&n) {
            std::cmp::Ordering::Less => 2,
            std::cmp::Ordering::Equal => 1,
            std::cmp::Ordering::Greater => 0,
        };
        let reach = n / 2;
        let steps = (-reach..=reach).flat_map(|j| (-reach..=reach).map(move |i| (i, j)));
        steps.filter_map(|(i, j)| Some((self.pixel(x + i, y + j)?, halves(i) * halves(j)))).collect()
    }
}

#[cfg(test)]
mod tests;
