// kernel family: pack_lhb
// contract core/src/kernels/pack_lhb.rs
// cpu backend-cpu/src/kernels/pack_lhb.rs
// gpu backend-gpu/src/kernels/pack_lhb.wgsl
// oracle conformance/src/oracle/pack_lhb.rs
//! Oracle of `pack_lhb`: pixel by pixel, with products and quotients of 64 bits where both twins shift.

use super::rasterize_lhb::Lists;
use twinlight_core::kernels::pack_lhb::PackLhbParams;
use twinlight_core::kernels::rasterize_lhb::{CAP_NEAR, LhbElement};

/// Units of depth per bin: 2³⁰ of them in 2048 bins.
const BIN: u64 = (1 << 30) / 2048;
/// Surfaces that a word tells apart.
const SURFACES: u64 = 2 * (1 << 20);
/// What a layer without an element holds.
const EMPTY: u32 = u32::MAX;

/// Packed buffers on the host.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Packed {
    /// As [`twinlight_core::kernels::pack_lhb::PackedLhbBuffers::offsets`].
    pub offsets: Vec<u32>,
    /// As [`twinlight_core::kernels::pack_lhb::PackedLhbBuffers::words`].
    pub words: Vec<u32>,
    /// As [`twinlight_core::kernels::pack_lhb::PackedLhbBuffers::left_out`].
    pub left_out: Vec<u32>,
}

/// What the contract promises for sound parameters and lists.
pub fn pack(lists: &Lists, params: &PackLhbParams) -> Packed {
    if params.layers == 0 {
        let words = lists.elements.iter().map(|e| word_of(*e)).collect();
        return Packed { offsets: lists.offsets.clone(), words, left_out: lists.left_out.clone() };
    }
    let layers = params.layers as usize;
    let mut packed = Packed::default();
    for (i, list) in lists.each().enumerate() {
        let kept: Vec<u32> = if params.cap_side == CAP_NEAR {
            list.iter().take(layers).map(|e| word_of(*e)).collect()
        } else {
            list.iter().skip(list.len().saturating_sub(layers)).map(|e| word_of(*e)).collect()
        };
        let lost = (list.len() - kept.len()) as u64 + lists.left_out.get(i).map_or(0, |&n| u64::from(n));
        packed.left_out.push(lost as u32);
        packed.words.extend((0..layers).map(|layer| kept.get(layer).copied().unwrap_or(EMPTY)));
    }
    packed
}

/// What the contract promises for sound packed buffers of so many layers.
pub fn unpack(packed: &Packed, layers: u32) -> Lists {
    let elements = |words: &[u32]| words.iter().map(|word| element_of(*word)).collect::<Vec<_>>();
    if layers == 0 {
        let offsets = packed.offsets.clone();
        return Lists { offsets, elements: elements(&packed.words), left_out: packed.left_out.clone() };
    }
    let is_there = |word: &u32| *word != EMPTY;
    let pixels: Vec<Vec<LhbElement>> = packed
        .words
        .chunks(layers as usize)
        .map(|list| elements(&list.iter().copied().take_while(is_there).collect::<Vec<_>>()))
        .collect();
    Lists { left_out: packed.left_out.clone(), ..Lists::of(pixels.iter().map(Vec::as_slice)) }
}

/// An element of a triangle that a word can number.
pub fn word_of(element: LhbElement) -> u32 {
    let bin = (u64::from(element.depth) / BIN).min(2047);
    let front = u64::from(element.is_front());
    (bin * SURFACES + u64::from(element.triangle()) * 2 + front) as u32
}

/// A word, read back.
pub fn element_of(word: u32) -> LhbElement {
    let (bin, surface) = (u64::from(word) / SURFACES, u64::from(word) % SURFACES);
    LhbElement { surface: surface as u32, depth: ((2 * bin + 1) * BIN / 2) as u32 }
}

#[cfg(test)]
mod tests;
