//! Bugs in `pack_lhb`: a packing on the host, wrong in one step.

use super::merge_lhb::{are_lists, host};
use crate::faults::Fault;
use crate::oracle::pack_lhb::{Packed, element_of, unpack, word_of};
use crate::oracle::rasterize_lhb::Lists;
use twinlight_core::kernels::pack_lhb::{EMPTY, PackLhbParams, PackedLhb, PackedLhbBuffers};
use twinlight_core::kernels::rasterize_lhb::{CAP_NEAR, Lhb, LhbBuffers, LhbElement};
use twinlight_core::{Backend, Error, Result};

pub(super) fn pack_lhb<B: Backend>(
    inner: &B,
    fault: Fault,
    lhb: &Lhb<B>,
    params: &PackLhbParams,
) -> Result<PackedLhb<B>> {
    let sound = inner.pack_lhb(lhb, params);
    let fit = params.check(lhb, |buffer| inner.len(buffer), inner.len(&lhb.elements)).is_ok();
    let packed = if fault == Fault::PackAcceptsAnything && !fit {
        Packed::default()
    } else if fault.sits_in("pack_lhb") && fit {
        let mut lists = host(inner, lhb)?;
        match (&sound, fault) {
            (Ok(_), _) => {}
            (Err(Error::LimitExceeded { .. }), Fault::PackCutsTriangles) => {
                lists.elements.iter_mut().for_each(|e| e.surface &= (1 << 21) - 1);
            }
            (Err(Error::InvalidInput { .. }), Fault::PackTrustsOffsets) => straighten(&mut lists),
            (Err(_), _) => return sound,
        }
        // Bugs must show in sound lists: those of other origin are left to the sound backend.
        if !are_lists(&lists) {
            return sound;
        }
        Broken { fault, params, lists: &lists }.packed()
    } else {
        return sound;
    };
    Ok(PackedLhbBuffers {
        size: lhb.size,
        view_count: lhb.view_count,
        layers: params.layers,
        offsets: inner.upload(&packed.offsets)?,
        words: inner.upload(&packed.words)?,
        left_out: inner.upload(&packed.left_out)?,
    })
}

pub(super) fn unpack_lhb<B: Backend>(inner: &B, fault: Fault, packed: &PackedLhb<B>) -> Result<Lhb<B>> {
    let sound = inner.unpack_lhb(packed);
    let fit = packed.check(|buffer| inner.len(buffer)).is_ok();
    let lists = if fault == Fault::UnpackAcceptsAnything && !fit {
        Lists::of([])
    } else if fault.sits_in("pack_lhb") && fit {
        let words = Packed {
            offsets: inner.download(&packed.offsets)?,
            words: inner.download(&packed.words)?,
            left_out: inner.download(&packed.left_out)?,
        };
        unpacked(fault, &words, packed.layers)
    } else {
        return sound;
    };
    Ok(LhbBuffers {
        size: packed.size,
        view_count: packed.view_count,
        offsets: inner.upload(&lists.offsets)?,
        elements: inner.upload(&lists.elements)?,
        left_out: inner.upload(&lists.left_out)?,
    })
}

/// Offsets that rise within their elements, instead of ones that don't.
fn straighten(lists: &mut Lists) {
    let count = lists.elements.len() as u32;
    lists.offsets.iter_mut().for_each(|offset| *offset = (*offset).min(count));
    lists.offsets.sort_unstable();
    lists.offsets[0] = 0;
    if let Some(last) = lists.offsets.last_mut() {
        *last = count;
    }
}

struct Broken<'a> {
    fault: Fault,
    params: &'a PackLhbParams,
    lists: &'a Lists,
}

impl Broken<'_> {
    fn packed(&self) -> Packed {
        let pixels: Vec<Vec<u32>> = self.lists.each().map(|list| self.words(list)).collect();
        let layers = self.params.layers as usize;
        if layers == 0 {
            let mut words = pixels.concat();
            self.lose_last(&mut words);
            return Packed {
                offsets: self.lists.offsets.clone(),
                words,
                left_out: self.lists.left_out.clone(),
            };
        }
        let empty = if self.fault == Fault::PackEmptyIsZero { 0 } else { EMPTY };
        let mut packed = Packed::default();
        for (i, list) in pixels.iter().enumerate() {
            let kept = self.within_layers(list);
            packed.left_out.push(self.left_out(i, (list.len() - kept.len()) as u32));
            packed.words.extend((0..layers).map(|layer| kept.get(layer).copied().unwrap_or(empty)));
        }
        self.lose_last(&mut packed.words);
        if self.fault == Fault::PackLayerByLayer {
            let words = |layer: usize| packed.words.iter().skip(layer).step_by(layers).copied();
            packed.words = (0..layers).flat_map(words).collect();
        }
        packed
    }

    fn lose_last(&self, words: &mut [u32]) {
        if self.fault == Fault::PackLosesLast && words.len() > 256 {
            words[256..].iter_mut().last().into_iter().for_each(|word| *word = 0);
        }
    }

    fn words(&self, list: &[LhbElement]) -> Vec<u32> {
        let mut words: Vec<u32> = list.iter().map(|e| self.word(*e)).collect();
        if self.fault == Fault::PackSortsWords {
            words.sort_unstable();
        }
        words
    }

    fn word(&self, element: LhbElement) -> u32 {
        let LhbElement { surface, depth } = element;
        match self.fault {
            Fault::PackRoundsDepth => word_of(LhbElement { depth: depth.saturating_add(1 << 18), surface }),
            Fault::PackWrapsDepth => depth >> 19 << 21 | surface,
            Fault::PackTwelveBits => word_of(LhbElement { depth: depth >> 1, surface }),
            Fault::PackDepthLast => word_of(element).rotate_left(11),
            Fault::PackLosesFacing => word_of(element) | 1,
            Fault::PackInvertsFacing => word_of(element) ^ 1,
            Fault::PackLosesBit => word_of(element) & !(1 << 20),
            _ => word_of(element),
        }
    }

    fn within_layers(&self, list: &[u32]) -> Vec<u32> {
        let layers = self.params.layers as usize;
        let most = if self.fault == Fault::PackLosesLayer { layers - 1 } else { layers }.min(list.len());
        let near = match self.fault {
            Fault::PackKeepsNear => true,
            Fault::PackKeepsFar => false,
            _ => self.params.cap_side == CAP_NEAR,
        };
        let mut kept = if near { list[..most].to_vec() } else { list[list.len() - most..].to_vec() };
        if self.fault == Fault::PackFarFirst && !near {
            kept.reverse();
        }
        kept
    }

    fn left_out(&self, i: usize, cut: u32) -> u32 {
        let before = self.lists.left_out.get(i).copied().unwrap_or(0);
        match self.fault {
            Fault::PackForgetsWhatItCuts => before,
            Fault::PackForgetsLeftOut => cut,
            Fault::PackLeftOutSaturates => before.saturating_add(cut),
            _ => before.wrapping_add(cut),
        }
    }
}

fn unpacked(fault: Fault, packed: &Packed, layers: u32) -> Lists {
    let mut lists = match fault {
        Fault::UnpackReadsEmpty if layers > 0 => {
            let offsets = (0..=packed.left_out.len() as u32).map(|i| i * layers).collect();
            let elements = packed.words.iter().map(|word| element_of(*word)).collect();
            Lists { offsets, elements, left_out: packed.left_out.clone() }
        }
        Fault::UnpackLosesLayer if layers > 1 => {
            let short = |list: &[u32]| list[..list.len() - 1].to_vec();
            let words = packed.words.chunks(layers as usize).flat_map(short).collect();
            unpack(&Packed { words, ..packed.clone() }, layers - 1)
        }
        _ => unpack(packed, layers),
    };
    for element in &mut lists.elements {
        element.depth -= if fault == Fault::UnpackReadsNearest { 1 << 18 } else { 0 };
    }
    if fault == Fault::UnpackForgetsLeftOut {
        lists.left_out.fill(0);
    }
    lists
}
