//! From a mask to ranks and lists of codes. Masks of fine grids are empty nearly everywhere: chunks without a bit are passed over.

use crate::buffer::try_zeroed;
use crate::simd::{Isa, Kernel, Width, dispatch};
use rayon::prelude::*;
use twinlight_core::Result;

/// Words of a mask per task.
const WORDS: usize = 1 << 12;

/// Codes per task.
const CODES: usize = 1 << 14;

/// Bits set before each word, and in all.
pub(crate) fn ranks(isa: Isa, mask: &[u32]) -> Result<Vec<u32>> {
    let mut ranks = try_zeroed::<u32>(mask.len() + 1)?;
    let counts: Vec<u32> = mask.par_chunks(WORDS).map(|words| dispatch(isa, Count { words })).collect();
    let mut before = 0;
    let mut starts = Vec::with_capacity(counts.len());
    for count in &counts {
        starts.push(before);
        before += count;
    }
    let chunks = ranks[1..].par_chunks_mut(WORDS).zip(mask.par_chunks(WORDS)).zip(&counts).zip(&starts);
    chunks.for_each(|(((ranks, words), &count), &before)| {
        if count == 0 {
            ranks.fill(before);
        } else {
            dispatch(isa, Rank { words, ranks, before });
        }
    });
    Ok(ranks)
}

/// Bits of some words.
struct Count<'a> {
    words: &'a [u32],
}

impl Kernel for Count<'_> {
    type Output = u32;

    #[inline(always)]
    fn run<W: Width>(self, _: W) -> u32 {
        let mut sum = 0;
        for word in self.words {
            sum += word.count_ones();
        }
        sum
    }
}

/// The ranks behind some words.
struct Rank<'a> {
    words: &'a [u32],
    ranks: &'a mut [u32],
    before: u32,
}

impl Kernel for Rank<'_> {
    type Output = ();

    #[inline(always)]
    fn run<W: Width>(self, _: W) {
        let mut sum = self.before;
        for (rank, word) in self.ranks.iter_mut().zip(self.words) {
            sum += word.count_ones();
            *rank = sum;
        }
    }
}

/// The codes of set bits, ascending.
pub(crate) fn codes(mask: &[u32], ranks: &[u32]) -> Result<Vec<u32>> {
    let mut codes = try_zeroed::<u32>(ranks[mask.len()] as usize)?;
    fill_codes(mask, ranks, &mut codes);
    Ok(codes)
}

/// The codes of set bits, ascending, in a slice of their number; `ranks` may begin with what comes before the mask.
pub(crate) fn fill_codes(mask: &[u32], ranks: &[u32], codes: &mut [u32]) {
    let mut rest = codes;
    let mut parts = Vec::new();
    for begin in (0..mask.len()).step_by(WORDS) {
        let end = mask.len().min(begin + WORDS);
        let part = rest.split_off_mut(..(ranks[end] - ranks[begin]) as usize).unwrap_or_default();
        if !part.is_empty() {
            parts.push((begin, &mask[begin..end], part));
        }
    }
    parts.into_par_iter().for_each(|(begin, words, part)| {
        let mut places = part.iter_mut();
        for (i, &word) in words.iter().enumerate() {
            let mut bits = word;
            while bits != 0 {
                if let Some(place) = places.next() {
                    *place = ((begin + i) << 5) as u32 | bits.trailing_zeros();
                }
                bits &= bits - 1;
            }
        }
    });
}

/// The codes of the next level.
pub(crate) fn parents(active: &[u32]) -> Vec<u32> {
    let chunks: Vec<Vec<u32>> = (0..active.len().div_ceil(CODES))
        .into_par_iter()
        .map(|chunk| {
            let begin = chunk * CODES;
            // A parent that began in the chunk before is listed there.
            let mut last = begin.checked_sub(1).map(|i| active[i] >> 3);
            let mut parents = Vec::with_capacity(CODES / 2);
            for code in &active[begin..active.len().min(begin + CODES)] {
                let parent = Some(code >> 3);
                if parent != last {
                    parents.extend(parent);
                    last = parent;
                }
            }
            parents
        })
        .collect();
    chunks.concat()
}
