// kernel family: trace_cones
// contract core/src/kernels/trace_cones.rs
// cpu backend-cpu/src/kernels/trace_cones.rs
// gpu backend-gpu/src/kernels/trace_cones.wgsl
// oracle conformance/src/oracle/trace_cones.rs
//! Oracle of `trace_cones`: a map from (level, voxel) to value, where both twins count bits, and for every number the interval that
//! WGSL's accuracy leaves to f32.
//!
//! *Decisions.* What a rounding may decide either way is decided either way. Where neighbouring answers meet without a step (⌊q⌋, level) the interval
//! spans both. The end of a cone is a step: [`possible`] gives every light that it may end with. So is whether a voxel is in front of a
//! surface: the interval then spans every choice of the voxels in doubt, and a mean whose weights may all be nothing spans the voxels' own values
//! and zero.

mod filter;
mod march;
mod value;
mod within;

pub use march::possible;
pub use within::Within;

use std::collections::BTreeMap;
use twinlight_core::kernels::reduce_mips::words_of;

/// The levels of a grid with what their voxels store.
#[derive(Debug, Clone)]
pub struct Pyramid {
    /// Voxels per axis.
    pub dims: [u32; 3],
    /// The level of one voxel.
    pub last: u32,
    /// One of the storages that hold light.
    pub storage: u32,
    values: BTreeMap<(u32, [u32; 3]), Vec<u32>>,
}

impl Pyramid {
    /// Of `values` in the order of `active`, whose codes from `starts[l]` on are those of level l.
    pub fn new(dims: [u32; 3], storage: u32, starts: &[u32], active: &[u32], values: &[u32]) -> Self {
        let words = words_of(storage).unwrap_or(1);
        let level_of = |at: usize| starts.iter().rposition(|&start| start as usize <= at).unwrap_or(0) as u32;
        let each = active.iter().zip(values.chunks(words)).enumerate();
        let values = each.map(|(at, (&code, value))| ((level_of(at), voxel_of(code)), value.to_vec()));
        Self { dims, last: starts.len() as u32 - 2, storage, values: values.collect() }
    }

    /// What an active voxel stores.
    pub fn value(&self, level: u32, voxel: [u32; 3]) -> Option<&[u32]> {
        self.values.get(&(level, voxel)).map(Vec::as_slice)
    }

    /// Voxels of a level that hold some of the grid, per axis.
    pub fn counts(&self, level: u32) -> [u32; 3] {
        (0..level).fold(self.dims, |counts, _| counts.map(|n| n.div_ceil(2)))
    }
}

/// The voxel of a code: each digit of a code to base 8 has a bit of every coordinate.
fn voxel_of(code: u32) -> [u32; 3] {
    let (mut voxel, mut rest, mut bit) = ([0; 3], code, 1);
    while rest > 0 {
        for (axis, c) in voxel.iter_mut().enumerate() {
            *c += bit * (rest >> axis & 1);
        }
        (rest, bit) = (rest / 8, bit * 2);
    }
    voxel
}

/// What may come through a cone.
#[derive(Debug, Clone, Copy)]
pub struct Possible {
    /// Radiance.
    pub rgb: [Within; 3],
    /// What is left of light from beyond.
    pub transmittance: Within,
}

impl Possible {
    /// Whether `light` is in it.
    pub fn holds(&self, light: &twinlight_core::kernels::trace_cones::ConeLight) -> bool {
        let rgb = self.rgb.iter().zip(light.rgb).all(|(within, found)| within.holds(found));
        rgb && self.transmittance.holds(light.transmittance)
    }
}

#[cfg(test)]
mod tests;
