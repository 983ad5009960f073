// kernel family: pack_lhb
// contract core/src/kernels/pack_lhb.rs
// cpu backend-cpu/src/kernels/pack_lhb.rs
// gpu backend-gpu/src/kernels/pack_lhb.wgsl
// oracle conformance/src/oracle/pack_lhb.rs
//! `pack_lhb`: one pass over elements or words in chunks of a fixed number of them; with layers, of lists. Offsets of layers that are
//! read back come from a pass that counts, before.

use crate::buffer::{try_copy, try_zeroed};
use crate::{CpuBackend, CpuBuffer};
use rayon::prelude::*;
use twinlight_core::Result;
use twinlight_core::kernels::pack_lhb::{
    EMPTY, PackLhbParams, PackedLhb, PackedLhbBuffers, PackedShape, check_triangles, malformed,
};
use twinlight_core::kernels::rasterize_lhb::{CAP_FAR, Lhb, LhbBuffers, LhbElement};
use twinlight_core::math::packed::{packed_element, unpacked_element};

/// Elements per task: what the caches hold, read and written.
const CHUNK: usize = 1 << 14;

/// Lists per task that reads or writes layers.
const LISTS: usize = 1 << 10;

/// The shape is that of the call.
pub(crate) fn pack_lhb(
    lhb: &Lhb<CpuBackend>,
    params: &PackLhbParams,
    shape: PackedShape,
) -> Result<PackedLhb<CpuBackend>> {
    let (offsets, left_out) = (lhb.offsets.as_slice(), lhb.left_out.as_slice());
    let mut words = try_zeroed(shape.words as usize)?;
    let (offsets, left_out, greatest) = if params.layers > 0 {
        let mut lost = try_zeroed(shape.lists)?;
        let layers = Layers { offsets, elements: lhb.elements.as_slice(), left_out, params };
        let greatest = layers.fill(&mut words, &mut lost)?;
        (Vec::new(), lost, greatest)
    } else {
        let greatest = pack_elements(lhb.elements.as_slice(), &mut words);
        (try_copy(offsets)?, try_copy(left_out)?, greatest)
    };
    check_triangles(greatest >> 1)?;
    Ok(PackedLhbBuffers {
        size: lhb.size,
        view_count: lhb.view_count,
        layers: params.layers,
        offsets: CpuBuffer::from(offsets),
        words: CpuBuffer::from(words),
        left_out: CpuBuffer::from(left_out),
    })
}

/// Packs elements one by one; returns the greatest surface.
fn pack_elements(elements: &[LhbElement], words: &mut [u32]) -> u32 {
    // [1] pack elements
    let chunks = elements.par_chunks(CHUNK).zip(words.par_chunks_mut(CHUNK));
    chunks.map(|(elements, words)| pack_part(elements, words)).max().unwrap_or(0)
}

fn pack_part(elements: &[LhbElement], words: &mut [u32]) -> u32 {
    let mut greatest = 0;
    for (element, word) in elements.iter().zip(words) {
        greatest = greatest.max(element.surface);
        *word = packed_element(*element);
    }
    greatest
}

/// Lists that are cut to layers.
struct Layers<'a> {
    offsets: &'a [u32],
    elements: &'a [LhbElement],
    /// Empty where nothing is known to be left out.
    left_out: &'a [u32],
    params: &'a PackLhbParams,
}

impl Layers<'_> {
    /// Fills all layers, and counts what they have no room for; returns the greatest surface of what they have.
    fn fill(&self, words: &mut [u32], lost: &mut [u32]) -> Result<u32> {
        // [2] fill layers
        let layers = self.params.layers as usize;
        let chunks = words.par_chunks_mut(layers.saturating_mul(LISTS)).zip(lost.par_chunks_mut(LISTS));
        let fill = |(chunk, (words, lost)): (usize, (&mut [u32], &mut [u32]))| {
            let mut lists = words.chunks_mut(layers).zip(lost).enumerate();
            lists.try_fold(0, |greatest: u32, (i, (words, lost))| {
                self.fill_list(chunk * LISTS + i, words, lost).map(|surface| greatest.max(surface))
            })
        };
        chunks.enumerate().map(fill).try_reduce(|| 0, |a, b| Ok(a.max(b)))
    }

    fn fill_list(&self, list: usize, words: &mut [u32], lost: &mut u32) -> Result<u32> {
        let (begin, end) = (self.offsets[list] as usize, self.offsets[list + 1] as usize);
        let elements = self.elements.get(begin..end).ok_or_else(malformed)?;
        let stays = elements.len().min(words.len());
        let beyond = elements.len() - stays;
        let first = if self.params.cap_side == CAP_FAR { beyond } else { 0 };
        let (full, empty) = words.split_at_mut(stays);
        empty.fill(EMPTY);
        *lost = self.left_out.get(list).copied().unwrap_or(0).wrapping_add(beyond as u32);
        Ok(pack_part(&elements[first..first + stays], full))
    }
}

/// The shape is that of `packed`.
pub(crate) fn unpack_lhb(packed: &PackedLhb<CpuBackend>, shape: PackedShape) -> Result<Lhb<CpuBackend>> {
    let words = packed.words.as_slice();
    let left_out = try_copy(packed.left_out.as_slice())?;
    let (offsets, elements) = if packed.layers > 0 {
        let layers = packed.layers as usize;
        let offsets = count(words, layers, shape.lists)?;
        let elements = unpack_layers(words, layers, &offsets)?;
        (offsets, elements)
    } else {
        (try_copy(packed.offsets.as_slice())?, unpack_words(words)?)
    };
    Ok(LhbBuffers {
        size: packed.size,
        view_count: packed.view_count,
        offsets: CpuBuffer::from(offsets),
        elements: CpuBuffer::from(elements),
        left_out: CpuBuffer::from(left_out),
    })
}

fn unpack_words(words: &[u32]) -> Result<Vec<LhbElement>> {
    // [3] unpack words
    let mut elements = try_zeroed::<LhbElement>(words.len())?;
    let chunks = elements.par_chunks_mut(CHUNK).zip(words.par_chunks(CHUNK));
    chunks.for_each(|(elements, words)| unpack_part(words, elements));
    Ok(elements)
}

fn unpack_part(words: &[u32], elements: &mut [LhbElement]) {
    for (element, word) in elements.iter_mut().zip(words) {
        *element = unpacked_element(*word);
    }
}

/// Where each list begins, and where the last ends.
fn count(words: &[u32], layers: usize, lists: usize) -> Result<Vec<u32>> {
    // [4] size
    let mut offsets = try_zeroed::<u32>(lists + 1)?;
    let chunks = offsets[1..].par_chunks_mut(LISTS).zip(words.par_chunks(layers.saturating_mul(LISTS)));
    chunks.for_each(|(sizes, words)| {
        for (size, list) in sizes.iter_mut().zip(words.chunks(layers)) {
            *size = len_of(list) as u32;
        }
    });
    // [5] scan
    // Sums are at most the number of words, which is below 2³².
    let mut end = 0;
    for offset in &mut offsets[1..] {
        end += *offset;
        *offset = end;
    }
    Ok(offsets)
}

/// How many words come before the empty ones. Not `partition_point`: between words of other origin its probes are its own.
fn len_of(list: &[u32]) -> usize {
    let (mut low, mut high) = (0, list.len());
    while low < high {
        let middle = low + (high - low) / 2;
        if list[middle] != EMPTY {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    low
}

fn unpack_layers(words: &[u32], layers: usize, offsets: &[u32]) -> Result<Vec<LhbElement>> {
    // [6] unpack layers
    let mut elements = try_zeroed::<LhbElement>(offsets[offsets.len() - 1] as usize)?;
    let mut rest = elements.as_mut_slice();
    let mut parts = Vec::new();
    for begin in (0..offsets.len() - 1).step_by(LISTS) {
        let offsets = &offsets[begin..offsets.len().min(begin + LISTS + 1)];
        let len = (offsets[offsets.len() - 1] - offsets[0]) as usize;
        parts.push((offsets, rest.split_off_mut(..len).unwrap_or_default()));
    }
    let chunks = parts.into_par_iter().zip(words.par_chunks(layers.saturating_mul(LISTS)));
    chunks.for_each(|((offsets, elements), words)| {
        for (ends, words) in offsets.windows(2).zip(words.chunks(layers)) {
            let place = |offset: u32| (offset - offsets[0]) as usize;
            let list = &mut elements[place(ends[0])..place(ends[1])];
            unpack_part(&words[..list.len()], list);
        }
    });
    Ok(elements)
}
